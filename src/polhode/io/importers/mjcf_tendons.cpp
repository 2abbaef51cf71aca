// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_tendons.hpp>

#include <limits>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/geometry/wrapping.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

}  // namespace

void MjcfTendons::read() {
  // Before springs of tendons change those of joints.
  relaxed_ = relaxed();
  for (const RobotJoint& joint : robot_.joints) rests_[joint.name] = joint.rest;
  for (const Element* section : file_.sections("tendon"))
    for (const Element* e = section->FirstChildElement(); e != nullptr;
         e = e->NextSiblingElement()) {
      static_cast<void>(file_.xml.children(*section, e->Name()));
      const MjcfTag tag{file_, *e, {"tendon"}, ""};
      const std::string name = tag.text("name", "");
      const std::string_view kind = e->Name();
      file_.ignored.attributes(*e, {"group", "width", "material", "rgba", "user", "solreflimit",
                                    "solimplimit", "solreffriction", "solimpfriction", "margin",
                                    "actuatorfrcrange", "actuatorfrclimited"});
      const bool limited = options_.limits && !tag.numbers("range", 2, 2).empty() &&
                           tag.boolean("limited", file_.compiler.auto_limits);
      const bool rubs = options_.friction && tag.number("frictionloss", 0.0) != 0.0;
      if (limited || rubs)
        refusals_.add(*e, format("the tendon {} has limits or friction", quote(name)),
                      "Import without limits and friction.");
      if (tag.number("armature", 0.0) != 0.0)
        refusals_.add(*e, format("the tendon {} has an armature", quote(name)), "Leave it out.");
      if (kind == "fixed")
        read_sum(tag, name);
      else if (kind == "spatial")
        read_spatial(tag, name);
      file_.xml.skip(*e);
    }
}

RobotCable* MjcfTendons::spatial(const std::string& name) {
  const auto found = spatial_.find(name);
  return found == spatial_.end() ? nullptr : &robot_.cables[found->second];
}

void MjcfTendons::finish() {
  std::vector<RobotCable> kept;
  for (RobotCable& cable : robot_.cables)
    if (cable.stiffness != 0.0 || cable.damping != 0.0 || cable.tension)
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
  const std::vector<double> given = tag.numbers("springlength", 1, 2);
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
  const double k = effort_of(tag, refusals_, "stiffness", name);
  const double d = effort_of(tag, refusals_, "damping", name);
  if (k == 0.0 && d == 0.0) return;
  if (sum.size() != 1 || sum[0].second == 0.0) {
    refusals_.add(tag.e,
                  format("the fixed tendon {} of {} joints has a stiffness or damping", quote(name),
                         sum.size()),
                  "Give each joint a spring or damper, or one of them a coupling.");
    return;
  }
  const Rest rest = rest_of(tag, at_rest);
  if (k != 0.0 && rest.lower != rest.upper) {
    refusals_.add(tag.e, format("the fixed tendon {} is without force over a range", quote(name)),
                  "Give one length.");
    return;
  }
  // The spring of the joint and this one act along the same coordinate.
  const double factor = sum[0].second, own = k * factor * factor;
  for (RobotJoint& joint : robot_.joints) {
    if (joint.name != sum[0].first) continue;
    joint.damping += d * factor * factor;
    if (own == 0.0) continue;
    joint.rest =
        (joint.stiffness * joint.rest + own * rest.lower / factor) / (joint.stiffness + own);
    joint.stiffness += own;
  }
}

void MjcfTendons::read_spatial(const MjcfTag& tag, const std::string& name) {
  RobotCable cable;
  cable.at = &tag.e;
  cable.name = name.empty() ? format("tendon_{}", robot_.cables.size() + 1) : name;
  cable.stiffness = effort_of(tag, refusals_, "stiffness", cable.name);
  cable.damping = effort_of(tag, refusals_, "damping", cable.name);
  if (!read_path(tag.e, cable)) return;
  if (cable.stiffness != 0.0) {
    const Rest rest = rest_of(tag, length_at_rest(cable));
    cable.shortest = rest.lower;
    cable.longest = rest.upper;
    const bool plain = cable.through.size() == 2 && cable.around.empty();
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
