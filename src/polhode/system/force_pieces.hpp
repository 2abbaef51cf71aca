// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace polhode {

/// Smooth pieces of forces at an instant. A number that depends on the piece alone names it.
struct ForcePieces {
  std::vector<double> kinks;  ///< Names of pieces at whose ends a derivative of the force jumps.
  std::vector<double> jumps;  ///< Of pieces at whose ends the force itself may jump.
  /// States of friction and stops: ±1 slips, between them the part of the limit under which it
  /// sticks or rests, 2 free; and ±1 whether a motion still has the direction of its slip.
  std::vector<double> slips;

  [[nodiscard]] bool operator==(const ForcePieces&) const = default;
  void add(double name, bool jumps_there = false) { (jumps_there ? jumps : kinks).push_back(name); }
};

}  // namespace polhode
