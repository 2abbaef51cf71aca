// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf.hpp>

#include <cmath>
#include <filesystem>
#include <map>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/mjcf_bodies.hpp>
#include <polhode/io/importers/write_robot.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Reader of options, equalities, tendons and actuators.
class MjcfReader {
 public:
  MjcfReader(XmlFile& xml, const ImportOptions& options, std::vector<ImportNote>& notes)
      : xml_(xml), options_(options), file_(xml, notes), refusals_(file_, options.allow_partial) {}

  Robot read(const std::string& folder) {
    robot_.follows = "<equality>";
    robot_.name = xml_.text(xml_.root(), "model").value_or("");
    if (options_.base != "fixed")
      xml_.fault(xml_.root(), "an MJCF file says itself which bodies move freely",
                 "Leave import.base out.");
    read_options();
    MjcfGeoms geoms(file_, folder);
    MjcfBodies bodies(file_, geoms, refusals_, options_, robot_);
    bodies.read();
    if (robot_.links.size() < 2)
      xml_.fault(xml_.root(), "the model has no body", "Add <body> to <worldbody>.");
    for (const Element* e : file_.sections("tendon")) read_tendons(*e);
    for (const Element* e : file_.sections("equality")) read_equality(*e, bodies);
    for (const Element* e : file_.sections("actuator")) read_actuators(*e);
    for (const Element* e : file_.sections("deformable")) {
      xml_.skip(*e);
      refusals_.add(*e, "<deformable> is not read", "Leave it out.");
    }
    file_.ignored.skip(xml_.root(), {"asset", "contact", "sensor", "keyframe", "visual", "size",
                                     "statistic", "custom", "extension"});
    file_.ignored.add_unread();
    return std::move(robot_);
  }

 private:
  void read_options() {
    bool weightless = false;
    for (const Element* e : file_.sections("option")) {
      if (const auto g = xml_.vector(*e, "gravity")) robot_.gravity = *g;
      for (const char* medium : {"density", "viscosity"})
        if (xml_.number(*e, medium).value_or(0.0) != 0.0)
          refusals_.add(*e, format("the medium has a {}", medium),
                        "Add loads of type drag instead.");
      if (const Element* flag = xml_.child(*e, "flag")) {
        weightless = weightless || xml_.text(*flag, "gravity").value_or("") == "disable";
        xml_.skip(*flag);
      }
      xml_.skip(*e);
      file_.ignored.add(*e, "<option> other than gravity", "belongs to another solver");
    }
    if (weightless) robot_.gravity.setZero();
  }

  [[nodiscard]] const RobotJoint* find_joint(const std::string& name) const {
    for (const RobotJoint& joint : robot_.joints)
      if (joint.name == name) return &joint;
    return nullptr;
  }

  /// Joint of a name, with one coordinate; null after an error.
  const RobotJoint* single_joint(const Element& e, const std::string& name) {
    const RobotJoint* joint = find_joint(name);
    if (joint == nullptr) {
      std::vector<std::string> names;
      for (const RobotJoint& j : robot_.joints) names.push_back(j.name);
      xml_.fault(e, format("there is no joint {}", quote(name)),
                 did_you_mean(name, names) + "Joints: " + name_list(names, 12) + ".");
    } else if (!joint->is_single()) {
      xml_.fault(e, format("{} does not have one coordinate", quote(name)),
                 "Name a hinge or slide.");
      joint = nullptr;
    }
    return joint;
  }

  void read_equality(const Element& section, const MjcfBodies& bodies) {
    for (const Element* e = section.FirstChildElement(); e != nullptr;
         e = e->NextSiblingElement()) {
      const std::string kind = e->Name();
      static_cast<void>(xml_.children(section, e->Name()));
      const MjcfTag tag{file_, *e, {"equality"}, ""};
      const std::string name = tag.text("name", format("{}_{}", kind, 1 + robot_.loops.size()));
      file_.ignored.attributes(*e, {"solref", "solimp", "torquescale"});
      if (!tag.boolean("active", true)) {
        xml_.skip(*e);
        file_.ignored.add(*e, "a constraint of <equality>", "is not active");
      } else if (kind == "joint") {
        read_joints(tag);
      } else if (kind == "tendon") {
        read_tendon_row(tag, name);
      } else if (kind == "connect" || kind == "weld") {
        read_loop(tag, name, kind, bodies);
      } else {
        xml_.skip(*e);
        refusals_.add(*e, format("<{}> in <equality> is not read", kind), "Leave it out.");
      }
    }
  }

