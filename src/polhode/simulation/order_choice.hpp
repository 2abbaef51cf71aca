// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/model/model.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Order of accuracy of a run, and how it is reached: as the analysis says, or chosen.
struct OrderChoice {
  int order = 2;              ///< The largest one if it varies.
  bool extrapolated = false;  ///< By extrapolation, not by composition.
  bool varies = false;        ///< Each step has the order from 4 on that needs the least work.
  std::string reason;         ///< A sentence about what was chosen; empty if all was given.

  /// In words: "order 6 by composition".
  [[nodiscard]] std::string text() const;
};

/// @throws InputError if settings cannot be combined: a higher order with ρ∞ < 1, with contacts, or
/// by composition with dampers; automatic steps of order 4 by composition; extrapolation of what is
/// not smooth.
[[nodiscard]] OrderChoice choose_order(const System& system, const Model& model);

}  // namespace polhode
