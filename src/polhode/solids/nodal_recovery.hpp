// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <polhode/solids/materials/material_kind.hpp>
#include <polhode/solids/mesh/mesh.hpp>
#include <polhode/solids/nodal_fields.hpp>
#include <polhode/system/element_group.hpp>

namespace polhode::solids {

/// √(3/2 s:s) of the deviator s of a stress [Pa].
[[nodiscard]] double von_mises(const Mat3& stress);

/// Recovery of nodal stresses of a solid from those in its elements.
///
/// Quadratic elements and tet4: a polynomial fitted to the superconvergent points of all elements
/// around a vertex (superconvergent patch recovery; O. C. Zienkiewicz and J. Z. Zhu, Int. J. Numer.
/// Methods Engrg. 33 (1992) 1331-1364). A vertex of the boundary uses the polynomials of its
/// interior neighbours. @eq{stress-patch}
/// Other elements: values of the elements around a node, averaged by volume. @eq{nodal-stress}
class NodalRecovery {
 public:
  /// @param mesh  Must outlive this.
  /// @param moduli  Of the material at rest [Pa], for energies; the bulk modulus is positive.
  NodalRecovery(const Mesh& mesh, LinearModuli moduli);
  /// Recovery in a solid of several materials, as the stress may jump across their interfaces: each
  /// is recovered by itself, and a node of several has the mean of theirs, weighted by their volume
  /// around it.
  /// @param materials  By block of the mesh, any numbers. @param moduli  By block.
  NodalRecovery(const Mesh& mesh, const std::vector<int>& materials,
                std::vector<LinearModuli> moduli);
  ~NodalRecovery();
  NodalRecovery(NodalRecovery&&) noexcept;

  /// Recovered fields. @param elements  One sample per element of the mesh.
  [[nodiscard]] NodalFields fields(std::span<const ElementSample> elements) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polhode::solids
