// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <polhode/simulation/simulation_details.hpp>
#include <polhode/study/grid_convergence.hpp>

namespace polhode {

/// One of the three runs of a certificate.
struct CertifiedRun {
  double setting = 0.0;    ///< Step [s], or tolerance [-] of automatic steps.
  double mean_step = 0.0;  ///< Time reached over accepted steps [s].
  RunSummary summary;
};

/// A group of columns of a probe, and the results of the comparison.
struct CertifiedQuantity {
  std::string probe;
  std::vector<std::string> columns;  ///< Names without units: x, y, z.
  std::string unit;
  double scale = 0.0;       ///< Largest size of the quantity [unit].
  double negligible = 0.0;  ///< Part of the scale of this unit that counts as noise [unit].
  RefinedSeries series;     ///< Up to the time reached by all runs.
  ConvergenceReport report;

  [[nodiscard]] std::string name() const;  ///< "tip x y z".
  /// Text of the order: "2.01", "below 0.5" where differences do not decrease, "rounding" where
  /// they are noise.
  [[nodiscard]] std::string order_text() const;
  /// Time at which the error bar is as large as the quantity itself and at its maximum: near an
  /// impact whose time the steps do not resolve. Nothing if there is none.
  [[nodiscard]] std::optional<double> unresolved_at() const;
};

/// Error of a model's results, estimated from three runs.
struct Certificate {
  std::string title;
  bool automatic = false;      ///< Tolerances were refined instead of a step.
  std::vector<double> orders;  ///< Possible orders of the method.
  double duration = 0.0;       ///< [s]
  std::array<CertifiedRun, 3> runs;
  std::vector<CertifiedQuantity> quantities;
  std::vector<std::string> notes;  ///< Choices for the model, a sentence each.

  /// Whether every run was finished.
  [[nodiscard]] bool finished() const;
  /// Whether every run is trusted: runs that agree on a balance that does not close certify
  /// nothing.
  [[nodiscard]] bool trusted() const;
  /// Whether every run was finished and every quantity converges at all times.
  [[nodiscard]] bool converges() const;
};

/// Observers of certify() while it runs.
struct CertifyHooks {
  /// Before each run (0: coarse, 2: fine), at its start.
  std::function<void(int run, Simulation&)> begin{};
  std::function<void(int run, Simulation&)> frame{};  ///< At output times.
  std::function<void(int run, Simulation&)> step{};   ///< After every step.
  std::function<void(int run, Simulation&)> end{};    ///< After each run, at its last state.
  const std::atomic<bool>* stop = nullptr;            ///< Ends the study when it becomes true.
};

/// Runs a model with its step, half and a quarter of it (automatic steps: its tolerance, a tenth
/// and a hundredth) and compares all probes at common times; a model without probes gets one for
/// each moving body, up to kMaxOwnProbes.
///
/// Automatic steps end at the common times in all runs. Where these times rather than the tolerance
/// determine the steps, each run's are shortened relative to the previous one: otherwise all runs
/// could agree on one wrong result.
/// @param model  Of type dynamics.
/// @throws InputError if the model is no motion over time, has nothing to compare, or its tolerance
/// is too small to be refined.
[[nodiscard]] Certificate certify(const Model& model, const CertifyHooks& hooks = {});

/// Checks a model. @throws InputError as certify() would at its start.
void check_certifiable(const Model& model);

/// Largest number of probes added to a model without any.
inline constexpr std::size_t kMaxOwnProbes = 20;

}  // namespace polhode
