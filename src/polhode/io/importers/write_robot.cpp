// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/write_robot.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/importers/node_builder.hpp>
#include <polhode/io/importers/robot_cables.hpp>
#include <polhode/io/importers/robot_contacts.hpp>
#include <polhode/io/importers/robot_loads.hpp>
#include <polhode/io/importers/robot_meshes.hpp>
#include <polhode/io/importers/robot_tree.hpp>

namespace polhode::io {

namespace {

using Kind = ImportNote::Kind;

/// Difference of rotations below which two of them are one [rad]: that of numbers with nine digits.
constexpr double kSameRotation = 1e-8;

/// A name of SDFormat with "__" instead of "::", which needs no note.
std::string scoped_name(std::string name) {
  for (std::size_t at = name.find("::"); at != std::string::npos; at = name.find("::", at + 2))
    name.replace(at, 2, "__");
  return name;
}

/// Writer of a robot as the content of a model file.
class ModelWriter {
 public:
  ModelWriter(const Robot& robot, const RobotTree& tree, const ImportOptions& options, XmlFile& xml,
              const std::string& folder, Imported& out)
      : robot_(robot),
        tree_(tree),
        options_(options),
        xml_(xml),
        out_(out),
        meshes_(options, xml, folder, out.notes) {}

  void write() {
    const NodeBuilder make{xml_.line(xml_.root())};
    note_idle_shapes(robot_, tree_, xml_, out_.notes);
    note_open_loops(robot_, tree_, xml_, out_.notes);
    name_all();
    contacts_.emplace(robot_, tree_, link_name_, xml_, out_.notes);
    SourceNode bodies = make.map(), joints = make.map(), loads = make.map();
    links_of_.resize(robot_.links.size());
    for (const int i : tree_.order)
      links_of_[static_cast<std::size_t>(at(tree_.body, i))].push_back(i);
    for (const int i : tree_.order)
      if (at(tree_.body, i) == i) write_body(i, bodies);
    for (const int i : tree_.order)
      if (const int j = at(tree_.parent_joint, i); j >= 0) write_joint(j, joints, loads);
    for (std::size_t j = 0; j < robot_.joints.size(); ++j)
      if (robot_.joints[j].closes) write_joint(static_cast<int>(j), joints, loads);
    for (const RobotLoop& loop : robot_.loops) write_loop(loop, joints);
    for (std::size_t j = 0; j < robot_.joints.size(); ++j)
      if (robot_.joints[j].mimic) write_mimic(static_cast<int>(j), loads);
    for (const RobotRow& row : robot_.rows) write_row(row, loads);
    if (options_.actuators) write_actuators(loads);
    CableWriter lines(robot_, tree_, link_name_, xml_, out_.notes);
    SourceNode cables = make.map();
    lines.write(cables, loads);
    if (options_.actuators) lines.write_pushes(loads);
    lines.write_weights(loads);
    lines.write_drags(loads);
    SourceNode probes = make.map();
    lines.write_probes({joint_name_, actuator_name_}, joints, probes);
    out_.root = make.map();
    make.put(out_.root, "format", make.text("1"));
    if (!robot_.name.empty()) {
      SourceNode title = make.text(robot_.name);
      title.in_quotes = true;
      make.put(out_.root, "title", std::move(title));
    }
    make.put(out_.root, "gravity", make.vector(robot_.gravity));
    make.put(out_.root, "bodies", std::move(bodies));
    if (robot_.contacts.wanted)
      if (SourceNode contacts = contacts_->section(*out_.root.find("bodies"));
          !contacts.keys.empty())
        make.put(out_.root, "contacts", std::move(contacts));
    if (!joints.keys.empty()) make.put(out_.root, "joints", std::move(joints));
    if (!loads.keys.empty()) make.put(out_.root, "loads", std::move(loads));
    if (!cables.keys.empty()) make.put(out_.root, "cables", std::move(cables));
    if (probes.keys.empty()) return;
    SourceNode output = make.map();
    make.put(output, "probes", std::move(probes));
    make.put(out_.root, "output", std::move(output));
  }

 private:
  template <class T>
  static const T& at(const std::vector<T>& list, int i) {
    return list[static_cast<std::size_t>(i)];
  }
  static bool at(const std::vector<bool>& list, int i) { return list[static_cast<std::size_t>(i)]; }

  void note(Kind kind, const XmlFile::Element& e, std::string what) {
    out_.notes.push_back({kind, xml_.place(e), std::move(what)});
  }
  void refuse(const XmlFile::Element& e, const std::string& what, const std::string& hint) {
    meshes_.refuse(e, what, hint);
  }

