// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/mjcf_actuators.hpp>
#include <polhode/io/importers/mjcf_armature.hpp>
#include <polhode/io/importers/mjcf_bodies.hpp>
#include <polhode/io/importers/mjcf_contacts.hpp>
#include <polhode/io/importers/mjcf_keyframe.hpp>
#include <polhode/io/importers/mjcf_medium.hpp>
#include <polhode/io/importers/mjcf_options.hpp>
#include <polhode/io/importers/mjcf_sensors.hpp>
#include <polhode/io/importers/mjcf_tendons.hpp>
#include <polhode/io/importers/write_robot.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Reader of options and equalities, and of all others in order.
class MjcfReader {
 public:
  /// @param options  Those that <option> of the file switches off become false.
  MjcfReader(XmlFile& xml, ImportOptions& options, std::vector<ImportNote>& notes)
      : xml_(xml), options_(options), file_(xml, notes), refusals_(file_, options.allow_partial) {}

  Robot read(const std::string& folder) {
    robot_.follows = "<equality>";
    robot_.name = xml_.text(xml_.root(), "model").value_or("");
    if (options_.base != "fixed")
      xml_.fault(xml_.root(), "an MJCF file says itself which bodies move freely",
                 "Leave import.base out.");
    read_options(file_, medium_, robot_, options_);
    MjcfGeoms geoms(file_, folder);
    MjcfBodies bodies(file_, geoms, refusals_, options_, robot_);
    bodies.read();
    add_medium(medium_, refusals_, bodies, robot_);
    if (robot_.links.size() < 2)
      xml_.fault(xml_.root(), "the model has no body", "Add <body> to <worldbody>.");
    const MjcfControls controls =
        read_keyframe(file_, options_, activations(), bodies.mocaps(), robot_);
    MjcfTendons tendons(file_, refusals_, bodies, options_, robot_);
    if (options_.actuators) add_actuator_armatures(file_, refusals_, tendons, robot_);
    tendons.read();
    for (const Element* e : file_.sections("equality")) read_equality(*e, bodies, tendons.sums());
    read_actuators(file_, refusals_, bodies, options_, controls, tendons, robot_);
    tendons.finish();
    add_free_armatures(file_, robot_);
    read_sensors(file_, bodies, robot_);
    read_contacts(file_, bodies, options_, robot_);
    for (const Element* section : file_.sections("asset"))
      for (const Element* e = section->FirstChildElement(); e != nullptr;
           e = e->NextSiblingElement()) {
        xml_.mark_read(*e);
        file_.skip(*e);
        const std::string_view tag = e->Name();
        if (tag == "texture" || tag == "material" || tag == "skin" || tag == "hfield")
          file_.ignored.add(*e, format("<{}> in <asset>", tag), "has no influence on the motion");
      }
    for (const Element* e : file_.sections("deformable")) {
      xml_.skip(*e);
      refusals_.add(*e, "<deformable> is not read", "Leave it out.");
    }
    file_.ignored.skip(xml_.root(), {"visual", "size", "statistic", "custom", "extension"});
    file_.ignored.add_unread();
    return std::move(robot_);
  }

 private:
  /// Whether each actuator has a state of its own.
  std::vector<bool> activations() {
    std::vector<bool> list;
    for (const MjcfActuator& a : actuators_of(file_)) list.push_back(a.has_activation());
    return list;
  }

  const RobotJoint* single_joint(const Element& e, const std::string& name) {
    return io::single_joint(xml_, robot_, e, name);
  }

