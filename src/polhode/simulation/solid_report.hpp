// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/solids/nodal_recovery.hpp>
#include <polhode/system/element_group.hpp>

namespace polhode {

/// How a deformable solid stands at the state of a simulation.
struct SolidReport {
  // By node of its mesh, world
  std::vector<Vec3> position;      ///< [m]
  std::vector<Vec3> displacement;  ///< From the start [m].
  std::vector<Vec3> velocity;      ///< [m/s]
  // By element of its mesh
  std::vector<ElementSample> elements;
  NodalFields nodal;  ///< Stresses at nodes, by what the elements have.
};

/// What a bonded body, or what prescribes nodes, exerts on a solid.
struct InterfaceReport {
  Vec3 force = Vec3::Zero();   ///< World axes [N].
  Vec3 moment = Vec3::Zero();  ///< About the body's centre of mass, or the world's origin [N m].
};

}  // namespace polhode
