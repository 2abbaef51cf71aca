// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/solve/lanes/tree_data.hpp>
#include <polhode/solve/node_system.hpp>

namespace polhode {

/// What moves a bonded or prescribed node exerts on it, over the last step taken.
struct NodeReaction {
  Vec3 force = Vec3::Zero();  ///< Inertia of the node included, at t_{n+αf} [N].
  /// From the body's centre of mass, at t_{n+αf}; from the world's origin if it is no moving
  /// body that holds the node [m].
  Vec3 arm = Vec3::Zero();
};

/// The nodes' part of the balance of energy and momenta: their own Newmark velocities with the
/// consistent mass, strain energy, and what ground, prescribed motion and loads put in.
class NodeLedger {
 public:
  explicit NodeLedger(const System& system);

  /// Adds the nodes' energies and momenta at a state.
  void add_sums(const State& state, BodySums& sums) const;
  /// Potential energy of the elements at a state [J].
  [[nodiscard]] double stored(const State& state) const;
  /// Adds work and dissipation of the step just solved to the ledger, and to the outside force [N]
  /// and moment about the origin [N m] that of loads, ground and prescribed motion at t_{n+αf}.
  /// @returns the potential energy at t_{n+1} [J].
  double close(Ledger& ledger, const State& state, Trial& trial, Vec3& force, Vec3& moment);

  /// From the next step on, works out what bodies exert on the nodes they carry.
  void keep_reactions() { keep_reactions_ = true; }
  /// By node; empty before a step was taken.
  [[nodiscard]] const std::vector<NodeReaction>& reactions() const { return reactions_; }

 private:
  void note_reactions(const State& state, const Trial& trial);

  const System* system_;
  NodeSystem nodes_;
  std::vector<int> held_;      ///< Nodes that the ground or a prescribed motion moves.
  std::vector<int> external_;  ///< Groups that act from outside.
  std::vector<double> forces_;
  bool keep_reactions_ = false;
  std::vector<NodeReaction> reactions_;
};

}  // namespace polhode
