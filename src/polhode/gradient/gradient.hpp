// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <polhode/gradient/outcome.hpp>
#include <polhode/gradient/step_sequence.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// A number of a model by which is differentiated.
struct GradientParameter {
  std::string path{};                       ///< As in the model file: "bodies.rod.mass".
  double value = 0.0;                       ///< In the unit below.
  std::string unit{};                       ///< As written in the file, or "" if it has none there.
  std::function<Model(double value)> at{};  ///< The model with another value.
  double step = 0.0;  ///< Of differences; 0: a thousandth of the value, or of 1.
};

struct GradientRequest {
  std::vector<GradientParameter> parameters{};
  std::vector<Outcome> outcomes{};
  /// Factors of the outcomes, one for each: instead of each outcome their weighted sum is
  /// differentiated, by one adjoint. Empty: each by itself.
  std::vector<double> weights{};
  /// Tangents of all parameters instead of the adjoint of each outcome: for more outcomes than
  /// parameters.
  bool forward = false;
  /// Leaves out the adjoints of all outcomes but the last, and with them their growth and check:
  /// for many outcomes, forward.
  bool only_last_adjoint = false;
};

/// Gradient of one outcome.
struct OutcomeGradient {
  std::string outcome{}, unit{};
  double value = 0.0, time = 0.0;  ///< The outcome, and the time at which it is taken [s].
  std::vector<double> by{};        ///< By parameter, per its unit.
  /// Largest growth of the adjoint backwards over the run [-]: a perturbation grows as much.
  double growth = 0.0;
  /// Difference of tangent and adjoint in one direction of all parameters, as a part of the sum of
  /// its terms [-].
  double spot_check = 0.0;
};

/// Gradients of the outcomes of a run, exact for its steps.
struct RunGradient {
  std::vector<OutcomeGradient> outcomes;
  std::int64_t steps = 0;    ///< Single ones: stages and members' steps, at orders above 2.
  double step = 0.0;         ///< Fixed length [s]; 0: automatic.
  int order = 2;             ///< The lowest one, if it varies.
  std::int64_t impacts = 0;  ///< Of contacts and stops, at each of which a step ends.
  std::int64_t events = 0;   ///< Of those with a condition, likewise.
  StepSequence sequence;     ///< The whole steps, which are kept.
  /// Joints with redundant rows, "joint 'elbow'", whose forces at ρ∞ < 1 cost digits.
  std::vector<std::string> redundant;
  double run_seconds = 0.0, gradient_seconds = 0.0;
};

/// Runs a model, and differentiates that run: tangents and the adjoint of its own steps, at their
/// solutions. Their lengths and orders, where these are automatic too, and the times of breaks are
/// kept. Automatic steps end at the times of outcomes.
/// @throws InputError for what has no gradient, see require_differentiable(), and for parameters
/// that change more than numbers; SolveError for a run that does not end.
[[nodiscard]] RunGradient differentiate(const Model& model, const GradientRequest& request);

/// Gradients of the run with steps of half the length, for error_bars(); each automatic step is
/// taken as two of half its length.
/// @param run  With the whole steps.
[[nodiscard]] RunGradient differentiate_halves(const Model& model, const GradientRequest& request,
                                               const RunGradient& run);

/// Reasons to doubt a gradient, a sentence each: steps that are too long for it, a motion that
/// forgets its parameters, round-off.
/// @param bars  Of that outcome, see error_bars(); may be empty.
[[nodiscard]] std::vector<std::string> gradient_doubts(const RunGradient& run, std::size_t outcome,
                                                       const GradientRequest& request,
                                                       const std::vector<double>& bars);

/// Differences of gradients with the step h and with h/2, from which errors of the first follow.
/// @param half  That with half the step. @returns by outcome and parameter.
[[nodiscard]] std::vector<std::vector<double>> error_bars(const RunGradient& own,
                                                          const RunGradient& half);

}  // namespace polhode
