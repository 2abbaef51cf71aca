// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace polhode::solids {

/// Discrete stress of a fibre over a step.
template <class P>
struct FibreDifference {
  P value;       ///< F[y_0, y_1] = (F(y_1) − F(y_0))/(y_1 − y_0) [Pa].
  P derivative;  ///< ∂F[y_0, y_1]/∂y_1 [Pa].
};

}  // namespace polhode::solids
