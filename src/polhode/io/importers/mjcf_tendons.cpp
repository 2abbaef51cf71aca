// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_tendons.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/geometry/wrapping.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Part of the inertia of its joints that the slide of a fixed tendon has; the relative error of
/// the motion is about as large.
constexpr double kNoInertia = 1e-10;

bool is_straight(const RobotCable& cable) {
  return cable.through.size() == 2 && cable.around.empty();
}

}  // namespace

void MjcfTendons::read() {
  // Before springs of tendons change those of joints.
  relaxed_ = relaxed();
  for (const RobotJoint& joint : robot_.joints) rests_[joint.name] = joint.rest;
  for (const Element* section : file_.sections("tendon"))
    for (const Element* e = section->FirstChildElement(); e != nullptr;
         e = e->NextSiblingElement()) {
      file_.xml.mark_read(*e);
      const MjcfTag tag{file_, *e, {"tendon"}, ""};
      const std::string name = tag.text("name", "");
      const std::string_view kind = e->Name();
      file_.ignored.attributes(*e, {"group", "width", "material", "rgba", "user", "solreflimit",
                                    "solimplimit", "solreffriction", "solimpfriction", "margin"});
      if (const auto range = tag.numbers("actuatorfrcrange", 2, 2);
          range.size() == 2 && range[0] < range[1] &&
          tag.boolean("actuatorfrclimited", file_.compiler.auto_limits))
        force_ranges_[name] = range;
      if (tag.has("springyield"))
        refusals_.add(*e, format("the spring of the tendon {} yields", quote(name)),
                      "Leave 'springyield' out.");
      if (kind == "fixed")
        read_sum(tag, name.empty() ? format("tendon_{}", sums_.size() + 1) : name);
      else if (kind == "spatial")
        read_spatial(tag, name);
      file_.skip(*e);
    }
}

RobotCable* MjcfTendons::spatial(const std::string& name) {
  const auto found = spatial_.find(name);
  return found == spatial_.end() ? nullptr : &robot_.cables[found->second];
}

void MjcfTendons::finish() {
  std::vector<RobotCable> kept;
  for (RobotCable& cable : robot_.cables)
    if (cable.stiffness != 0.0 || cable.damping != 0.0 || !cable.tension.empty())
      kept.push_back(std::move(cable));
    else
      file_.ignored.add(*cable.at, "a tendon without stiffness, damping and actuator",
                        "exerts no force");
  robot_.cables = std::move(kept);
  spatial_.clear();
}

namespace {

/// Stiffness or damping of a tendon; a polynomial is refused.
double effort_of(const MjcfTag& tag, MjcfRefusals& refusals, const char* attribute,
                 const std::string& name) {
  const std::vector<double> list = tag.numbers(attribute, 1, 8);
  for (std::size_t k = 1; k < list.size(); ++k)
    if (list[k] != 0.0)
      refusals.add(tag.e, format("'{}' of the tendon {} is a polynomial", attribute, quote(name)),
                   "Give one number.");
  if (list.empty() || list[0] >= 0.0) return list.empty() ? 0.0 : list[0];
  tag.file.xml.fault(tag.e, format("'{}' of the tendon {} is {}", attribute, quote(name), list[0]),
                     "Give a value that is not negative.");
  return 0.0;
}

}  // namespace

MjcfTendons::Rest MjcfTendons::rest_of(const MjcfTag& tag, double length_at_rest) {
  // One number is both lengths, also where a default has two.
  const XmlFile::Element* giver = file_.giver(tag.e, "springlength", tag.kinds, tag.child_class);
  const std::vector<double> given =
      giver == nullptr
          ? std::vector<double>()
          : file_.xml.numbers(*giver, "springlength", 1, 2).value_or(std::vector<double>());
  if (given.empty() || given[0] == -1.0) return {length_at_rest, length_at_rest};
  const Rest rest{given[0], given.size() > 1 ? given[1] : given[0]};
  if (rest.lower <= rest.upper) return rest;
  file_.xml.fault(tag.e, format("'springlength' is from {} to {}", rest.lower, rest.upper),
                  "Give the smaller length first.");
  return {rest.upper, rest.lower};
}

