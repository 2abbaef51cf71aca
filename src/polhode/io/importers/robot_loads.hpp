// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <polhode/io/importers/node_builder.hpp>
#include <polhode/io/importers/robot.hpp>

namespace polhode::io {

/// Adds the spring, damper and inerter of a joint with one coordinate to the loads of a model.
/// @param name   Of the joint in the model.
/// @param turns  Angle that the model does not count [rad].
void put_joint_loads(const NodeBuilder& make, const RobotJoint& joint, const std::string& name,
                     double turns, SourceNode& loads);

/// Adds the dry friction of a joint with one coordinate. @param node  The joint in the model.
void put_friction(const NodeBuilder& make, const RobotJoint& joint, SourceNode& node);

/// Adds the damper of a ball joint, which resists the relative angular velocity in all directions.
/// @param node  The joint in the model.
void put_ball_loads(const NodeBuilder& make, const RobotJoint& joint, const std::string& name,
                    const SourceNode& node, SourceNode& loads);

/// Adds the damper of a body that moves freely: it resists the velocity of a point and the angular
/// velocity.
/// @param point, in_body  The point in the world and in the body's coordinates.
void put_free_damping(const NodeBuilder& make, const RobotJoint& joint, const std::string& name,
                      const std::string& body, const Vec3& point, const Vec3& in_body,
                      SourceNode& loads);

/// Makes the bounds of a servo's effort opposite, by a constant effort that acts beside it.
/// @returns that effort, if it is not zero
[[nodiscard]] std::optional<double> centre_bounds(RobotActuator& servo);

/// The motor or servo of a joint with one coordinate.
/// @param name   Of the joint in the model.
/// @param turns  Angle that the model does not count [rad].
[[nodiscard]] SourceNode actuator_load(const NodeBuilder& make, const RobotActuator& actuator,
                                       const RobotJoint& joint, const std::string& name,
                                       double turns);

/// Coordinates of a coupling, if a screw, which has two, is among its joints.
void put_coordinates(const NodeBuilder& make, const std::vector<const RobotJoint*>& joints,
                     SourceNode& load);

}  // namespace polhode::io
