// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <polhode/solids/materials/material_kind.hpp>
#include <polhode/solids/mesh/mesh.hpp>
#include <polhode/system/element_group.hpp>

namespace polhode {

/// √(3/2 s:s) of the deviator s of a stress [Pa].
[[nodiscard]] double von_mises(const Mat3& stress);

/// Stresses and energies of a solid at its nodes, and how far its elements are from them.
struct NodalFields {
  std::vector<Mat3> cauchy;                   ///< World [Pa].
  std::vector<double> von_mises;              ///< Of that stress [Pa].
  std::vector<double> strain_energy_density;  ///< [J/m³]
  /// By element: root mean square over its nodes of how far its own stress is from that of the
  /// nodes, as a von Mises stress [Pa]. @eq{stress-error}
  std::vector<double> stress_error;
  double energy = 0.0;        ///< Complementary energy of the stress at nodes [J].
  double error_energy = 0.0;  ///< That of the differences [J]. @eq{stress-error-energy}
};

/// Stresses at the nodes of a solid from those in its elements.
///
/// Quadratic elements and tet4: a polynomial fitted to the points of all elements around a vertex
/// that are best known (superconvergent patch recovery; O. C. Zienkiewicz and J. Z. Zhu, Int. J.
/// Numer. Methods Engrg. 33 (1992) 1331-1364). A vertex of the boundary takes the polynomials of
/// its neighbours inside. @eq{stress-patch}
/// Other elements: what the elements around a node have there, averaged by volume.
/// @eq{nodal-stress}
class NodalRecovery {
 public:
  /// @param mesh    Outlives this.
  /// @param moduli  Of the material at rest [Pa], for energies; the bulk modulus is positive.
  NodalRecovery(const Mesh& mesh, LinearModuli moduli);
  ~NodalRecovery();
  NodalRecovery(NodalRecovery&&) noexcept;

  /// @param elements  One sample an element of the mesh.
  [[nodiscard]] NodalFields fields(std::span<const ElementSample> elements) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polhode
