// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/robot_cables.hpp>

#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

namespace {

/// A name that a map does not have yet.
std::string free_name(const SourceNode& map, const std::string& wanted) {
  std::string name = allowed_name(wanted);
  for (int k = 2; map.find(name) != nullptr; ++k) name = format("{}_{}", allowed_name(wanted), k);
  return name;
}

}  // namespace

const std::string& CableWriter::body(const std::string& link_name) const {
  const int own = tree_.body[static_cast<std::size_t>(link(link_name))];
  return link_names_[static_cast<std::size_t>(own)];
}

Vec3 CableWriter::place(const RobotPoint& point) const {
  return tree_.in_body(link(point.link)) * point.p;
}

void CableWriter::write(SourceNode& cables, SourceNode& loads) {
  for (const RobotCable& cable : robot_.cables) {
    const auto moves = [&](const RobotPoint& point) {
      return !tree_.grounded[static_cast<std::size_t>(link(point.link))];
    };
    const bool plain = cable.through.size() == 2 && cable.around.empty();
    if (std::none_of(cable.through.begin(), cable.through.end(), moves) ||
        (plain && body(cable.through[0].link) == body(cable.through[1].link))) {
      notes_.push_back({ImportNote::Kind::ignored, xml_.place(*cable.at),
                        format("the tendon {} is between points that do not move relative to each "
                               "other",
                               quote(cable.name))});
      continue;
    }
    if (plain)
      write_springs(cable, loads);
    else
      write_line(cable, cables);
  }
}

void CableWriter::write_springs(const RobotCable& cable, SourceNode& loads) {
  const NodeBuilder make{xml_.line(*cable.at)};
  const auto add = [&](const char* type, const char* ending) -> SourceNode& {
    SourceNode load = make.map();
    make.put(load, "type", make.text(type));
    make.put(load, "bodies",
             make.list(
                 {make.text(body(cable.through[0].link)), make.text(body(cable.through[1].link))}));
    make.put(
        load, "at_body",
        make.list({make.vector(place(cable.through[0])), make.vector(place(cable.through[1]))}));
    const std::string name = free_name(loads, cable.name + ending);
    written_.try_emplace(cable.name, "load", name);
    return make.put(loads, name, std::move(load));
  };
  const bool slack = cable.stiffness != 0.0 && cable.shortest < cable.longest;
  if (cable.stiffness != 0.0) {
    SourceNode& spring = add("spring_damper", "");
    make.put(spring, "stiffness", make.number(cable.stiffness));
    make.put(spring, "free_length", make.number(cable.longest));
    if (slack) make.put(spring, "acts", make.text("tension"));
    if (cable.damping != 0.0) make.put(spring, "damping", make.number(cable.damping));
  } else if (cable.damping != 0.0) {
    make.put(add("spring_damper", ""), "damping", make.number(cable.damping));
  }
  if (slack && cable.shortest > 0.0) {
    SourceNode& push = add("spring_damper", "_push");
    make.put(push, "stiffness", make.number(cable.stiffness));
    make.put(push, "free_length", make.number(cable.shortest));
    make.put(push, "acts", make.text("compression"));
  }
  if (!cable.tension.empty())
    make.put(add("axial_force", cable.stiffness != 0.0 || cable.damping != 0.0 ? "_pull" : ""),
             "pull", signal_node(make, cable.tension));
}

void CableWriter::write_line(const RobotCable& cable, SourceNode& cables) {
  const NodeBuilder make{xml_.line(*cable.at)};
  SourceNode line = make.map();
  std::vector<SourceNode> points;
  for (const RobotPoint& point : cable.through)
    points.push_back(make.list({make.text(body(point.link)), make.vector(place(point))}));
  make.put(line, "through", make.list(std::move(points)));
  make.put(line, "slides", make.boolean(true));
  const bool slack = cable.stiffness != 0.0 && cable.shortest < cable.longest;
  if (!slack) make.put(line, "tension_only", make.boolean(false));
  if (cable.stiffness != 0.0) {
    make.put(line, "stiffness", make.number(cable.stiffness * cable.longest));
    make.put(line, "free_length", make.number(cable.longest));
  }
  if (cable.damping != 0.0) make.put(line, "damping", make.number(cable.damping));
  if (!cable.tension.empty() || cable.stiffness == 0.0)
    make.put(line, "tension", signal_node(make, cable.tension));
  SourceNode around = make.map();
  for (const RobotCable::Obstacle& o : cable.around) {
    const Mat3 R = tree_.in_body(link(o.at.link)).R;
    SourceNode obstacle = make.map();
    make.put(obstacle, "type", make.text(o.type));
    make.put(obstacle, "body", make.text(body(o.at.link)));
    make.put(obstacle, "at", make.vector(place(o.at)));
    make.put(obstacle, "radius", make.number(o.radius));
    if (o.type == "cylinder") make.put(obstacle, "axis", make.direction(R * o.axis));
    if (o.side) make.put(obstacle, "side", make.direction(R * *o.side));
    make.put(obstacle, "after", make.text(format("{}", o.after + 1)));
    make.put(around, free_name(around, o.name), std::move(obstacle));
  }
  if (!around.keys.empty()) make.put(line, "around", std::move(around));
  const std::string name = free_name(cables, cable.name);
  written_.try_emplace(cable.name, "cable", name);
  make.put(cables, name, std::move(line));
}

