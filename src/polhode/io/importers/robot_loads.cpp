// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/robot_loads.hpp>

#include <cmath>
#include <numbers>

namespace polhode::io {

void put_joint_loads(const NodeBuilder& make, const RobotJoint& joint, const std::string& name,
                     double turns, SourceNode& loads) {
  const bool angle = joint.turns();
  const auto load_on_joint = [&](const char* type) {
    SourceNode load = make.map();
    make.put(load, "type", make.text(type));
    make.put(load, "joint", make.text(name));
    return load;
  };
  if (joint.stiffness != 0.0 || joint.damping != 0.0) {
    SourceNode spring = load_on_joint(angle ? "torsional_spring" : "translational_spring");
    if (joint.stiffness != 0.0) {
      make.put(spring, "stiffness", make.number(joint.stiffness));
      make.put(spring, angle ? "free_angle" : "free_displacement", make.number(joint.rest - turns));
    }
    if (joint.damping != 0.0) make.put(spring, "damping", make.number(joint.damping));
    make.put(loads, name + (joint.stiffness != 0.0 ? "_spring" : "_damping"), std::move(spring));
  }
  if (joint.armature == 0.0) return;
  SourceNode inerter = load_on_joint(angle ? "rotary_inerter" : "linear_inerter");
  make.put(inerter, "inertance", make.number(joint.armature));
  make.put(loads, name + "_armature", std::move(inerter));
}

void put_friction(const NodeBuilder& make, const RobotJoint& joint, SourceNode& node) {
  SourceNode friction = make.map();
  if (joint.type == "screw") {
    // The cylindrical joint slips where the resultant of the axial force and of the moment over a
    // radius, here 1 m, reaches a force: along the thread they do as much work as the moment.
    const double lead = joint.pitch / (2.0 * std::numbers::pi);
    make.put(friction, "force", make.number(joint.friction / std::hypot(1.0, lead)));
    make.put(friction, "radius", make.number(1.0));
  } else {
    make.put(friction, joint.turns() ? "moment" : "force", make.number(joint.friction));
  }
  make.put(node, "friction", std::move(friction));
}

void put_ball_loads(const NodeBuilder& make, const RobotJoint& joint, const std::string& name,
                    const SourceNode& node, SourceNode& loads) {
  if (joint.damping == 0.0) return;
  SourceNode damper = make.map();
  make.put(damper, "type", make.text("vector_damper"));
  make.put(damper, "bodies", *node.find("bodies"));
  make.put(damper, "at_body", *node.find("at_body"));
  make.put(damper, "turning_damping", make.number(joint.damping));
  make.put(loads, name + "_damping", std::move(damper));
}

void put_free_damping(const NodeBuilder& make, const RobotJoint& joint, const std::string& name,
                      const std::string& body, const Vec3& point, const Vec3& in_body,
                      SourceNode& loads) {
  SourceNode damper = make.map();
  make.put(damper, "type", make.text("vector_damper"));
  make.put(damper, "bodies", make.list({make.text("ground"), make.text(body)}));
  make.put(damper, "at_body", make.list({make.vector(point), make.vector(in_body)}));
  make.put(damper, "damping", make.number(joint.damping));
  make.put(damper, "turning_damping", make.number(joint.damping));
  make.put(loads, name + "_damping", std::move(damper));
}

SourceNode actuator_load(const NodeBuilder& make, const RobotActuator& actuator,
                         const RobotJoint& joint, const std::string& name, double turns) {
  const bool angle = joint.turns(), servo = actuator.kind != RobotActuator::Kind::effort;
  SourceNode load = make.map();
  make.put(load, "type",
           make.text(servo   ? angle ? "rotary_servo" : "linear_servo"
                     : angle ? "rotary_motor"
                             : "linear_motor"));
  make.put(load, "joint", make.text(name));
  const char* target = actuator.kind == RobotActuator::Kind::velocity ? "speed"
                       : servo ? angle ? "angle" : "displacement"
                       : angle ? "moment"
                               : "force";
  const bool place = actuator.kind == RobotActuator::Kind::place;
  make.put(load, target, make.number(actuator.target - (place ? turns : 0.0)));
  if (actuator.stiffness != 0.0) make.put(load, "stiffness", make.number(actuator.stiffness));
  if (actuator.damping != 0.0) make.put(load, "damping", make.number(actuator.damping));
  if (servo && actuator.most)
    make.put(load, angle ? "max_moment" : "max_force", make.number(*actuator.most));
  return load;
}

}  // namespace polhode::io
