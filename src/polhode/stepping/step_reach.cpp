// SPDX-License-Identifier: Apache-2.0
#include <polhode/stepping/step_reach.hpp>

#include <algorithm>

#include <polhode/core/format.hpp>

namespace polhode {

namespace {

/// Sum of the errors of all steps, in tolerances, above which a warning is given: at order 2, which
/// spreads the tolerance over the run, and at the others, which apply it to each step.
constexpr double kClearly = 2.0, kClearlyComposed = 200.0;

}  // namespace

void StepReach::count(double t, double error, double asked, bool noise) {
  ++steps_;
  sum_ += error;
  if (!noise && error <= asked) return;
  if (beyond_++ == 0) first_ = t;
  worst_ = std::max(worst_, error);
}

std::vector<std::string> StepReach::warnings(double tolerance, int order) const {
  const bool adds_up = sum_ > (order == 2 ? kClearly : kClearlyComposed) * tolerance;
  // Order 2 spreads the tolerance over the run; small steps may be below round-off harmlessly. So
  // may steps of order 2 among extrapolated ones.
  if (beyond_ == 0 || ((order == 2 || worst_ <= tolerance) && !adds_up)) {
    if (!adds_up) return {};
    return {
        format("tolerance: {:.2g} applies to one step; the estimated errors of {} steps add up to "
               "{:.1e}. Give a smaller tolerance if that is too much",
               tolerance, steps_, sum_)};
  }
  return {
      format("tolerance: {:.2g} was not reached: {} of {} steps, the first at t = {:.6g} s, have "
             "errors up to {:.1e}, and shorter steps do not reduce them; the estimated errors of "
             "all steps add up to {:.1e}. Give a larger tolerance, or look for ratios of stiffness "
             "and mass that cause round-off noise",
             tolerance, beyond_, steps_, first_, worst_, sum_)};
}

}  // namespace polhode
