// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <polhode/statics/static_newton.hpp>

namespace polhode {

/// Equilibria under increasing loads: gravity, loads and prescribed displacements times a load
/// factor from 0 to 1. The first increment is the whole load; increments are adapted to the number
/// of iterations. Or equilibria along a history, at times from 0 to StaticOptions::history: then
/// the loads at its start grow first, before the time 0.
class LoadStepper {
 public:
  explicit LoadStepper(const System& system, const StaticOptions& options = {});
  ~LoadStepper();

  /// Starts the analysis at a state whose velocities are set to zero. A history starts with the
  /// equilibrium at its start; if there is none, advance() fails.
  void begin(State& state);
  /// Continues after interactions have been switched: the next equilibrium may be far.
  void switched(State& state);
  /// Takes the next load step, not beyond `limit`. On failure the state is that of the last
  /// equilibrium.
  /// @returns true if an equilibrium at a higher load factor was reached.
  bool advance(State& state, double limit = 1.0);
  /// Load factor or time at the end.
  [[nodiscard]] double end() const;
  [[nodiscard]] const StaticReport& report() const;
  /// Strain energy of springs, beams and solids [J]: all potentials but those of gravity and loads.
  [[nodiscard]] double strain_energy(const State& state) const;
  /// Ends a search when this becomes true, without an equilibrium; null: never.
  void set_stop(const std::atomic<bool>* stop);
  /// Tangent and residual at the last equilibrium.
  [[nodiscard]] StaticNewton& newton();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Solves for the equilibrium under the full load; `observe` is called at every equilibrium on the
/// way. On failure the state is that of the last equilibrium found.
StaticReport solve_statics(const System& system, State& state, const StaticOptions& options = {},
                           const std::function<void(const State&)>& observe = {});

}  // namespace polhode