  /// Names that a model file allows, each once.
  void name_all() {
    std::set<std::string> taken{"ground"};
    const auto choose = [&](const std::string& name, const XmlFile::Element& e) {
      std::string chosen = allowed_name(name);
      for (int k = 2; !taken.insert(chosen).second; ++k)
        chosen = format("{}_{}", allowed_name(name), k);
      if (chosen != scoped_name(name))
        note(Kind::approximated, e,
             format("{} is called {} in the model", quote(name), quote(chosen)));
      return chosen;
    };
    for (const RobotLink& l : robot_.links) link_name_.push_back(choose(l.name, *l.at));
    taken.clear();
    for (const RobotJoint& j : robot_.joints) joint_name_[j.name] = choose(j.name, *j.at);
    for (const RobotLoop& l : robot_.loops) joint_name_[l.name] = choose(l.name, *l.at);
  }

  /// Frame of a link in its body's coordinates.
  [[nodiscard]] Pose in_body(int link) const { return tree_.in_body(link); }

  void write_body(int i, SourceNode& bodies) {
    const RobotLink& link = at(robot_.links, i);
    const NodeBuilder make{xml_.line(*link.at)};
    const geometry::MassProperties& mass = at(tree_.mass, i);
    SourceNode body = make.map();
    const bool grounded = at(tree_.grounded, i);
    if (grounded) make.put(body, "fixed", make.boolean(true));
    if (mass.mass > 0.0) make.put(body, "mass", make.number(mass.mass));
    if (mass.mass > 0.0 && is_inertia(mass)) make.put(body, "inertia", make.inertia(mass.inertia));
    if (!mass.com.isZero(0.0) && mass.mass > 0.0) make.put(body, "com", make.vector(mass.com));
    const Pose& world = at(tree_.world, i);
    make.put(body, "position_of", make.text("origin"));
    make.put(body, "position", make.vector(world.p));
    if (!world.R.isIdentity(0.0))
      make.put(body, "orientation", make.orientation(Quat(world.R).normalized()));
    if (!tree_.spin.empty() && !grounded) {
      const Vec3& spin = at(tree_.spin, i);
      const Vec3 velocity = at(tree_.velocity, i) + spin.cross(world.R * mass.com);
      if (!velocity.isZero(0.0)) make.put(body, "velocity", make.vector(velocity));
      if (!spin.isZero(0.0)) make.put(body, "angular_velocity", make.vector(spin));
    }
    SourceNode shapes = make.list();
    if (options_.shapes != "none")
      for (const int k : at(links_of_, i)) write_shapes(k, shapes);
    if (!shapes.children.empty()) make.put(body, "shape", std::move(shapes));
    make.put(bodies, at(link_name_, i), std::move(body));
  }

  static bool is_inertia(const geometry::MassProperties& mass) {
    try {
      geometry::check_mass_properties("", mass.mass, mass.inertia);
      return true;
    } catch (const InputError&) {
      return false;
    }
  }

  void write_shapes(int i, SourceNode& shapes) {
    const RobotLink& link = at(robot_.links, i);
    const bool visual = options_.shapes == "visual" && !link.visual.empty();
    for (const RobotShape& shape : visual ? link.visual : link.collision) {
      const NodeBuilder make{xml_.line(*shape.at)};
      SourceNode node = make.map();
      const Pose pose = in_body(i) * shape.pose;
      const bool plane = shape.kind == "plane", ground = plane || !shape.heights.empty();
      if (shape.kind == "mesh") {
        if (!meshes_.write(shape, make, node)) continue;
      } else if (ground && !at(tree_.grounded, i)) {
        note(Kind::ignored, *shape.at,
             format("a {} on a body that moves is not read", plane ? "plane" : "height field"));
        continue;
      } else {
        put_sizes(make, shape, pose, node);
      }
      if (!pose.p.isZero(0.0)) make.put(node, "position", make.vector(pose.p));
      if (!pose.R.isIdentity(0.0) && !plane)
        make.put(node, "orientation", make.orientation(Quat(pose.R).normalized()));
      contacts_->put_shape(shape, make, node);
      shapes.children.push_back(std::move(node));
    }
  }

  /// Points and axes of a joint on both links.
  void put_frames(const NodeBuilder& make, SourceNode& node, const Pose& a, const Pose& b,
                  const Vec3& axis, bool axes, bool zero) {
    make.put(node, "at_body", make.list({make.vector(a.p), make.vector(b.p)}));
    if (!axes) return;
    make.put(node, "axis_body",
             make.list({make.direction(a.R * axis), make.direction(b.R * axis)}));
    const Vec3 x = axes_along(axis).col(0);
    if (zero)
      make.put(node, "x_axis_body", make.list({make.direction(a.R * x), make.direction(b.R * x)}));
  }

