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
  std::string scheme;     ///< Order and how it is reached, in words.
  std::string narration;  ///< Choices and reasons, a sentence each.
};

/// @throws InputError if settings cannot be combined, as choose_order(); the tree with an
/// unsupported momentum rate or Jacobian policy; an unknown solver.
[[nodiscard]] Method choose_method(const System& system, const Model& model);

}  // namespace polhode