void MjcfTendons::read_sum(const MjcfTag& tag, const std::string& name) {
  auto& sum = sums_[name];
  double at_rest = 0.0;
  for (const Element* e : file_.xml.children(tag.e, "joint")) {
    const std::string joint_name = file_.xml.required_text(*e, "joint");
    const double factor = file_.xml.number(*e, "coef").value_or(0.0);
    const RobotJoint* joint = single_joint(file_.xml, robot_, *e, joint_name);
    if (joint == nullptr) continue;
    sum.emplace_back(joint_name, factor);
    at_rest += factor * rests_.at(joint_name);
  }
  sum_tags_[name] = &tag.e;
  Law law = law_of(tag, name, at_rest);
  const bool gap = law.stiffness != 0.0 && law.rest.lower != law.rest.upper;
  if (law.stiffness == 0.0 && law.damping == 0.0 && law.friction == 0.0 && law.armature == 0.0 &&
      !law.range)
    return;
  std::erase_if(sum, [](const auto& part) { return part.second == 0.0; });
  if (sum.empty()) {
    file_.ignored.add(tag.e, "a fixed tendon without joints", "exerts no force");
    return;
  }
  const bool alone = sum.size() == 1 && !gap;
  const std::string joint_name = alone ? sum[0].first : length_joint(name);
  if (!alone) {
    for (RobotLink& link : robot_.links)
      if (link.name == joint_name) link.mass.mass += law.armature;
    law.armature = 0.0;
  }
  for (RobotJoint& joint : robot_.joints)
    if (joint.name == joint_name) put_law(law, alone ? sum[0].second : 1.0, joint);
}

MjcfTendons::Law MjcfTendons::law_of(const MjcfTag& tag, const std::string& name,
                                     double length_at_rest) {
  Law law;
  if (file_.flags.springs) law.stiffness = effort_of(tag, refusals_, "stiffness", name);
  if (file_.flags.dampers) law.damping = effort_of(tag, refusals_, "damping", name);
  if (options_.friction) law.friction = effort_of(tag, refusals_, "frictionloss", name);
  law.armature = effort_of(tag, refusals_, "armature", name);
  if (const auto more = of_actuators_.find(name); more != of_actuators_.end()) {
    law.damping += more->second.first;
    law.armature += more->second.second;
  }
  if (law.stiffness != 0.0) law.rest = rest_of(tag, length_at_rest);
  law.range = range_of(tag, name);
  return law;
}

std::optional<MjcfTendons::Rest> MjcfTendons::range_of(const MjcfTag& tag,
                                                       const std::string& name) {
  const std::vector<double> range = tag.numbers("range", 2, 2);
  if (!options_.limits || range.empty() || !tag.boolean("limited", file_.compiler.auto_limits))
    return std::nullopt;
  if (range[0] < range[1]) return Rest{range[0], range[1]};
  file_.xml.fault(tag.e,
                  format("the tendon {} has the limits {} to {}", quote(name), range[0], range[1]),
                  "Give a lower limit below the upper one.");
  return std::nullopt;
}

/// Limits of the distance of the two sites of a tendon.
void MjcfTendons::add_link(const RobotCable& cable, const Rest& range) {
  RobotLoop link;
  link.name = cable.name + "_limits";
  link.type = "slack_link";
  link.at = cable.at;
  for (std::size_t k = 0; k < 2; ++k) {
    link.links[k] = cable.through[k].link;
    link.frames[k].p = cable.through[k].p;
  }
  if (range.lower > 0.0) link.lower = range.lower;
  link.upper = range.upper;
  robot_.loops.push_back(std::move(link));
}

void MjcfTendons::put_law(const Law& law, double factor, RobotJoint& joint) const {
  const double squared = factor * factor, own = law.stiffness * squared;
  joint.damping += law.damping * squared;
  joint.friction += law.friction * std::abs(factor);
  joint.armature += law.armature * squared;
  if (law.rest.lower != law.rest.upper) joint.rest_upper = law.rest.upper;
  if (own != 0.0) {
    // The spring of the joint and this one act along the same coordinate.
    joint.rest =
        (joint.stiffness * joint.rest + own * law.rest.lower / factor) / (joint.stiffness + own);
    joint.stiffness += own;
  }
  if (!law.range) return;
  double low = law.range->lower / factor, high = law.range->upper / factor;
  if (factor < 0.0) std::swap(low, high);
  joint.lower = std::max(low, joint.lower.value_or(low));
  joint.upper = std::min(high, joint.upper.value_or(high));
}

const MjcfInertia& MjcfTendons::inertia() {
  if (!inertia_) inertia_.emplace(robot_, bodies_.frames());
  return *inertia_;
}

double MjcfTendons::inertia_of(const std::string& name) {
  const MjcfInertia& inertia = this->inertia();
  if (!inertia.is_there()) return 0.0;
  std::vector<std::pair<std::size_t, double>> sum;
  for (const auto& [joint, factor] : sums_.at(name))
    for (std::size_t j = 0; j < robot_.joints.size(); ++j)
      if (robot_.joints[j].name == joint) sum.emplace_back(j, factor);
  return inertia.effective(sum);
}