  [[nodiscard]] SourceNode bodies_of(const NodeBuilder& make, int a, int b) const {
    return make.list({make.text(at(link_name_, at(tree_.body, a))),
                      make.text(at(link_name_, at(tree_.body, b)))});
  }

  void write_joint(int j, SourceNode& joints, SourceNode& loads) {
    const RobotJoint& joint = at(robot_.joints, j);
    const int parent = at(tree_.parent, j), child = at(tree_.child, j);
    if (!moves(j)) return;
    const NodeBuilder make{xml_.line(*joint.at)};
    const std::string& name = joint_name_.at(joint.name);
    if (joint.type == "floating") {
      if (joint.damping > 0.0) {
        const Pose here = at(tree_.world, child);
        put_free_damping(make, joint, name, at(link_name_, at(tree_.body, child)), here.p,
                         in_body(child).p, loads);
      }
      return;
    }
    SourceNode node = make.map();
    const bool screw = joint.type == "screw";
    const std::string type = screw ? "cylindrical" : joint.turns() ? "revolute" : joint.type;
    make.put(node, "type", make.text(type));
    make.put(node, "bodies", bodies_of(make, parent, child));
    put_frames(make, node, in_body(parent) * joint.origin, in_body(child) * at_zero(joint),
               joint.axis, joint.is_single() || type == "planar",
               joint.turns() || type == "planar");
    if (type == "universal")
      make.put(
          node, "axes",
          make.list({make.direction(at(tree_.world, parent).R * joint.origin.R * joint.axis),
                     make.direction(at(tree_.world, child).R * joint.on_child.R * joint.axis2)}));
    if (joint.is_single()) {
      put_limits(make, joint, at(tree_.start, j)[0], node);
      if (joint.friction > 0.0 && options_.friction) put_friction(make, joint, node);
      put_joint_loads(make, joint, name, turns_at_start(joint, at(tree_.start, j)[0]), loads);
      if (screw) {
        SourceNode thread = make.map();
        make.put(thread, "type", make.text("screw"));
        make.put(thread, "joint", make.text(name));
        make.put(thread, "pitch", make.number(joint.pitch));
        make.put(loads, name + "_thread", std::move(thread));
      }
    } else if (type == "spherical") {
      put_ball_loads(make, joint, name, node, loads);
    } else if (type != "fixed" && (joint.damping > 0.0 || joint.friction > 0.0)) {
      refuse(*joint.at,
             format("the damping or friction of the {} joint {} has no meaning", type,
                    quote(joint.name)),
             "Leave it out.");
    }
    make.put(joints, name, std::move(node));
  }

  /// Frame of a joint on its child, displaced so that the coordinate is that of the joint.
  static Pose at_zero(const RobotJoint& joint) {
    Pose frame = joint.on_child;
    if (joint.zero == 0.0) return frame;
    if (joint.turns())  // A screw's coordinate is zero at its pose.
      frame.R = frame.R * Eigen::AngleAxisd(joint.zero, joint.axis).toRotationMatrix();
    else
      frame.p += joint.zero * (frame.R * joint.axis);
    return frame;
  }

  /// Turns of an angle at the start, which the model does not count [rad].
  static double turns_at_start(const RobotJoint& joint, double start) {
    return joint.turns() ? start - std::remainder(start, 2.0 * std::numbers::pi) : 0.0;
  }

  void put_limits(const NodeBuilder& make, const RobotJoint& joint, double start,
                  SourceNode& node) {
    if (!options_.limits || (!joint.lower && !joint.upper)) return;
    if (joint.in_loop &&
        start != std::clamp(start, joint.lower.value_or(start), joint.upper.value_or(start))) {
      note(
          Kind::approximated, *joint.at,
          format("the joint {} has no stops, as its loop is closed where it is at {}, outside them",
                 quote(joint.name), start));
      return;
    }
    // An angle counts from between -pi and pi at the start.
    const double turns = turns_at_start(joint, start);
    if (turns != 0.0)
      note(Kind::approximated, *joint.at,
           format("the angle of {} counts from {:.6g} rad", quote(joint.name), turns));
    SourceNode limits = make.map();
    if (joint.lower) make.put(limits, "lower", make.number(*joint.lower - turns));
    if (joint.upper) make.put(limits, "upper", make.number(*joint.upper - turns));
    make.put(node, joint.type == "screw" ? "angle_limits" : "limits", std::move(limits));
  }

