// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <polhode/newton/newton.hpp>
#include <polhode/stepping/ledger.hpp>
#include <polhode/stepping/step_report.hpp>
#include <polhode/stepping/switching.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// How steps are chosen.
struct StepControl {
  int order = 2;               ///< 2, 4, 6 or 8.
  std::optional<double> step;  ///< Fixed step H [s]; absent: automatic.
  double tolerance = 1e-6;     ///< Error of automatic steps [-], see docs/theory/step_control.md.
  double horizon = 1.0;        ///< Duration of the run, over which order 2 spreads its error [s].
  double min_step = 0.0;       ///< 0: 1e-9 of the horizon or 1e-6 of the fixed step [s].
  double max_step = 0.0;       ///< 0: none [s].
  NewtonOptions newton;
  bool conserving = true;  ///< Potentials in discrete-gradient form.
};

/// Advances a state: predictor, Newton, acceptance, step control, compositions of higher order.
class Stepper {
 public:
  /// @param kernels  Vector kernels for predictor and end of step; the same whatever the engine.
  Stepper(const System& system, std::unique_ptr<NewtonEngine> engine, const GeneralizedAlpha& ga,
          const StepControl& control, const LaneKernels& kernels);
  ~Stepper();

  /// Starts the ledger; once, at the consistent start.
  void begin(State& state);
  /// One accepted step of the chosen order, ending at t_limit at the latest. On failure the state
  /// is left as it was.
  StepReport advance(State& state, double t_limit);
  /// Switches interactions between two steps; the next one starts without a past.
  SwitchReport switch_over(State& state, std::span<const int> on, std::span<const int> off);
  /// What sets forces made them jump at the state: as switch_over().
  void forces_jump(State& state);
  /// The next step starts at another state than the last one ended at.
  void leave();
  [[nodiscard]] const NewtonEngine& engine() const;
  [[nodiscard]] Balance balance(const State& state) const;
  /// Goals that automatic steps could not reach, in plain words.
  [[nodiscard]] std::vector<std::string> warnings() const;
  /// Seconds spent in phases since construction.
  [[nodiscard]] std::vector<std::pair<std::string, double>> phases() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polhode
