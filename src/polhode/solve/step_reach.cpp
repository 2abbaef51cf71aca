// SPDX-License-Identifier: Apache-2.0
#include <polhode/solve/step_reach.hpp>

#include <algorithm>

#include <polhode/base/format.hpp>

namespace polhode {

namespace {

/// A sum of errors is said to be too large from this many tolerances on.
constexpr double kClearly = 2.0;

}  // namespace

void StepReach::count(double t, double error, double asked, bool noise) {
  ++steps_;
  sum_ += error;
  if (!noise && error <= asked) return;
  if (beyond_++ == 0) first_ = t;
  worst_ = std::max(worst_, error);
}

std::vector<std::string> StepReach::warnings(double tolerance, int order) const {
  if (beyond_ == 0) return {};
  // Order 2 spreads the tolerance over the run; small steps may be below round-off without harm.
  if (order == 2 && sum_ < kClearly * tolerance) return {};
  return {format(
      "tolerance: {:.2g} was not reached: {} of {} steps, the first at t = {:.6g} s, err by up to "
      "{:.1e}, and no shorter step does better; the errors of all steps add up to {:.1e} by their "
      "own estimate. Ask for a larger tolerance, or look for stiffness and mass ratios that leave "
      "noise",
      tolerance, beyond_, steps_, first_, worst_, sum_)};
}

}  // namespace polhode