  void write_loop(const RobotLoop& loop, SourceNode& joints) {
    int links[2] = {-1, -1};
    for (int k = 0; k < 2; ++k) {
      const auto found = tree_.link_index.find(loop.links[k]);
      if (found != tree_.link_index.end())
        links[k] = found->second;
      else
        xml_.fault(*loop.at, format("there is no link {}", quote(loop.links[k])),
                   "Name a link of the file.");
    }
    if (links[0] < 0 || links[1] < 0) return;
    if (at(tree_.body, links[0]) == at(tree_.body, links[1]) ||
        (at(tree_.grounded, links[0]) && at(tree_.grounded, links[1]))) {
      xml_.fault(*loop.at,
                 format("the links of {} cannot move relative to each other", quote(loop.name)),
                 "Leave it out.");
      return;
    }
    const NodeBuilder make{xml_.line(*loop.at)};
    SourceNode node = make.map();
    const std::string type = loop.type == "continuous" ? "revolute" : loop.type;
    make.put(node, "type", make.text(type));
    make.put(node, "bodies", bodies_of(make, links[0], links[1]));
    const bool link = type == "slack_link";
    const Mat3 turn = (at(tree_.world, links[0]) * loop.frames[0]).R.transpose() *
                      (at(tree_.world, links[1]) * loop.frames[1]).R;
    if (type == "fixed" && !turn.isIdentity(kSameRotation))
      refuse(*loop.at,
             format("the constraint {} holds another rotation than that of the start",
                    quote(loop.name)),
             "Start where it is satisfied.");
    put_frames(make, node, in_body(links[0]) * loop.frames[0], in_body(links[1]) * loop.frames[1],
               loop.axis, type != "fixed" && type != "spherical" && !link, false);
    if (link) {
      const double start = (at(tree_.world, links[0]) * loop.frames[0].p -
                            at(tree_.world, links[1]) * loop.frames[1].p)
                               .norm();
      if (start < loop.lower.value_or(start) || start > loop.upper.value_or(start))
        return note(Kind::approximated, *loop.at,
                    format("there is no {}, as the length is {:.6g} at the start, outside of it",
                           quote(loop.name), start));
      SourceNode limits = make.map();
      if (loop.lower) make.put(limits, "lower", make.number(*loop.lower));
      if (loop.upper) make.put(limits, "upper", make.number(*loop.upper));
      make.put(node, "limits", std::move(limits));
    }
    make.put(joints, joint_name_.at(loop.name), std::move(node));
  }

  /// A coupling of the joints of a row that move; the others have their start in the sum.
  void write_row(const RobotRow& row, SourceNode& loads) {
    const NodeBuilder make{xml_.line(*row.at)};
    std::vector<SourceNode> joints, factors;
    std::vector<const RobotJoint*> coupled;
    double sum = row.sum, first = 0.0;
    for (std::size_t k = 0; k < row.joints.size(); ++k) {
      const int j = tree_.joint_index.at(row.joints[k]);
      const double start = at(tree_.start, j)[0];
      const bool moving = moves(j);
      sum -= row.factors[k] * (moving ? turns_at_start(at(robot_.joints, j), start) : start);
      if (!moving || row.factors[k] == 0.0) continue;
      if (joints.empty())
        first = row.factors[k];
      else
        factors.push_back(make.number(-row.factors[k] / first));
      joints.push_back(make.text(joint_name_.at(row.joints[k])));
      coupled.push_back(&at(robot_.joints, j));
    }
    if (joints.empty()) return;
    SourceNode load = make.map();
    make.put(load, "type", make.text("coupling"));
    make.put(load, "joints", make.list(std::move(joints)));
    put_coordinates(make, coupled, load);
    if (!factors.empty()) make.put(load, "factors", make.list(std::move(factors)));
    make.put(load, "offset", make.number(sum / first));
    std::string name = allowed_name(row.name);
    while (loads.find(name) != nullptr) name += "_row";
    make.put(loads, name, std::move(load));
  }

  void write_actuators(SourceNode& loads) {
    for (const RobotActuator& actuator : robot_.actuators) {
      const auto found = tree_.joint_index.find(actuator.joint);
      if (found == tree_.joint_index.end() || !moves(found->second)) {
        note(Kind::ignored, *actuator.at,
             format("the actuator {} acts on no joint that moves", quote(actuator.name)));
        continue;
      }
      const RobotJoint& joint = at(robot_.joints, found->second);
      const double turns = turns_at_start(joint, at(tree_.start, found->second)[0]);
      RobotActuator own = actuator;
      const std::optional<double> beside = centre_bounds(own);
      if (own.most > own.least || !beside)
        actuator_name_[actuator.name] = put_actuator(own, joint, turns, loads);
      if (!beside) continue;
      RobotActuator constant;
      constant.at = own.at;
      constant.joint = own.joint;
      constant.name = own.name + "_middle";
      constant.target.constant = *beside;
      put_actuator(constant, joint, turns, loads);
    }
  }