const std::string& MjcfTendons::length_joint(const std::string& name) {
  const auto [found, is_new] = length_joints_.try_emplace(name);
  std::string& joint_name = found->second;
  if (!is_new) return joint_name;
  const Element& at = *sum_tags_.at(name);
  std::set<std::string> taken;
  for (const RobotJoint& joint : robot_.joints) taken.insert(joint.name);
  for (const RobotLink& link : robot_.links) taken.insert(link.name);
  joint_name = name + "_length";
  while (taken.contains(joint_name)) joint_name += "_2";
  // Mass that moves with the tendon besides its joints: almost none, across gravity.
  double mass = inertia_of(name);
  if (!(mass > 0.0))
    for (const RobotLink& link : robot_.links) mass += link.mass.mass;
  RobotLink link;
  link.name = joint_name;
  link.at = &at;
  link.has_inertial = true;
  link.name_in_file = false;
  link.mass = {kNoInertia * mass, Vec3::Zero(), kNoInertia * mass * Mat3::Identity()};
  RobotJoint joint;
  joint.name = joint_name;
  joint.type = "prismatic";
  joint.parent = robot_.links.front().name;
  joint.child = joint_name;
  joint.at = &at;
  joint.axis = axes_along(robot_.gravity.isZero(0.0) ? Vec3(Vec3::UnitZ())
                                                     : Vec3(robot_.gravity.normalized()))
                   .col(0);
  joint.in_loop = true;
  RobotRow row;
  row.name = joint_name + "_sum";
  row.at = &at;
  row.defines_first = true;
  row.joints.push_back(joint_name);
  row.factors.push_back(1.0);
  for (const auto& [part, factor] : sums_.at(name)) {
    if (factor == 0.0) continue;
    row.joints.push_back(part);
    row.factors.push_back(-factor);
  }
  robot_.links.push_back(std::move(link));
  robot_.joints.push_back(std::move(joint));
  robot_.rows.push_back(std::move(row));
  file_.notes.push_back(
      {ImportNote::Kind::approximated, file_.xml.place(at),
       format("the length of the tendon {} is the displacement of {}, which has {} of the inertia "
              "of its joints",
              quote(name), quote(joint_name), kNoInertia)});
  return joint_name;
}

void MjcfTendons::read_spatial(const MjcfTag& tag, const std::string& name) {
  RobotCable cable;
  cable.at = &tag.e;
  cable.name = name.empty() ? format("tendon_{}", robot_.cables.size() + 1) : name;
  if (file_.flags.springs) cable.stiffness = effort_of(tag, refusals_, "stiffness", cable.name);
  if (file_.flags.dampers) cable.damping = effort_of(tag, refusals_, "damping", cable.name);
  double armature = tag.number("armature", 0.0);
  if (const auto more = of_actuators_.find(cable.name); more != of_actuators_.end()) {
    cable.damping += more->second.first;
    armature += more->second.second;
  }
  const auto refuse_property = [&](bool is, const char* what, const char* hint) {
    if (is) refusals_.add(tag.e, format("the tendon {} has {}", quote(cable.name), what), hint);
  };
  refuse_property(options_.friction && tag.number("frictionloss", 0.0) != 0.0, "friction of a line",
                  "Import without friction.");
  refuse_property(armature != 0.0, "an armature", "Leave it out.");
  if (!read_path(tag.e, cable)) return;
  if (const std::optional<Rest> range = range_of(tag, cable.name); range) {
    refuse_property(!is_straight(cable), "limits of a length over several points",
                    "Import without limits.");
    if (is_straight(cable)) add_link(cable, *range);
  }
  if (cable.stiffness != 0.0) {
    const Rest rest = rest_of(tag, length_at_rest(cable));
    cable.shortest = rest.lower;
    cable.longest = rest.upper;
    const bool plain = is_straight(cable);
    const auto refuse = [&](const std::string& what, const char* hint) {
      refusals_.add(tag.e, format("the tendon {} {}", quote(cable.name), what), hint);
      cable.stiffness = 0.0;
    };
    if (!plain && rest.lower != rest.upper && rest.lower > 0.0)
      refuse(format("pushes where it is shorter than {}", rest.lower),
             "Let 'springlength' begin at 0.");
    else if (!plain && !(rest.upper > 0.0))
      refuse("has no free length", "Give a 'springlength' above 0.");
    else if (rest.upper < 0.0)
      refuse(format("has the free length {}", rest.upper), "Give one that is not negative.");
    else if (!plain && rest.lower != rest.upper && cable.damping != 0.0)
      file_.notes.push_back(
          {ImportNote::Kind::approximated, file_.xml.place(tag.e),
           format("the tendon {} is damped only while it pulls", quote(cable.name))});
  }
  spatial_[cable.name] = robot_.cables.size();
  robot_.cables.push_back(std::move(cable));
}

