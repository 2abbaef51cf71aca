// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <polhode/joints/joint.hpp>
#include <polhode/loads/load_description.hpp>

namespace polhode {

/// A joint of a gear before the system is finished.
struct GearJoint {
  const Joint* joint = nullptr;
  std::string coordinate;        ///< As in the user's file; "" for the only one.
  bool assembled_start = false;  ///< The initial positions of bodies differ from the given ones.
};

/// Pose of a body at the start; for the ground the world.
struct GearPose {
  Vec3 r = Vec3::Zero();
  Mat3 Lambda = Mat3::Identity();
};

/// Bodies and coordinates of a gear between two joints. @eq{gear-angle}
struct GearGeometry {
  Participants bodies;
  GearPair pair;
  bool mixed = false;  ///< The first coordinate is a displacement, the second an angle.
};

/// @param where  Path for messages, such as loads.train.
/// @param poses  By body of the system.
/// @throws InputError if the joints have no such coordinates or no common carrier.
[[nodiscard]] GearGeometry gear_geometry(const std::string& where,
                                         const std::array<GearJoint, 2>& joints,
                                         const std::vector<GearPose>& poses);

}  // namespace polhode
