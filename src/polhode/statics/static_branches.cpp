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
/// Numbers of bisections after which two equilibria are connected if their distance has decreased
/// to these parts: nearly in proportion to the load, or by its root.
constexpr int kTrials = 3, kMoreTrials = 10;
constexpr double kShrinks = 0.25, kShrinksSlowly = 0.1;
/// Ratio of the first two increments of Newton's method below which it contracts.
constexpr double kContracts = 0.5;
/// Largest extrapolation to a limit point, in differences of the last two loads.
constexpr double kReach = 8.0;
/// Remaining part of the distance, at the smallest interval, above which there is a jump, and
/// distance below which there is none.
constexpr double kJumps = 0.1, kSamePlace = 1e-6;

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

namespace {

/// Bisection between two equilibria.
struct BranchSearch {
  const System& system;
  const StaticOptions& options;
  LoadInterval at;
  int first, after;     ///< Unstable directions of both, or of the last trial that differs.
  StaticNewton finder;  ///< One of its own: the tangent of the other is used later.
  BranchCheck found;
  /// Stiffness of the softest motion at both ends, negative above; NaN: not known [N/m].
  double at_low = std::numeric_limits<double>::quiet_NaN(), at_high = at_low;

  BranchSearch(const System& s, const StaticOptions& o, LoadInterval interval, int below, int above)
      : system(s), options(o), at(std::move(interval)), first(below), after(above), finder(s, o) {}

  /// Whether stability tells the two branches apart.
  [[nodiscard]] bool stability_differs() const {
    return first >= 0 && after >= 0 && first != after;
  }
  /// Whether a trial has as many unstable directions as the equilibrium below, as far as known.
  [[nodiscard]] bool same_stability(const StaticStep& step) const {
    return first < 0 || step.unstable < 0 || step.unstable == first;
  }
  /// Whether Newton's method contracted from its start on, so that there is hardly another solution
  /// near it: this tells an equilibrium of equal stability on a third branch from one on the branch
  /// from below that has left the others. Near a fold, where it decides nothing, distances tell.
  [[nodiscard]] static bool contracts(const StaticStep& step) {
    const std::vector<double>& e = step.increments;
    return e.size() < 2 || e[1] < kContracts * e[0];
  }
  [[nodiscard]] bool nearer_below(const State& state) const {
    return state_distance(system, at.below, state) < state_distance(system, state, at.above);
  }
  [[nodiscard]] double accuracy() const { return stability_differs() ? kLocated : kEnds; }
  [[nodiscard]] double distance() const { return state_distance(system, at.below, at.above); }

  /// Load factor of the next trial: where the smallest stiffness vanishes by linear interpolation,
  /// or the middle.
  [[nodiscard]] double next_factor(int trial) const {
    double part = at_low / (at_low - at_high);
    if (!(part > 0.02 && part < 0.98) || trial % 3 == 2) part = 0.5;
    return at.low + part * (at.high - at.low);
  }

  /// One trial between the two. @returns false if it lies at a change of stability to rounding: its
  /// tangent is singular, so that its unstable directions cannot be counted.
  bool narrow(double factor) {
    State middle = at.below;
    StaticStep step = finder.solve(middle, factor);
    if (!step.converged) {  // no equilibrium near below: one there would belong to the branch above
      middle = at.above;
      step = finder.solve(middle, factor);
    }
    if (!step.converged) {
      at.high = factor;
      at_high = std::numeric_limits<double>::quiet_NaN();
      return true;
    }
    const SoftestMotion soft = stability_differs() ? finder.softest() : SoftestMotion{};
    if (!soft.text.empty()) found.point.motion = soft.text;
    if (stability_differs() && step.unstable < 0) {
      if (!step.free_motions.empty()) found.point.motion = step.free_motions.front();
      found.point.load_factor = factor;
      return false;
    }
    if (same_stability(step) &&
        (nearer_below(middle) || (stability_differs() && contracts(step)))) {
      at.low = factor;
      at.below = std::move(middle);
      at_low = std::abs(soft.stiffness);
    } else {
      if (first >= 0 && step.unstable >= 0) after = step.unstable;
      at.high = factor;
      at.above = std::move(middle);
      at_high = -std::abs(soft.stiffness);
    }
    return true;
  }

  BranchCheck run() {
    double whole = distance();
    found.point.unstable = after;
    if (stability_differs()) {
      finder.assemble_at(at.above, at.high);
      const SoftestMotion soft = finder.softest();
      found.point.motion = soft.text;
      at_high = -std::abs(soft.stiffness);
    }
    int trials = 0;  // with two equilibria that differ by their distance only
    for (int i = 0; i < kLocations && at.high - at.low > accuracy() * std::abs(at.high); ++i) {
      const bool differed = stability_differs();
      if (!narrow(next_factor(i))) return finish(BranchRelation::changes);
      if (differed != stability_differs()) whole = std::max(whole, distance());
      if (stability_differs() || differed) continue;
      ++trials;
      if (trials == kTrials && distance() < kShrinks * whole) return finish(BranchRelation::same);
      if (trials == kMoreTrials && distance() < kShrinksSlowly * whole)
        return finish(BranchRelation::same);
    }
    const double close = std::max(kJumps * whole, kSamePlace);
    if (!stability_differs() && distance() < kJumps * whole) return finish(BranchRelation::same);
    found.state = at.below;
    found.further = finder.solve(found.state, at.high);
    const bool there = found.further.converged;
    const double way = there ? state_distance(system, at.below, found.state) : 0.0;
    if (there && same_stability(found.further) &&
        (way < close || (stability_differs() && contracts(found.further))))
      return finish(BranchRelation::continues);
    found.point.load_factor = 0.5 * (at.low + at.high);
    const bool connected = distance() <= close || (there && way <= close);
    if (stability_differs() && connected) return finish(BranchRelation::changes);
    finder.assemble_at(at.below, at.low);
    found.point.motion = finder.softest().text;
    found.point.load_factor = at.low;
    found.point.jump = true;
    found.point.distance = distance();
    return finish(BranchRelation::ends);
  }

  BranchCheck finish(BranchRelation relation) {
    found.relation = relation;
    return std::move(found);
  }
};

}  // namespace

/// @eq{statics-jump}
BranchCheck follow_branch(const System& system, const StaticOptions& options, LoadInterval interval,
                          int first, int after) {
  return BranchSearch(system, options, std::move(interval), first, after).run();
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
