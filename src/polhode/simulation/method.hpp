// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <polhode/kernels/dispatch.hpp>
#include <polhode/model/model.hpp>
#include <polhode/stepping/stepper.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// How a model is going to be integrated: what the user asked for, and what was chosen where the
/// user did not.
struct Method {
  GeneralizedAlpha ga;
  StepControl control;
  std::unique_ptr<NewtonEngine> engine;
  const LaneKernels* kernels = nullptr;
  std::string narration;  ///< What was chosen and why, a sentence each.
};

/// @throws InputError if what is asked for does not go together: a higher order with ρ∞ < 1 or with
///         dampers; automatic steps of order 4; the tree with a rate of momentum
///         or a Jacobian policy it does not have; an unknown solver.
[[nodiscard]] Method choose_method(const System& system, const AnalysisSpec& analysis);

}  // namespace polhode
