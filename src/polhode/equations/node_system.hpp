// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/equations/node_motion.hpp>
#include <polhode/system/changing_sparsity.hpp>

namespace polhode {

/// Residual and tangent of the nodes of deformable solids, as if all nodes were free:
///
///   F = M a_{n+αm} − f_{n+αf} − M g      by node, [N]
///
/// Forces of bodies and ground on bonded nodes are added where these are eliminated, see
/// NodeCondensation. @eq{eq:ga-residual-vector}
class NodeSystem {
 public:
  explicit NodeSystem(const System& system);

  /// Selects statics: no inertia and no velocities. Before assembling.
  void set_static(bool yes, bool mixed_point = false) { static_ = yes, mixed_point_ = mixed_point; }
  /// @param tangent  Computes tangent() as well.
  /// @param turns  By connected component of the nodes: rotation since the internal unknowns of its
  /// elements were last condensed; used if !tangent.
  ElementReport assemble(const State& state, Trial& trial, bool tangent,
                         const std::vector<Mat3>& turns);
  /// Updates the internal unknowns of the elements after the nodes moved by du.
  /// @returns the largest change [m].
  double advance(const double* du, Trial& trial, const std::vector<Mat3>& turns) const;

  [[nodiscard]] const std::vector<double>& residual() const { return residual_; }  ///< 3 per node.
  /// D F / D x_{n+1}: 3×3 blocks of the graph, row by row, then those of moving() [N/m].
  [[nodiscard]] const std::vector<double>& tangent() const { return tangent_; }
  /// Blocks outside the graph, where surfaces of solids may be in contact; positions may repeat.
  [[nodiscard]] const NodeBlocks& moving() const { return moving_; }
  [[nodiscard]] int worst_group() const { return worst_group_; }  ///< In the last report.
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