  std::string put_actuator(const RobotActuator& actuator, const RobotJoint& joint, double turns,
                           SourceNode& loads) {
    const NodeBuilder make{xml_.line(*actuator.at)};
    std::string name = allowed_name(actuator.name);
    while (loads.find(name) != nullptr) name += "_actuator";
    make.put(loads, name,
             actuator_load(make, actuator, joint, joint_name_.at(actuator.joint), turns));
    return name;
  }

  /// Whether a joint moves in the model.
  [[nodiscard]] bool moves(int j) const {
    return !(at(tree_.grounded, at(tree_.child, j)) && at(tree_.grounded, at(tree_.parent, j))) &&
           at(tree_.body, at(tree_.parent, j)) != at(tree_.body, at(tree_.child, j));
  }

  /// A joint's coordinate as factor times that of another one plus an offset.
  struct Follows {
    int leader;
    double factor, offset;
  };

  /// Coordinate of a joint with a mimic, by that of the joint at the beginning of the chain.
  [[nodiscard]] Follows follows(int j) const {
    Follows f{j, 1.0, 0.0};
    while (const auto& mimic = at(robot_.joints, f.leader).mimic) {
      f.offset += f.factor * mimic->offset;
      f.factor *= mimic->multiplier;
      f.leader = tree_.joint_index.at(mimic->joint);
    }
    return f;
  }

  /// Joints that follow one that moves nothing, and is held, follow the first one of them.
  void write_mimic(int j, SourceNode& loads) {
    const RobotJoint& joint = at(robot_.joints, j);
    if (!moves(j)) return;
    Follows f = follows(j);
    if (f.factor != 0.0 && !moves(f.leader)) {
      const auto [first, is_first] = first_follower_.try_emplace(f.leader, j);
      if (is_first) {
        out_.notes.push_back(
            {Kind::approximated, xml_.place(*joint.mimic->at),
             format("the joint {} moves freely, as {}, which it follows, moves no mass",
                    quote(joint.name), quote(at(robot_.joints, f.leader).name))});
        return;
      }
      const Follows other = follows(first->second);
      f = {first->second, f.factor / other.factor,
           f.offset - f.factor / other.factor * other.offset};
    }
    const NodeBuilder make{xml_.line(*joint.mimic->at)};
    SourceNode row = make.map();
    make.put(row, "type", make.text("coupling"));
    std::vector<SourceNode> joints{make.text(joint_name_.at(joint.name))};
    if (f.factor != 0.0) {
      joints.push_back(make.text(joint_name_.at(at(robot_.joints, f.leader).name)));
      if (at(robot_.joints, f.leader).turns()) {
        // Turns of its start, which the model does not count.
        const double start = at(tree_.start, f.leader)[0];
        constexpr double kTurn = 2.0 * std::numbers::pi;
        f.offset += f.factor * kTurn * std::round(start / kTurn);
      }
    }
    make.put(row, "joints", make.list(std::move(joints)));
    std::vector<const RobotJoint*> coupled{&joint};
    if (f.factor != 0.0) coupled.push_back(&at(robot_.joints, f.leader));
    put_coordinates(make, coupled, row);
    if (f.factor != 0.0) make.put(row, "factors", make.list({make.number(f.factor)}));
    make.put(row, "offset", make.number(f.offset));
    make.put(loads, joint_name_.at(joint.name) + "_mimic", std::move(row));
  }

  const Robot& robot_;
  const RobotTree& tree_;
  const ImportOptions& options_;
  XmlFile& xml_;
  Imported& out_;
  RobotMeshes meshes_;
  std::optional<ContactWriter> contacts_;
  std::vector<std::string> link_name_;
  std::vector<std::vector<int>> links_of_;  ///< Of each link that is a body, in order.
  std::map<std::string, std::string> joint_name_, actuator_name_;
  std::map<int, int> first_follower_;  ///< By leader that moves nothing.
};

}  // namespace

bool write_robot(const Robot& robot, const ImportOptions& options, XmlFile& xml,
                 Diagnostics& diagnostics, const std::string& folder, Imported& out) {
  RobotTree tree;
  if (!arrange(robot, options, xml, diagnostics, out.notes, tree)) return false;
  ModelWriter(robot, tree, options, xml, folder, out).write();
  return true;
}

}  // namespace polhode::io
