// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/robot_tree.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/robot_bodies.hpp>

namespace polhode::io {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Arranger {
 public:
  Arranger(const Robot& robot, const ImportOptions& options, XmlFile& xml, Diagnostics& diagnostics,
           std::vector<ImportNote>& notes, RobotTree& tree)
      : robot_(robot),
        options_(options),
        xml_(xml),
        diagnostics_(diagnostics),
        notes_(notes),
        tree_(tree) {}

  bool arrange() {
    connect();
    if (!diagnostics_.empty()) return false;
    order();
    if (!diagnostics_.empty()) return false;
    start();
    if (!diagnostics_.empty()) return false;
    place();
    form_bodies(robot_, options_, xml_, diagnostics_, notes_, tree_);
    if (diagnostics_.empty()) set_moving();
    return diagnostics_.empty();
  }

 private:
  [[nodiscard]] const RobotLink& link(int i) const {
    return robot_.links[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] const RobotJoint& joint(int j) const {
    return robot_.joints[static_cast<std::size_t>(j)];
  }
  template <class T>
  static auto& at(std::vector<T>& list, int i) {
    return list[static_cast<std::size_t>(i)];
  }

  template <class T>
  static const auto& at(const std::vector<T>& list, int i) {
    return list[static_cast<std::size_t>(i)];
  }
  static std::vector<bool>::reference at(std::vector<bool>& list, int i) {
    return list[static_cast<std::size_t>(i)];
  }

  void connect() {
    for (const RobotLink& l : robot_.links)
      tree_.link_index.emplace(l.name, static_cast<int>(tree_.link_index.size()));
    tree_.parent_joint.assign(robot_.links.size(), -1);
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
      const RobotJoint& joint = robot_.joints[j];
      tree_.joint_index.emplace(joint.name, static_cast<int>(j));
      const int parent = find_link(*joint.at, joint.parent);
      const int child = find_link(*joint.at, joint.child);
      tree_.parent.push_back(parent);
      tree_.child.push_back(child);
      if (parent < 0 || child < 0) continue;
      if (parent == child) {
        xml_.fault(
            *joint.at,
            format("the joint {} connects {} with itself", quote(joint.name), quote(joint.child)),
            "Name two links.");
      } else if (joint.closes) {
        continue;
      } else if (at(tree_.parent_joint, child) >= 0) {
        xml_.fault(
            *joint.at,
            format("the link {} is the child of two joints, {} and {}", quote(joint.child),
                   quote(this->joint(at(tree_.parent_joint, child)).name), quote(joint.name)),
            "Close a loop with <loop_joint>, or with a joint of an overlay.");
      } else {
        at(tree_.parent_joint, child) = static_cast<int>(j);
      }
    }
    tree_.held.assign(robot_.joints.size(), false);
  }

  int find_link(const XmlFile::Element& at, const std::string& name) {
    const auto found = tree_.link_index.find(name);
    if (found != tree_.link_index.end()) return found->second;
    std::vector<std::string> names;
    for (const RobotLink& l : robot_.links) names.push_back(l.name);
    xml_.fault(at, format("there is no link {}", quote(name)),
               did_you_mean(name, names) + "Links: " + name_list(names, 12) + ".");
    return -1;
  }

  /// Finds the root and the links below it, parents first, in the order of the file.
  void order() {
    std::vector<int> roots;
    for (std::size_t i = 0; i < robot_.links.size(); ++i)
      if (tree_.parent_joint[i] < 0) roots.push_back(static_cast<int>(i));
    if (roots.size() > 1) {
      std::vector<std::string> names;
      for (const int i : roots) names.push_back(link(i).name);
      xml_.fault(*link(roots[1]).at,
                 format("{} links have no parent: {}", roots.size(), name_list(names, 8)),
                 "Connect all but one to another link by a joint.");
      return;
    }
    std::vector<std::vector<int>> below(robot_.links.size());
    for (std::size_t j = 0; j < robot_.joints.size(); ++j)
      if (!robot_.joints[j].closes) at(below, tree_.parent[j]).push_back(tree_.child[j]);
    std::vector<int> next = roots;
    while (!next.empty()) {
      const int i = next.back();
      next.pop_back();
      tree_.order.push_back(i);
      next.insert(next.end(), at(below, i).rbegin(), at(below, i).rend());
    }
    if (tree_.order.size() < robot_.links.size()) {
      std::vector<bool> reached(robot_.links.size(), false);
      for (const int i : tree_.order) at(reached, i) = true;
      const auto first = std::find(reached.begin(), reached.end(), false) - reached.begin();
      xml_.fault(
          *link(static_cast<int>(first)).at,
          format("the link {} is its own ancestor", quote(link(static_cast<int>(first)).name)),
          "Joints form a tree; close a loop with <loop_joint>, or with a joint of an overlay.");
      return;
    }
    tree_.root = roots[0];
  }

