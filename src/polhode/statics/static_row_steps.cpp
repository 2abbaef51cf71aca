// SPDX-License-Identifier: Apache-2.0
// Load steps with unilateral rows: closing contacts, and jumps of bodies that touch with friction.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/statics/static_row_steps.hpp>

namespace polhode {

namespace {

/// Searches for the load at which a contact closes, and its accuracy.
constexpr int kClosings = 60;
constexpr double kClosed = 1e-9;
/// Way of a body in a load step, in sizes of the model or rad, up to which it is no jump.
constexpr double kNoJump = 1e-4;
/// Halvings of a load step in search of a jump, and the number of them in which a way that vanishes
/// with the load step is shortened by this part at least.
constexpr int kHalvings = 18, kShortening = 4;
constexpr double kVanishes = 0.8;
/// Number of contacts that a message names.
constexpr std::size_t kMostRubbing = 4;

}  // namespace

int end_where_it_closes(const System& system, StaticNewton& newton, const State& old, double size,
                        State& state, StaticStep& step) {
  int iterations = 0;
  const double from = old.t;
  double low = from, high = step.load_factor, gap_before = 0.0, low_before = from;
  double gap = std::numeric_limits<double>::infinity();
  bool known = false;  // two gaps before the contact
  double last = high;
  const auto solve = [&](State& trial, double at) {
    last = at;
    const StaticStep there = newton.solve(trial, at);
    iterations += there.iterations;
    return there;
  };
  for (int k = 0; k < kClosings && high - low > kClosed * size; ++k) {
    double at = 0.5 * (low + high);
    if (k == 0) at = std::min(at, from + kClosed * size);  // it falls, whatever the load
    if (known && gap < gap_before)
      at = std::clamp(low + (low - low_before) * gap / (gap_before - gap), low, at);
    if (!(at > low)) at = std::min(high, low + kClosed * size);
    State trial = old;
    const StaticStep there = solve(trial, at);
    if (!there.converged) break;
    if (newton.closes()) {
      high = at;
      state = std::move(trial);
      step = there;
      continue;
    }
    const double now = newton.rows()->gap_of_closing();
    known = std::isfinite(gap) && std::isfinite(now);
    gap_before = gap;
    low_before = low;
    gap = now;
    low = at;
    if (gap > system.touching_gap()) continue;
    state = std::move(trial);
    step = there;
    return iterations;
  }
  if (last == step.load_factor) return iterations;
  state = old;  // reports are those of the last search
  step = solve(state, step.load_factor);
  return iterations;
}

/// @eq{statics-friction-jump}
std::optional<FrictionJump> find_friction_jump(const System& system, StaticNewton& newton,
                                               const State& old, const State& state,
                                               const StaticStep& step, int& iterations) {
  const std::vector<int> bodies = newton.rows()->bodies_with_friction();
  const auto way = [&](const State& a, const State& b) {
    double most = 0.0;
    for (const int body : bodies) {
      const BodyMotion x = system.motion(a, body), y = system.motion(b, body);
      most = std::max({most, (y.r - x.r).norm() / system.length_scale(),
                       rotation_vector(y.q * x.q.conjugate()).norm()});
    }
    return most;
  };
  State low = old, high = state;
  double from = old.t, to = step.load_factor;
  std::vector<double> ways{way(low, high)};
  if (!(ways.back() > kNoJump)) return {};
  const std::vector<std::string> names = newton.rows()->with_friction();
  const auto jump = [&](const std::string& why) {
    return FrictionJump{
        from, format("{} {} or open{}, and the next equilibrium is not near: where friction would "
                     "end the motion depends on the motion{}",
                     name_list(names, kMostRubbing), names.size() == 1 ? "slides" : "slide",
                     names.size() == 1 ? "s" : "", why)};
  };
  for (int k = 0; k < kHalvings && ways.back() > kNoJump; ++k) {
    const double middle = 0.5 * (from + to);
    State half = low;
    const StaticStep first = newton.solve(half, middle);
    iterations += first.iterations;
    if (!first.converged) return jump(format(" ({})", first.reason));
    State whole = half;
    const StaticStep second = newton.solve(whole, to);
    iterations += second.iterations;
    if (!second.converged) return jump(format(" ({})", second.reason));
    const double before = way(low, half), after = way(half, whole);
    ways.push_back(std::max(before, after));
    if (before >= after) {
      high = std::move(half);
      to = middle;
    } else {
      low = std::move(half);
      high = std::move(whole);
      from = middle;
    }
  }
  const std::size_t n = ways.size();
  if (ways.back() <= kNoJump || ways.back() < kVanishes * ways[n - 1 - kShortening]) return {};
  return jump("");
}

}  // namespace polhode
