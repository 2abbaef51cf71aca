// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/robot_span.hpp>

#include <numeric>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

namespace polhode::io {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Exchanges parent and child of a joint, whose coordinate remains.
void reverse(RobotJoint& joint) {
  std::swap(joint.parent, joint.child);
  std::swap(joint.origin, joint.on_child);
  if (joint.type == "universal") {
    std::swap(joint.axis, joint.axis2);
    joint.axis2 = -joint.axis2;
  }
  joint.axis = -joint.axis;
}

class Spanner {
 public:
  Spanner(Robot& robot, const std::vector<Pose>& placed) : robot_(robot), placed_(placed) {}

  void span() {
    for (std::size_t i = 0; i < robot_.links.size(); ++i)
      number_.emplace(robot_.links[i].name, static_cast<int>(i));
    for (const RobotJoint& joint : robot_.joints) names_.insert(joint.name);
    close_loops();
    reached_.assign(robot_.links.size(), false);
    depth_.assign(robot_.links.size(), 1);
    depth_[0] = 0;
    joint_above_.assign(robot_.links.size(), 0);
    reach_from(0);
    // Roots that are no child come first, so that few joints are reversed.
    std::vector<bool> is_child(robot_.links.size(), false);
    for (const RobotJoint& joint : robot_.joints)
      if (!joint.closes) is_child[index(number_.at(joint.child))] = true;
    for (const bool children : {false, true})
      for (std::size_t i = 0; i < robot_.links.size(); ++i)
        if (!reached_[i] && (children || !is_child[i])) set_free(static_cast<int>(i));
    mark_loops();
  }

 private:
  int set_of(int link) {
    while (set_[index(link)] != link) link = set_[index(link)] = set_[index(set_[index(link)])];
    return link;
  }

  /// A joint between links that joints before it connect closes a loop.
  void close_loops() {
    set_.resize(robot_.links.size());
    std::iota(set_.begin(), set_.end(), 0);
    joints_of_.resize(robot_.links.size());
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
      RobotJoint& joint = robot_.joints[j];
      const int a = number_.at(joint.parent), b = number_.at(joint.child);
      if (set_of(a) == set_of(b)) {
        joint.closes = true;
        continue;
      }
      set_[index(set_of(b))] = set_of(a);
      joints_of_[index(a)].push_back(j);
      joints_of_[index(b)].push_back(j);
    }
  }

  void reach_from(int root) {
    std::vector<int> next{root};
    reached_[index(root)] = true;
    while (!next.empty()) {
      const int link = next.back();
      next.pop_back();
      for (const std::size_t j : joints_of_[index(link)]) {
        RobotJoint& joint = robot_.joints[j];
        const int a = number_.at(joint.parent), b = number_.at(joint.child);
        const int other = a == link ? b : a;
        if (reached_[index(other)]) continue;
        if (a != link) reverse(joint);
        reached_[index(other)] = true;
        depth_[index(other)] = depth_[index(link)] + 1;
        joint_above_[index(other)] = j;
        next.push_back(other);
      }
    }
  }

  void set_free(int link) {
    RobotJoint joint;
    joint.at = robot_.links[index(link)].at;
    joint.type = "floating";
    joint.parent = robot_.links[0].name;
    joint.child = robot_.links[index(link)].name;
    joint.name = joint.child + "_free";
    joint.origin = placed_[index(link)];
    while (!names_.insert(joint.name).second) joint.name += "_2";
    joint_above_[index(link)] = robot_.joints.size();
    robot_.joints.push_back(std::move(joint));
    reach_from(link);
  }

  /// Marks the joints between the ends of each joint that closes a loop.
  void mark_loops() {
    std::iota(set_.begin(), set_.end(), 0);  // Links that marked joints connect, by the upper one.
    for (RobotJoint& joint : robot_.joints) {
      if (!joint.closes) continue;
      joint.in_loop = true;
      int a = set_of(number_.at(joint.parent)), b = set_of(number_.at(joint.child));
      while (a != b) {
        int& lower = depth_[index(a)] > depth_[index(b)] ? a : b;
        RobotJoint& above = robot_.joints[joint_above_[index(lower)]];
        above.in_loop = true;
        const int upper = set_of(number_.at(above.parent));
        set_[index(lower)] = upper;
        lower = upper;
      }
    }
  }

  Robot& robot_;
  const std::vector<Pose>& placed_;
  std::unordered_map<std::string, int> number_;
  std::vector<int> set_;  ///< Links that joints connect, as a forest.
  std::vector<std::vector<std::size_t>> joints_of_;
  std::vector<bool> reached_;
  std::vector<int> depth_;                ///< Of each link in the tree.
  std::vector<std::size_t> joint_above_;  ///< Of each link but the world.
  std::set<std::string> names_;           ///< Of joints.
};

}  // namespace

void span_tree(Robot& robot, const std::vector<Pose>& placed) { Spanner(robot, placed).span(); }

}  // namespace polhode::io