  /// Coordinates at the start: as asked for, by mimic, or 0, or the limit nearest to it.
  void start() {
    tree_.start.resize(robot_.joints.size());
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
      const RobotJoint& joint = robot_.joints[j];
      const std::size_t count = joint.is_single()          ? 1
                                : joint.type == "planar"   ? 3
                                : joint.type == "floating" ? 6
                                                           : 0;
      tree_.start[j].assign(count, joint.start.value_or(joint.zero));
      const auto given = options_.start.find(joint.name);
      if (given == options_.start.end()) {
        if (count == 1 && options_.limits && !joint.in_loop) clamp(joint, tree_.start[j][0]);
        continue;
      }
      const bool defined_by_others = std::any_of(
          robot_.rows.begin(), robot_.rows.end(),
          [&](const RobotRow& row) { return row.defines_first && row.joints[0] == joint.name; });
      if (defined_by_others)
        fault_start(joint.name, "is the length of a tendon, which follows from its joints",
                    "Give the starts of those.");
      else if (joint.closes)
        fault_start(joint.name, "closes a loop, so that its start follows from other joints",
                    "Give the starts of those.");
      else if (joint.mimic)
        fault_start(joint.name, format("follows another joint by {}", robot_.follows),
                    "Give the start of that one.");
      else if (given->second.size() != count)
        fault_start(joint.name,
                    format("has {} coordinates, but {} are given", count, given->second.size()),
                    "Planar joints have [x, y, angle], floating ones [x, y, z, roll, pitch, yaw].");
      else if (check_units(joint))
        tree_.start[j] = given->second;
      if (count == 1 && options_.limits && !joint.mimic && given->second.size() == 1) {
        const double q = given->second[0];
        if (q < joint.lower.value_or(q) || q > joint.upper.value_or(q))
          fault_start(joint.name,
                      format("would start at {}, outside its limits {} to {}", q,
                             joint.lower.value_or(-kInfinity), joint.upper.value_or(kInfinity)),
                      "Give a start between them.");
      }
    }
    std::vector<std::string> names;
    for (const RobotJoint& j : robot_.joints) names.push_back(j.name);
    for (const auto& [name, values] : options_.start)
      if (!tree_.joint_index.contains(name))
        fault_start(name, "is no joint of the file",
                    did_you_mean(name, names) + "Joints: " + name_list(names, 12) + ".");
    follow();
  }

  /// Whether the coordinates of a joint have no unit, or one of their kind; otherwise an error.
  bool check_units(const RobotJoint& joint) {
    const auto given = options_.start_units.find(joint.name);
    if (given == options_.start_units.end()) return true;
    const std::string kinds = joint.type == "planar"     ? "mmr"
                              : joint.type == "floating" ? "mmmrrr"
                              : joint.turns()            ? "r"
                                                         : "m";
    for (std::size_t k = 0; k < std::min(kinds.size(), given->second.size()); ++k) {
      if (given->second[k] == '-' || given->second[k] == kinds[k]) continue;
      const auto word = [](char kind) { return kind == 'r' ? "an angle" : "a length"; };
      fault_start(joint.name,
                  format("its coordinate {} is {}, and {} is given", k + 1, word(kinds[k]),
                         word(given->second[k])),
                  "Angles have the unit rad or deg, lengths m or mm.");
      return false;
    }
    return true;
  }

  void fault_start(const std::string& name, std::string what, std::string hint) {
    diagnostics_.add({options_.file, 0, 0}, "import.start." + name, std::move(what),
                     std::move(hint));
  }