void CableWriter::write_pushes(SourceNode& loads) {
  for (const RobotPush& push : robot_.pushes) {
    if (tree_.grounded[static_cast<std::size_t>(link(push.point.link))]) {
      notes_.push_back({ImportNote::Kind::ignored, xml_.place(*push.at),
                        format("the actuator {} acts on no body that moves", quote(push.name))});
      continue;
    }
    const NodeBuilder make{xml_.line(*push.at)};
    const Mat3 R = push.in_world ? Mat3::Identity() : tree_.in_body(link(push.point.link)).R;
    const bool both = !push.force.isZero(0.0) && !push.moment.isZero(0.0);
    const auto add = [&](const char* type, const Vec3& vector, const char* ending) {
      if (vector.isZero(0.0)) return;
      const Vec3 turned = R * vector;
      SourceNode load = make.map();
      make.put(load, "type", make.text(type));
      make.put(load, "body", make.text(body(push.point.link)));
      if (std::string_view(type) == "force")
        make.put(load, "at_body", make.vector(place(push.point)));
      std::vector<SourceNode> components;
      for (int k = 0; k < 3; ++k)
        components.push_back(signal_node(make, {push.signal.times(turned[k])}));
      make.put(load, type, make.list(std::move(components)));
      if (!push.in_world) make.put(load, "body_fixed", make.boolean(true));
      const std::string name = free_name(loads, push.name + ending);
      written_.try_emplace(push.name, "load", name);
      make.put(loads, name, std::move(load));
    };
    add("force", push.force, "");
    add("moment", push.moment, both ? "_moment" : "");
  }
}

void CableWriter::write_weights(SourceNode& loads) {
  for (std::size_t i = 0; i < robot_.links.size(); ++i) {
    const RobotLink& link = robot_.links[i];
    const Vec3 force = -link.carried * link.mass.mass * robot_.gravity;
    if (tree_.grounded[i] || force.isZero(0.0)) continue;
    const NodeBuilder make{xml_.line(*link.at)};
    SourceNode load = make.map();
    make.put(load, "type", make.text("force"));
    make.put(load, "body", make.text(body(link.name)));
    make.put(load, "at_body", make.vector(place({link.name, link.mass.com})));
    make.put(load, "force", make.vector(force));
    make.put(loads, free_name(loads, link_names_[i] + "_weightless"), std::move(load));
  }
}

void CableWriter::write_drags(SourceNode& loads) {
  for (const RobotDrag& drag : robot_.drags) {
    const auto own = static_cast<std::size_t>(link(drag.link));
    if (tree_.grounded[own]) continue;
    const NodeBuilder make{xml_.line(*drag.at)};
    const Pose frame = tree_.world[own] * drag.frame;
    SourceNode load = make.map();
    make.put(load, "type", make.text("axis_drag"));
    make.put(load, "bodies", make.list({make.text("ground"), make.text(body(drag.link))}));
    make.put(load, "at_body",
             make.list({make.vector(frame.p), make.vector(place({drag.link, drag.frame.p}))}));
    make.put(load, "axis", make.direction(frame.R.col(2)));
    make.put(load, "x_axis", make.direction(frame.R.col(0)));
    const auto put = [&](const char* key, const Vec3& values) {
      if (!values.isZero(0.0)) make.put(load, key, make.vector(values));
    };
    put("linear", drag.linear);
    put("quadratic", drag.quadratic);
    put("turning", drag.turning);
    put("quadratic_turning", drag.quadratic_turning);
    make.put(loads, free_name(loads, link_names_[own] + "_medium"), std::move(load));
  }
}

void CableWriter::write_probes(const Names& names, const SourceNode& joints, SourceNode& probes) {
  for (const RobotProbe& p : robot_.probes) {
    const NodeBuilder make{xml_.line(*p.at)};
    SourceNode probe = make.map();
    if (p.kind == RobotProbe::Kind::body) {
      make.put(probe, "body", make.text(body(p.point.link)));
      make.put(probe, "point", make.vector(place(p.point)));
      if (!p.rotation.empty()) make.put(probe, "rotation", make.text(p.rotation));
      if (p.angular) make.put(probe, "angular", make.boolean(true));
      if (!p.seen_from.empty()) make.put(probe, "seen_from", make.text(body(p.seen_from)));
    } else if (p.kind == RobotProbe::Kind::joint) {
      const auto found = names.joints.find(p.of);
      if (found != names.joints.end() && joints.find(found->second) != nullptr)
        make.put(probe, "joint", make.text(found->second));
    } else if (p.kind == RobotProbe::Kind::load) {
      if (const auto found = names.actuators.find(p.of); found != names.actuators.end())
        make.put(probe, "load", make.text(found->second));
      else if (const auto other = written_.find(p.of); other != written_.end())
        make.put(probe, other->second.first, make.text(other->second.second));
    } else if (const auto found = written_.find(p.of); found != written_.end()) {
      make.put(probe, found->second.first, make.text(found->second.second));
    }
    if (probe.keys.empty()) {
      notes_.push_back({ImportNote::Kind::ignored, xml_.place(*p.at),
                        format("the sensor {} is of {}, which is not in the model", quote(p.name),
                               quote(p.of))});
      continue;
    }
    make.put(probes, free_name(probes, p.name), std::move(probe));
  }
}

}  // namespace polhode::io
