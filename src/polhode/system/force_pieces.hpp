// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace polhode {

/// Smooth pieces of forces at an instant. A number that depends on the piece alone names it.
struct ForcePieces {
  std::vector<double> kinks;  ///< Names of pieces at whose ends a derivative of the force jumps.
  std::vector<double> jumps;  ///< Of pieces at whose ends the force itself may jump.
  /// States of friction and stops that the last step left: ±1, or in between the part of the limit
  /// under which it sticks; ±1 whether the motion still has the direction of slip; 0 for none.
  std::vector<double> slips;

  [[nodiscard]] bool operator==(const ForcePieces&) const = default;
  void add(double name, bool jumps_there = false) { (jumps_there ? jumps : kinks).push_back(name); }
};

}  // namespace polhode
