// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/newton/rank_report.hpp>
#include <polhode/newton/row_check.hpp>
#include <polhode/stepping/contradiction.hpp>
#include <polhode/stepping/instant.hpp>

namespace polhode {

namespace {

/// Relative rounding of rates and of accelerations with the velocities of the state.
constexpr double kRateNoise = 1e-8, kAccelerationNoise = 1e-6;
/// Part of a step in which the curvature of the rows is negligible, and part of the increments of
/// drives above which a contradiction is not curvature.
constexpr double kShortPart = 1e-3, kNotCurvature = 1e-2;
/// Gap of a step that counts, as a part of the tolerance of rows, which earlier steps may have used
/// up nearly.
constexpr double kLeastGap = 1e-3;
/// Relative size of nearly dependent combinations of rows. The distance of a mechanism from its
/// limit position is the square of that.
constexpr double kNearlyDependent[] = {1e-7, 1e-5, 1e-3, 1e-2};

/// Part of the gaps after a step that no motion closes: an iteration that has ended has closed the
/// others.
constexpr double kMostOfGap = 0.5;

constexpr std::size_t kMostNames = 12;

/// Prescribed rates of rows, or their increments over a step divided by its length [1/s].
std::vector<double> rates_of_drives(const System& system, const State& state, double dt) {
  std::vector<double> rates(static_cast<std::size_t>(system.rows()), 0.0);
  for (const int i : system.drives()) {
    const InteractionRef& ref = system.interactions()[i];
    PairView view = system.instant(state, ref, state.lambda.data());
    view.context.dt = dt;
    const PrescribedRows rows =
        system.group(ref.group).prescribed(ref.item, view.step(), TimeSide::kAfter);
    for (int k = 0; k < ref.rows; ++k)
      rates[ref.first_row + k] = dt > 0.0 ? rows.increment[k] / dt : rows.rate[k];
  }
  return rates;
}

/// γ of the rows, with velocities that satisfy them.
std::vector<double> acceleration_terms(const System& system, State state) {
  (void)project_velocities(system, state);
  std::vector<double> gamma(static_cast<std::size_t>(system.rows()), 0.0);
  for (const InteractionRef& ref : system.interactions()) {
    if (ref.rows == 0) continue;
    const PairView view = system.instant(state, ref, state.lambda.data());
    Vec6 of = Vec6::Zero();
    system.group(ref.group).acceleration_terms(ref.item, view.step(), of);
    for (int k = 0; k < ref.rows; ++k) gamma[ref.first_row + k] += of[k];
  }
  return gamma;
}

}  // namespace

std::vector<std::string> contradicting(const System& system, const State& state, double dt) {
  const double least = kLeastGap * RowCheck::kTolerance * system.length_scale();
  const auto found = [&](const Contradiction& c, double noise, double gap_per_part) {
    return c.part > noise * c.of && c.part * gap_per_part > least;
  };
  if (!system.drives().empty()) {
    const Contradiction of_rates =
        find_contradiction(system, state, rates_of_drives(system, state, 0.0));
    if (found(of_rates, kRateNoise, dt)) return of_rates.names;
  }
  const Contradiction of_accelerations =
      find_contradiction(system, state, acceleration_terms(system, state));
  if (found(of_accelerations, kAccelerationNoise, 0.5 * dt * dt)) return of_accelerations.names;
  if (system.drives().empty()) return {};
  const Contradiction in_short =
      find_contradiction(system, state, rates_of_drives(system, state, kShortPart * dt));
  if (!(in_short.part > kNotCurvature * in_short.of)) return {};
  const Contradiction in_step =
      find_contradiction(system, state, rates_of_drives(system, state, dt));
  return found(in_step, kNotCurvature, dt) ? in_step.names : std::vector<std::string>();
}

std::vector<std::string> held_open(const System& system, const State& state,
                                   std::span<const double> gaps) {
  const Contradiction found = find_contradiction(system, state, gaps);
  if (!(found.part > kMostOfGap * found.of)) return {};
  for (const int drive : system.drives())
    if (std::find(found.names.begin(), found.names.end(), interaction_name(system, drive)) !=
        found.names.end())
      return found.names;
  return {};
}

std::vector<std::string> at_limit(const System& system, const State& state) {
  if (system.drives().empty()) return {};
  const std::vector<double> rates = rates_of_drives(system, state, 0.0);
  for (const double tolerance : kNearlyDependent) {
    const Contradiction c = find_contradiction(system, state, rates, tolerance);
    if (c.part > kNotCurvature * c.of) return c.names;
  }
  return {};
}

std::string gap_text(const System& system, const OpenRow& open, double dt) {
  return format("a step of {:.3g} s leaves {} at {}", dt, open.gap_text(),
                interaction_name(system, open.interaction));
}

std::string contradiction_text(double t, const std::vector<std::string>& names,
                               const std::string& gap) {
  if (names.empty()) return {};
  return format(
      "At t = {:.9g} s these cannot all hold: {}; {}. Remove one of them, or change its motion.", t,
      name_list(names, kMostNames), gap);
}

std::string limit_text(const System& system, const State& state, const std::string& gap) {
  const std::vector<std::string> names = at_limit(system, state);
  if (names.empty()) return {};
  return format(
      "At t = {:.9g} s a limit position is reached, beyond which these cannot all hold: {}{}{}. "
      "Shorten the motion of the drive, or change the lengths.",
      state.t, name_list(names, kMostNames), gap.empty() ? "" : "; ", gap);
}

std::string locking_joint(const System& system) {
  for (const InteractionRef& ref : system.interactions()) {
    const InteractionTraits& traits = system.traits(ref);
    if (traits.rows > 0 && (traits.works || traits.unilateral > 0) && !traits.prescribes)
      return format("friction or a stop that locks {} '{}', ", system.group(ref.group).kind(),
                    traits.name);
  }
  return {};
}

}  // namespace polhode
