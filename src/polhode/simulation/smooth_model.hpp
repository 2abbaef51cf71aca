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
/// @param automatic  The error of steps is held at a tolerance. Steps then end at kinks of forces;
/// those in which a stop is met are left to order 2.
[[nodiscard]] std::optional<NotSmooth> not_smooth(const Model& model, const System& system,
                                                  int order, bool automatic);

}  // namespace polhode
