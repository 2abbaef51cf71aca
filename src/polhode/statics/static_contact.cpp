// SPDX-License-Identifier: Apache-2.0
// Contact between surfaces of solids in the search for an equilibrium.
#include <algorithm>

#include <polhode/equations/node_motion.hpp>
#include <polhode/statics/static_newton.hpp>

namespace polhode {

namespace {

/// Reduction of admissible parts of an increment, as bodies rotate.
constexpr double kShorter = 0.98;
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
double StaticNewton::free_part(const State& at, const double* from, const double* to) const {
  double most = 1.0;
  NodeStep start = node_step(at, trial_), end = start;
  start.x_n1 = from;
  end.x_n1 = to;
  for (const Meeting& m : meetings_) {
    const double* history = at.element_history.data() + m.first_history;
    const double free = m.points->free_part(start, end, history);
    if (free < 1.0) most = std::min(most, kShorter * free);
  }
  return most;
}

double StaticNewton::free_part_of_increment() {
  if (meetings_.empty()) return 1.0;
  matrix_.expand(x_, du_);
  for (std::size_t k = 0; k < du_.size(); ++k) du_[k] += given_[k] + trial_.node_x[k];
  return free_part(work_, trial_.node_x.data(), du_.data());
}

}  // namespace polhode
