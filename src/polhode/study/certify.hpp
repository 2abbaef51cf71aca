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

/// Columns of a probe that belong together, and what the runs say of them.
struct CertifiedQuantity {
  std::string probe;
  std::vector<std::string> columns;  ///< Names without units: x, y, z.
  std::string unit;
  double scale = 0.0;       ///< Largest size of the quantity [unit].
  double negligible = 0.0;  ///< Part of what is large in this unit that counts as noise [unit].
  RefinedSeries series;     ///< Up to the time that all runs reached.
  ConvergenceReport report;

  [[nodiscard]] std::string name() const;  ///< "tip x y z".
  /// "2.01", "below 0.5" where differences do not fall, "rounding" where there is no more to see.
  [[nodiscard]] std::string order_text() const;
  /// The time at which the bar is as large as the quantity itself and larger than anywhere: about
  /// an impact, whose instant the steps do not resolve. Nothing where it never is.
  [[nodiscard]] std::optional<double> unresolved_at() const;
};

/// Error of a model's results as three runs show it.
struct Certificate {
  std::string title;
  bool automatic = false;      ///< Tolerances were refined, not a step.
  std::vector<double> orders;  ///< That the method may show.
  double duration = 0.0;       ///< [s]
  std::array<CertifiedRun, 3> runs;
  std::vector<CertifiedQuantity> quantities;
  std::vector<std::string> notes;  ///< What was chosen for the model, a sentence each.

  /// Every run came to its end.
  [[nodiscard]] bool finished() const;
  /// Every run came to its end and every quantity converges all the time.
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
/// and a hundredth) and compares all probes at common times; a model without probes is given one
/// of each moving body, up to kMaxOwnProbes.
///
/// Automatic steps end at the common times in all runs. Where these landings rather than the
/// tolerance choose the steps, each run's are made shorter than those of the one before: else all
/// would agree on one wrong answer.
/// @param model  Of type dynamics.
/// @throws InputError if the model is no motion over time, has nothing to compare, or a tolerance
///         that leaves no room below.
[[nodiscard]] Certificate certify(const Model& model, const CertifyHooks& hooks = {});

/// @throws InputError as certify() would before it begins.
void check_certifiable(const Model& model);

/// Probes that a model without any is given.
inline constexpr std::size_t kMaxOwnProbes = 20;

}  // namespace polhode
