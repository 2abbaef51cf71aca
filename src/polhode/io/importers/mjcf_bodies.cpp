// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_bodies.hpp>

#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/mjcf_inertia.hpp>
#include <polhode/io/importers/mjcf_medium.hpp>

namespace polhode::io {

using geometry::MassProperties;

namespace {

/// Copies of all <replicate> of a file.
constexpr int kMostCopies = 100000;

}  // namespace

void MjcfRefusals::add(const XmlFile::Element& at, const std::string& what,
                       const std::string& hint) {
  if (partial_)
    file_.notes.push_back({ImportNote::Kind::left_out, file_.xml.place(at), what});
  else
    file_.xml.fault(at, what, hint + " Or allow a partial import.");
}

int MjcfBodies::add_link(const std::string& name, const Element& at) {
  std::string chosen = name;
  for (int k = 2; frames_.contains(chosen); ++k) chosen = format("{}_{}", name, k);
  RobotLink link;
  link.name = chosen;
  link.at = &at;
  robot_.links.push_back(std::move(link));
  frames_[chosen];
  return static_cast<int>(robot_.links.size()) - 1;
}

void MjcfBodies::read() {
  const Element& root = file_.xml.root();
  const int world = add_link("world", root);
  Parts parts;
  for (const Element* e : file_.sections("worldbody"))
    read_content(*e, {"world", world, {}, file_.xml.text(*e, "childclass").value_or("")}, parts,
                 false);
  double sum = 0.0;
  for (const RobotLink& link : robot_.links) sum += link.mass.mass;
  if (file_.compiler.total_mass > 0.0 && sum > 0.0)
    for (RobotLink& link : robot_.links) {
      link.mass.mass *= file_.compiler.total_mass / sum;
      link.mass.inertia *= file_.compiler.total_mass / sum;
    }
  tune();
}

/// Springs and dampers by the inertia of their joints in the model's configuration, as MuJoCo's
/// compiler chooses them.
void MjcfBodies::tune() {
  if (tuned_.empty()) return;
  const MjcfInertia inertia(robot_, frames_);
  for (const Tuned& t : tuned_) {
    RobotJoint& joint = robot_.joints[t.joint];
    const double J = inertia.is_there() ? inertia.effective(t.joint) : 0.0;
    if (!(J > 0.0)) {
      refusals_.add(
          *t.at,
          format("the 'springdamper' of {} {}", quote(joint.name),
                 inertia.is_there() ? "acts on a tree that has no inertia at one of its joints"
                                    : format("stands in a model with more than {} joint velocities",
                                             MjcfInertia::kMost)),
          "Give stiffness and damping.");
      continue;
    }
    if (file_.flags.springs) joint.stiffness = J / (t.time * t.time * t.ratio * t.ratio);
    if (file_.flags.dampers) joint.damping = 2.0 * J / t.time;
  }
}

void MjcfBodies::read_content(const Element& e, const Place& place, Parts& parts, bool massive) {
  XmlFile& xml = file_.xml;
  for (const Element* inner = e.FirstChildElement(); inner != nullptr;
       inner = inner->NextSiblingElement()) {
    const std::string_view name = inner->Name();
    if (name == "geom") {
      xml.mark_read(*inner);
      const MjcfTag tag{file_, *inner, {"geom"}, place.child_class, place.suffix};
      const MjcfGeom geom = geoms_.read(tag, place.frame, massive);
      if (geom.ellipsoid) ellipsoids_.push_back(inner);
      if (geom.mass) {
        parts.mass.push_back(*geom.mass);
        parts.axes = geom.axes;
      }
      const auto own = tag.name();
      if (own && touching_.contains(*own))
        xml.fault(*inner, format("the geom {} stands twice", quote(*own)), "Rename one of them.");
      if (own) touching_[*own] = {place.link, geom.friction, geom.dimensions};
      if (own && geom.shape)
        if (const std::string& kind = geom.shape->kind; kind == "sphere" || kind == "cylinder")
          wraps_[*own] = {place.link, geom.shape->pose, kind == "sphere",
                          0.5 * geom.shape->sizes[0]};
      RobotLink& link = robot_.links[static_cast<std::size_t>(place.body)];
      const bool plane = geom.shape && geom.shape->kind == "plane";
      if (plane && place.link != "world") {
        file_.ignored.add(*inner, "a plane on a body that moves", "is not read");
        continue;
      }
      if (geom.shape && geom.seen) link.visual.push_back(*geom.shape);
      if (geom.shape && geom.touches) link.collision.push_back(*geom.shape);
    } else if (name == "site") {
      const MjcfTag tag{file_, *inner, {"site"}, place.child_class, place.suffix};
      Pose frame = tag.pose();
      if (const auto ends = tag.numbers("fromto", 6, 6); !ends.empty())
        frame.p = 0.5 * Vec3(ends[0] + ends[3], ends[1] + ends[4], ends[2] + ends[5]);
      if (const auto site = tag.name();
          site && !sites_.try_emplace(*site, Site{place.link, place.frame * frame}).second)
        xml.fault(*inner, format("the site {} stands twice", quote(*site)), "Rename one of them.");
      file_.skip(*inner);
    } else if (name == "frame") {
      xml.mark_read(*inner);
      const MjcfTag tag{file_, *inner, {}, ""};
      file_.ignored.attributes(*inner, {"name"});
      read_content(*inner,
                   {place.link, place.body, place.frame * tag.pose(),
                    xml.text(*inner, "childclass").value_or(place.child_class), place.suffix},
                   parts, massive);
    } else if (name == "replicate") {
      xml.mark_read(*inner);
      read_copies(*inner, place, parts, massive);
    } else if (name == "body") {
      xml.mark_read(*inner);
      read_body(*inner, place);
    } else if (name == "composite" || name == "flexcomp" || name == "attach" || name == "plugin") {
      xml.skip(*inner);
      refusals_.add(*inner, format("<{}> is not read", name),
                    name == "attach"     ? "Let MuJoCo save the model, which writes its bodies out."
                    : name == "flexcomp" ? "Add a solid or a cable in a model file."
                    : name == "plugin"   ? "Leave it out."
                                         : "Write its bodies, or use <replicate>.");
    }
  }
  file_.ignored.skip(e, {"camera", "light"});
}

MassProperties MjcfBodies::inertial(const Element& e, Mat3& axes) {
  XmlFile& xml = file_.xml;
  const MjcfTag tag{file_, e, {}, ""};
  MassProperties mass;
  mass.mass = xml.number(e, "mass").value_or(0.0);
  if (e.Attribute("mass") == nullptr)
    xml.fault(e, "<inertial> has no 'mass'", "Write <inertial pos=\"...\" mass=\"...\"/>.");
  if (mass.mass < 0.0)
    xml.fault(e, format("the mass is {}", mass.mass), "Give a mass that is not negative.");
  mass.com = tag.vector("pos", Vec3::Zero());
  Mat3 J = Mat3::Zero();
  if (const auto all = xml.numbers(e, "fullinertia", 6, 6)) {
    J.diagonal() << (*all)[0], (*all)[1], (*all)[2];
    J(0, 1) = J(1, 0) = (*all)[3];
    J(0, 2) = J(2, 0) = (*all)[4];
    J(1, 2) = J(2, 1) = (*all)[5];
  } else if (const auto diagonal = xml.vector(e, "diaginertia")) {
    J.diagonal() = *diagonal;
  }
  const Mat3 R = tag.rotation();
  const Mat3 turned = R * J * R.transpose();
  mass.inertia = 0.5 * (turned + turned.transpose());
  axes = J.isDiagonal(0.0) ? R : rotated_to_principal(mass.inertia);
  return mass;
}

void MjcfBodies::bound(MassProperties& mass) const {
  const MjcfCompiler& c = file_.compiler;
  if (c.least_mass > 0.0) mass.mass = std::max(mass.mass, c.least_mass);
  if (c.least_inertia <= 0.0 && !c.balance) return;
  geometry::PrincipalAxes p = geometry::principal_axes(mass.inertia);
  p.moments = p.moments.cwiseMax(c.least_inertia);
  if (c.balance && p.moments[0] + p.moments[1] < p.moments[2])
    p.moments.setConstant(p.moments.mean());
  mass.inertia = p.axes * p.moments.asDiagonal() * p.axes.transpose();
}

/// Copies of bodies, geoms and sites, each moved from the one before. Names get the number of the
/// copy, with as many digits as their count.
void MjcfBodies::read_copies(const Element& e, const Place& place, Parts& parts, bool massive) {
  XmlFile& xml = file_.xml;
  const double count = xml.number(e, "count").value_or(0.0);
  if (!(count >= 1.0) || count != std::floor(count) || copies_ + count > kMostCopies) {
    xml.fault(e, format("<replicate> has the count {}", count),
              format("Give a whole number from 1, up to {} for all of them.", kMostCopies));
    return;
  }
  if (e.FirstChildElement("joint") != nullptr || e.FirstChildElement("freejoint") != nullptr)
    xml.fault(e, "<replicate> has a joint that is not in a body", "Put it into a <body>.");
  const std::string separator = xml.text(e, "sep").value_or("");
  const Pose move{xml.vector(e, "offset").value_or(Vec3::Zero()),
                  MjcfTag{file_, e, {}, ""}.rotation()};
  const std::size_t digits = std::to_string(static_cast<int>(count)).size();
  Place copy = place;
  for (int k = 0; k < static_cast<int>(count); ++k) {
    ++copies_;
    std::string number = std::to_string(k);
    number.insert(0, digits - number.size(), '0');
    copy.suffix = separator + number + place.suffix;
    read_content(e, copy, parts, massive);
    copy.frame = copy.frame * move;
  }
}

void MjcfBodies::read_body(const Element& e, const Place& parent) {
  XmlFile& xml = file_.xml;
  const std::string given = MjcfTag{file_, e, {}, "", parent.suffix}.name().value_or("");
  const std::string child_class = xml.text(e, "childclass").value_or(parent.child_class);
  file_.ignored.attributes(e, {"user", "sleep"});
  if (!given.empty() && frames_.contains(given))
    xml.fault(e, format("the body {} stands twice", quote(given)), "Rename one of them.");
  const std::string name = given.empty() ? format("body_{}", robot_.links.size()) : given;
  if (xml.text(e, "mocap").value_or("false") == "true") {
    mocaps_.push_back(robot_.joints.size());
    file_.notes.push_back({ImportNote::Kind::approximated, xml.place(e),
                           format("the mocap body {} is fixed", quote(name))});
  }
  const Pose pose = parent.frame * MjcfTag{file_, e, {}, ""}.pose();

  std::vector<const Element*> joints;
  for (const Element* inner = e.FirstChildElement(); inner != nullptr;
       inner = inner->NextSiblingElement())
    if (const std::string_view tag = inner->Name(); tag == "joint" || tag == "freejoint")
      joints.push_back(inner);
  static_cast<void>(xml.children(e, "joint"));
  static_cast<void>(xml.children(e, "freejoint"));

  std::string above = parent.link;
  const Pose here = frames_.at(parent.link) * pose;
  int body = -1;
  for (std::size_t k = 0; k < std::max<std::size_t>(1, joints.size()); ++k) {
    RobotJoint joint;
    joint.at = joints.empty() ? &e : joints[k];
    joint.name = joints.empty() ? name + "_weld"
                                : MjcfTag{file_, *joints[k], {}, "", parent.suffix}.name().value_or(
                                      joints.size() == 1 ? name + "_joint"
                                                         : format("{}_joint_{}", name, k + 1));
    const bool named = !joints.empty() && xml.text(*joints[k], "name").value_or("") != "";
    if (named && !given_joints_.insert(joint.name).second)
      xml.fault(*joint.at, format("the joint {} stands twice", quote(joint.name)),
                "Rename one of them.");
    while (!joint_names_.insert(joint.name).second) joint.name += "_2";
    joint.type = "fixed";
    joint.origin = k == 0 ? pose : Pose{};
    if (!joints.empty()) read_joint({file_, *joints[k], {"joint"}, child_class}, joint);
    if (joint.type == "floating" && (parent.link != "world" || joints.size() > 1))
      xml.fault(
          *joint.at,
          format("the free joint {} is not the only one of a body of the world", quote(joint.name)),
          "Only bodies of the world can move freely.");
    const bool last = k + 1 >= joints.size();
    body = add_link(last ? name : name + "_" + joint.name, e);
    robot_.links[static_cast<std::size_t>(body)].name_in_file = last;
    joint.parent = above;
    joint.child = above = robot_.links[static_cast<std::size_t>(body)].name;
    frames_[above] = here;
    robot_.joints.push_back(std::move(joint));
  }
  const Element* given_mass = xml.child(e, "inertial");
  if (const Element* next =
          given_mass == nullptr ? nullptr : given_mass->NextSiblingElement("inertial"))
    xml.fault(*next, format("the body {} has a second <inertial>", quote(name)),
              "Keep one of the two.");
  const auto how = file_.compiler.inertia;
  const bool from_geoms = how == MjcfCompiler::FromGeoms::always ||
                          (how == MjcfCompiler::FromGeoms::automatic && given_mass == nullptr);
  Parts parts;
  read_content(e, {above, body, {}, child_class, parent.suffix}, parts, from_geoms);
  MassProperties mass;
  Mat3 axes = Mat3::Identity();
  if (given_mass != nullptr) mass = inertial(*given_mass, axes);
  if (from_geoms && !parts.mass.empty()) {
    mass = geometry::composed(parts.mass);
    axes = parts.mass.size() == 1 ? parts.axes : rotated_to_principal(mass.inertia);
  }
  axes_[robot_.links[static_cast<std::size_t>(body)].name] = axes;
  bound(mass);
  robot_.links[static_cast<std::size_t>(body)].mass = mass;
  robot_.links[static_cast<std::size_t>(body)].has_inertial = mass.mass > 0.0;
  robot_.links[static_cast<std::size_t>(body)].carried = xml.number(e, "gravcomp").value_or(0.0);
  // Without springs and dampers MuJoCo leaves all passive forces out.
  if (!file_.flags.springs && !file_.flags.dampers)
    robot_.links[static_cast<std::size_t>(body)].carried = 0.0;
}

void MjcfBodies::read_joint(const MjcfTag& tag, RobotJoint& joint) {
  file_.ignored.attributes(tag.e, {"group", "user", "solreflimit", "solimplimit", "solreffriction",
                                   "solimpfriction", "margin", "actuatorgravcomp", "align"});
  if (std::string_view(tag.e.Name()) == "freejoint") {
    joint.type = "floating";
    return;
  }
  const std::string type = tag.text("type", "hinge");
  static const std::map<std::string, std::string> types{
      {"hinge", "revolute"}, {"slide", "prismatic"}, {"ball", "spherical"}, {"free", "floating"}};
  const auto found = types.find(type);
  if (found == types.end()) {
    file_.xml.fault(tag.e,
                    format("the joint {} has the unknown type {}", quote(joint.name), quote(type)),
                    "Types: hinge, slide, ball, free.");
    return;
  }
  joint.type = found->second;
  if (const auto tuned = tag.numbers("springdamper", 2, 2);
      tuned.size() == 2 && tuned[0] > 0.0 && tuned[1] > 0.0) {
    if (joint.is_single())
      tuned_.push_back({&tag.e, robot_.joints.size(), tuned[0], tuned[1]});
    else
      refusals_.add(
          tag.e,
          format("the joint {} has a 'springdamper', but is no hinge or slide", quote(joint.name)),
          "Add a bushing, whose moment is the same at small angles.");
  }
  const auto effort = [&](const char* attribute, std::array<double, 2>* law = nullptr) {
    const std::vector<double> list = tag.numbers(attribute, 1, 8);
    for (std::size_t k = 1; k < list.size(); ++k)
      if (law != nullptr && k < 3 && joint.is_single())
        (*law)[k - 1] = list[k];
      else if (list[k] != 0.0)
        refusals_.add(tag.e, format("'{}' of {} is a polynomial", attribute, quote(joint.name)),
                      "Give one number.");
    if (list.empty()) return 0.0;
    if (list[0] < 0.0)
      file_.xml.fault(tag.e, format("'{}' of {} is {}", attribute, quote(joint.name), list[0]),
                      "Give a value that is not negative.");
    return list[0];
  };
  if (file_.flags.dampers) joint.damping = effort("damping", &joint.damper_law);
  if (file_.flags.springs) joint.stiffness = effort("stiffness", &joint.spring_law);
  file_.ignored.attributes(tag.e, {"damping", "stiffness"});
  if (tag.has("springyield"))
    refusals_.add(tag.e, format("the spring of {} yields", quote(joint.name)),
                  "Leave 'springyield' out.");
  joint.friction = effort("frictionloss");
  joint.armature = effort("armature");
  if (joint.type == "floating") {
    if (joint.stiffness != 0.0 || (joint.friction != 0.0 && options_.friction))
      refusals_.add(tag.e,
                    format("the free joint {} has a stiffness or friction", quote(joint.name)),
                    "Leave it out, or use a <freejoint>, which has none.");
    return;
  }
  const Pose at{tag.vector("pos", Vec3::Zero()), Mat3::Identity()};
  joint.origin = joint.origin * at;
  joint.on_child = at;
  if (joint.type == "spherical") {
    read_ball(tag, joint);
    return;
  }
  const Vec3 axis = tag.vector("axis", Vec3::UnitZ());
  if (axis.norm() > 0.0)
    joint.axis = axis.normalized();
  else
    file_.xml.fault(tag.e, format("the axis of {} has no length", quote(joint.name)),
                    "Give a direction, such as axis=\"0 0 1\".");
  const auto coordinate = [&](const char* attribute) {
    const double value = tag.number(attribute, 0.0);
    return joint.turns() ? file_.angle(value) : value;
  };
  if (const auto range = tag.numbers("actuatorfrcrange", 2, 2);
      !range.empty() && range[0] < range[1] &&
      tag.boolean("actuatorfrclimited", file_.compiler.auto_limits)) {
    joint.least_effort = range[0];
    joint.most_effort = range[1];
  }
  joint.zero = coordinate("ref");
  joint.rest = joint.law_rest = coordinate("springref");
  read_limits(tag, joint);
}

void MjcfBodies::read_limits(const MjcfTag& tag, RobotJoint& joint) {
  const std::vector<double> range = tag.numbers("range", 2, 2);
  const bool limited = tag.boolean("limited", file_.compiler.auto_limits && !range.empty());
  if (!limited || range.empty()) return;
  const double low = joint.turns() ? file_.angle(range[0]) : range[0];
  const double high = joint.turns() ? file_.angle(range[1]) : range[1];
  if (low < high) {
    joint.lower = low;
    joint.upper = high;
  } else if (low != 0.0 || high != 0.0 || tag.has("limited")) {  // "0 0" is no range.
    file_.xml.fault(tag.e,
                    format("the joint {} has the limits {} to {}", quote(joint.name), low, high),
                    "Give a lower limit below the upper one.");
  }
}

void MjcfBodies::read_ball(const MjcfTag& tag, RobotJoint& joint) {
  const auto refuse = [&](bool is, const char* what,
                          const char* hint = "Use hinges one after the other.") {
    if (is) refusals_.add(tag.e, format("the ball joint {} has {}", quote(joint.name), what), hint);
  };
  refuse(joint.stiffness != 0.0, "a stiffness",
         "Add a bushing, whose moment is the same at small angles.");
  refuse(joint.armature != 0.0, "an armature");
  refuse(joint.friction != 0.0 && options_.friction, "a friction loss");
  refuse(options_.limits && !tag.numbers("range", 2, 2).empty() &&
             tag.boolean("limited", file_.compiler.auto_limits),
         "a limit");
  joint.stiffness = joint.armature = joint.friction = 0.0;
}

const RobotJoint* single_joint(XmlFile& xml, const Robot& robot, const XmlFile::Element& at,
                               const std::string& name) {
  std::vector<std::string> names;
  for (const RobotJoint& joint : robot.joints) {
    names.push_back(joint.name);
    if (joint.name != name) continue;
    if (joint.is_single()) return &joint;
    xml.fault(at, format("{} does not have one coordinate", quote(name)), "Name a hinge or slide.");
    return nullptr;
  }
  xml.fault(at, format("there is no joint {}", quote(name)),
            did_you_mean(name, names) + "Joints: " + name_list(names, 12) + ".");
  return nullptr;
}

}  // namespace polhode::io
