// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/urdf.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/ignored_tags.hpp>
#include <polhode/io/importers/write_robot.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Types of <joint>, and of Drake's <drake:joint>.
const std::vector<std::string> kJointTypes{"revolute", "continuous", "prismatic",
                                           "fixed",    "floating",   "planar"};
const std::vector<std::string> kDrakeTypes{"floating", "ball", "planar", "screw", "universal"};

/// Reader of one file; errors go to its diagnostics.
class RobotReader {
 public:
  RobotReader(XmlFile& xml, std::vector<ImportNote>& notes)
      : xml_(xml), notes_(notes), ignored_(xml, notes) {}

  Robot read() {
    const Element& root = xml_.root();
    if (std::string_view(root.Name()) != "robot") {
      xml_.fault(root, format("the file's tag is <{}>, not <robot>", root.Name()),
                 "Give a URDF, which starts with <robot name=\"...\">.");
      return {};
    }
    refuse_xacro(root);
    Robot robot;
    robot.name = xml_.text(root, "name").value_or("");
    ignored_.attributes(root, {"version"});
    for (const Element* e : xml_.children(root, "link")) read_link(*e, robot);
    for (const Element* e : xml_.children(root, "joint")) read_joint(*e, kJointTypes, robot);
    for (const Element* e : xml_.children(root, "drake:joint")) read_joint(*e, kDrakeTypes, robot);
    for (const char* tag : {"loop_joint", "loop"})
      for (const Element* e : xml_.children(root, tag)) read_loop(*e, robot);
    for (const char* tag : {"constraint", "coupling"})
      if (const Element* e = root.FirstChildElement(tag))
        xml_.fault(*e, format("<{}> has no meaning that is agreed on", tag),
                   "Write it as <mimic>, or as a joint or load of an overlay.");
    ignored_.skip(root, {"material", "transmission", "gazebo", "sensor", "ros2_control",
                         "constraint", "coupling"});
    if (robot.links.empty()) xml_.fault(root, "the robot has no link", "Add <link name=\"...\">.");
    ignored_.add_unread();
    return robot;
  }

 private:
  /// An error about the first tag that xacro should have replaced. @returns whether there is one.
  bool refuse_xacro(const Element& e) {
    if (std::string_view(e.Name()).starts_with("xacro:")) {
      xml_.fault(e, format("<{}> is a tag of xacro, which has not been expanded", e.Name()),
                 "Expand the file by xacro, or call it .xacro.");
      return true;
    }
    for (const Element* inner = e.FirstChildElement(); inner != nullptr;
         inner = inner->NextSiblingElement())
      if (refuse_xacro(*inner)) return true;
    return false;
  }

  /// A child that stands at most once; null if there is none.
  const Element* single(const Element& parent, const char* tag) {
    const Element* e = xml_.child(parent, tag);
    if (const Element* next = e == nullptr ? nullptr : e->NextSiblingElement(tag))
      xml_.fault(*next, format("<{}> stands twice in <{}>", tag, parent.Name()),
                 "Keep one of the two.");
    return e;
  }

  Pose read_origin(const Element& parent) {
    const Element* e = single(parent, "origin");
    return e == nullptr ? Pose{} : read_pose(*e);
  }

  Pose read_pose(const Element& e) {
    Pose pose;
    if (const auto p = xml_.vector(e, "xyz")) pose.p = *p;
    const auto rpy = xml_.vector(e, "rpy");
    if (rpy) pose.R = rotation_of_rpy(*rpy);
    const auto q = xml_.numbers(e, "quat_xyzw", 4, 4);
    if (!q) return pose;
    const Eigen::Vector4d numbers(q->data());
    const double largest = numbers.cwiseAbs().maxCoeff();
    if (rpy || !(largest > 0.0))
      xml_.fault(e, rpy ? "<origin> has both 'rpy' and 'quat_xyzw'" : "'quat_xyzw' has no length",
                 rpy ? "Give one of the two." : "Write 0 0 0 1 for no rotation.");
    else
      pose.R = Quat(numbers / largest).normalized().toRotationMatrix();
    return pose;
  }

  void read_link(const Element& e, Robot& robot) {
    RobotLink link;
    link.name = xml_.required_text(e, "name");
    link.at = &e;
    ignored_.attributes(e, {"type"});
    if (!link.name.empty() && !links_.insert(link.name).second)
      xml_.fault(e, format("the link {} stands twice", quote(link.name)), "Rename one of them.");
    if (const Element* inertial = single(e, "inertial")) read_inertial(*inertial, link);
    for (const char* tag : {"visual", "collision"})
      for (const Element* shape : xml_.children(e, tag))
        read_shape(*shape, tag == std::string_view("visual") ? link.visual : link.collision);
    ignored_.skip(e, {"self_collision_checking", "contact", "sensor", "gazebo"});
    robot.links.push_back(std::move(link));
  }