bool MjcfTendons::read_path(const Element& e, RobotCable& cable) {
  const auto refuse = [&](const Element& at, const std::string& what, const char* hint) {
    refusals_.add(at, format("the tendon {} {}", quote(cable.name), what), hint);
    return false;
  };
  bool geom = false;
  for (const Element* part = e.FirstChildElement(); part != nullptr;
       part = part->NextSiblingElement()) {
    const std::string_view kind = part->Name();
    if (kind == "pulley") return refuse(*part, "has a <pulley>", "Leave it out.");
    if (kind == "site") {
      const std::string site_name = file_.xml.required_text(*part, "site");
      const auto site = bodies_.sites().find(site_name);
      if (site == bodies_.sites().end()) {
        file_.xml.fault(*part, format("there is no site {}", quote(site_name)),
                        "Name a site of a body.");
        return false;
      }
      cable.through.push_back({site->second.link, site->second.frame.p});
      geom = false;
    } else if (kind == "geom") {
      if (geom || cable.through.empty()) {
        file_.xml.fault(*part,
                        format("a geom of the tendon {} has no site before it", quote(cable.name)),
                        "Let a site stand before and after each geom.");
        return false;
      }
      geom = true;
      if (!add_obstacle(*part, cable)) return false;
    }
  }
  if (cable.through.size() >= 2 && !geom) return true;
  file_.xml.fault(
      e, format("the tendon {} has fewer than two sites, or ends on a geom", quote(cable.name)),
      "Let it begin and end at a site.");
  return false;
}

bool MjcfTendons::add_obstacle(const Element& e, RobotCable& cable) {
  const std::string name = file_.xml.required_text(e, "geom");
  const auto geom = bodies_.wraps().find(name);
  if (geom == bodies_.wraps().end()) {
    file_.xml.fault(e, format("there is no sphere or cylinder {}", quote(name)),
                    "Name a geom of one of these types.");
    return false;
  }
  const MjcfBodies::Wrap& wrap = geom->second;
  RobotCable::Obstacle obstacle;
  obstacle.name = name;
  obstacle.type = wrap.sphere ? "sphere" : "cylinder";
  obstacle.at = {wrap.link, wrap.frame.p};
  obstacle.axis = wrap.frame.R.col(2);
  obstacle.radius = wrap.radius;
  obstacle.after = cable.through.size() - 1;
  if (const auto side = file_.xml.text(e, "sidesite")) {
    const auto site = bodies_.sites().find(*side);
    if (site == bodies_.sites().end() || site->second.link != wrap.link) {
      file_.xml.fault(e, format("there is no site {} on the body of {}", quote(*side), quote(name)),
                      "Name a site of that body.");
      return false;
    }
    Vec3 way = site->second.frame.p - wrap.frame.p;
    if (!wrap.sphere) way -= way.dot(obstacle.axis) * obstacle.axis;
    if (way.norm() < wrap.radius) {
      refusals_.add(
          e,
          format("the tendon {} passes through the inside of {}", quote(cable.name), quote(name)),
          "Give a 'sidesite' outside of the geom.");
      return false;
    }
    obstacle.side = way.normalized();
  }
  cable.around.push_back(std::move(obstacle));
  return true;
}

std::map<std::string, Pose> MjcfTendons::relaxed() const {
  std::map<std::string, Pose> frames;
  frames[robot_.links.front().name];
  for (const RobotJoint& joint : robot_.joints) {
    Pose motion;
    const double way = joint.rest - joint.zero;
    if (joint.is_single() && joint.turns())
      motion.R = Eigen::AngleAxisd(way, joint.axis).toRotationMatrix();
    else if (joint.is_single())
      motion.p = way * joint.axis;
    frames[joint.child] =
        frames.at(joint.parent) * joint.origin * motion * joint.on_child.inverse();
  }
  return frames;
}

double MjcfTendons::length_at_rest(const RobotCable& cable) {
  std::vector<Vec3> x;
  for (const RobotPoint& point : cable.through) x.push_back(relaxed_.at(point.link) * point.p);
  double length = 0.0;
  for (std::size_t k = 0; k + 1 < x.size(); ++k) {
    double span = (x[k + 1] - x[k]).norm();
    for (const RobotCable::Obstacle& o : cable.around) {
      if (o.after != k) continue;
      const Pose frame = relaxed_.at(o.at.link);
      const Mat3 axes = rotation_to(o.axis);
      geometry::Roller roller{Vec3::Constant(o.radius)};
      if (o.type == "cylinder") roller.semi_axes.z() = std::numeric_limits<double>::infinity();
      if (o.side) roller.side = Vec3(axes.transpose() * *o.side);
      const auto seen = [&](const Vec3& point) -> Vec3 {
        return axes.transpose() * (frame.inverse() * point - o.at.p);
      };
      const auto way = geometry::wrap(roller, seen(x[k]), seen(x[k + 1]), false);
      if (way) span = way->length;
    }
    length += span;
  }
  return length;
}

}  // namespace polhode::io