  void clamp(const RobotJoint& joint, double& q) {
    const double wanted = q;
    q = std::clamp(q, joint.lower.value_or(q), joint.upper.value_or(q));
    if (q != wanted)
      notes_.push_back({ImportNote::Kind::approximated, xml_.place(*joint.at),
                        format("the joint {} starts at its limit {}, as {} is outside",
                               quote(joint.name), q, wanted)});
  }

  /// Starts of joints that follow others; refuses those that follow themselves.
  void follow() {
    std::vector<char> state(robot_.joints.size(), 0);  // 1: on the way, 2: done.
    for (std::size_t first = 0; first < robot_.joints.size(); ++first) {
      std::vector<int> way;
      for (int j = static_cast<int>(first); at(state, j) == 0;) {
        at(state, j) = 1;
        way.push_back(j);
        if (!joint(j).mimic) break;
        const int leader = leader_of(j);
        if (leader < 0) return;
        if (at(state, leader) == 1) {
          xml_.fault(*joint(j).mimic->at,
                     format("the joint {} follows itself by {}", quote(joint(leader).name),
                            robot_.follows),
                     "Let one of the joints move freely.");
          return;
        }
        j = leader;
      }
      for (auto j = way.rbegin(); j != way.rend(); ++j) {
        at(state, *j) = 2;
        if (!joint(*j).mimic) continue;
        const RobotMimic& m = *joint(*j).mimic;
        at(tree_.start, *j)[0] = m.multiplier * at(tree_.start, leader_of(*j))[0] + m.offset;
      }
    }
    for (const RobotRow& row : robot_.rows)
      if (row.defines_first)
        at(tree_.start, tree_.joint_index.at(row.joints[0]))[0] =
            defined(row, row.sum, [&](int j) { return at(tree_.start, j)[0]; });
  }

  /// First coordinate of a row, or its rate, by those of the others.
  template <class Value>
  double defined(const RobotRow& row, double sum, Value&& value_of) const {
    for (std::size_t k = 1; k < row.joints.size(); ++k)
      sum -= row.factors[k] * value_of(tree_.joint_index.at(row.joints[k]));
    return sum / row.factors[0];
  }

  int leader_of(int j) {
    const RobotMimic& m = *joint(j).mimic;
    const auto found = tree_.joint_index.find(m.joint);
    if (found == tree_.joint_index.end()) {
      std::vector<std::string> names;
      for (const RobotJoint& other : robot_.joints) names.push_back(other.name);
      xml_.fault(*m.at, format("there is no joint {}", quote(m.joint)),
                 did_you_mean(m.joint, names) + "Joints: " + name_list(names, 12) + ".");
      return -1;
    }
    if (joint(j).is_single() && joint(found->second).is_single()) return found->second;
    xml_.fault(
        *m.at,
        format("{} and {} do not both have one coordinate", quote(joint(j).name), quote(m.joint)),
        "Only revolute, continuous and prismatic joints can follow each other.");
    return -1;
  }

  /// Frame of the child in that of the parent at the start.
  [[nodiscard]] Pose across(int j) {
    const RobotJoint& joint = this->joint(j);
    const std::vector<double>& q = at(tree_.start, j);
    Pose motion;
    if (joint.type == "spherical" ||
        (joint.type == "floating" && !options_.start.contains(joint.name))) {
      motion = joint.start_motion;
    } else if (joint.turns()) {
      motion.R = Eigen::AngleAxisd(q[0] - joint.zero, joint.axis).toRotationMatrix();
      if (joint.type == "screw")
        motion.p = joint.pitch / (2.0 * std::numbers::pi) * (q[0] - joint.zero) * joint.axis;
    } else if (joint.type == "prismatic") {
      motion.p = (q[0] - joint.zero) * joint.axis;
    } else if (joint.type == "planar") {
      const Mat3 F = axes_along(joint.axis);
      motion.p = F * Vec3(q[0], q[1], 0.0);
      motion.R = Eigen::AngleAxisd(q[2], joint.axis).toRotationMatrix();
    } else if (joint.type == "floating") {
      motion.p = Vec3(q[0], q[1], q[2]);
      motion.R = (Eigen::AngleAxisd(q[5], Vec3::UnitZ()) * Eigen::AngleAxisd(q[4], Vec3::UnitY()) *
                  Eigen::AngleAxisd(q[3], Vec3::UnitX()))
                     .toRotationMatrix();
    }
    const Pose frame = motion.is_identity() ? joint.origin : joint.origin * motion;
    return joint.on_child.is_identity() ? frame : frame * joint.on_child.inverse();
  }

