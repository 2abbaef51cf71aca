// SPDX-License-Identifier: Apache-2.0
// Trials of a step, and estimates of their errors.
#include <polhode/stepping/column_choice.hpp>
#include <polhode/stepping/local_error.hpp>
#include <polhode/stepping/stepper_impl.hpp>

namespace polhode {

/// Runs stages from the state; on failure the state is not restored.
NewtonReport Stepper::Impl::run_stages(State& state, const std::vector<double>& list, double H,
                                       bool fresh) {
  if (extrapolates()) {
    const ExtrapolationTable::Way way{columns(state), give_up_above, fresh, to_break};
    return table->advance(state, list, H, single, control.newton, way);
  }
  NewtonReport report;
  SingleStep::Predictor predictor;
  predictor.degree = list.size() > 1 ? 1 : (automatic() ? 1 : 3);
  predictor.remember = automatic() && (control.order == 2 || by_two) && list.size() == 1;
  int iterations = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (fresh && i == 0) predictor.degree = -1;
    report = single.take(state, list[i] * H, control.newton, predictor);
    if (fresh && i == 0) predictor.degree = list.size() > 1 ? 1 : 3;
    iterations += report.iterations;
    report.iterations = iterations;
    if (!report.converged) return report;
  }
  return report;
}

/// Difference by a companion from the same start; nothing if it does not converge.
std::optional<double> Stepper::Impl::difference_of(const std::vector<double>& list,
                                                   const State& from, const State& reached,
                                                   double H, double of_velocities) {
  companion = from;
  single.ledger().forget();
  const NewtonReport r = run_stages(companion, list, H, true);
  single.ledger().forget();
  companion_iterations += companion.ledger.iterations - from.ledger.iterations;
  if (!r.converged) return std::nullopt;
  return state_difference(system, companion, reached, of_velocities);
}

/// Error estimate of a composed step from cheap companions of orders 2 and 4: y4 − y and y2 − y
/// decrease by known powers of H, so their ratio extrapolates from one order to the next.
std::optional<double> Stepper::Impl::composed_error(const State& from, const State& reached,
                                                    double H) {
  const auto e2 = difference_of(check2, from, reached, H, H);
  const auto e4 = e2 ? difference_of(check4, from, reached, H, H) : std::nullopt;
  if (!e4) return std::nullopt;
  if (*e2 == 0.0) return 0.0;
  const double ratio = *e4 / *e2;
  return control.order == 6 ? kErrorOfSix * *e4 * ratio : kErrorOfEight * *e4 * ratio * ratio;
}

/// Error estimate of an extrapolated step: the difference of its columns, or the energy that it
/// gains or loses beside the balance, which is to close to ten tolerances over the run. An undamped
/// vibration that no member resolves grows by extrapolation, hardly seen in positions. The work of
/// drives and joints in steps that limits cut short is rounding.
double Stepper::Impl::extrapolated_error(const State& from, const State& reached, double H,
                                         double allowed) const {
  const double difference = table->difference();
  if (difference > allowed || cut_short) return difference;
  const double missed =
      single.ledger().imbalance(from, reached, kWorkRounding * reach_of_bodies / std::abs(H));
  return std::max(difference, missed * control.horizon / (kBalanceTolerances * std::abs(H)));
}

/// Part of a step at whose end it has passed the first kink of a force within it, of order 2 the
/// first turn of a motion with dry friction; nothing if there is none, but near its ends. Errors δ
/// in the time of a jump change velocities by δ, in that of a kink by δ²: the root of the tolerance
/// is near enough. @eq{force-kink} @eq{break-away}
/// @param planned  Length of a step that no kink ends [s]. @param ends  Pieces, at order 2.
std::optional<double> Stepper::Impl::to_kink(const State& from, const State& reached, double H,
                                             double planned, const ForceKinks::Ends& ends) const {
  if (force_kinks.none() || !automatic() || H <= least_step()) return std::nullopt;
  if (composed()) {
    const State* given_up = extrapolates() ? table->given_up_at() : nullptr;
    const double whole = std::max(planned, H) / H;
    const ForceKinks::Margins near{.kink = std::sqrt(2.0 * control.tolerance) * whole,
                                   .jump = control.tolerance * whole};
    return force_kinks.first(from, given_up ? *given_up : reached, near);
  }
  if (!watches_jumps()) return std::nullopt;
  const double whole = first_step(from) / H, at_end = control.tolerance * whole;
  const double of_joints = force_kinks.first_turn(from, reached, at_end).value_or(1.0);
  const bool stops = ends.stopped * (control.horizon - from.t) > control.tolerance;
  if (const double turn = std::min({of_joints, ends.turn, stops ? 0.5 : 1.0}); turn < 1.0 - at_end)
    return std::max(turn, at_end);
  // By halves of the way: the line through two forces is the better the shorter they act.
  const auto away = force_kinks.break_away(from, reached, ends);
  const double near = std::sqrt(control.tolerance) * whole;
  if (!away || *away <= near) return std::nullopt;
  return std::max(0.5 * *away, near);
}

