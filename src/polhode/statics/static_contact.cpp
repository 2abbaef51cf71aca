// SPDX-License-Identifier: Apache-2.0
// Surfaces of solids that may meet each other while an equilibrium is looked for.
#include <algorithm>

#include <polhode/equations/node_motion.hpp>
#include <polhode/statics/static_newton.hpp>

namespace polhode {

namespace {

/// Parts of an increment that surfaces leave free are taken a little smaller, as bodies turn.
constexpr double kShorter = 0.98;
/// Increments below this, in sizes of elements, that stay above this part of the one before, come
/// no nearer to an equilibrium.
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

/// Iterates that go to and fro without coming nearer: on which sides of the kinks they are changes,
/// and a mixture of the sides' forces balances.
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

/// How far nodes may go on the straight way between two places: surfaces of solids are seen from
/// one side only, so that no iterate may take them through each other.
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
