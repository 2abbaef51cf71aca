// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/sdf_joints.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Rounding of the scalar product of two unit vectors, below which they are perpendicular, or of
/// their cross product, below which they are parallel.
constexpr double kSameDirection = 1e-12;
/// Cross product of unit axes of different joints below which they are parallel: a file gives them
/// with few digits.
constexpr double kParallel = 1e-6;

class SdfJointReader {
 public:
  SdfJointReader(SdfFile& file, SdfFrames& frames, Robot& robot)
      : file_(file), xml_(file.xml), frames_(frames), robot_(robot) {}

  void read(const std::vector<SdfJoint>& joints) {
    for (const SdfJoint& j : joints) find_leaders(j);
    std::vector<const SdfJoint*> gearboxes;
    for (const SdfJoint& j : joints) {
      if (xml_.text(*j.at, "type").value_or("") == "gearbox")
        gearboxes.push_back(&j);
      else
        read_joint(j);
    }
    for (const SdfJoint* j : gearboxes) read_gearbox(*j);
  }

 private:
  /// Name of a joint that another one mentions.
  [[nodiscard]] std::string full_name(int scope, const std::string& name) const {
    const int found = frames_.find(scope, name);
    return found >= 0 && frames_[found].kind == SdfFrame::Kind::joint
               ? frames_[found].name
               : frames_.prefix(scope) + name;
  }

  void find_leaders(const SdfJoint& j) {
    for (const char* tag : {"axis", "axis2"})
      if (const Element* axis = xml_.child(*j.at, tag))
        if (const Element* mimic = xml_.child(*axis, "mimic"))
          leaders_.insert(full_name(frames_[j.frame].scope, mimic->Attribute("joint") == nullptr
                                                                ? ""
                                                                : mimic->Attribute("joint")));
  }

  /// Frame of the link at an end; −1 after an error.
  int end(const SdfJoint& j, const char* tag) {
    const std::string name = file_.required_text(*j.at, tag);
    if (name.empty()) return -1;
    if (name == "world") return 0;
    const int frame = frames_.required(*j.at, frames_[j.frame].scope, name);
    return frame < 0 ? -1 : frames_.link_of(*j.at, frame);
  }

  [[nodiscard]] const std::string& link_name(int frame) const {
    return robot_.links[static_cast<std::size_t>(frames_[frame].link)].name;
  }

  void ignore(const Element& e) {
    file_.ignored.attributes(e, {"name", "type"});
    file_.ignored.skip(e, {"physics", "sensor", "plugin"});
  }

  void read_joint(const SdfJoint& j) {
    const Element& e = *j.at;
    RobotJoint joint;
    joint.at = &e;
    joint.name = frames_[j.frame].name;
    ignore(e);
    if (!names_.insert(joint.name).second)
      xml_.fault(e, format("the joint {} stands twice", quote(joint.name)), "Rename one of them.");
    static const std::vector<std::string> types{"revolute", "continuous", "prismatic",
                                                "ball",     "universal",  "revolute2",
                                                "fixed",    "screw",      "gearbox"};
    const std::string type = xml_.required_text(e, "type");
    if (!type.empty() && std::find(types.begin(), types.end(), type) == types.end()) {
      xml_.fault(e, format("the joint {} has the unknown type {}", quote(joint.name), quote(type)),
                 did_you_mean(type, types) + "Types: " + name_list(types) + ".");
      return;
    }
    const int parent = end(j, "parent"), child = end(j, "child");
    if (parent < 0 || child < 0 || type.empty()) return;
    joint.type = type == "ball" ? "spherical" : type;
    joint.parent = link_name(parent);
    joint.child = link_name(child);
    joint.origin = frames_.between(parent, j.frame);
    joint.on_child = frames_.between(child, j.frame);
    const bool two = type == "universal" || type == "revolute2";
    if (two)
      read_pair(j, joint);
    else if (type == "fixed" || type == "ball")
      skip_axes(e, joint);
    else
      read_axis(j, "axis", joint);
    if (type == "screw") read_pitch(e, joint);
    if (!two) robot_.joints.push_back(std::move(joint));
  }

  void skip_axes(const Element& e, const RobotJoint& joint) {
    for (const char* tag : {"axis", "axis2"})
      for (const Element* axis : xml_.children(e, tag)) {
        xml_.skip(*axis);
        file_.ignored.add(*axis, format("<{}> of a {} joint", tag, joint.type), "is not read");
      }
  }