  void read_joints(const MjcfTag& tag) {
    const std::string name = xml_.required_text(tag.e, "joint1");
    const auto second = xml_.text(tag.e, "joint2");
    const RobotJoint* first = name.empty() ? nullptr : single_joint(tag.e, name);
    const RobotJoint* leader = second ? single_joint(tag.e, *second) : nullptr;
    std::vector<double> c = tag.numbers("polycoef", 1, 5);
    if (c.empty()) c = {0.0, 1.0};
    c.resize(5, 0.0);
    if (first == nullptr || (second && leader == nullptr)) return;
    if (c[2] != 0.0 || c[3] != 0.0 || c[4] != 0.0) {
      refusals_.add(tag.e, format("{} follows by a polynomial of a higher order", quote(name)),
                    "Only linear ones are read.");
      return;
    }
    if (first->mimic || !second) {
      refusals_.add(tag.e,
                    first->mimic ? format("{} follows two joints", quote(name))
                                 : format("{} is held at a value", quote(name)),
                    "Add a coupling, or a motor with a constant angle.");
      return;
    }
    RobotMimic mimic;
    mimic.at = &tag.e;
    mimic.joint = *second;
    mimic.multiplier = c[1];
    mimic.offset = c[0] + first->zero - c[1] * leader->zero;
    for (RobotJoint& joint : robot_.joints)
      if (joint.name == name) joint.mimic = mimic;
  }

  /// A fixed tendon whose length, a sum of coordinates, remains that of the configuration.
  void read_tendon_row(const MjcfTag& tag, const std::string& name) {
    const std::string tendon = xml_.required_text(tag.e, "tendon1");
    const std::vector<double> c = tag.numbers("polycoef", 1, 5);
    const auto found = fixed_tendons_.find(tendon);
    if (found == fixed_tendons_.end() || xml_.text(tag.e, "tendon2")) {
      refusals_.add(
          tag.e, format("the length of the tendon {} is not a sum of coordinates", quote(tendon)),
          "Only one fixed tendon can be held.");
      return;
    }
    RobotRow row;
    row.name = name;
    row.at = &tag.e;
    row.sum = c.empty() ? 0.0 : c[0];
    for (const auto& [joint_name, factor] : found->second) {
      const RobotJoint* joint = single_joint(tag.e, joint_name);
      if (joint == nullptr || factor == 0.0) continue;
      row.joints.push_back(joint_name);
      row.factors.push_back(factor);
      row.sum += factor * joint->zero;
    }
    if (row.joints.empty()) return;
    file_.notes.push_back(
        {ImportNote::Kind::approximated, xml_.place(tag.e),
         format("the constraint {} holds exactly, and is soft in MuJoCo", quote(name))});
    robot_.rows.push_back(std::move(row));
  }

