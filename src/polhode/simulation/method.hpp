// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <polhode/kernels/dispatch.hpp>
#include <polhode/model/model.hpp>
#include <polhode/stepping/stepper.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Integration method of a model: the user's settings, and choices where there are none.
struct Method {
  GeneralizedAlpha ga;
  StepControl control;
  std::unique_ptr<NewtonEngine> engine;
  const LaneKernels* kernels = nullptr;
  std::string narration;  ///< Choices and reasons, a sentence each.
};

/// Whether orders above 2 are reached by extrapolation.
[[nodiscard]] bool is_extrapolated(const AnalysisSpec& analysis);

/// @throws InputError if settings cannot be combined: a higher order with ρ∞ < 1, or by composition
/// with dampers; automatic steps of order 4; the tree with an unsupported momentum rate or Jacobian
/// policy; an unknown solver.
[[nodiscard]] Method choose_method(const System& system, const AnalysisSpec& analysis);

/// Order of accuracy of that method. @throws InputError likewise
[[nodiscard]] int method_order(const System& system, const AnalysisSpec& analysis);

}  // namespace polhode
