// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_keyframe.hpp>

#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Most numbers of a list.
constexpr std::size_t kMostNumbers = 1'000'000;

/// Numbers of a joint in a list of positions and in one of velocities.
struct Freedoms {
  std::size_t positions, velocities;
};

Freedoms freedoms_of(const RobotJoint& joint) {
  if (joint.type == "floating") return {7, 6};
  if (joint.type == "spherical") return {4, 3};
  return joint.is_single() ? Freedoms{1, 1} : Freedoms{0, 0};
}

class KeyframeReader {
 public:
  KeyframeReader(MjcfFile& file, const Element& key, const std::vector<std::size_t>& mocaps,
                 Robot& robot)
      : xml_(file.xml), key_(key), mocaps_(mocaps), robot_(robot) {
    for (const RobotJoint& joint : robot.joints) {
      whole_.positions += freedoms_of(joint).positions;
      whole_.velocities += freedoms_of(joint).velocities;
    }
  }

  MjcfControls read(const std::vector<bool>& active) {
    const std::vector<double> q = list("qpos", "positions", whole_.positions);
    const std::vector<double> v = list("qvel", "velocities", whole_.velocities);
    std::size_t at_q = 0, at_v = 0;
    for (RobotJoint& joint : robot_.joints) {
      const Freedoms own = freedoms_of(joint);
      if (!q.empty() && own.positions > 0) place(joint, &q[at_q]);
      if (!v.empty()) joint.rate.assign(&v[at_v], &v[at_v] + own.velocities);
      at_q += own.positions;
      at_v += own.velocities;
    }
    place_mocaps();
    MjcfControls controls;
    controls.controls = list("ctrl", "controls", active.size());
    const auto count = static_cast<std::size_t>(std::count(active.begin(), active.end(), true));
    const std::vector<double> given = list("act", "activations", count);
    std::size_t next = 0;
    for (const bool is : active)
      controls.activations.push_back(is && next < given.size() ? given[next++] : 0.0);
    return controls;
  }

 private:
  /// A list with a number for each freedom; empty if it is missing, or after an error.
  std::vector<double> list(const char* attribute, const char* what, std::size_t count) {
    const auto given = xml_.numbers(key_, attribute, 0, kMostNumbers);
    if (!given || given->empty()) return {};
    if (given->size() == count) return *given;
    xml_.fault(
        key_,
        format("'{}' of <key> has {} numbers, but the model {} {}", attribute, given->size(), count,
               what),
        "Give one for each, in the order of the joints, actuators or mocap bodies in the file.");
    return {};
  }

  /// Puts the bodies that a program moves in MuJoCo where the keyframe has them.
  void place_mocaps() {
    const std::vector<double> p = list("mpos", "numbers of mocap bodies", 3 * mocaps_.size());
    const std::vector<double> q = list("mquat", "numbers of mocap bodies", 4 * mocaps_.size());
    for (std::size_t k = 0; k < mocaps_.size(); ++k) {
      Pose& pose = robot_.joints[mocaps_[k]].origin;
      if (!p.empty()) pose.p = Eigen::Map<const Vec3>(&p[3 * k]);
      if (q.empty()) continue;
      const Quat turn(q[4 * k], q[4 * k + 1], q[4 * k + 2], q[4 * k + 3]);
      if (turn.norm() > 0.0)
        pose.R = turn.normalized().toRotationMatrix();
      else
        xml_.fault(key_, "'mquat' of <key> has a quaternion of length 0",
                   "Give four numbers that are not all zero.");
    }
  }

  void place(RobotJoint& joint, const double* q) {
    if (joint.is_single()) {
      joint.start = q[0];
      return;
    }
    const bool free = joint.type == "floating";
    if (free) q += 3;
    const Quat turn(q[0], q[1], q[2], q[3]);
    if (!(turn.norm() > 0.0)) {
      xml_.fault(
          key_,
          format("the rotation of {} in 'qpos' is a quaternion of length 0", quote(joint.name)),
          "Give four numbers that are not all zero.");
      return;
    }
    joint.start_motion.R = turn.normalized().toRotationMatrix();
    if (!free) return;
    joint.start_motion.p = Vec3(q[-3], q[-2], q[-1]);
    joint.start_motion = joint.origin.inverse() * joint.start_motion;
  }

  XmlFile& xml_;
  const Element& key_;
  const std::vector<std::size_t>& mocaps_;  ///< Their joints.
  Robot& robot_;
  Freedoms whole_{0, 0};
};

}  // namespace

MjcfControls read_keyframe(MjcfFile& file, const ImportOptions& options,
                           const std::vector<bool>& active, const std::vector<std::size_t>& mocaps,
                           Robot& robot) {
  std::vector<const Element*> keys;
  for (const Element* section : file.sections("keyframe"))
    for (const Element* key : file.xml.children(*section, "key")) keys.push_back(key);
  const Element* chosen = nullptr;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const std::string name = file.xml.text(*keys[k], "name").value_or(format("{}", k));
    names.push_back(name);
    file.ignored.attributes(*keys[k], {"time"});
    if (options.keyframe.empty() ? k == 0 : name == options.keyframe && chosen == nullptr)
      chosen = keys[k];
  }
  const bool wanted = !options.keyframe.empty() && options.keyframe != "none";
  if (wanted && chosen == nullptr)
    file.xml.fault(file.xml.root(), format("there is no keyframe {}", quote(options.keyframe)),
                   names.empty() ? "The file has none."
                                 : did_you_mean(options.keyframe, names) +
                                       "Keyframes: " + name_list(names, 12) + ", none.");
  MjcfControls controls;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (keys[k] != chosen) {
      file.xml.skip(*keys[k]);
      file.ignored.add(*keys[k], "a <key> other than that of the start", "is not read");
      continue;
    }
    controls = KeyframeReader(file, *chosen, mocaps, robot).read(active);
    file.notes.push_back({ImportNote::Kind::approximated, file.xml.place(*chosen),
                          format("the model starts at the keyframe {}; MuJoCo starts at its "
                                 "reference configuration by default",
                                 quote(names[k]))});
  }
  return controls;
}

}  // namespace polhode::io
