// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace polhode {

/// How a bar measures its strain.
enum class BarStrain {
  engineering,  ///< (l − L)/L
  green         ///< (l² − L²)/(2L²)
};

}  // namespace polhode
