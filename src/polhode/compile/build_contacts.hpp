// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <polhode/core/error.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

class SolidContact;
class SurfaceContactInterface;
namespace contact {
class ContactSet;
}

/// What the contacts of a Model became.
struct ContactMap {
  /// A pair of sides whose contact is kept: of the sensors, of pairs with a law of their own, of
  /// probes, and, in models with few, of all that may meet.
  struct Pair {
    int a = 0, b = 0;    ///< Sides, see contact_spec.hpp.
    std::string sensor;  ///< Name of the sensor, or empty.
  };
  std::vector<Pair> pairs;
  std::vector<int> body;   ///< By shape of the ContactSet: index into Model::bodies.
  bool all_pairs = false;  ///< Every pair that may meet is kept.
  /// Faces of one kind of a solid against one shape of a body; or points of its surface against
  /// that of a solid, of which another such entry has the points. Or the centre line of a cable.
  struct Surface {
    int own = 0;            ///< Whose points: the side of a solid or of a cable.
    int side = 0;           ///< What it meets, see contact_spec.hpp.
    std::size_t shape = 0;  ///< Of a body.
    int group = 0;          ///< Of elements, in System::nodes().
    const SurfaceContactInterface* touching = nullptr;  ///< That group; the System keeps it.
    /// Likewise, if it meets the mesh of a solid; else null.
    const SolidContact* on_mesh = nullptr;
  };
  std::vector<Surface> surfaces;
};

/// Models with more pairs of bodies that may meet keep only those that are named.
inline constexpr int kMaxContactPairs = 100;

/// Finds what only the shapes show: hulls without volume, open meshes, point masses that would
/// turn, unknown materials, too many groups.
void check_contact_shapes(const Model& model, std::vector<InputError>& faults);

/// Builds the contact of a model.
/// @param bodies  By Model::bodies: index into System::bodies(), kGround if fixed.
/// @returns null if the model has no contacts, or if beside solids no two bodies may meet. @throws
/// InputError, see check_contact_shapes().
[[nodiscard]] std::shared_ptr<contact::ContactSet> build_contacts(const Model& model,
                                                                  const std::vector<int>& bodies,
                                                                  ContactMap& map);

}  // namespace polhode