/// Error estimate of a single step from its two halves, whose error is a quarter; it does not use
/// past steps. @eq{step-halves}
std::optional<double> Stepper::Impl::error_by_halves(const State& from, const State& reached,
                                                     double H) {
  const auto difference = difference_of({0.5, 0.5}, from, reached, H, 0.0);
  if (!difference) return std::nullopt;
  return 4.0 / 3.0 * *difference;
}

/// Adds an estimate of the accepted step's error to the ledger. Some fixed steps of higher order
/// are repeated in two halves. @eq{step-error}
void Stepper::Impl::record(State& state, double H, double verdict) {
  if (!composed()) return record_last_step(system, state);
  if (automatic()) return record_error(state, {verdict, -1, -1});
  if (state.ledger.steps % kSampled != 0) return;
  std::vector<double> halves = stages;
  halves.insert(halves.end(), stages.begin(), stages.end());
  for (double& stage : halves) stage *= 0.5;
  companion_iterations = 0;
  const auto difference = difference_of(halves, before, state, H, H);
  state.ledger.iterations += companion_iterations;
  if (difference)
    record_error(state, {*difference / (1.0 - std::pow(0.5, control.order)), -1, -1}, kSampled);
}

/// Error estimate of steps of order 2 from a state, known after three; nothing if one does not
/// converge.
std::optional<double> Stepper::Impl::error_of_two(const State& from, double dt) {
  companion = from;
  single.ledger().forget();
  bool fine = true;
  for (int i = 0; i < 3 && fine; ++i)
    fine = single.take(companion, dt, control.newton, {i == 0 ? -1 : 1, i == 2}).converged;
  single.ledger().forget();
  companion_iterations = companion.ledger.iterations - from.ledger.iterations;
  if (!fine) return std::nullopt;
  return single.error_estimate();
}

/// Finds an automatic step of order 2 whose estimate, known after three steps, is acceptable: at
/// the start and where past steps give no information. @param way  Time to the next break [s].
void Stepper::Impl::find_length(State& state, double way) {
  // Values that are set between steps are constant in the first one, and in these trials: their
  // change within it is an error of second order that no estimate contains.
  const double first = first_step(state) * (control.lagged ? std::sqrt(control.tolerance) : 1.0);
  const double most = sampled(state, std::min(first, way / 3.0));
  double dt = state.dt_next > 0.0 ? std::min(state.dt_next, most) : most, good = 0.0;
  before = state;
  for (int attempt = 0; attempt < kStepProbes && (dt > least_step() || attempt == 0); ++attempt) {
    const std::optional<double> error = error_of_two(before, dt);
    state.ledger.iterations += companion_iterations;
    const double allowed = allowed_error(state, dt);
    if (!error || *error > allowed) {
      if (good > 0.0) break;
      dt *= error ? std::clamp(kSafety * std::sqrt(allowed / *error), 0.1, 0.9) : 0.5;
      continue;
    }
    good = dt;
    const double longer =
        *error > 0.0 ? std::min(kLonger, kSafety * std::sqrt(allowed / *error)) : kLonger;
    if (longer < kWorthLonger || dt >= most) break;
    dt = std::min(most, longer * dt);
  }
  state.dt_next = good > 0.0 ? good : std::max(dt, std::min(most, least_step()));
  state.easy_steps = 0;
  single.ledger().forget();
}

/// Projects velocities onto the rows before a step much shorter than the last one. Their normal
/// part is of the order of the square of the step that left it; the short step would turn it into
/// reactions, and these into dry friction. @eq{force-kink}
void Stepper::Impl::prepare_short_step(State& state, double H) {
  if (system.rows() == 0 || !system.drives().empty() || !(H < kMuchShorter * state.dt_last)) return;
  const BodySums before_it = single.ledger().sums(state);
  project_velocities(system, state);
  single.ledger().add_jump(state, before_it, 0.0);
}

