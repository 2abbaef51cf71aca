// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/io/importers/mjcf_bodies.hpp>

namespace polhode::io {

/// A medium at rest that resists all bodies, as that of <option>.
struct MjcfMedium {
  const XmlFile::Element* at = nullptr;
  double density = 0.0, viscosity = 0.0;  ///< [kg/m³], [Pa s]
  bool wind = false;
};

/// Principal axes as columns, by rotations in the planes of the largest products of inertia,
/// beginning with the given axes: those that MuJoCo's compiler finds, also where moments are equal.
[[nodiscard]] Mat3 rotated_to_principal(const Mat3& inertia);

/// Resistance of a medium by the boxes that have the inertia of each body.
void add_medium(const MjcfMedium& medium, MjcfRefusals& refusals, const MjcfBodies& bodies,
                Robot& robot);

}  // namespace polhode::io
