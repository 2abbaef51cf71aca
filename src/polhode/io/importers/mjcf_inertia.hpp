// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <polhode/io/importers/robot.hpp>

namespace polhode::io {

/// The mass matrix of a robot's joint velocities in the model's configuration, with armatures, by
/// which MuJoCo's compiler chooses some springs and dampers.
class MjcfInertia {
 public:
  /// Most velocities of joints of which there is a matrix.
  static constexpr int kMost = 1000;

  /// @param robot   Links in the order of the file: link k + 1 is the child of joint k.
  /// @param frames  Frame of each link in the world, by name.
  MjcfInertia(const Robot& robot, const std::map<std::string, Pose>& frames);

  /// Inertia of a joint while all others are free to move, the harmonic mean over its velocities;
  /// zero if the matrix is not positive [kg m², kg].
  [[nodiscard]] double effective(std::size_t joint) const;
  /// Inertia along a sum of coordinates of joints: factors by their numbers.
  [[nodiscard]] double effective(const std::vector<std::pair<std::size_t, double>>& sum) const;
  /// Whether there are few enough joints.
  [[nodiscard]] bool is_there() const { return first_.back() <= kMost; }

 private:
  std::vector<int> first_;    ///< Number of the first velocity of each joint, and of all.
  Eigen::MatrixXd mobility_;  ///< Inverse of the matrix; empty if that is not positive.
};

}  // namespace polhode::io
