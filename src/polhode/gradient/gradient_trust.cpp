// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/gradient/gradient.hpp>

namespace polhode {

namespace {

/// Error bar, as a part of the gradient, above which it is no property of the motion; effect of a
/// parameter, as a part of the largest, from which on its bar counts; error that is promised.
constexpr double kWide = 0.1, kCounts = 1e-3, kDigits = 1e-9;

}  // namespace

std::vector<std::vector<double>> error_bars(const RunGradient& own, const RunGradient& half) {
  // The error at h is C h^p, at h/2 it is 2^-p of that.
  const double factor = 1.0 / (1.0 - std::pow(0.5, own.order));
  std::vector<std::vector<double>> bars;
  for (std::size_t k = 0; k < own.outcomes.size(); ++k) {
    bars.emplace_back();
    for (std::size_t j = 0; j < own.outcomes[k].by.size(); ++j)
      bars.back().push_back(factor * std::abs(own.outcomes[k].by[j] - half.outcomes[k].by[j]));
  }
  return bars;
}

std::vector<std::string> gradient_doubts(const RunGradient& run, std::size_t outcome,
                                         const GradientRequest& request,
                                         const std::vector<double>& bars) {
  const OutcomeGradient& g = run.outcomes[outcome];
  std::vector<std::string> doubts;
  // Effects of parameters on the outcome, of which those far below the largest do not count.
  double largest = 0.0;
  const auto effect = [&](std::size_t j) {
    const double p = request.parameters[j].value;
    return std::abs(g.by[j] * (p != 0.0 ? p : 1.0));
  };
  for (std::size_t j = 0; j < g.by.size(); ++j) largest = std::max(largest, effect(j));
  std::string wide;
  for (std::size_t j = 0; j < bars.size(); ++j)
    if (effect(j) > kCounts * largest && bars[j] > kWide * std::abs(g.by[j]))
      wide += (wide.empty() ? "" : ", ") + request.parameters[j].path;
  if (!wide.empty())
    doubts.push_back(
        format("the gradient of '{}' by {} changes by more than {:.0f} % with half the step: it is "
               "exact for this run, and no property of the motion. Take {} or a shorter run",
               g.outcome, wide, 100.0 * kWide,
               run.step > 0.0 || run.sequence.empty() ? "a shorter step" : "a smaller tolerance"));
  if (!run.redundant.empty())
    doubts.push_back(
        format("the gradient of '{}' has about seven digits: where rho_inf is below 1, forces of "
               "redundant rows, which are not unique, move the bodies a little ({}). Use rho_inf: "
               "1, or joints without redundant rows",
               g.outcome, name_list(run.redundant, 4)));
  const double rounding =
      g.growth * std::numeric_limits<double>::epsilon() * static_cast<double>(run.steps);
  if (rounding > kDigits || g.spot_check > kDigits)
    doubts.push_back(
        format("the gradient of '{}' has fewer than nine digits: perturbations grow by a factor of "
               "{:.2g}, and tangent and adjoint differ by {:.0e}",
               g.outcome, g.growth, g.spot_check));
  return doubts;
}

}  // namespace polhode
