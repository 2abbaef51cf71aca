// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_sensors.hpp>

#include <algorithm>
#include <optional>
#include <string_view>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

namespace {

/// Sensors that a probe of their object records.
struct SensorKind {
  std::string_view tag;
  const char* object;  ///< Attribute that names it.
  RobotProbe::Kind kind;
};
constexpr auto kOfBody = RobotProbe::Kind::body;
constexpr auto kOfJoint = RobotProbe::Kind::joint;
constexpr auto kOfLoad = RobotProbe::Kind::load;
constexpr auto kOfCable = RobotProbe::Kind::cable;
constexpr SensorKind kSensorKinds[] = {
    {"jointpos", "joint", kOfJoint},
    {"jointvel", "joint", kOfJoint},
    {"ballquat", "joint", kOfJoint},
    {"ballangvel", "joint", kOfJoint},
    {"jointactuatorfrc", "joint", kOfJoint},
    {"tendonpos", "tendon", kOfCable},
    {"tendonvel", "tendon", kOfCable},
    {"tendonactuatorfrc", "tendon", kOfCable},
    {"actuatorpos", "actuator", kOfLoad},
    {"actuatorvel", "actuator", kOfLoad},
    {"actuatorfrc", "actuator", kOfLoad},
    {"framepos", "objname", kOfBody},
    {"framequat", "objname", kOfBody},
    {"framexaxis", "objname", kOfBody},
    {"frameyaxis", "objname", kOfBody},
    {"framezaxis", "objname", kOfBody},
    {"framelinvel", "objname", kOfBody},
    {"frameangvel", "objname", kOfBody},
    {"framelinacc", "objname", kOfBody},
    {"frameangacc", "objname", kOfBody},
    {"accelerometer", "site", kOfBody},
    {"velocimeter", "site", kOfBody},
    {"gyro", "site", kOfBody},
    {"force", "site", kOfJoint},
    {"torque", "site", kOfJoint},
};

class SensorReader {
 public:
  SensorReader(MjcfFile& file, const MjcfBodies& bodies, Robot& robot)
      : file_(file), bodies_(bodies), robot_(robot) {}

  void read(const XmlFile::Element& e) {
    const std::string_view tag = e.Name();
    const auto kind = std::find_if(std::begin(kSensorKinds), std::end(kSensorKinds),
                                   [&](const SensorKind& k) { return k.tag == tag; });
    if (kind == std::end(kSensorKinds)) {
      file_.ignored.add(
          e, format("<{}> in <sensor>", tag),
          "is not recorded by a probe: results.h5 has all motions, forces and energies");
      return;
    }
    RobotProbe probe;
    probe.at = &e;
    probe.kind = kind->kind;
    probe.of = file_.xml.required_text(e, kind->object);
    probe.name = file_.xml.text(e, "name").value_or(format("{}_{}", tag, probe.of));
    if (probe.of.empty() || !exists(e, kind->object, probe.of)) return;
    if (probe.kind == kOfBody
            ? !read_body(e, tag, probe)
            : probe.kind == kOfJoint && *kind->object == 's' && !find_joint(e, probe))
      return;
    if (!said_)
      file_.notes.push_back(
          {ImportNote::Kind::approximated, file_.xml.place(e),
           "sensors become probes, which record all of a joint, load, cable or point of a body, "
           "vectors in world axes, without noise and delay"});
    said_ = true;
    robot_.probes.push_back(std::move(probe));
  }

 private:
  /// A frame on a link.
  struct Frame {
    std::string link;
    Pose pose;
  };

  /// Whether there is a joint, tendon or actuator of a name; otherwise an error.
  bool exists(const XmlFile::Element& e, const std::string& object, const std::string& name) {
    std::vector<std::string> names;
    if (object == "joint")
      for (const RobotJoint& joint : robot_.joints) names.push_back(joint.name);
    else if (object == "tendon" || object == "actuator")
      for (const XmlFile::Element* section : file_.sections(object.c_str()))
        for (const XmlFile::Element* one = section->FirstChildElement(); one != nullptr;
             one = one->NextSiblingElement())
          names.push_back(file_.xml.text(*one, "name").value_or(""));
    else
      return true;
    if (std::find(names.begin(), names.end(), name) != names.end()) return true;
    file_.xml.fault(e, format("there is no {} {}", object, quote(name)),
                    did_you_mean(name, names) + format("Name one of the {}s.", object));
    return false;
  }

