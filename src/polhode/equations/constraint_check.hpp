// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace polhode {

/// How well the constraints hold at the current iterate.
struct ConstraintCheck {
  double residual = 0.0;  ///< Largest |g| [m or -].
  int worst_row = -1;
  double work_defect = 0.0;  ///< Σ |λ g|: the energy that the multipliers may leak [J].
  double work_scale = 0.0;  ///< Σ |λ|(ℓ + |x|): times round-off, the least that can be asked [J].
};

}  // namespace polhode
