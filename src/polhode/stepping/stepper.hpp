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

/// Choice of steps.
struct StepControl {
  int order = 2;               ///< 2, 4, 6 or 8; extrapolated also 10 and 12.
  bool extrapolated = false;   ///< Orders above 2 by extrapolation, not by composition.
  bool varies = false;         ///< Each extrapolated step has an order of its own up to `order`.
  std::optional<double> step;  ///< Fixed step H [s]; absent: automatic.
  double tolerance = 1e-6;     ///< Error of automatic steps [-], see docs/theory/step_control.md.
  double horizon = 1.0;        ///< Duration of the run, over which order 2 spreads its error [s].
  double min_step = 0.0;       ///< 0: 1e-9 of the horizon or 1e-6 of the fixed step [s].
  double max_step = 0.0;       ///< 0: none [s].
  /// Continuous controllers: they set values of loads between steps, from the motion up to there,
  /// and hold them over the first step.
  bool lagged = false;
  NewtonOptions newton;
  bool conserving = true;  ///< Potentials in discrete-gradient form.
  int threads = 1;         ///< For members of extrapolated steps; results have the same bits.
};

/// Advances a state: predictor, Newton, acceptance, step control, compositions and
/// extrapolations of higher order.
class Stepper {
 public:
  /// @param kernels  SIMD kernels for predictor and end of step; the same for every engine.
  Stepper(const System& system, std::unique_ptr<NewtonEngine> engine, const GeneralizedAlpha& ga,
          const StepControl& control, const LaneKernels& kernels);
  ~Stepper();

  /// Starts the ledger; once, at the consistent initial state.
  void begin(State& state);
  /// Takes one accepted step of the chosen order, ending at t_limit at the latest. On failure the
  /// state is unchanged.
  StepReport advance(State& state, double t_limit);
  /// Switches interactions between two steps; the next one starts without past steps.
  SwitchReport switch_over(State& state, std::span<const int> on, std::span<const int> off);
  /// Must be called after forces jumped at the state: restarts as switch_over().
  void forces_jump(State& state);
  /// Must be called before a step from another state than the last one ended at.
  void leave();
  [[nodiscard]] const NewtonEngine& engine() const;
  /// Whether the last step was of the method's order, so that its motion is smooth: not one of
  /// order 2 instead, around a stop or where that needs less work.
  [[nodiscard]] bool took_whole_order() const;
  [[nodiscard]] Balance balance(const State& state) const;
  /// Warnings: goals that automatic steps could not reach.
  [[nodiscard]] std::vector<std::string> warnings() const;
  /// Time spent in phases since construction [s].
  [[nodiscard]] std::vector<std::pair<std::string, double>> phases() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polhode
