// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <polhode/dynamics/body_motion.hpp>
#include <polhode/joint_space/free_motion.hpp>
#include <polhode/joint_space/joint_space.hpp>

namespace polhode {

/// A joint of the tree, or the free motion of a body that no joint leads to.
struct TreeJoint {
  int joint = -1;                ///< Index into Model::joints; -1: a free body.
  int a = kGround, b = kGround;  ///< Bodies, in the user's order.
  bool from_a = true;            ///< a is the parent, b the child; else the other way round.
  Vec3 Z_a = Vec3::Zero(), Z_b = Vec3::Zero();
  Mat3 R_a = Mat3::Identity(), R_b = Mat3::Identity();
  FreeMotion free;
  int first = 0;  ///< Of its coordinates in those of the tree.

  /// Whether it is the free motion of a point mass, whose orientation does not change.
  [[nodiscard]] bool is_free_point() const { return joint < 0 && free.size() == 3; }
  [[nodiscard]] int child() const { return from_a ? b : a; }
  [[nodiscard]] int parent() const { return from_a ? a : b; }
};

/// Bodies along a spanning tree of joints: placement, motion vectors and sums along it.
class TreeSpace {
 public:
  using Motions = JointSpace::Motions;

  /// @param preferred  Names of coordinates whose joints are in the tree if they can be.
  /// @param released   Names of joints that do not act.
  TreeSpace(const Model& model, std::span<const std::string> preferred,
            std::span<const std::string> released);

  [[nodiscard]] const std::vector<IndependentCoordinate>& coordinates() const { return names_; }
  [[nodiscard]] int size() const { return static_cast<int>(names_.size()); }
  [[nodiscard]] const std::vector<TreeJoint>& joints() const { return joints_; }
  /// Whether a joint of the model is part of the tree.
  [[nodiscard]] bool has(int joint) const { return in_tree_[static_cast<std::size_t>(joint)] != 0; }
  /// The names that coordinates of joints that close loops would have.
  [[nodiscard]] const std::vector<std::string>& closing() const { return closing_; }
  /// Joint of the tree that leads to a body; -1 for a fixed one.
  [[nodiscard]] int joint_to(int body) const { return to_[static_cast<std::size_t>(body)]; }

  /// Coordinates of a position. @param near  As JointSpace::positions().
  [[nodiscard]] Eigen::VectorXd read(const Motions& motions, std::span<const double> near) const;
  /// Places all bodies at rest. @param motions  In: those of fixed bodies.
  void place(const Eigen::VectorXd& q, Motions& motions) const;
  /// Turns derivatives by rates, the columns of G, into those by coordinates.
  void by_coordinates(const Eigen::VectorXd& q, Eigen::MatrixXd& G) const;
  /// Size of a change of coordinates: of angles [rad], of displacements over a length [-].
  [[nodiscard]] double size_of(const Eigen::VectorXd& change, double length) const;

  /// Motions and their vectors at one position.
  struct Sweep {
    std::vector<MotionVector> s;             ///< Of a child relative to its parent, by coordinate.
    std::vector<MotionVector> twist;         ///< By body.
    std::vector<MotionVector> acceleration;  ///< Likewise, at constant rates.
  };
  [[nodiscard]] Sweep sweep(const Motions& motions) const;
  /// Motion vectors, velocities and accelerations at given rates.
  [[nodiscard]] Sweep sweep(const Motions& motions, const Eigen::VectorXd& rates) const;
  /// Sets velocities.
  static void set_velocities(const Sweep& sweep, Motions& motions);

  /// Adds, for each coordinate, the wrenches on the bodies that it moves, (force, moment about the
  /// world's origin) by body: s · Σ w.
  [[nodiscard]] Eigen::VectorXd project(const Sweep& sweep, std::vector<Vec6> wrenches) const;
  /// Rate of one coordinate by the velocities of its bodies. @param sweep  Of these motions.
  [[nodiscard]] double rate(const Motions& motions, const Sweep& sweep, int coordinate) const;
  /// Velocities of a point and of its body by rates (6 × size).
  [[nodiscard]] Eigen::MatrixXd jacobian(const Sweep& sweep, int body, const Vec3& x) const;

 private:
  [[nodiscard]] PlacedFrames frames(const TreeJoint& joint, const Motions& motions) const;
  [[nodiscard]] RelativePose pose(const TreeJoint& joint, const Motions& motions) const;

  std::vector<TreeJoint> joints_;  ///< Parents first.
  std::vector<IndependentCoordinate> names_;
  std::vector<std::string> closing_;
  std::vector<char> in_tree_;
  std::vector<int> to_;
};

}  // namespace polhode