  /// Direction of an axis in the joint's frame.
  Vec3 direction(const SdfJoint& j, const Element& axis, const std::string& joint) {
    Vec3 given = file_.vector(axis, "xyz").value_or(Vec3::UnitZ());
    if (const double largest = given.cwiseAbs().maxCoeff(); largest > 0.0)
      given /= largest;  // Squares of any numbers are finite then.
    const Element* xyz = xml_.child(axis, "xyz");
    // Before version 1.5 axes were along those of the model.
    const bool of_model = file_.boolean(axis, "use_parent_model_frame", j.version < 5);
    std::string in = xyz == nullptr ? "" : xml_.text(*xyz, "expressed_in").value_or("");
    if (in.empty() && of_model) in = "__model__";
    if (!(given.norm() > 0.0)) {
      xml_.fault(axis, format("the axis of {} has no length", quote(joint)),
                 "Give a direction, such as 0 0 1.");
      return Vec3::UnitZ();
    }
    if (in.empty()) return given.normalized();
    const int base = frames_.required(axis, frames_[j.frame].scope, in);
    return base < 0 ? Vec3(given.normalized())
                    : Vec3((frames_.between(j.frame, base).R * given).normalized());
  }

  void read_axis(const SdfJoint& j, const char* tag, RobotJoint& joint) {
    joint.axis = Vec3::UnitZ();
    const Element* axis = xml_.child(*j.at, tag);
    if (axis == nullptr) {
      xml_.fault(*j.at, format("the joint {} has no <{}>", quote(joint.name), tag),
                 format("Write <{}><xyz>0 0 1</xyz></{}>.", tag, tag));
      return;
    }
    joint.axis = direction(j, *axis, joint.name);
    if (const Element* dynamics = xml_.child(*axis, "dynamics")) {
      joint.damping = file_.not_negative(*dynamics, "damping");
      joint.friction = file_.not_negative(*dynamics, "friction");
      joint.stiffness = file_.not_negative(*dynamics, "spring_stiffness");
      joint.rest = file_.number(*dynamics, "spring_reference").value_or(0.0);
    }
    read_limits(*axis, joint);
    file_.ignored.skip(*axis, {"initial_position"});
    if (const Element* mimic = xml_.child(*axis, "mimic")) read_mimic(j, *mimic, joint);
  }

  void read_limits(const Element& axis, RobotJoint& joint) {
    const Element* limit = xml_.child(axis, "limit");
    if (limit == nullptr) return;
    for (const char* unused : {"effort", "velocity"})
      if (xml_.child(*limit, unused) != nullptr)
        file_.ignored.add(*limit, format("<{}> in <limit>", unused),
                          "limits an actuator, and there is none");
    file_.ignored.skip(*limit, {"stiffness", "dissipation"});
    const auto lower = file_.bound(*limit, "lower"), upper = file_.bound(*limit, "upper");
    if (joint.type == "continuous" || (!lower && !upper)) return;
    if (!lower || !upper || *lower < *upper) {
      joint.lower = lower;
      joint.upper = upper;
    } else if (*lower > *upper) {
      xml_.fault(*limit,
                 format("the joint {} has the limits {} to {}", quote(joint.name), *lower, *upper),
                 "Give a lower limit below the upper one.");
    } else if (file_.options.limits && joint.type != "screw") {
      Pose at;
      if (joint.type == "prismatic")
        at.p = *lower * joint.axis;
      else
        at.R = Eigen::AngleAxisd(*lower, joint.axis).toRotationMatrix();
      if (*lower != 0.0) joint.origin = joint.origin * at;
      joint.type = "fixed";
      joint.damping = joint.friction = joint.stiffness = 0.0;
      file_.approximated(*limit, format("the joint {} is fixed, as both its limits are {}",
                                        quote(joint.name), *lower));
    }
  }

  void read_mimic(const SdfJoint& j, const Element& e, RobotJoint& joint) {
    RobotMimic mimic;
    mimic.at = &e;
    const std::string name = xml_.required_text(e, "joint");
    mimic.joint = full_name(frames_[j.frame].scope, name);
    const std::string axis = xml_.text(e, "axis").value_or("axis");
    if (axis == "axis2")
      mimic.joint += "_axis2";
    else if (axis != "axis")
      xml_.fault(e, format("'axis' of <mimic> is {}", quote(axis)), "Write axis or axis2.");
    mimic.multiplier = file_.number(e, "multiplier").value_or(1.0);
    mimic.offset = file_.number(e, "offset").value_or(0.0) -
                   mimic.multiplier * file_.number(e, "reference").value_or(0.0);
    if (name.empty()) return;
    if (joint.type == "fixed")
      file_.ignored.add(e, "<mimic> of a fixed joint", "has no influence on the motion");
    else
      joint.mimic = mimic;
  }

  void read_pitch(const Element& e, RobotJoint& joint) {
    if (const auto pitch = file_.number(e, "screw_thread_pitch")) {
      joint.pitch = *pitch;
      static_cast<void>(xml_.child(e, "thread_pitch"));
    } else if (const auto old = file_.number(e, "thread_pitch")) {
      // Radians per metre, left-handed.
      if (*old == 0.0)
        xml_.fault(e, format("<thread_pitch> of {} is 0", quote(joint.name)),
                   "Give <screw_thread_pitch> in metres per turn.");
      else
        joint.pitch = -2.0 * std::numbers::pi / *old;
    } else {
      joint.pitch = 1.0;
      file_.approximated(e, format("the screw {} has no <screw_thread_pitch>: 1 m per turn, which "
                                   "is the standard value",
                                   quote(joint.name)));
    }
  }

