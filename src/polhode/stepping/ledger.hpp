// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/equations/newton_system.hpp>
#include <polhode/equations/trial.hpp>
#include <polhode/kernels/dispatch.hpp>
#include <polhode/stepping/balance.hpp>
#include <polhode/stepping/node_ledger.hpp>

namespace polhode {

/// Largest drifts over the largest magnitudes reached, and these at least so large that rounding
/// alone does not read as a drift [-]. @eq{drift-floor}
struct Drifts {
  double energy = 0.0, linear_momentum = 0.0, angular_momentum = 0.0;
};
[[nodiscard]] Drifts drifts(const Ledger& ledger);

/// Keeps the balance of energy and momenta: what loads and ground put in over each step, and how
/// far what the bodies hold is from that.
class EnergyLedger {
 public:
  EnergyLedger(const System& system, const LaneKernels& kernels, const NewtonEngine& engine);

  /// Starts the sums at a state.
  void begin(State& state);
  /// Adds what an accepted step did. Call with the trial converged, before and after the state
  /// moves to t_{n+1}.
  void before_commit(State& state, Trial& trial);
  void after_commit(State& state, const Trial& trial);
  /// What the engine's own forces did over the step, between before_commit() and after_commit().
  void add(State& state, const Work& work);
  /// Velocities have jumped: what they lost, and what stands still took, since `before`.
  void add_jump(State& state, const BodySums& before);
  /// The same where a prescribed motion made them jump: what they gained is its work.
  void add_driven_jump(State& state, const BodySums& before);
  /// Interactions were switched: velocities that jumped lost energy, the rest that they gained is
  /// work of drives; potential energy that is gone is lost, what came is put in. @eq{switch-loss}
  /// @param before     Sums before.
  /// @param lost       By impulses [J].
  /// @param potential  Change of potential energy [J].
  void add_switch(State& state, const BodySums& before, double lost, double potential);
  [[nodiscard]] BodySums sums(const State& state) const;
  /// Stored by interactions, solids and contacts [J].
  [[nodiscard]] double potential(const State& state) const { return stored(state); }
  /// The next call is about another state than the last one.
  void forget() { sums_are_of_state_ = false; }
  /// Compares with the start; at the end of whole steps.
  void close_step(State& state);
  [[nodiscard]] Balance balance(const State& state) const;

 private:
  [[nodiscard]] double stored(const State& state) const;
  /// Work that rows which follow functions of time put in over the step.
  void add_drives(State& state, const Trial& trial) const;
  void add_impulses(State& state, const BodySums& before, const BodySums& after);

  const System* system_;
  const LaneKernels* kernels_;
  const NewtonEngine* engine_;
  std::vector<MassBlock> mass_;
  double total_mass_ = 0.0;
  std::vector<int> working_;  ///< Interactions without rows: they store, dissipate, put in.
  std::vector<int> outside_;  ///< Interactions with one moving body that the engine does not sum.
  InteractionSweep outside_sweep_;
  NodeLedger nodes_;
  std::vector<int> touched_;  ///< Bodies of those.
  struct CoupledMass {
    int slot_a, slot_b;  ///< −1: the ground.
    double mass;
  };
  std::vector<CoupledMass> coupled_;  ///< Kinetic energy that interactions hold.
  std::vector<BodyStep> steps_;
  BodySums at_n_, at_n1_;                              ///< Of the state before and after the step.
  double outside_force_ = 0.0, outside_moment_ = 0.0;  ///< Over the last step [N, N m].
  bool sums_are_of_state_ = false;
  double potential_ = 0.0;  ///< Stored by the interactions at the state.
};

}  // namespace polhode