  void read_inertial(const Element& e, RobotLink& link) {
    const Element* mass = single(e, "mass");
    const Element* inertia = single(e, "inertia");
    const Pose pose = read_origin(e);
    link.has_inertial = true;
    link.mass.com = pose.p;
    if (mass == nullptr) {
      xml_.fault(e, format("the inertial of {} has no <mass>", quote(link.name)),
                 "Write <mass value=\"...\"/>.");
    } else {
      const auto value = xml_.number(*mass, "value");
      link.mass.mass = value.value_or(0.0);
      if (!value && mass->Attribute("value") == nullptr)
        xml_.fault(*mass, "<mass> has no 'value'", "Write <mass value=\"...\"/>.");
      if (link.mass.mass < 0.0)
        xml_.fault(*mass, format("the mass of {} is {}", quote(link.name), link.mass.mass),
                   "Give a mass that is not negative.");
    }
    if (inertia == nullptr) return;
    const auto entry = [&](const char* name) { return xml_.number(*inertia, name).value_or(0.0); };
    Mat3 J;
    J(0, 0) = entry("ixx");
    J(1, 1) = entry("iyy");
    J(2, 2) = entry("izz");
    J(0, 1) = J(1, 0) = entry("ixy");
    J(0, 2) = J(2, 0) = entry("ixz");
    J(1, 2) = J(2, 1) = entry("iyz");
    const Mat3 turned = pose.R * J * pose.R.transpose();
    link.mass.inertia = pose.R.isIdentity(0.0) ? J : Mat3(0.5 * (turned + turned.transpose()));
  }

  void read_shape(const Element& e, std::vector<RobotShape>& shapes) {
    RobotShape shape;
    shape.at = &e;
    shape.pose = read_origin(e);
    ignored_.attributes(e, {"name"});
    ignored_.skip(e, {"material", "verbose", "contact_coefficients"});
    const Element* geometry = single(e, "geometry");
    if (geometry == nullptr) {
      xml_.fault(e, format("<{}> has no <geometry>", e.Name()), "Add it, or leave the tag out.");
      return;
    }
    if (read_geometry(*geometry, shape)) shapes.push_back(std::move(shape));
  }

  /// Number that must be there and positive; 0 after an error.
  double length(const Element& e, const char* attribute) {
    const auto value = xml_.number(e, attribute);
    if (value && *value > 0.0) return *value;
    if (value || e.Attribute(attribute) == nullptr)
      xml_.fault(e,
                 format("'{}' of <{}> must be above 0, but is {}", attribute, e.Name(),
                        value ? format("{}", *value) : "missing"),
                 "Give a length [m].");
    return 0.0;
  }

  bool read_geometry(const Element& e, RobotShape& shape) {
    if (const Element* box = xml_.child(e, "box")) {
      shape.kind = "box";
      const auto size = xml_.vector(*box, "size");
      if (size && size->isZero(0.0))  // A sign of a link that has only a place.
        ignored_.add(*box, "a <box> of the size 0 0 0", "has no surface");
      else if (size && size->minCoeff() > 0.0)
        shape.sizes = {size->x(), size->y(), size->z()};
      else if (size || box->Attribute("size") == nullptr)
        xml_.fault(*box, "the size of <box> must be three numbers above 0",
                   "Write <box size=\"x y z\"/>.");
    } else if (const Element* ball = xml_.child(e, "sphere")) {
      shape.kind = "sphere";
      shape.sizes = {2.0 * length(*ball, "radius")};
    } else if (const Element* bar = xml_.child(e, "cylinder")) {
      shape.kind = "cylinder";
      shape.sizes = {2.0 * length(*bar, "radius"), length(*bar, "length")};
    } else if (const Element* pill = xml_.child(e, "capsule")) {
      shape.kind = "capsule";  // The length in a URDF is without the hemispheres.
      const double radius = length(*pill, "radius");
      shape.sizes = {2.0 * radius, length(*pill, "length") + 2.0 * radius};
    } else if (const Element* mesh = xml_.child(e, "mesh")) {
      shape.kind = "mesh";
      shape.file = xml_.required_text(*mesh, "filename");
      if (const auto scale = xml_.vector(*mesh, "scale")) shape.scale = *scale;
      return !shape.file.empty();
    } else {
      return false;  // Unknown ones are listed as unread.
    }
    return std::all_of(shape.sizes.begin(), shape.sizes.end(), [](double s) { return s > 0.0; }) &&
           !shape.sizes.empty();
  }

