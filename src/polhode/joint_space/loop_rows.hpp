// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/compile/build_system.hpp>
#include <polhode/joint_space/tree_space.hpp>

namespace polhode {

/// Rows between the coordinates of a tree: of joints that close loops, gears, couplings and other
/// loads with rows that no time prescribes.
class LoopRows {
 public:
  /// Rows of a model; joints that a stiffness enforces count as exact.
  /// @param released  Names of joints and loads that do not act.
  LoopRows(const Model& model, const TreeSpace& tree, std::span<const std::string> released);

  [[nodiscard]] int size() const { return rows_; }

  /// Rows at one position, by the coordinates of the tree.
  struct Values {
    Eigen::MatrixXd G;      ///< rows × coordinates, by their rates.
    Eigen::VectorXd g;      ///< Constraint values [m or -].
    Eigen::VectorXd gamma;  ///< G q̈ + γ = 0, with the motion at constant rates in it.
    double scale = 0.0;     ///< Largest term of an entry of G, of those that may cancel.
  };
  /// Counted turns and the like, as of a position.
  struct History {
    std::vector<double> values;
    Eigen::VectorXd g;  ///< Constraint values there that count as zero.
  };

  /// At the model's position.
  [[nodiscard]] const History& first_history() const { return first_history_; }
  /// At a position that is assembled: the values of gears and couplings there are zero, whatever
  /// turns led to it.
  [[nodiscard]] History history_at(const JointSpace::Motions& motions,
                                   const TreeSpace::Sweep& sweep) const;
  /// Rows at a position. @param sweep  Of these motions; with velocities if γ is wanted.
  [[nodiscard]] Values at(const JointSpace::Motions& motions, const TreeSpace::Sweep& sweep,
                          const History& history) const;
  /// Update of the counted turns, to those of a position nearby.
  void follow(const JointSpace::Motions& motions, History& history) const;
  /// The object of a row, for messages: "joint 'C'".
  [[nodiscard]] std::string name_of(int row) const;

 private:
  [[nodiscard]] PairView view(const InteractionRef& ref, const JointSpace::Motions& motions,
                              const History& history) const;

  struct Source {
    int interaction = 0, first_row = 0;
  };
  const TreeSpace& tree_;
  SystemMap map_;
  System system_;                // after the map, which it fills
  std::vector<int> model_body_;  ///< By body of the system.
  std::vector<Source> sources_;
  History first_history_;
  int rows_ = 0;
};

}  // namespace polhode
