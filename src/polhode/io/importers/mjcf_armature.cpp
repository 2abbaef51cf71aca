// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_armature.hpp>

#include <set>
#include <utility>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

void add_free_armatures(MjcfFile& file, Robot& robot) {
  std::set<std::string> taken;
  for (const RobotLink& link : robot.links) taken.insert(link.name);
  const std::size_t count = robot.joints.size();
  for (std::size_t j = 0; j < count; ++j) {
    const RobotJoint& joint = robot.joints[j];
    if (joint.type != "floating" || joint.armature == 0.0) continue;
    const double a = joint.armature;
    RobotLink link;
    link.name = joint.child + "_armature";
    while (!taken.insert(link.name).second) link.name += "_2";
    link.at = joint.at;
    link.has_inertial = true;
    link.name_in_file = false;
    link.carried = 1.0;
    link.mass = {a, Vec3::Zero(), a * Mat3::Identity()};
    file.notes.push_back({ImportNote::Kind::approximated, file.xml.place(*joint.at),
                          format("the armature of {} is a body on it, {}, without weight: {} kg "
                                 "and kg m²",
                                 quote(joint.name), quote(link.name), a)});
    RobotJoint weld;
    weld.name = link.name;
    weld.type = "fixed";
    weld.parent = joint.child;
    weld.child = link.name;
    weld.at = joint.at;
    robot.links.push_back(std::move(link));
    robot.joints.push_back(std::move(weld));
  }
}

}  // namespace polhode::io