  /// @param needed  Whether the joint has an axis.
  Vec3 read_axis(const Element& parent, bool needed) {
    const Element* e = single(parent, "axis");
    if (e == nullptr) return Vec3::UnitX();
    const auto axis = xml_.vector(*e, "xyz");
    if (!axis) return Vec3::UnitX();
    if (axis->norm() > 0.0) return axis->normalized();
    if (!needed) return Vec3::UnitX();
    xml_.fault(*e, "the axis has no length", "Give a direction, such as xyz=\"0 0 1\".");
    return Vec3::UnitX();
  }

  /// @param types  Those of the tag.
  void read_joint(const Element& e, const std::vector<std::string>& types, Robot& robot) {
    RobotJoint joint;
    joint.at = &e;
    joint.name = xml_.required_text(e, "name");
    joint.type = xml_.required_text(e, "type");
    if (!joint.name.empty() && !joints_.insert(joint.name).second)
      xml_.fault(e, format("the joint {} stands twice", quote(joint.name)), "Rename one of them.");
    if (!joint.type.empty() && std::find(types.begin(), types.end(), joint.type) == types.end())
      xml_.fault(
          e, format("the joint {} has the unknown type {}", quote(joint.name), quote(joint.type)),
          did_you_mean(joint.type, types) + "Types: " + name_list(types) + ".");
    const auto link_of = [&](const char* tag) {
      const Element* link = xml_.child(e, tag);
      if (link != nullptr) return xml_.required_text(*link, "link");
      xml_.fault(e, format("the joint {} has no <{}>", quote(joint.name), tag),
                 format("Write <{} link=\"...\"/>.", tag));
      return std::string();
    };
    joint.parent = link_of("parent");
    joint.child = link_of("child");
    joint.origin = read_origin(e);
    joint.axis = read_axis(e, joint.type != "fixed" && joint.type != "floating");
    if (types == kDrakeTypes) read_drake_joint(e, joint);
    read_limit(e, joint);
    if (const Element* dynamics = single(e, "dynamics")) {
      joint.damping = has_damping(*dynamics, joint) ? not_negative(*dynamics, "damping") : 0.0;
      joint.friction = not_negative(*dynamics, "friction");
      if (joint.type == "fixed" && (joint.damping > 0.0 || joint.friction > 0.0))
        ignored_.add(*dynamics, "<dynamics> of a fixed joint", "has no influence on the motion");
    }
    if (const Element* mimic = single(e, "mimic")) read_mimic(*mimic, joint);
    ignored_.skip(e, {"calibration", "safety_controller", "gazebo", "hardwareInterface"});
    robot.joints.push_back(std::move(joint));
  }

  /// Drake's joints: a plane across z, angles about x and then y, a thread along the axis.
  void read_drake_joint(const Element& e, RobotJoint& joint) {
    if (joint.type == "planar") joint.axis = Vec3::UnitZ();
    if (joint.type == "universal") joint.axis = Vec3::UnitX();
    if (joint.type == "ball") joint.type = "spherical";
    if (joint.type != "screw") return;
    const Element* pitch = xml_.child(e, "drake:screw_thread_pitch");
    if (pitch != nullptr && pitch->Attribute("value") != nullptr)
      joint.pitch = xml_.number(*pitch, "value").value_or(0.0);
    else
      xml_.fault(e, format("the screw {} has no <drake:screw_thread_pitch>", quote(joint.name)),
                 "Write <drake:screw_thread_pitch value=\"...\"/>, in metres per turn.");
  }

  /// Whether the damping of a joint is one number for all its motions. Drake's planar joint has
  /// three of them, and a universal one damps two angles.
  bool has_damping(const Element& e, const RobotJoint& joint) {
    if (joint.type != "planar" && joint.type != "universal") return true;
    const auto values = xml_.numbers(e, "damping", 1, 3);
    if (values && std::any_of(values->begin(), values->end(), [](double c) { return c != 0.0; }))
      xml_.fault(e, format("the {} joint {} has a damping", joint.type, quote(joint.name)),
                 joint.type == "planar" ? "Add a bushing, or use two slides and a hinge."
                                        : "Use two hinges with a link between them.");
    return false;
  }