  void read_equality(const Element& section, const MjcfBodies& bodies,
                     const MjcfTendons::Sums& sums) {
    for (const Element* e = section.FirstChildElement(); e != nullptr;
         e = e->NextSiblingElement()) {
      const std::string kind = e->Name();
      xml_.mark_read(*e);
      const MjcfTag tag{file_, *e, {"equality"}, ""};
      const std::string name = tag.text("name", format("{}_{}", kind, 1 + robot_.loops.size()));
      file_.ignored.attributes(*e, {"solref", "solimp", "torquescale"});
      if (!tag.boolean("active", true)) {
        file_.skip(*e);
        file_.ignored.add(*e, "a constraint of <equality>", "is not active");
      } else if (!file_.flags.equality) {
        file_.skip(*e);
        file_.ignored.add(*e, "a constraint of <equality> that <option> switches off",
                          "holds nothing");
      } else if (kind == "joint") {
        read_joints(tag, name);
      } else if (kind == "tendon") {
        read_tendon_row(tag, name, sums);
      } else if (kind == "connect" || kind == "weld") {
        read_loop(tag, name, kind, bodies);
      } else {
        xml_.skip(*e);
        refusals_.add(*e, format("<{}> in <equality> is not read", kind), "Leave it out.");
      }
    }
  }

  void say_exact(const Element& e, const std::string& name) {
    file_.notes.push_back(
        {ImportNote::Kind::approximated, xml_.place(e),
         format("the constraint {} holds exactly, and is soft in MuJoCo", quote(name))});
  }

  /// A joint that follows another one, or that is held at a coordinate.
  void read_joints(const MjcfTag& tag, const std::string& row_name) {
    const std::string name = xml_.required_text(tag.e, "joint1");
    const auto second = xml_.text(tag.e, "joint2");
    const RobotJoint* first = name.empty() ? nullptr : single_joint(tag.e, name);
    const RobotJoint* leader = second ? single_joint(tag.e, *second) : nullptr;
    std::vector<double> c{0.0, 1.0, 0.0, 0.0, 0.0};
    const std::vector<double> given = tag.numbers("polycoef", 1, 5);
    std::copy(given.begin(), given.end(), c.begin());
    if (first == nullptr || (second && leader == nullptr)) return;
    if (second && (c[2] != 0.0 || c[3] != 0.0 || c[4] != 0.0)) {
      refusals_.add(tag.e, format("{} follows by a polynomial of a higher order", quote(name)),
                    "Only linear ones are read.");
      return;
    }
    if (first->mimic) {
      refusals_.add(tag.e, format("{} follows two joints", quote(name)), "Add a coupling.");
      return;
    }
    if (!second) {
      RobotRow row;
      row.name = row_name;
      row.at = &tag.e;
      row.joints = {name};
      row.factors = {1.0};
      row.sum = c[0] + first->zero;
      say_exact(tag.e, row_name);
      robot_.rows.push_back(std::move(row));
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
  void read_tendon_row(const MjcfTag& tag, const std::string& name, const MjcfTendons::Sums& sums) {
    const std::string tendon = xml_.required_text(tag.e, "tendon1");
    const std::vector<double> c = tag.numbers("polycoef", 1, 5);
    const auto found = sums.find(tendon);
    if (found == sums.end() || xml_.text(tag.e, "tendon2")) {
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
    say_exact(tag.e, name);
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
    say_exact(tag.e, name);
    mark_loop(loop);
    robot_.loops.push_back(std::move(loop));
  }

  /// Joints between two links that a constraint connects: what they hold is the loop as it is.
  void mark_loop(const RobotLoop& loop) {
    std::map<std::string, RobotJoint*> above;
    for (RobotJoint& joint : robot_.joints) above[joint.child] = &joint;
    std::set<RobotJoint*> in_one;
    for (std::string link : loop.links)
      for (auto at = above.find(link); at != above.end(); at = above.find(at->second->parent))
        if (!in_one.insert(at->second).second) in_one.erase(at->second);
    for (RobotJoint* joint : in_one) joint->in_loop = true;
  }

  XmlFile& xml_;
  ImportOptions& options_;
  MjcfFile file_;
  MjcfRefusals refusals_;
  Robot robot_;
  MjcfMedium medium_;
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
  ImportOptions left = options;
  const Robot robot = MjcfReader(xml, left, result.notes).read(own_folder);
  diagnostics.throw_if_any();
  write_robot(robot, left, xml, diagnostics, folder, result);
  diagnostics.throw_if_any();
  return result;
}

}  // namespace polhode::io
