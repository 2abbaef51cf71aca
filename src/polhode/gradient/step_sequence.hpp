// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace polhode {

/// A whole step as a run took it.
struct TakenStep {
  double length = 0.0;  ///< [s]
  int members = 1;      ///< Of an extrapolated step; 1: a step of order 2, or a composition.
};

/// The steps of a run in their order, which its gradient keeps.
using StepSequence = std::vector<TakenStep>;

}  // namespace polhode