  void place() {
    tree_.world.resize(robot_.links.size());
    for (const int i : tree_.order)
      if (const int j = at(tree_.parent_joint, i); j >= 0)
        at(tree_.world, i) = at(tree_.world, at(tree_.parent, j)) * across(j);
  }

  /// Rate of a joint's coordinate at the start; of one that follows another one as that of it.
  double rate_of(int j) {
    for (const RobotRow& row : robot_.rows)
      if (row.defines_first && row.joints[0] == joint(j).name)
        return defined(row, 0.0, [&](int k) { return rate_of(k); });
    double factor = 1.0;
    for (; joint(j).mimic; j = tree_.joint_index.at(joint(j).mimic->joint))
      factor *= joint(j).mimic->multiplier;
    return joint(j).rate.empty() || at(tree_.held, j) ? 0.0 : factor * joint(j).rate[0];
  }

  /// Adds the velocity of a joint at the start to that with which its child moves with its parent.
  void add_rate(int j, int child) {
    const RobotJoint& joint = this->joint(j);
    const Pose frame = at(tree_.world, child) * joint.on_child;
    Vec3 spin = Vec3::Zero(), slide = Vec3::Zero();
    if (joint.is_single()) {
      const Vec3 way = rate_of(j) * (frame.R * joint.axis);
      if (joint.turns()) spin = way;
      if (joint.type == "prismatic") slide = way;
      if (joint.type == "screw") slide = joint.pitch / (2.0 * std::numbers::pi) * way;
    } else if (!joint.rate.empty()) {
      const Eigen::Map<const Vec3> last(joint.rate.data() + joint.rate.size() - 3);
      spin = at(tree_.world, child).R * last;
      if (joint.type == "floating") slide = Eigen::Map<const Vec3>(joint.rate.data());
    }
    at(tree_.spin, child) += spin;
    at(tree_.velocity, child) += slide + spin.cross(at(tree_.world, child).p - frame.p);
  }

  /// Velocities of all links at the start.
  void set_moving() {
    const auto moves = [](const RobotJoint& joint) {
      return std::any_of(joint.rate.begin(), joint.rate.end(), [](double v) { return v != 0.0; });
    };
    if (std::none_of(robot_.joints.begin(), robot_.joints.end(), moves)) return;
    tree_.velocity.assign(robot_.links.size(), Vec3::Zero());
    tree_.spin.assign(robot_.links.size(), Vec3::Zero());
    for (const int i : tree_.order) {
      const int j = at(tree_.parent_joint, i);
      if (j < 0) continue;
      const int above = at(tree_.parent, j);
      at(tree_.spin, i) = at(tree_.spin, above);
      at(tree_.velocity, i) =
          at(tree_.velocity, above) +
          at(tree_.spin, above).cross(at(tree_.world, i).p - at(tree_.world, above).p);
      if (!at(tree_.held, j)) add_rate(j, i);
    }
  }

  const Robot& robot_;
  const ImportOptions& options_;
  XmlFile& xml_;
  Diagnostics& diagnostics_;
  std::vector<ImportNote>& notes_;
  RobotTree& tree_;
};

}  // namespace

Pose RobotTree::in_body(int link) const {
  const auto own = static_cast<std::size_t>(body[static_cast<std::size_t>(link)]);
  return static_cast<int>(own) == link
             ? Pose{}
             : world[own].inverse() * world[static_cast<std::size_t>(link)];
}

bool arrange(const Robot& robot, const ImportOptions& options, XmlFile& xml,
             Diagnostics& diagnostics, std::vector<ImportNote>& notes, RobotTree& tree) {
  return Arranger(robot, options, xml, diagnostics, notes, tree).arrange();
}

}  // namespace polhode::io
