// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <polhode/statics/static_newton.hpp>

namespace polhode {

/// A load at which the stability of the equilibrium changes: a limit point or a branch.
struct LimitPoint {
  double load_factor = 0.0;
  int unstable = -1;    ///< Directions in which equilibria beyond it are unstable; −1: not known.
  std::string motion;   ///< That meets no stiffness there, in words.
  bool jump = false;    ///< The equilibrium ends there: those beyond lie on another branch.
  double distance = 0;  ///< How far that is: lengths of the model, or rad [-].
};

/// How a static analysis went.
struct StaticReport {
  bool converged = false;              ///< The full load is carried.
  double load_factor = 0.0;            ///< Reached, in [0, 1].
  std::vector<StaticStep> steps;       ///< All that were tried, in order.
  int iterations = 0;                  ///< Of them all.
  double residual = 0.0, force = 0.0;  ///< Largest unbalanced and largest force at the end [N].
  int unstable = -1;  ///< Directions in which the equilibrium is unstable; −1: not known.
  std::vector<std::string> free_motions;  ///< That nothing in the model resists.
  std::vector<LimitPoint> limit_points;   ///< That were passed, by load factor.
  std::vector<std::string> slack;         ///< Cables that carry nothing at the end.
  int relaxations = 0;  ///< Equilibria that relaxation has found where Newton's method has not.
  std::string message;  ///< If not converged: what happened, where, what to try.
};

/// Finds equilibria under growing loads: gravity, loads and prescribed displacements times a load
/// factor from 0 to 1. The first increment is the whole load; increments grow and shrink with the
/// iterations they take.
class LoadStepper {
 public:
  explicit LoadStepper(const System& system, const StaticOptions& options = {});
  ~LoadStepper();

  /// Starts the analysis at a state whose velocities do not count: they become zero.
  void begin(State& state);
  /// The next load step, not beyond `limit`. On failure the state is that of the last equilibrium.
  /// @returns true if an equilibrium at a higher load factor was reached.
  bool advance(State& state, double limit = 1.0);
  [[nodiscard]] const StaticReport& report() const;
  /// Stored in springs, beams and solids [J]: all potentials but those of gravity and loads.
  [[nodiscard]] double strain_energy(const State& state) const;
  /// Tangent and residual at the last equilibrium.
  [[nodiscard]] StaticNewton& newton();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The equilibrium under the full load; `observe` is called at every equilibrium on the way. On
/// failure the state is that of the last equilibrium found.
StaticReport solve_statics(const System& system, State& state, const StaticOptions& options = {},
                           const std::function<void(const State&)>& observe = {});

}  // namespace polhode
