// SPDX-License-Identifier: Apache-2.0
// Contact between surfaces of solids in the search for an equilibrium.
#include <algorithm>

#include <polhode/equations/node_motion.hpp>
#include <polhode/statics/static_newton.hpp>

namespace polhode {

namespace {

/// Reduction of admissible parts of an increment, as bodies rotate.
constexpr double kShorter = 0.98;
/// Part of the clearance to a stop that an increment must leave, as in dynamics.
constexpr double kLeaveStop = 0.1;
/// Increment, in sizes of elements, and its ratio to the previous one: below the first and above
/// the second the iteration has stalled.
constexpr double kSmall = 1e-5, kStalls = 0.5;

}  // namespace

void StaticNewton::look_for_neighbours() {
  if (meetings_.empty()) return;
  NodeStep step = node_step(work_, trial_);
  step.x_n = x_before_.empty() ? step.x_n1 : x_before_.data();
  for (const Meeting& m : meetings_)
    m.pattern->renew(step, work_.element_history.data() + m.first_history);
  x_before_ = trial_.node_x;
}

/// Whether alternating iterates are at an equilibrium on a kink: they change sides, and a convex
/// combination of the sides' forces vanishes.
bool StaticNewton::balanced_on_a_kink(StaticStep& step) {
  const std::size_t n = step.increments.size();
  if (meetings_.empty() || n < 3) return false;
  const double e = step.increments[n - 1];
  if (!(e < kSmall) || !(e > kStalls * step.increments[n - 2])) {
    kinks_.clear();
    return false;
  }
  kinks_.add(rhs_);
  const Vec here = rhs_;
  rhs_ = kinks_.shortest();
  const bool all = balanced(step) != Balance::off;
  rhs_ = here;
  return all;
}

/// Admissible part of a straight displacement of nodes. Surfaces of solids are one-sided, so that
/// no iterate may take them through each other.
double StaticNewton::free_part(const double* from, const double* to) const {
  double most = 1.0;
  NodeStep start = node_step(last_, trial_), end = start;
  start.x_n1 = from;
  end.x_n1 = to;
  for (const Meeting& m : meetings_) {
    const double* history = work_.element_history.data() + m.first_history;
    const double free = m.points->free_part(start, end, history);
    if (free < 1.0) most = std::min(most, kShorter * free);
  }
  const Nodes& nodes = system_->nodes();
  for (const int g : shapes_)
    most = std::min(most, nodes.group(g).barrier_constraint()->free_part(
                              start, end, work_.element_history.data() + nodes.first_history(g)));
  return most;
}

double StaticNewton::free_part_of_increment() {
  double most = 1.0;
  for (const int i : system_->barriers()) {
    const InteractionRef& ref = system_->interactions()[i];
    const auto clearance = [&](double part) {
      const auto moved = [&](int body) {
        BodyStep s = body_step(*system_, last_, trial_, body);
        if (body == kGround) return s;
        const Vec3 r = part * x_.segment<3>(6 * body), theta = part * x_.segment<3>(6 * body + 3);
        s.r_n1 += r;
        s.u += r;
        s.Lambda_n1 = cay(theta) * s.Lambda_n1;
        s.theta = compose_cayley(theta, s.theta);
        return s;
      };
      const BodyStep a = moved(ref.a), b = moved(ref.b);
      return system_->group(ref.group).clearance(
          ref.item, {a, b, trial_.context, work_.lambda.data() + ref.first_row,
                     work_.history.data() + ref.first_history});
    };
    const double from = clearance(0.0), to = clearance(1.0),
                 leave = kLeaveStop * std::min(from, 1.0);
    if (from > 0.0 && to < leave) most = std::min(most, kShorter * (from - leave) / (from - to));
  }
  if (meetings_.empty() && shapes_.empty()) return most;
  matrix_.expand(x_, du_);
  for (std::size_t k = 0; k < du_.size(); ++k) du_[k] += given_[k] + trial_.node_x[k];
  return std::min(most, free_part(trial_.node_x.data(), du_.data()));
}

/// Element group of a contact with a shape through which a point has passed since the last
/// equilibrium, as bodies do not move straight; -1: none.
int StaticNewton::passed_shape() const {
  if (shapes_.empty()) return -1;
  const NodeStep end = node_step(last_, trial_);
  NodeStep start = end;
  start.x_n1 = start.x_n;
  for (const int g : shapes_)
    if (const Nodes& nodes = system_->nodes();
        nodes.group(g).barrier_constraint()->free_part(
            start, end, work_.element_history.data() + nodes.first_history(g)) < 1.0)
      return g;
  return -1;
}

}  // namespace polhode
