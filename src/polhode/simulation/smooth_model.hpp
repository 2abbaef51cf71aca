// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <polhode/model/model.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// A part of a model that an extrapolated step does not combine, in words for a sentence.
struct NotSmooth {
  std::string what;  ///< The part by its name, and what it has: "the joint 'a' has dry friction".
  std::string why;   ///< "which is not smooth".
  std::string hint;  ///< What to do.
};

/// The first part of a model whose motion has fewer derivatives than an extrapolated step of this
/// order needs, but for times that steps end at, or whose state is not combined rightly.
/// @param automatic  The error of steps is held at a tolerance. Members of a step across a kink of
/// a force differ by its effect, so that steps are short around it, and only there; steps in which
/// a stop is met are left to order 2.
[[nodiscard]] std::optional<NotSmooth> not_smooth(const Model& model, const System& system,
                                                  int order, bool automatic);

/// The first force of loads and cables that may have a kink in a coordinate or a rate, whether it
/// is reached or not.
[[nodiscard]] std::optional<NotSmooth> kink_of_forces(const Model& model);

}  // namespace polhode
