// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <polhode/core/error.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

namespace contact {
class ContactSet;
}
namespace surface_contact {
class SolidContact;
class SurfaceContactInterface;
}  // namespace surface_contact

/// Result of building the contacts of a Model.
struct ContactMap {
  /// A recorded pair of sides: of sensors, of pairs with their own law, of probes, and, in small
  /// models, all pairs that may be in contact.
  struct Pair {
    Side a, b;
    std::string sensor;  ///< Name of the sensor, or empty.
  };
  std::vector<Pair> pairs;
  std::vector<int> body;   ///< By shape of the ContactSet: index into Model::bodies.
  bool all_pairs = false;  ///< All possible pairs are recorded.
  /// Faces of one kind of a solid against one shape of a body; or points of its surface against
  /// that of a solid, with another entry for the opposite direction; or the centre line of a cable.
  struct Surface {
    Side own;               ///< With the points, of a solid or of a cable.
    Side side;              ///< Opposite one.
    std::size_t shape = 0;  ///< Of a body.
    int group = 0;          ///< Of elements, in System::nodes().
    const surface_contact::SurfaceContactInterface* touching =
        nullptr;  ///< Contact of that group; owned by the System.
    /// Contact of that group if it is one with the mesh of a solid, else null.
    const surface_contact::SolidContact* on_mesh = nullptr;
  };
  std::vector<Surface> surfaces;
};

/// Number of possible pairs of bodies above which only named pairs are recorded.
inline constexpr int kMaxContactPairs = 100;

/// Checks properties of the shapes: hulls without volume, open meshes, point masses that would
/// rotate, unknown materials, too many groups.
void check_contact_shapes(const Model& model, std::vector<InputError>& faults);

/// Builds the contacts of a model.
/// @param bodies  By Model::bodies: index into System::bodies(), kGround if fixed.
/// @returns null if the model has no contacts, or if no two bodies may be in contact. @throws
/// InputError, see check_contact_shapes().
[[nodiscard]] std::shared_ptr<contact::ContactSet> build_contacts(const Model& model,
                                                                  const std::vector<int>& bodies,
                                                                  ContactMap& map);

}  // namespace polhode
