// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/equations/newton_engine.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/kernels/dispatch.hpp>
#include <polhode/stepping/balance.hpp>
#include <polhode/stepping/node_ledger.hpp>

namespace polhode {

/// Largest drifts relative to the largest magnitudes, which have a lower bound so that rounding
/// alone is not reported as a drift [-]. @eq{drift-floor}
struct Drifts {
  double energy = 0.0, linear_momentum = 0.0, angular_momentum = 0.0;
};
[[nodiscard]] Drifts drifts(const Ledger& ledger);

/// Balance of energy and momenta: input of loads and ground over each step, and the drift of the
/// bodies' sums from it.
class EnergyLedger {
 public:
  EnergyLedger(const System& system, const LaneKernels& kernels, const NewtonEngine& engine);

  /// Starts the sums at a state.
  void begin(State& state);
  /// Adds an accepted step. Call with the converged trial, before and after the state moves to
  /// t_{n+1}.
  void before_commit(State& state, Trial& trial);
  void after_commit(State& state, const Trial& trial);
  /// Adds the work of the engine's own forces over the step, between before_commit() and
  /// after_commit().
  void add(State& state, const Work& work);
  /// Adds a velocity jump since `before`: the work of drives in it, the loss of energy, and the
  /// impulse on fixed objects. @eq{jump-work}
  void add_jump(State& state, const BodySums& before, double work);
  /// Adds a jump by a prescribed motion: the energy gain is its work.
  void add_driven_jump(State& state, const BodySums& before);
  /// Adds a switch of interactions. Energy lost by impulses is dissipated, a remaining gain is work
  /// of drives; potential energy that disappears is dissipated, new potential energy is input.
  /// @eq{switch-loss}
  /// @param before  Sums before.
  /// @param lost  By impulses [J].
  /// @param potential  Change of potential energy [J].
  void add_switch(State& state, const BodySums& before, double lost, double potential);
  [[nodiscard]] BodySums sums(const State& state) const;
  /// Energy stored by interactions, solids and contacts [J].
  [[nodiscard]] double potential(const State& state) const { return stored(state); }
  /// Must be called if the next call concerns another state than the last one.
  void forget() { sums_are_of_state_ = false; }
  /// Updates the drifts since the start; at the end of whole steps.
  void close_step(State& state);
  [[nodiscard]] Balance balance(const State& state) const;
  /// Energy that the balance from one state to the next misses, as a part of the largest energy
  /// [-]; 0 if it is rounding. @param rounding  Of the works between them, by magnitude of the
  /// momenta [m/s].
  [[nodiscard]] double imbalance(const State& from, const State& to, double rounding) const;

 private:
  [[nodiscard]] double stored(const State& state) const;
  /// Adds the work of rows that follow functions of time over the step.
  void add_drives(State& state, const Trial& trial) const;
  void add_impulses(State& state, const BodySums& before, const BodySums& after);

  const System* system_;
  const LaneKernels* kernels_;
  const NewtonEngine* engine_;
  std::vector<MassBlock> mass_;
  double total_mass_ = 0.0;
  std::vector<int> working_;  ///< Interactions without rows: they store, dissipate, do work.
  /// Interactions with the ground that are not summed by the engine.
  std::vector<int> outside_;
  InteractionSweep outside_sweep_;
  InteractionSweep beside_rows_;  ///< Of joints of the tree.
  NodeLedger nodes_;
  std::vector<int> touched_;  ///< Bodies of those.
  struct CoupledMass {
    int slot_a, slot_b;  ///< −1: the ground.
    double mass;
  };
  std::vector<CoupledMass> coupled_;  ///< Kinetic energy of interactions.
  /// Rows of an interaction, those of forces first, and a body of it.
  struct RowSizes {
    int first_row, forces, moments, slot;
  };
  std::vector<RowSizes> row_sizes_;
  std::vector<BodyStep> steps_;
  BodySums at_n_, at_n1_;                              ///< Of the state before and after the step.
  double outside_force_ = 0.0, outside_moment_ = 0.0;  ///< Sums of magnitudes over the last step.
  bool sums_are_of_state_ = false;
  double potential_ = 0.0;  ///< Stored by the interactions at the state.
};

}  // namespace polhode
