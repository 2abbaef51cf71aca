// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/assembly/element_group.hpp>
#include <polhode/fe/mesh/mesh.hpp>

namespace polhode {

/// How a deformable solid stands at the state of a simulation.
struct SolidReport {
  // By node of its mesh, world
  std::vector<Vec3> position;      ///< [m]
  std::vector<Vec3> displacement;  ///< From the start [m].
  std::vector<Vec3> velocity;      ///< [m/s]
  // By element of its mesh
  std::vector<ElementSample> elements;
};

/// What a bonded body, or what prescribes nodes, exerts on a solid.
struct InterfaceReport {
  Vec3 force = Vec3::Zero();   ///< World axes [N].
  Vec3 moment = Vec3::Zero();  ///< About the body's centre of mass, or the world's origin [N m].
};

/// √(3/2 s:s) of the deviator s of a stress [Pa].
[[nodiscard]] double von_mises(const Mat3& stress);

/// Stresses and energies at nodes: what the elements around a node have there, averaged by volume.
/// @eq{nodal-stress}
struct NodalAverages {
  std::vector<Mat3> cauchy;                   ///< World [Pa].
  std::vector<double> von_mises;              ///< Of the averaged stress [Pa].
  std::vector<double> strain_energy_density;  ///< [J/m³]
  /// By element: mean over its nodes of how far its own stress is from the averaged one, as a von
  /// Mises stress [Pa]. (O. C. Zienkiewicz and J. Z. Zhu, Int. J. Numer. Methods Engrg. 24 (1987)
  /// 337-357.) @eq{stress-error}
  std::vector<double> stress_error;
};
[[nodiscard]] NodalAverages nodal_averages(const Mesh& mesh,
                                           const std::vector<ElementSample>& elements);

}  // namespace polhode
