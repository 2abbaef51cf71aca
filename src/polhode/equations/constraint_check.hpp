// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace polhode {

/// Violation of the constraints at the current iterate.
struct ConstraintCheck {
  double residual = 0.0;  ///< Largest |g| [m or -].
  int worst_row = -1;
  double work_defect = 0.0;  ///< Σ |λ g|: possible energy leak of the multipliers [J].
  double work_scale = 0.0;  ///< Σ |λ|(ℓ + |x|): times round-off, the smallest attainable leak [J].
  std::string broken;       ///< Fault of a contact in the step; empty: none.
};

}  // namespace polhode
