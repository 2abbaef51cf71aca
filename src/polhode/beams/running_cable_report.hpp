// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace polhode {

/// State of a running cable at an instant.
struct RunningCableReport {
  double tension = 0.0;  ///< [N]
  double length = 0.0;   ///< [m]
  double rate = 0.0;     ///< Of the length [m/s].
  double energy = 0.0;   ///< Stored [J].
  /// Of a muscle: length of its fibres [m], their activation, passive part of the tension [N].
  double fibre_length = 0.0, activation = 0.0, passive = 0.0;
};

}  // namespace polhode
