// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include <polhode/io/importers/robot.hpp>

namespace polhode::io {

/// The links and joints of a robot as a tree, with its start and the links that form one body.
struct RobotTree {
  int root = -1;
  std::vector<int> order;          ///< Links, parents first.
  std::vector<int> parent_joint;   ///< Of each link; −1: the root.
  std::vector<int> parent, child;  ///< Links of each joint.
  std::unordered_map<std::string, int> link_index, joint_index;
  std::vector<std::vector<double>> start;  ///< Coordinates of each joint [rad, m].
  std::vector<Pose> world;                 ///< Frame of each link at the start.
  /// Velocity of each link's origin and its angular velocity at the start, in world axes; empty if
  /// the file gives none.
  std::vector<Vec3> velocity, spin;
  std::vector<bool> held;      ///< Joints that do not move although their type does.
  std::vector<bool> grounded;  ///< Links that never move.
  std::vector<int> body;       ///< Link whose body each link belongs to; its own: it is one.
  /// Mass properties of each link that is a body, in its axes.
  std::vector<geometry::MassProperties> mass;

  /// Frame of a link in its body's coordinates.
  [[nodiscard]] Pose in_body(int link) const;
};

/// Arranges a robot. Errors go to the file's diagnostics, and then the tree is incomplete.
/// @returns whether there was none.
[[nodiscard]] bool arrange(const Robot& robot, const ImportOptions& options, XmlFile& xml,
                           Diagnostics& diagnostics, std::vector<ImportNote>& notes,
                           RobotTree& tree);

/// Notes of loops that are open where the joints start, by how much.
void note_open_loops(const Robot& robot, const RobotTree& tree, XmlFile& xml,
                     std::vector<ImportNote>& notes);

}  // namespace polhode::io
