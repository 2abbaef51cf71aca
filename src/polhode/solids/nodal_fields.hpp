// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/core/types.hpp>

namespace polhode::solids {

/// Stresses and energies of a solid at its nodes, and the deviation of its elements from them.
struct NodalFields {
  std::vector<Mat3> cauchy;                   ///< World [Pa].
  std::vector<double> von_mises;              ///< Of that stress [Pa].
  std::vector<double> strain_energy_density;  ///< [J/m³]
  /// By element: root mean square over its nodes of the difference between its own stress and that
  /// of the nodes, as a von Mises stress [Pa]. @eq{stress-error}
  std::vector<double> stress_error;
  double energy = 0.0;        ///< Complementary energy of the stress at nodes [J].
  double error_energy = 0.0;  ///< That of the differences [J]. @eq{stress-error-energy}
};

}  // namespace polhode::solids
