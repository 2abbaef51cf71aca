// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/robot_loads.hpp>

#include <cmath>
#include <numbers>

#include <polhode/core/format.hpp>

namespace polhode::io {

namespace {

/// Squares and cubes of a joint's spring and damper, as a load of their own.
void put_laws(const NodeBuilder& make, const RobotJoint& joint, const std::string& name,
              double turns, SourceNode& loads) {
  const auto is_there = [](const std::array<double, 2>& law) {
    return law[0] != 0.0 || law[1] != 0.0;
  };
  if (!is_there(joint.spring_law) && !is_there(joint.damper_law)) return;
  const bool angle = joint.turns();
  SourceNode load = make.map();
  make.put(load, "type", make.text(angle ? "torsional_spring" : "translational_spring"));
  make.put(load, "joint", make.text(name));
  const std::string kind = angle ? "moment" : "force";
  const auto expression = [&](const std::string& text) {
    SourceNode node = make.text(text);
    node.in_quotes = true;
    return node;
  };
  if (is_there(joint.spring_law)) {
    make.put(load, "spring_" + kind,
             expression(format("({})*x^2 + ({})*x^3", joint.spring_law[0], joint.spring_law[1])));
    make.put(load, angle ? "free_angle" : "free_displacement", make.number(joint.law_rest - turns));
  }
  if (is_there(joint.damper_law))
    make.put(
        load, "damper_" + kind,
        expression(format("({})*v*abs(v) + ({})*v^3", joint.damper_law[0], joint.damper_law[1])));
  make.put(loads, name + "_law", std::move(load));
}

}  // namespace

void put_joint_loads(const NodeBuilder& make, const RobotJoint& joint, const std::string& name,
                     double turns, SourceNode& loads) {
  const bool angle = joint.turns();
  const auto load_on_joint = [&](const char* type) {
    SourceNode load = make.map();
    make.put(load, "type", make.text(type));
    make.put(load, "joint", make.text(name));
    return load;
  };
  const auto put_rest = [&](SourceNode& spring, double rest) {
    make.put(spring, "stiffness", make.number(joint.stiffness));
    make.put(spring, angle ? "free_angle" : "free_displacement", make.number(rest - turns));
  };
  const char* const kind = angle ? "torsional_spring" : "translational_spring";
  const bool gap = joint.stiffness != 0.0 && joint.rest_upper && *joint.rest_upper > joint.rest;
  if (joint.stiffness != 0.0 || joint.damping != 0.0) {
    SourceNode spring = load_on_joint(kind);
    if (joint.stiffness != 0.0) put_rest(spring, gap ? *joint.rest_upper : joint.rest);
    if (gap) make.put(spring, "acts", make.text("tension"));
    if (joint.damping != 0.0) make.put(spring, "damping", make.number(joint.damping));
    make.put(loads, name + (joint.stiffness != 0.0 ? "_spring" : "_damping"), std::move(spring));
  }
  if (gap) {
    SourceNode push = load_on_joint(kind);
    put_rest(push, joint.rest);
    make.put(push, "acts", make.text("compression"));
    make.put(loads, name + "_push", std::move(push));
  }
  put_laws(make, joint, name, turns, loads);
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

std::optional<double> centre_bounds(RobotActuator& servo) {
  const double middle = 0.5 * (servo.least + servo.most);
  if (servo.kind == RobotActuator::Kind::effort || !std::isfinite(middle) || middle == 0.0)
    return std::nullopt;
  servo.least -= middle;
  servo.most -= middle;
  const double gain = servo.kind == RobotActuator::Kind::place ? servo.stiffness : servo.damping;
  servo.target = servo.target.plus(-middle / gain);
  return middle;
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
  const RobotSignal target =
      servo ? actuator.target : actuator.target.within(actuator.least, actuator.most);
  const char* key = actuator.kind == RobotActuator::Kind::velocity ? "speed"
                    : servo ? angle ? "angle" : "displacement"
                    : angle ? "moment"
                            : "force";
  const bool place = actuator.kind == RobotActuator::Kind::place;
  make.put(load, key, signal_node(make, {target.plus(place ? -turns : 0.0)}));
  if (actuator.stiffness != 0.0) make.put(load, "stiffness", make.number(actuator.stiffness));
  if (actuator.damping != 0.0) make.put(load, "damping", make.number(actuator.damping));
  if (servo && std::isfinite(actuator.most))
    make.put(load, angle ? "max_moment" : "max_force", make.number(actuator.most));
  return load;
}

void put_coordinates(const NodeBuilder& make, const std::vector<const RobotJoint*>& joints,
                     SourceNode& load) {
  std::vector<SourceNode> list;
  bool screws = false;
  for (const RobotJoint* joint : joints) {
    list.push_back(make.text(joint->turns() ? "rz" : "z"));
    screws = screws || joint->type == "screw";
  }
  if (screws) make.put(load, "coordinates", make.list(std::move(list)));
}

}  // namespace polhode::io
