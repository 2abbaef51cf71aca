// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/equations/node_motion.hpp>
#include <polhode/system/changing_sparsity.hpp>

namespace polhode {

/// Residual and tangent of the nodes of deformable solids, as if no body carried any of them:
///
///   F = M a_{n+αm} − f_{n+αf} − M g      by node, [N]
///
/// What bodies and ground do to the nodes they carry is put in by who eliminates them, see
/// NodeCondensation. @eq{eq:ga-residual-vector}
class NodeSystem {
 public:
  explicit NodeSystem(const System& system);

  /// Statics: neither inertia nor velocities. Set before assembling.
  void set_static(bool yes, bool mixed_point = false) { static_ = yes, mixed_point_ = mixed_point; }
  /// @param tangent  Fills tangent() as well.
  /// @param turns    By piece of the nodes: rotation since the internal unknowns of its elements
  ///                 were last condensed; read if !tangent.
  ElementReport assemble(const State& state, Trial& trial, bool tangent,
                         const std::vector<Mat3>& turns);
  /// Moves the internal unknowns of the elements after the nodes moved by du.
  /// @returns the largest move [m].
  double advance(const double* du, Trial& trial, const std::vector<Mat3>& turns) const;

  [[nodiscard]] const std::vector<double>& residual() const { return residual_; }  ///< 3 a node.
  /// D F / D x_{n+1}: 3×3 blocks of the graph, row by row, then those of moving() [N/m].
  [[nodiscard]] const std::vector<double>& tangent() const { return tangent_; }
  /// Blocks beside the graph, where surfaces of solids may touch; of one place perhaps several.
  [[nodiscard]] const NodeBlocks& moving() const { return moving_; }
  [[nodiscard]] int worst_group() const { return worst_group_; }  ///< Of the last report.
  [[nodiscard]] const System& system() const { return *system_; }

 private:
  void gather_moving(const State& state);
  void add_inertia(const State& state, const Trial& trial, bool tangent);

  const System* system_;
  bool static_ = false, mixed_point_ = false;
  std::vector<double> residual_, tangent_, acceleration_;
  struct MovingGroup {
    int group;
    const ChangingSparsity* pattern;
    std::size_t first;  ///< Its first block of moving_.
  };
  std::vector<MovingGroup> moving_groups_;
  NodeBlocks moving_;
  int worst_group_ = -1;
};

}  // namespace polhode