/// Verdict on a step of order 2 in which a force passes from one smooth piece to another, or a
/// joint begins or ceases to stick; nothing if there is none, or it matters little. The velocity
/// then has an error of first or second order, which the rest of the run multiplies by its time.
/// Three thirds measure it, as they reverse the velocity normal to rows like one step; it may be a
/// part of the tolerance. @eq{force-kink}
/// @param planned  Length of a step without a passage [s].
std::optional<Stepper::Impl::Verdict> Stepper::Impl::judge_passage(const State& from,
                                                                   State& reached, double H,
                                                                   double planned,
                                                                   const ForceKinks::Ends& ends) {
  if (!ends.passed()) return std::nullopt;
  const double rest = std::max(H, control.horizon - from.t);
  companion_iterations = 0;
  constexpr double kThird = 1.0 / 3.0;
  const auto difference = difference_of({kThird, kThird, kThird}, from, reached, H, rest);
  reached.ledger.iterations += companion_iterations;
  if (!difference) return Verdict{.fine = false, .factor = 0.5};
  // Velocities have the rounding of positions, by the step.
  const double allowed = std::max(kImpactError * control.tolerance, least_error * rest / H);
  Verdict v;
  v.fine = *difference <= allowed || H <= least_step();
  if (!v.fine) {
    v.kink = true;
    v.factor = std::clamp(kSafety * std::sqrt(allowed / *difference), kMinFactorTable, 0.5);
    return v;
  }
  if (*difference <= kPassesUnnoticed * allowed) return std::nullopt;
  begin_anew(reached);
  v.factor = std::max(1.0, planned / H);
  return v;
}

/// Verdict on a step in which a stop is active. Its time within the step is arbitrary, which hardly
/// matters if the step is short enough.
Stepper::Impl::Verdict Stepper::Impl::judge_stop(const State& from, const State& reached,
                                                 double H) const {
  Verdict v;
  // Contacts are rows: the jump alone, as other forces do not stop the bodies.
  v.error = system.contacts() ? H * single.jump() : jump_difference(system, from, reached, H);
  const double allowed = kImpactError * control.tolerance;
  v.fine = v.error <= allowed || H <= least_step();
  const double wanted = v.error > 0.0 ? kSafety * allowed / v.error : kMaxFactor;
  // After an impact steps grow from the one that contained it.
  v.factor = v.fine ? std::clamp(wanted, 1.0, single.jumped() ? 1.0 : kMaxFactor)
                    : std::clamp(wanted, kMinImpactFactor, 0.9);
  if (v.fine) v.error = 0.0;  // a bound for one impact, not an error of every step
  return v;
}

Stepper::Impl::Verdict Stepper::Impl::judge(const State& from, State& reached, double H, bool fresh,
                                            Refused& refused) {
  Verdict v;
  companion_iterations = 0;
  double power = 0.5, safety = kSafety, longest = kMaxFactor;
  const double allowed = std::max(allowed_error(from, H), extrapolates() ? table->rounding() : 0.0);
  std::optional<double> error;
  if (composed()) {
    error = extrapolates() ? extrapolated_error(from, reached, H, allowed)
                           : composed_error(from, reached, H);
    reached.error_last =
        std::max(std::min(error.value_or(0.0), control.tolerance), kNoiseFades * noise(from));
    if (error) error = std::max(*error, 0.1 * from.error_last);
    power = 1.0 / (control.order + 1.0);
    safety = kSafetyComposed;
  } else if (from.past_count < 2 && !fresh) {
    // find_length() has tried these steps, or they are as short as the impact's. With contacts by
    // forces there is no estimate.
    if (!watches_jumps()) v.factor = std::clamp(first_step(reached) / H, 1.0, kMaxFactor);
    return v;
  } else {
    if (!fresh) error = single.error_estimate();
    // Past steps may be noise, or give no information: then the step is measured by itself.
    if (watches_jumps() && (fresh || (*error > allowed && refused.count > 0))) {
      const auto halves = error_by_halves(from, reached, H);
      error = halves && error ? std::min(*error, *halves) : halves;
      longest = 1.0;  // the past would reject a longer one
    }
    reached.error_last = kNoiseFades * from.error_last;
  }
  reached.ledger.iterations += companion_iterations;
  const bool shortest = H <= least_step();
  if (!error) return {.fine = shortest, .factor = shortest ? 1.0 : 0.5, .noise = shortest};
  v.error = *error;
  v.factor = longest;
  if (extrapolates()) {
    const ColumnErrors errors{columns(from), v.error, table->difference_before()};
    int least = errors.columns, most = errors.columns;
    if (control.varies) {
      least = std::min(kLeastColumns, table->most_columns());
      if (v.error <= allowed) most = table->most_columns();
    }
    const ColumnPlan plan = plan_columns(errors, allowed, least, most);
    v.factor = plan.factor;
    v.columns = plan.columns;
  } else if (v.error > 0.0) {
    v.factor = std::clamp(safety * std::pow(allowed / v.error, power), kMinFactor, longest);
  }
  v.fine = v.error <= allowed;
  if (v.fine) return v;
  const double most_noise = composed() ? kMaxNoiseComposed : kMaxNoise;
  if (shortest || (v.error < most_noise && refused.leaves_noise(H, v.error))) {
    v.fine = v.noise = true;
    // The longer one was equally good.
    v.factor = shortest ? 1.0 : refused.H / H;
    reached.error_last = std::clamp(refused.error, std::min(v.error, most_noise), most_noise);
  }
  if (composed() || refused.count > 0) refused = {H, v.error, refused.count};
  return v;
}

}  // namespace polhode
