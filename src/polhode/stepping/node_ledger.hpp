// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/equations/node_system.hpp>
#include <polhode/kernels/tree_data.hpp>

namespace polhode {

/// Contribution of nodes to the balance of energy and momenta: their Newmark velocities with the
/// consistent mass, strain energy, and input of ground, prescribed motion and loads.
class NodeLedger {
 public:
  explicit NodeLedger(const System& system);

  /// Adds the nodes' energies and momenta at a state.
  void add_sums(const State& state, BodySums& sums) const;
  /// Potential energy of the elements at a state [J].
  [[nodiscard]] double stored(const State& state) const;
  /// Adds work and dissipation of the step just solved to the ledger, and to the external force [N]
  /// and moment about the origin [N m] that of loads, ground and prescribed motion at t_{n+αf}.
  /// @returns the potential energy at t_{n+1} [J].
  double close(Ledger& ledger, const State& state, Trial& trial, Vec3& force, Vec3& moment);

 private:
  void add_lag(Ledger& ledger, const State& state, const Trial& trial, Vec3& moment) const;

  const System* system_;
  NodeSystem nodes_;
  std::vector<int> held_;      ///< Nodes moved by the ground or a prescribed motion.
  std::vector<int> external_;  ///< Groups of external loads.
  std::vector<double> forces_;
};

}  // namespace polhode
