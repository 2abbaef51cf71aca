// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <polhode/equations/node_condensation.hpp>

namespace polhode {

/// Mass and forces of deformable solids on their bodies at an instant: the nodes' equations M a = f
/// + M g with bonded nodes accelerated by their bodies, a_i = P (r̈, α) + ω × (ω × z_i), and the
/// free ones eliminated. @eq{eq:rbm-rigid-point-acceleration}
class NodeInertia {
 public:
  explicit NodeInertia(const System& system);

  [[nodiscard]] const std::vector<linear::KktPair>& pairs() const { return condensation_.pairs(); }
  /// Assembles an instant. @returns false if the solids' mass matrix is singular.
  [[nodiscard]] bool take(const State& state);
  /// Assembles masses only, without forces and rotation: for impulses instead of forces, and jumps
  /// of velocities instead of accelerations.
  /// @param given  Jumps of prescribed components, three per node, zero elsewhere; may be empty.
  [[nodiscard]] bool take_masses(const State& state, std::span<const double> given = {});
  /// Adds the condensed mass and, to `force` by body, the forces of the nodes, all times `scale`.
  void put(double scale, std::vector<Vec6>& force, std::vector<Mat6>& diagonal,
           std::span<linear::KktValues::Pair> pairs);
  /// Sets impulses on free nodes (3 each, zero on others), after take_masses() and put(); their
  /// share on the bodies is added to `force` by body, times `scale`. accelerations() are then the
  /// jumps.
  void press(std::span<const double> impulses, double scale, std::vector<Vec6>& force);
  /// Accelerations of all nodes (3 each) from those of the bodies (6 each).
  [[nodiscard]] const std::vector<double>& accelerations(const double* bodies);
  /// M a − f − M g of all nodes (3 each) for the last accelerations: forces of bodies, ground and
  /// prescribed motion on their nodes, round-off on the free ones [N].
  [[nodiscard]] std::vector<double> reactions() const;

 private:
  [[nodiscard]] bool condense();
  [[nodiscard]] Vec3 M_gamma(int node) const;  ///< Of a node [N].

  const System* system_;
  NodeCondensation condensation_;
  Trial trial_;
  std::vector<double> mass_;      ///< M by 3×3 blocks of the graph.
  std::vector<double> tangent_;   ///< Unused itself.
  std::vector<double> residual_;  ///< M γ − f − M g.
  std::vector<double> gamma_;  ///< ω × (ω × z) of bonded nodes, accelerations of prescribed ones.
  std::vector<double> a_;
};

}  // namespace polhode
