// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace polhode {

class Simulation;

/// Fields of the contact of a deformable solid, by node of its mesh: NaN at nodes without contact
/// points.
struct SolidContactFields {
  std::vector<double> pressure;  ///< Mean of the last step [Pa], by reference area.
  /// To the nearest surface with which it may be in contact, at the present time [m]; NaN also
  /// where none is near.
  std::vector<double> gap;
};

/// Whether points of a solid's surface may be in contact. @param solid  Index in the Model.
[[nodiscard]] bool has_contact_fields(const Simulation& simulation, int solid);
/// Fields at the present state. Edges in contact have no pressure: they press along lines.
[[nodiscard]] SolidContactFields solid_contact_fields(const Simulation& simulation, int solid);

}  // namespace polhode
