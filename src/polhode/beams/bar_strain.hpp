// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace polhode {

/// Strain measure of a bar.
enum class BarStrain {
  engineering,  ///< (l − L)/L
  green         ///< (l² − L²)/(2L²)
};

}  // namespace polhode
