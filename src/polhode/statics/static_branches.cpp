// SPDX-License-Identifier: Apache-2.0
// Loads between two equilibria at which stability changes or a branch ends.
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/statics/static_branches.hpp>

namespace polhode {

namespace {

/// Relative accuracy of loads at which stability changes, and largest number of searches.
constexpr double kLocated = 1e-6;
constexpr int kLocations = 40;
/// Relative accuracy of ends of branches, at which Newton's method converges slowly.
constexpr double kEnds = 1e-5;
/// Ratio of the distances of two equilibria, for an eighth of the load interval, below which they
/// are connected.
constexpr double kShrinks = 0.5;
constexpr int kTrials = 3;
/// Largest extrapolation to a limit point, in differences of the last two loads.
constexpr double kReach = 8.0;
/// Remaining part of the distance, at the smallest interval, above which there is a jump.
constexpr double kJumps = 0.1;

}  // namespace

double state_distance(const System& system, const State& a, const State& b) {
  const double per_length = 1.0 / system.length_scale();
  double most = 0.0;
  for (int i = 0; i < system.body_count(); ++i) {
    const BodyMotion m = system.motion(a, i), other = system.motion(b, i);
    most = std::max(most, per_length * (m.r - other.r).norm());
    if (!system.bodies()[i].point_mass) most = std::max(most, m.q.angularDistance(other.q));
  }
  for (std::size_t k = 0; k < a.node_x.size(); ++k)
    most = std::max(most, per_length * std::abs(a.node_x[k] - b.node_x[k]));
  return most;
}

/// A trial whose count is not known lies at the load itself: its tangent is singular to rounding.
/// One that has not converged is beyond it on the path from below; it narrows the interval, but is
/// no equilibrium that has lost its stability.
std::optional<LimitPoint> locate_stability_change(const System& system,
                                                  const StaticOptions& options, LoadInterval at,
                                                  int first, int after) {
  LimitPoint point;
  point.unstable = after;
  bool seen = false;                     // otherwise the equilibrium above lies on another branch
  StaticNewton finder(system, options);  // the tangent of the other one is used later
  finder.assemble_at(at.above, at.high);
  SoftestMotion soft = finder.softest();
  point.motion = soft.text;
  double at_high = -std::abs(soft.stiffness), at_low = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < kLocations && at.high - at.low > kLocated * at.high; ++i) {
    double part = at_low / (at_low - at_high);
    if (!(part > 0.02 && part < 0.98) || i % 3 == 2) part = 0.5;
    const double factor = at.low + part * (at.high - at.low);
    State trial = at.below;
    StaticStep step = finder.solve(trial, factor);
    if (!step.converged) {
      trial = at.above;
      step = finder.solve(trial, factor);
    }
    if (!step.converged) {
      at.high = factor;
      at_high = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    soft = finder.softest();
    if (!soft.text.empty()) point.motion = soft.text;
    if (step.unstable < 0) {
      if (!step.free_motions.empty()) point.motion = step.free_motions.front();
      point.load_factor = factor;
      return point;
    }
    if (step.unstable == first) {
      at.low = factor;
      at.below = std::move(trial);
      at_low = std::abs(soft.stiffness);
    } else {
      at.high = factor;
      at.above = std::move(trial);
      at_high = -std::abs(soft.stiffness);
      seen = true;
    }
  }
  point.load_factor = 0.5 * (at.low + at.high);
  if (!seen) return {};
  return point;
}

/// @eq{statics-jump}
std::optional<LimitPoint> locate_jump(const System& system, const StaticOptions& options,
                                      LoadInterval at, std::optional<State>& continued) {
  StaticNewton finder(system, options);
  const double load = at.high;
  const double whole = state_distance(system, at.below, at.above);
  double way = whole;
  LimitPoint point;
  for (int i = 0; i < kLocations && at.high - at.low > kEnds * at.high; ++i) {
    const double factor = 0.5 * (at.low + at.high);
    State middle = at.below;
    bool found = finder.solve(middle, factor).converged;
    if (!found) {  // no equilibrium near below: one there would belong to the branch above
      middle = at.above;
      found = finder.solve(middle, factor).converged;
    }
    const bool on_the_first = found && state_distance(system, at.below, middle) <
                                           state_distance(system, middle, at.above);
    if (on_the_first) {
      at.low = factor;
      at.below = middle;
    } else {
      at.high = factor;
      if (found) at.above = middle;
    }
    way = state_distance(system, at.below, at.above);
    if (i == kTrials - 1 && way < kShrinks * whole) return {};
  }
  if (way < kJumps * whole) return {};
  if (load - at.low <= 2.0 * kEnds * load) {  // followed as far as the load itself
    State end = at.below;
    if (finder.solve(end, load).converged &&
        state_distance(system, at.below, end) < kJumps * whole) {
      continued = std::move(end);
      return {};
    }
  }
  finder.assemble_at(at.below, at.low);
  point.motion = finder.softest().text;
  point.load_factor = at.low;
  point.jump = true;
  point.distance = way;
  return point;
}

std::optional<LimitPoint> extrapolate_limit(const System& system, const StaticOptions& options,
                                            const LoadInterval& at) {
  StaticNewton finder(system, options);
  finder.assemble_at(at.below, at.low);
  const double before = finder.softest().stiffness;
  finder.assemble_at(at.above, at.high);
  const SoftestMotion soft = finder.softest();
  if (!(soft.stiffness > 0.0 && before > soft.stiffness)) return {};
  const double part =
      soft.stiffness * soft.stiffness / (before * before - soft.stiffness * soft.stiffness);
  if (!(part < kReach)) return {};
  LimitPoint point;
  point.load_factor = at.high + part * (at.high - at.low);
  point.motion = soft.text;
  return point;
}

}  // namespace polhode
