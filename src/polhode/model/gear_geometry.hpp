// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <variant>

#include <polhode/joints/joint.hpp>
#include <polhode/loads/load_description.hpp>

namespace polhode {

/// A joint of a gear before the system is finished.
struct GearJoint {
  const Joint* joint = nullptr;
  std::string coordinate;  ///< As in the user's file; "" for the only one.
};

/// The free coordinate of a joint.
/// @param where  Path for messages, such as loads.train.
/// @throws InputError if there is none, or not only one, or the joint's frame is moved.
[[nodiscard]] std::variant<FreeAngle, FreeDisplacement> free_coordinate(const std::string& where,
                                                                        const GearJoint& joint);

/// Bodies and coordinates of a gear between two joints. @eq{gear-angle}
struct GearGeometry {
  Participants bodies;
  GearPair pair;
  bool mixed = false;  ///< The first coordinate is a displacement, the second an angle.
};

/// @param where  Path for messages, such as loads.train.
/// @throws InputError if the joints have no such coordinates or no common carrier.
[[nodiscard]] GearGeometry gear_geometry(const std::string& where,
                                         const std::array<GearJoint, 2>& joints);

}  // namespace polhode
