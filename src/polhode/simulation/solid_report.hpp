// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/solids/nodal_fields.hpp>
#include <polhode/system/element_sample.hpp>

namespace polhode {

/// Fields of a deformable solid at the state of a simulation.
struct SolidReport {
  // By node of its mesh, world
  std::vector<Vec3> position;      ///< [m]
  std::vector<Vec3> displacement;  ///< From the start [m].
  std::vector<Vec3> velocity;      ///< [m/s]
  // By element of its mesh
  std::vector<ElementSample> elements;
  solids::NodalFields nodal;  ///< Stresses at nodes, averaged from elements.
};

/// Wrench of a bonded body, or of prescribed nodes, on a solid.
struct InterfaceReport {
  Vec3 force = Vec3::Zero();   ///< World axes [N].
  Vec3 moment = Vec3::Zero();  ///< About the body's centre of mass, or the world's origin [N m].
};

}  // namespace polhode
