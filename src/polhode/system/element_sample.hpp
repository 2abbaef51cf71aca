// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/core/types.hpp>

namespace polhode {

/// Fields of an element at an instant, averaged over its integration points.
struct ElementSample {
  Mat3 cauchy = Mat3::Zero();               ///< World [Pa].
  Vec3 principal_stretches = Vec3::Ones();  ///< Largest first [-].
  double strain_energy_density = 0.0;       ///< Per reference volume [J/m³].
  double volume = 0.0;                      ///< Reference [m³].
  /// Cauchy stress [Pa] and energy density [J/m³] at its nodes, extrapolated from the integration
  /// points; empty for elements without an extrapolation.
  std::vector<Mat3> cauchy_at_nodes;
  std::vector<double> energy_at_nodes;
};

}  // namespace polhode