  void read_loop(const MjcfTag& tag, const std::string& name, const std::string& kind,
                 const MjcfBodies& bodies) {
    RobotLoop loop;
    loop.at = &tag.e;
    loop.name = name;
    loop.type = kind == "weld" ? "fixed" : "spherical";
    const bool by_site = xml_.text(tag.e, "site1").has_value();
    for (int k = 0; k < 2; ++k) {
      const std::string attribute = format("{}{}", by_site ? "site" : "body", k + 1);
      const std::string on = k == 1 && !by_site
                                 ? xml_.text(tag.e, attribute.c_str()).value_or("world")
                                 : xml_.required_text(tag.e, attribute.c_str());
      if (by_site) {
        const auto site = bodies.sites().find(on);
        if (site == bodies.sites().end()) {
          xml_.fault(tag.e, format("there is no site {}", quote(on)), "Name a site of a body.");
          return;
        }
        loop.links[k] = site->second.link;
        loop.frames[k] = site->second.frame;
      } else {
        if (!bodies.frames().contains(on)) {
          xml_.fault(tag.e, format("there is no body {}", quote(on)), "Name a body.");
          return;
        }
        loop.links[k] = on;
      }
    }
    if (!by_site) {
      const Pose &a = bodies.frames().at(loop.links[0]), &b = bodies.frames().at(loop.links[1]);
      const std::vector<double> relative = tag.numbers("relpose", 7, 7);
      const Quat turn = relative.empty() ? Quat(0, 0, 0, 0)
                                         : Quat(relative[3], relative[4], relative[5], relative[6]);
      if (kind == "weld" && turn.norm() > 0.0) {
        // The anchor is on the second body; the pose is that of the second in the first.
        const Pose of_b{Vec3(relative[0], relative[1], relative[2]),
                        turn.normalized().toRotationMatrix()};
        loop.frames[1].p = tag.vector("anchor", Vec3::Zero());
        loop.frames[0] = of_b * loop.frames[1];
      } else {
        const bool of_second = kind == "weld";
        const Pose anchor{tag.vector("anchor", Vec3::Zero()), Mat3::Identity()};
        loop.frames[of_second ? 1 : 0] = anchor;
        loop.frames[of_second ? 0 : 1] =
            of_second ? a.inverse() * b * anchor : b.inverse() * a * anchor;
      }
    }
    file_.notes.push_back(
        {ImportNote::Kind::approximated, xml_.place(tag.e),
         format("the constraint {} holds exactly, and is soft in MuJoCo", quote(name))});
    robot_.loops.push_back(std::move(loop));
  }

  void read_tendons(const Element& section) {
    for (const Element* e = section.FirstChildElement(); e != nullptr;
         e = e->NextSiblingElement()) {
      static_cast<void>(xml_.children(section, e->Name()));
      const MjcfTag tag{file_, *e, {"tendon"}, ""};
      const std::string name = tag.text("name", "");
      if (std::string_view(e->Name()) == "fixed")
        for (const Element* joint : xml_.children(*e, "joint"))
          fixed_tendons_[name].emplace_back(xml_.text(*joint, "joint").value_or(""),
                                            xml_.number(*joint, "coef").value_or(0.0));
      const bool limits = options_.limits && !tag.numbers("range", 2, 2).empty() &&
                          tag.boolean("limited", file_.compiler.auto_limits);
      const bool friction = options_.friction && tag.number("frictionloss", 0.0) != 0.0;
      const bool acts = limits || friction;
      bool pulls = false;
      for (const char* attribute : {"stiffness", "damping", "armature"})
        for (const double value : tag.numbers(attribute, 1, 8)) pulls = pulls || value != 0.0;
      xml_.skip(*e);
      if (acts || pulls)
        refusals_.add(
            *e,
            format("the tendon {} has {}", quote(name),
                   pulls ? "a stiffness, damping or armature" : "limits or friction"),
            pulls ? "Add a cable or spring of your own." : "Import without limits and friction.");
      else
        file_.ignored.add(*e, "a tendon without stiffness, damping and limits", "exerts no force");
    }
  }

  void read_actuators(const Element& section) {
    static const std::vector<std::string> kinds{"general",  "motor",       "position", "velocity",
                                                "damper",   "intvelocity", "cylinder", "muscle",
                                                "adhesion", "plugin"};
    for (const Element* e = section.FirstChildElement(); e != nullptr;
         e = e->NextSiblingElement()) {
      static_cast<void>(xml_.children(section, e->Name()));
      if (options_.actuators) read_actuator({file_, *e, kinds, ""});
      xml_.skip(*e);
    }
  }