  /// A universal joint, or two hinges with a link between them: that is needed where they have
  /// limits, springs or dampers, or are not perpendicular.
  void read_pair(const SdfJoint& j, const RobotJoint& whole) {
    RobotJoint first = whole, second = whole;
    first.type = second.type = "revolute";
    read_axis(j, "axis", first);
    read_axis(j, "axis2", second);
    const auto is_plain = [&](const RobotJoint& hinge) {
      return hinge.type == "revolute" && hinge.damping == 0.0 && hinge.stiffness == 0.0 &&
             (hinge.friction == 0.0 || !file_.options.friction) && !hinge.mimic &&
             (!file_.options.limits || (!hinge.lower && !hinge.upper));
    };
    if (is_plain(first) && is_plain(second) && !leaders_.contains(whole.name) &&
        std::abs(first.axis.dot(second.axis)) < kSameDirection) {
      first.type = "universal";
      first.axis2 = second.axis;
      robot_.joints.push_back(std::move(first));
      return;
    }
    if (first.axis.cross(second.axis).norm() < kParallel) {
      xml_.fault(*j.at, format("both axes of {} are the same", quote(whole.name)),
                 "Give two directions, or another type of joint.");
      return;
    }
    RobotLink cross;
    cross.name = whole.name + "_cross";
    const auto taken = [&] {
      return std::any_of(robot_.links.begin(), robot_.links.end(),
                         [&](const RobotLink& link) { return link.name == cross.name; });
    };
    while (taken()) cross.name += "_";
    cross.at = j.at;
    cross.name_in_file = false;
    first.child = second.parent = cross.name;
    first.on_child = second.origin = Pose{};
    second.name += "_axis2";
    robot_.links.push_back(std::move(cross));
    robot_.joints.push_back(std::move(first));
    robot_.joints.push_back(std::move(second));
    file_.approximated(*j.at, format("the joint {} is two hinges with a link between them, which "
                                     "takes 1e-10 of the mass of the next one",
                                     quote(whole.name)));
  }

  /// Hinge between the reference body of a gearbox and one of its links.
  /// @param sign  −1 where its coordinate counts the other way.
  const RobotJoint* hinge(int reference, int other, const Vec3& axis, double& sign) {
    for (const RobotJoint& joint : robot_.joints) {
      if (!joint.turns() || joint.type == "screw") continue;
      const std::string &a = link_name(reference), &b = link_name(other);
      const bool along = joint.parent == a && joint.child == b;
      if (!along && (joint.parent != b || joint.child != a)) continue;
      const int on = along ? other : reference;
      const Vec3 in_world = frames_.in_world(on).R * joint.on_child.R * joint.axis;
      const double cosine = in_world.dot(axis);
      if (in_world.cross(axis).norm() > kParallel) continue;
      sign = (cosine > 0.0) == along ? 1.0 : -1.0;
      return &joint;
    }
    return nullptr;
  }

  /// A row between the angles of two hinges that both links have with the reference body.
  void read_gearbox(const SdfJoint& j) {
    const Element& e = *j.at;
    const std::string& name = frames_[j.frame].name;
    ignore(e);
    const int parent = end(j, "parent"), child = end(j, "child");
    const std::string body = file_.required_text(e, "gearbox_reference_body");
    const double ratio = file_.number(e, "gearbox_ratio").value_or(1.0);
    if (parent < 0 || child < 0 || body.empty()) return;
    const int named = body == "world" ? 0 : frames_.required(e, frames_[j.frame].scope, body);
    const int reference = named < 0 ? -1 : frames_.link_of(e, named);
    if (reference < 0) return;
    RobotRow row;
    row.name = name;
    row.at = &e;
    const int links[2] = {child, parent};
    const char* tags[2] = {"axis2", "axis"};
    for (int k = 0; k < 2; ++k) {
      RobotJoint own;
      own.name = name;
      own.type = "continuous";
      const bool given = k == 1 || xml_.child(e, "axis2") != nullptr;
      read_axis(j, given ? tags[k] : "axis", own);
      const Vec3 axis = frames_.in_world(j.frame).R * own.axis;
      double sign = 1.0;
      const RobotJoint* found = hinge(reference, links[k], axis, sign);
      if (found == nullptr) {
        file_.refuse(e,
                     format("the gearbox {} is not between two hinges of {}", quote(name),
                            quote(link_name(reference))),
                     "Add a coupling of joints.");
        return;
      }
      row.joints.push_back(found->name);
      row.factors.push_back(k == 0 ? sign : ratio * sign);
    }
    robot_.rows.push_back(std::move(row));
  }

  SdfFile& file_;
  XmlFile& xml_;
  SdfFrames& frames_;
  Robot& robot_;
  std::set<std::string> names_, leaders_;
};

}  // namespace

void read_sdf_joints(SdfFile& file, SdfFrames& frames, const std::vector<SdfJoint>& joints,
                     Robot& robot) {
  SdfJointReader(file, frames, robot).read(joints);
}

}  // namespace polhode::io