  double not_negative(const Element& e, const char* attribute) {
    const double value = xml_.number(e, attribute).value_or(0.0);
    if (value < 0.0)
      xml_.fault(e, format("'{}' of <{}> is {}", attribute, e.Name(), value),
                 "Give a value that is not negative.");
    return std::max(0.0, value);
  }

  void read_limit(const Element& e, RobotJoint& joint) {
    const Element* limit = single(e, "limit");
    if (limit == nullptr) {
      if (joint.type == "revolute" || joint.type == "prismatic")
        notes_.push_back({ImportNote::Kind::approximated, xml_.place(e),
                          format("the joint {} has no <limit>, and no stops", quote(joint.name))});
      return;
    }
    for (const char* unused : {"effort", "velocity", "acceleration", "deceleration", "jerk"})
      if (xml_.text(*limit, unused))
        ignored_.add(*limit, format("attribute '{}' of <limit>", unused),
                     "limits an actuator, and there is none");
    const auto lower = xml_.number(*limit, "lower"), upper = xml_.number(*limit, "upper");
    if (joint.type != "revolute" && joint.type != "prismatic") return;
    if (!lower && !upper) return;
    const double low = lower.value_or(0.0), high = upper.value_or(0.0);
    if (low < high) {
      joint.lower = low;
      joint.upper = high;
    } else if (low > high) {
      xml_.fault(*limit,
                 format("the joint {} has the limits {} to {}", quote(joint.name), low, high),
                 "Give a lower limit below the upper one, or type=\"fixed\".");
    } else {
      notes_.push_back(
          {ImportNote::Kind::approximated, xml_.place(*limit),
           format("the joint {} has both limits at {}: it has no stops", quote(joint.name), low)});
    }
  }

  void read_mimic(const Element& e, RobotJoint& joint) {
    RobotMimic mimic;
    mimic.at = &e;
    mimic.joint = xml_.required_text(e, "joint");
    mimic.multiplier = xml_.number(e, "multiplier").value_or(1.0);
    mimic.offset = xml_.number(e, "offset").value_or(0.0);
    if (mimic.joint.empty()) return;
    if (joint.type == "fixed")
      ignored_.add(e, "<mimic> of a fixed joint", "has no influence on the motion");
    else
      joint.mimic = mimic;
  }

  void read_loop(const Element& e, Robot& robot) {
    RobotLoop loop;
    loop.at = &e;
    loop.name = xml_.required_text(e, "name");
    loop.type = xml_.required_text(e, "type");
    if (!loop.name.empty() && !joints_.insert(loop.name).second)
      xml_.fault(e, format("the joint {} stands twice", quote(loop.name)), "Rename one of them.");
    static const std::vector<std::string> types{"revolute",  "continuous",  "prismatic", "fixed",
                                                "spherical", "cylindrical", "planar"};
    if (!loop.type.empty() && std::find(types.begin(), types.end(), loop.type) == types.end())
      xml_.fault(e, format("<{}> has the unknown type {}", e.Name(), quote(loop.type)),
                 did_you_mean(loop.type, types) + "Types: " + name_list(types) + ".");
    const bool pair = std::string_view(e.Name()) == "loop_joint";
    const char* tags[2] = {pair ? "link1" : "predecessor", pair ? "link2" : "successor"};
    for (int k = 0; k < 2; ++k) {
      const Element* link = xml_.child(e, tags[k]);
      if (link == nullptr) {
        xml_.fault(e, format("<{}> has no <{}>", e.Name(), tags[k]),
                   format("Write <{} link=\"...\" xyz=\"...\" rpy=\"...\"/>.", tags[k]));
        continue;
      }
      loop.links[k] = xml_.required_text(*link, "link");
      const Element* origin = xml_.child(*link, "origin");
      loop.frames[k] = read_pose(origin != nullptr ? *origin : *link);
    }
    loop.axis = read_axis(e, loop.type != "fixed" && loop.type != "spherical");
    robot.loops.push_back(std::move(loop));
  }

  XmlFile& xml_;
  std::vector<ImportNote>& notes_;
  IgnoredTags ignored_;
  std::set<std::string> links_, joints_;
};

}  // namespace

Imported import_urdf(std::shared_ptr<const SourceText> source, const ImportOptions& options,
                     const std::string& folder) {
  Imported result;
  result.format = "URDF";
  result.source = source;
  Diagnostics diagnostics(*source);
  XmlFile xml(source, diagnostics);
  const Robot robot = RobotReader(xml, result.notes).read();
  diagnostics.throw_if_any();
  write_robot(robot, options, xml, diagnostics, folder, result);
  diagnostics.throw_if_any();
  return result;
}

}  // namespace polhode::io