  void read_actuator(const MjcfTag& tag) {
    const std::string kind = tag.e.Name();
    RobotActuator actuator;
    actuator.at = &tag.e;
    actuator.joint = xml_.text(tag.e, "joint").value_or("");
    actuator.name = tag.text("name", actuator.joint + "_" + kind);
    const auto refuse = [&](const std::string& what) {
      refusals_.add(tag.e, format("the actuator {} {}", quote(actuator.name), what),
                    "Import without actuators.");
    };
    if (actuator.joint.empty()) return refuse("does not act on a joint");
    const RobotJoint* joint = single_joint(tag.e, actuator.joint);
    if (joint == nullptr) return;
    if (actuator.name == actuator.joint) actuator.name += "_motor";
    const std::vector<double> gears = tag.numbers("gear", 1, 6);
    const double gear = gears.empty() ? 1.0 : gears[0];
    if (tag.number("timeconst", 0.0) != 0.0 || tag.text("dyntype", "none") != "none")
      return refuse("has dynamics of its own");
    const double squared = gear * gear;
    if (kind == "position") {
      actuator.kind = RobotActuator::Kind::place;
      actuator.stiffness = squared * tag.number("kp", 1.0);
      actuator.damping = squared * tag.number("kv", 0.0);
      if (tag.number("dampratio", 0.0) != 0.0) return refuse("has a damping ratio");
    } else if (kind == "velocity") {
      actuator.kind = RobotActuator::Kind::velocity;
      actuator.damping = squared * tag.number("kv", 1.0);
    } else if (kind == "general") {
      const std::vector<double> bias = tag.numbers("biasprm", 1, 10);
      const std::string type = tag.text("biastype", "none");
      if (tag.text("gaintype", "fixed") != "fixed" || (type != "none" && type != "affine"))
        return refuse("has a gain or bias that is not affine");
      const auto entry = [&](std::size_t k) {
        return type == "none" || k >= bias.size() ? 0.0 : bias[k];
      };
      if (entry(0) != 0.0 || entry(1) > 0.0 || entry(2) > 0.0)
        return refuse("has a bias that is no spring and damper");
      actuator.stiffness = -squared * entry(1);
      actuator.damping = -squared * entry(2);
      if (actuator.stiffness > 0.0 || actuator.damping > 0.0)
        actuator.kind =
            actuator.stiffness > 0.0 ? RobotActuator::Kind::place : RobotActuator::Kind::velocity;
    } else if (kind != "motor") {
      return refuse(format("is a {}", kind));
    }
    const std::vector<double> range = tag.numbers("forcerange", 2, 2);
    if (!range.empty() && tag.boolean("forcelimited", file_.compiler.auto_limits) &&
        actuator.kind != RobotActuator::Kind::effort) {
      if (range[0] == -range[1] && range[1] > 0.0)
        actuator.most = std::abs(gear) * range[1];
      else
        file_.ignored.add(tag.e, "'forcerange' that is not symmetric", "limits nothing");
    }
    robot_.actuators.push_back(std::move(actuator));
  }

  XmlFile& xml_;
  const ImportOptions& options_;
  MjcfFile file_;
  MjcfRefusals refusals_;
  Robot robot_;
  /// Joints and their factors.
  std::map<std::string, std::vector<std::pair<std::string, double>>> fixed_tendons_;
};

}  // namespace

Imported import_mjcf(std::shared_ptr<const SourceText> source, const ImportOptions& options,
                     const std::string& folder) {
  Imported result;
  result.format = "MJCF";
  result.source = source;
  Diagnostics diagnostics(*source);
  XmlFile xml(source, diagnostics);
  if (const std::string_view root = xml.root().Name(); root != "mujoco") {
    xml.fault(xml.root(), format("the file's tag is <{}>, not <mujoco>", root),
              "Give an MJCF file, which starts with <mujoco>, or a URDF as .urdf.");
    diagnostics.throw_if_any();
  }
  const std::string own_folder = std::filesystem::path(options.file).parent_path().string();
  xml.include_files(own_folder);
  diagnostics.throw_if_any();
  const Robot robot = MjcfReader(xml, options, result.notes).read(own_folder);
  diagnostics.throw_if_any();
  write_robot(robot, options, xml, diagnostics, folder, result);
  diagnostics.throw_if_any();
  return result;
}

}  // namespace polhode::io
