// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <polhode/joint_space/joint_space.hpp>

namespace polhode {

/// Target position of a point of a body, and target orientation of the body.
struct PoseTarget {
  int body = 0;                       ///< Index into Model::bodies.
  Vec3 point = Vec3::Zero();          ///< Of it, from the centre of mass, body axes [m].
  std::optional<Vec3> position{};     ///< Of the point, world [m].
  std::optional<Quat> orientation{};  ///< Of the body, to the world.
};

/// Position of all bodies that brings one of them to its target, or as near as was found.
struct PoseReached {
  JointSpace::Motions motions;    ///< At rest.
  std::vector<double> positions;  ///< Their coordinates.
  double distance = 0.0;          ///< Of the point from its target [m].
  double angle = 0.0;             ///< Between the orientations [rad].
  bool reached = false;           ///< Both to round-off.
};

/// Bounds of coordinates, from the stops of their joints; infinite without [rad, m].
struct CoordinateLimits {
  std::vector<double> lower, upper;
};
[[nodiscard]] CoordinateLimits coordinate_limits(const Model& model, const JointSpace& space);

/// Solves inverse kinematics by damped Gauss-Newton steps with the exact Jacobian, within limits of
/// the coordinates. Where steps end short of the target, other starts are tried; they are the same
/// ones each time. @eq{inverse-kinematics}
/// @param from  An assembled position, from which the first start begins.
/// @param near  Its coordinates.
[[nodiscard]] PoseReached reach(const JointSpace& space, const CoordinateLimits& limits,
                                const JointSpace::Motions& from, std::span<const double> near,
                                const PoseTarget& target);

}  // namespace polhode
