// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace polhode {

/// State of a running cable at an instant.
struct RunningCableReport {
  double tension = 0.0;  ///< Of all spans, with friction their mean by free length [N].
  double length = 0.0;   ///< [m]
  double rate = 0.0;     ///< Of the length [m/s].
  double energy = 0.0;   ///< Stored [J].
  std::vector<double> tensions = {};  ///< Of each span [N].
  /// Of a muscle: length of its fibres [m], their activation, passive part of the tension [N].
  double fibre_length = 0.0, activation = 0.0, passive = 0.0;
};

}  // namespace polhode