  /// The joint between a body and its parent, by a site of the body.
  bool find_joint(const XmlFile::Element& e, RobotProbe& probe) {
    const auto site = find_site(e, probe.of);
    if (!site) return false;
    for (const RobotJoint& j : robot_.joints)
      if (j.child == site->link) probe.of = j.name;
    return true;
  }

  std::optional<Frame> find_site(const XmlFile::Element& e, const std::string& name) {
    const auto site = bodies_.sites().find(name);
    if (site != bodies_.sites().end()) return Frame{site->second.link, site->second.frame};
    file_.xml.fault(e, format("there is no site {}", quote(name)), "Name a site of a body.");
    return std::nullopt;
  }

  /// Frame of an object of a type; of a body that of its inertia.
  std::optional<Frame> find_frame(const XmlFile::Element& e, const std::string& type,
                                  const std::string& name) {
    if (type == "site") return find_site(e, name);
    if (type == "body" || type == "xbody") {
      for (const RobotLink& link : robot_.links) {
        if (link.name != name) continue;
        if (type == "xbody") return Frame{name, {}};
        const auto axes = bodies_.axes().find(name);
        return Frame{
            name,
            {link.mass.com, axes == bodies_.axes().end() ? Mat3::Identity().eval() : axes->second}};
      }
      file_.xml.fault(e, format("there is no body {}", quote(name)), "Name a body.");
      return std::nullopt;
    }
    file_.ignored.add(e, format("a sensor of a {}", type),
                      "is not recorded: a probe is on a body or site");
    return std::nullopt;
  }

  void say(const XmlFile::Element& e, std::string what) {
    file_.notes.push_back({ImportNote::Kind::approximated, file_.xml.place(e), std::move(what)});
  }

  /// A rotation as the numbers of its quaternion.
  static std::string turn_text(const Mat3& R) {
    const Quat q = Quat(R).normalized();
    return format("{:.6g} {:.6g} {:.6g} {:.6g}", q.w(), q.x(), q.y(), q.z());
  }

  bool read_body(const XmlFile::Element& e, std::string_view tag, RobotProbe& probe) {
    const bool on_site = !tag.starts_with("frame");
    const std::string type = on_site ? std::string("site") : file_.xml.required_text(e, "objtype");
    const auto frame = find_frame(e, type, probe.of);
    if (!frame) return false;
    probe.point = {frame->link, frame->pose.p};
    if (tag == "framequat")
      probe.rotation = "quaternion";
    else if (tag.ends_with("axis"))
      probe.rotation = "matrix";
    if (!probe.rotation.empty() && !frame->pose.R.isIdentity(0.0))
      say(e, format("the rotation of the sensor {} is that of the body {}; multiply it from the "
                    "right by that of its frame in the body, the quaternion {}",
                    quote(probe.name), quote(frame->link), turn_text(frame->pose.R)));
    if (tag == "framelinacc" && !robot_.gravity.isZero(0.0))
      say(e, format("the acceleration of the sensor {} is that of the point, from which MuJoCo "
                    "subtracts gravity",
                    quote(probe.name)));
    probe.angular = tag == "gyro" || tag.starts_with("frameang");
    const std::string reference = file_.xml.text(e, "refname").value_or("");
    if (reference.empty()) return true;
    const auto seen = find_frame(e, file_.xml.text(e, "reftype").value_or("body"), reference);
    if (!seen) return false;
    probe.seen_from = seen->link;
    if (!seen->pose.is_identity())
      say(e, format("the sensor {} is seen from the body {}, and in MuJoCo from a frame in it at "
                    "{:.6g} {:.6g} {:.6g}, turned by the quaternion {}",
                    quote(probe.name), quote(seen->link), seen->pose.p.x(), seen->pose.p.y(),
                    seen->pose.p.z(), turn_text(seen->pose.R)));
    return true;
  }

  MjcfFile& file_;
  const MjcfBodies& bodies_;
  Robot& robot_;
  bool said_ = false;
};

}  // namespace

void read_sensors(MjcfFile& file, const MjcfBodies& bodies, Robot& robot) {
  SensorReader reader(file, bodies, robot);
  for (const XmlFile::Element* section : file.sections("sensor"))
    for (const XmlFile::Element* e = section->FirstChildElement(); e != nullptr;
         e = e->NextSiblingElement()) {
      file.xml.mark_read(*e);
      reader.read(*e);
      file.skip(*e);
    }
}

}  // namespace polhode::io
