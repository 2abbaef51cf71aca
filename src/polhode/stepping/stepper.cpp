// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <polhode/core/format.hpp>
#include <polhode/dynamics/composition.hpp>
#include <polhode/stepping/contradiction.hpp>
#include <polhode/stepping/drive_kinks.hpp>
#include <polhode/stepping/extrapolation_table.hpp>
#include <polhode/stepping/local_error.hpp>
#include <polhode/stepping/single_step.hpp>
#include <polhode/stepping/start.hpp>
#include <polhode/stepping/step_control.hpp>
#include <polhode/stepping/step_error.hpp>
#include <polhode/stepping/step_lengths.hpp>
#include <polhode/stepping/step_reach.hpp>
#include <polhode/stepping/step_verdict.hpp>
#include <polhode/stepping/stepper.hpp>
#include <polhode/system/time_breaks.hpp>

namespace polhode {

using namespace step_control;

struct Stepper::Impl {
  const System& system;
  SingleStep single;
  DriveKinks kinks;
  GeneralizedAlpha ga;
  StepControl control;
  TimeBreaks breaks;
  std::vector<double> stages{1.0};          ///< Of the order.
  std::vector<double> check2, check4;       ///< Of the companions of orders 2 and 4.
  std::optional<ExtrapolationTable> table;  ///< Instead of a composition.
  State before, companion;                  ///< Copies to return to and to compare with.
  StepReach reach;
  double least_error = kMinError;  ///< Rounding of positions [-].

  Impl(const System& s, std::unique_ptr<NewtonEngine> engine, const GeneralizedAlpha& g,
       const StepControl& c, const LaneKernels& kernels)
      : system(s),
        single(s, std::move(engine), g, kernels, c.conserving),
        kinks(s),
        ga(g),
        control(c),
        breaks(s, c.horizon, c.order == 2 ? kBreaksOfTwo : std::max(kBreaksComposed, c.order - 3)) {
    least_error = std::max(kMinError, kStepRoundOff * extent(s) / s.length_scale()) *
                  (c.order > 2 ? kRoundOffComposed : 1.0);
    if (c.extrapolated) table.emplace(s, c.order);
    if (table) return;
    const bool doubled = c.order > 4 && s.rows() > 0;
    stages = composition_stages(c.order, doubled);
    // Companions have doubled stages too: an odd number of single steps would end with the
    // constraint-normal velocity reversed, which would dominate the difference.
    check2 = doubled ? std::vector<double>{0.5, 0.5} : std::vector<double>{1.0};
    check4 = composition_stages(4, doubled);
  }

  [[nodiscard]] bool automatic() const { return !control.step; }
  /// Whether a step consists of several single ones.
  [[nodiscard]] bool composed() const { return stages.size() > 1 || table; }
  [[nodiscard]] double least_step() const {
    if (control.min_step > 0.0) return control.min_step;
    return automatic() ? 1e-9 * control.horizon : 1e-6 * *control.step;
  }
  [[nodiscard]] double most_step() const {
    if (!automatic()) return *control.step;
    return control.max_step > 0.0 ? control.max_step : control.horizon;
  }

  /// Shortest length of a step here: of the usual ones, which are those of the run if that is
  /// shorter.
  [[nodiscard]] double shortest_length(const State& state) const {
    const double usual = !automatic()          ? std::min(*control.step, control.horizon)
                         : state.dt_next > 0.0 ? state.dt_next
                                               : first_step(state);
    return shortest_step(state.t, usual);
  }

  /// Initial length of an automatic step: a small part of the run, and of the fastest rotation.
  [[nodiscard]] double first_step(const State& state) const {
    double omega = 0.0;
    for (int b = 0; b < system.body_count(); ++b)
      omega = std::max(omega, system.motion(state, b).W.norm());
    const double turn = control.order == 2 ? 0.01 : 0.5;
    return std::min({most_step(), control.horizon / 50.0, turn / std::max(omega, 1e-12)});
  }

  /// Longest step of at most dt for which loads are sampled often enough.
  [[nodiscard]] double sampled(const State& state, double dt) const {
    if (!automatic() || breaks.empty()) return dt;
    return breaks.sampled_length(state.t, dt, composed() ? kSamplesComposed : 1.0);
  }

  /// Length of the next trial from t: not beyond the limit and the next break; a fixed step that
  /// was cut returns to its grid.
  [[nodiscard]] double next_length(const State& state, double t_limit, double at_break) const {
    double dt = state.dt_next > 0.0 ? std::min(state.dt_next, most_step()) : most_step();
    if (automatic()) {
      dt = part_of(std::min(t_limit, at_break) - state.t, sampled(state, dt));
    } else {
      const double H = *control.step;
      const double steps_done = std::floor((state.t + shortest_length(state)) / H);
      dt = part_of((steps_done + 1.0) * H - state.t, dt);
      dt = part_of(t_limit - state.t, dt);
    }
    const double way = at_break - state.t;
    if (way > (1.0 + kStretch) * dt || at_break > t_limit) return dt;
    return std::abs(way - dt) <= kSameTime * dt && !looks_at_end() ? dt : way;
  }

  /// Next break of a function of time; one that falls on the grid is over there.
  [[nodiscard]] TimeBreak next_break(const State& state) {
    if (breaks.empty()) return {};
    return breaks.next(automatic() ? state.t : state.t + kSameTime * *control.step);
  }
  [[nodiscard]] bool looks_at_end() const { return ga.alpha_f > kLooksAtEnd; }
  /// End of the step before a break: a method that evaluates the end of a step must not use values
  /// beyond the break.
  [[nodiscard]] double landing(const TimeBreak& at) const {
    return looks_at_end() ? at.t * (1.0 - kJustBeside) : at.t;
  }

  /// Drops the past steps: after a jump of accelerations or velocities.
  void begin_anew(State& state) const {
    state.past_count = 0;
    state.error_last = 0.0;
    if (automatic()) state.easy_steps = kFindAnew;
  }
  [[nodiscard]] bool stands_at(const TimeBreak& at, double t) const {
    const double same = automatic() ? kSameBreak * at.t : kSameTime * *control.step;
    return at.exists() && at.t - t <= same;
  }
  void pass_break(State& state, const TimeBreak& at) const {
    if (at.derivative > 2) return;
    begin_anew(state);
    if (!system.contacts())
      restart_accelerations(system, state, ga, std::max(at.t, state.t) * (1.0 + kJustBeside));
  }

  /// Runs stages from the state; on failure the state is not restored.
  NewtonReport run_stages(State& state, const std::vector<double>& list, double H, bool fresh) {
    if (table) return table->advance(state, list, H, single, control.newton, fresh);
    NewtonReport report;
    SingleStep::Predictor predictor;
    predictor.degree = list.size() > 1 ? 1 : (automatic() ? 1 : 3);
    predictor.remember = automatic() && control.order == 2 && list.size() == 1;
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

  /// Passes a break at the time reached, if there is one.
  void pass(State& state, const TimeBreak& ahead) {
    const bool stands = stands_at(ahead, state.t);
    const double t = state.t;
    if (stands) state.t = ahead.t;  // where a function jumps, though the step ended beside it
    kinks.pass(state, single.ledger());
    state.t = t;
    if (stands) pass_break(state, ahead);
  }

  /// Goes to limits that are nearer than any step is short, without a step.
  /// @returns whether t_limit is reached.
  bool skip(State& state, double t_limit) {
    for (;;) {
      const TimeBreak ahead = next_break(state);
      const double limit = std::min(t_limit, landing(ahead));
      // Between breaks that are near a load may be as large as it is short: only round-off is left.
      const double least = shortest_length(state), way = limit - state.t;
      if (way >= least) return false;
      if (way > kRoundOff * limit && breaks.near(state.t, kShortPhase * least)) return false;
      state.t = limit;
      if (stands_at(ahead, state.t)) pass(state, ahead);
      if (state.t >= t_limit) return true;
    }
  }

  /// Difference by a companion from the same start; nothing if it does not converge.
  std::optional<double> difference_of(const std::vector<double>& list, const State& from,
                                      const State& reached, double H, double of_velocities) {
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
  std::optional<double> composed_error(const State& from, const State& reached, double H) {
    const auto e2 = difference_of(check2, from, reached, H, H);
    const auto e4 = e2 ? difference_of(check4, from, reached, H, H) : std::nullopt;
    if (!e4) return std::nullopt;
    if (*e2 == 0.0) return 0.0;
    const double ratio = *e4 / *e2;
    return control.order == 6 ? kErrorOfSix * *e4 * ratio : kErrorOfEight * *e4 * ratio * ratio;
  }

  /// Error estimate of a single step from its two halves, whose error is a quarter; it does not use
  /// past steps. @eq{step-halves}
  std::optional<double> error_by_halves(const State& from, const State& reached, double H) {
    const auto difference = difference_of({0.5, 0.5}, from, reached, H, 0.0);
    if (!difference) return std::nullopt;
    return 4.0 / 3.0 * *difference;
  }

  /// Adds an estimate of the accepted step's error to the ledger. Some fixed steps of higher order
  /// are repeated in two halves. @eq{step-error}
  void record(State& state, double H, double verdict) {
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

  std::int64_t companion_iterations = 0;

  /// Finds an automatic step of order 2 whose estimate, known after three steps, is acceptable: at
  /// the start and where past steps give no information. @param way  Time to the next break [s].
  void find_length(State& state, double way) {
    const double most = sampled(state, std::min(first_step(state), way / 3.0));
    double dt = state.dt_next > 0.0 ? std::min(state.dt_next, most) : most, good = 0.0;
    before = state;
    for (int attempt = 0; attempt < kStepProbes && (dt > least_step() || attempt == 0); ++attempt) {
      companion = before;
      single.ledger().forget();
      bool fine = true;
      for (int i = 0; i < 3 && fine; ++i)
        fine = single.take(companion, dt, control.newton, {i == 0 ? -1 : 1, i == 2}).converged;
      state.ledger.iterations += companion.ledger.iterations - before.ledger.iterations;
      const double error = fine ? single.error_estimate() : 0.0, allowed = allowed_error(state, dt);
      if (!fine || error > allowed) {
        if (good > 0.0) break;
        dt *= fine ? std::clamp(kSafety * std::sqrt(allowed / error), 0.1, 0.9) : 0.5;
        continue;
      }
      good = dt;
      const double longer =
          error > 0.0 ? std::min(kLonger, kSafety * std::sqrt(allowed / error)) : kLonger;
      if (longer < kWorthLonger || dt >= most) break;
      dt = std::min(most, longer * dt);
    }
    state.dt_next = good > 0.0 ? good : std::max(dt, std::min(most, least_step()));
    state.easy_steps = 0;
    single.ledger().forget();
  }

  /// Smallest attainable error of a step, as found: State::error_last stores it at order 2, and if
  /// it is above the tolerance at the others, which otherwise store their last estimate there.
  [[nodiscard]] double noise(const State& state) const {
    return !composed() || state.error_last > control.tolerance ? state.error_last : 0.0;
  }
  /// Requested error of a step. Order 2 spreads the tolerance over the run, error per unit of time;
  /// the higher orders apply it per step.
  [[nodiscard]] double requested_error(double dt) const {
    return control.order == 2 ? control.tolerance * std::abs(dt) / control.horizon
                              : control.tolerance;
  }
  /// Requested error, but not below the noise.
  [[nodiscard]] double allowed_error(const State& state, double dt) const {
    return std::max({least_error, requested_error(dt), kNoiseAllowed * noise(state)});
  }

  using Verdict = StepVerdict;
  using Refused = RefusedStep;
  Verdict judge(const State& from, State& reached, double H, bool fresh, Refused& refused);
  /// Verdict on a step in which a stop is active. Its time within the step is arbitrary, which
  /// hardly matters if the step is short enough.
  [[nodiscard]] Verdict judge_stop(const State& from, const State& reached, double H) const;
  void accept(State& state, double H, const Verdict& verdict, int iterations, double kept);
  StepReport advance(State& state, double t_limit);
};

Stepper::Impl::Verdict Stepper::Impl::judge_stop(const State& from, const State& reached,
                                                 double H) const {
  Verdict v;
  v.error = jump_difference(system, from, reached, H);
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
  const double allowed = allowed_error(from, H);
  std::optional<double> error;
  if (composed()) {
    error = table ? table->difference() : composed_error(from, reached, H);
    reached.error_last =
        std::max(std::min(error.value_or(0.0), control.tolerance), kNoiseFades * noise(from));
    if (error) error = std::max(*error, 0.1 * from.error_last);
    power = 1.0 / (table ? control.order - 1.0 : control.order + 1.0);
    safety = kSafetyComposed;
  } else if (from.past_count < 2 && !fresh) {
    // find_length() has tried these steps, or they are as short as the impact's. With contacts
    // there is no estimate.
    if (system.contacts()) v.factor = std::clamp(first_step(reached) / H, 1.0, kMaxFactor);
    return v;
  } else {
    if (!fresh) error = single.error_estimate();
    // Past steps may be noise, or give no information: then the step is measured by itself.
    if (!system.contacts() && (fresh || (*error > allowed && refused.count > 0))) {
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
  if (v.error > 0.0)
    v.factor = std::clamp(safety * std::pow(allowed / v.error, power), kMinFactor, longest);
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

/// Plans the next step after an accepted one. @param kept  Lower bound of its length [s].
void Stepper::Impl::accept(State& state, double H, const Verdict& verdict, int iterations,
                           double kept) {
  if (automatic()) {
    const double shortest = std::min(least_step(), H);
    state.dt_next = std::min(most_step(), std::max({kept, shortest, verdict.factor * H}));
    reach.count(state.t, verdict.error, requested_error(H), verdict.noise);
    return;
  }
  const int per_stage = iterations / (table ? table->substeps() : static_cast<int>(stages.size()));
  state.easy_steps = per_stage <= kFewIterations ? state.easy_steps + 1 : 0;
  if (state.dt_next > 0.0 && H < *control.step && state.easy_steps >= kEasySteps) {
    state.dt_next = std::min(*control.step, 2.0 * std::max(H, state.dt_next));
    state.easy_steps = 0;
  }
}

StepReport Stepper::Impl::advance(State& state, double t_limit) {
  StepReport report;
  report.accepted = skip(state, t_limit);
  report.t = state.t;
  if (report.accepted) return report;
  const double start = state.t;
  single.hold_to_round_off(false);
  const TimeBreak ahead = next_break(state);
  const double limit = std::min(t_limit, landing(ahead));
  if (automatic() && (state.dt_next <= 0.0 || state.easy_steps == kFindAnew)) {
    if (control.order == 2)
      find_length(state, landing(ahead) - state.t);
    else if (state.dt_next <= 0.0)
      state.dt_next = first_step(state);
    state.easy_steps = 0;
  }
  const double planned = state.dt_next;
  double wanted = next_length(state, t_limit, landing(ahead));
  bool fresh = false;
  Refused refused;
  std::string gap;  // left by the first trial whose rows did not all hold
  for (;;) {
    const double H = wanted;
    if (composed() || automatic()) before = state;
    report.newton = run_stages(state, stages, H, fresh);
    // Contacts handle velocity jumps themselves.
    const bool stopped = !composed() && !system.contacts() && single.stopped();
    const bool impact = stopped && single.jumped();
    Verdict verdict{.fine = report.newton.converged, .factor = 0.5};
    if (verdict.fine && automatic()) {
      const Verdict by_stop = stopped ? judge_stop(before, state, H) : Verdict{.fine = false};
      verdict = impact || by_stop.fine ? by_stop : judge(before, state, H, fresh, refused);
    }
    if (verdict.fine) {
      report.accepted = true;
      const double t = composed() ? before.t + H : state.t;
      const bool at_limit = std::abs(t - limit) < kSameTime * std::abs(H);
      state.t = at_limit ? limit : t;
      if (!automatic()) state.t = on_grid(state.t, *control.step, start);
      report.t = state.t;
      report.dt = H;
      // A step cut short by a limit does not shorten the next one.
      const double kept = refused.count == 0 && verdict.factor >= 1.0 && !impact ? planned : 0.0;
      accept(state, H, verdict, report.newton.iterations, kept);
      if (report.newton.hard) record_hard(state);
      record(state, H, verdict.error);
      pass(state, ahead);
      if (impact && automatic()) state.past_count = 0;
      ++state.ledger.steps;
      single.ledger().close_step(state);
      return report;
    }
    // Rejected: back to t_n with a shorter step; past steps are of little use for the next trial.
    const std::int64_t iterations = state.ledger.iterations;
    if (composed() || automatic()) {
      state = before;
      single.ledger().forget();
    }
    state.ledger.iterations = iterations;
    ++state.ledger.rejected;
    ++report.rejected;
    if (const auto& open = single.open_row(); open && !report.newton.converged && gap.empty()) {
      gap = gap_text(system, *open, H);
      // A shorter step would only make the gap smaller.
      std::vector<std::string> names = contradicting(system, state, H);
      if (names.empty()) names = single.contradicting();
      report.message = contradiction_text(state.t, names, gap);
      if (!report.message.empty()) return report;
      single.hold_to_round_off(true);
    }
    wanted *= report.newton.converged ? std::min(verdict.factor, 0.9) : 0.5;
    state.easy_steps = 0;
    fresh = !report.newton.converged;
    ++refused.count;
    if (H > least_step()) {
      wanted = std::max(wanted, least_step());
    } else {
      report.message = limit_text(system, state, gap);
      if (report.message.empty())
        report.message = format(
            "{} Steps down to {:.2g} s were tried. Look for a singular position of the joints, "
            "{}very stiff loads or springs, and masses that differ by many orders of magnitude. "
            "'polhode check --tangents' compares the derivatives of all forces.",
            report.newton.text(), least_step(), locking_joint(system));
      return report;
    }
  }
}

Stepper::Stepper(const System& system, std::unique_ptr<NewtonEngine> engine,
                 const GeneralizedAlpha& ga, const StepControl& control, const LaneKernels& kernels)
    : impl_(std::make_unique<Impl>(system, std::move(engine), ga, control, kernels)) {}

Stepper::~Stepper() = default;

void Stepper::begin(State& state) { impl_->single.ledger().begin(state); }

StepReport Stepper::advance(State& state, double t_limit) { return impl_->advance(state, t_limit); }

SwitchReport Stepper::switch_over(State& state, std::span<const int> on, std::span<const int> off) {
  Impl& s = *impl_;
  const SwitchReport report = switch_interactions(s.system, state, on, off, s.single.ledger());
  forces_jump(state);
  return report;
}

void Stepper::forces_jump(State& state) {
  impl_->begin_anew(state);
  if (!impl_->system.contacts())
    restart_accelerations(impl_->system, state, impl_->ga, state.t * (1.0 + kJustBeside));
}

void Stepper::leave() { impl_->single.ledger().forget(); }

const NewtonEngine& Stepper::engine() const { return impl_->single.engine(); }

Balance Stepper::balance(const State& state) const { return impl_->single.ledger().balance(state); }

std::vector<std::string> Stepper::warnings() const {
  return impl_->reach.warnings(impl_->control.tolerance, impl_->control.order);
}

std::vector<std::pair<std::string, double>> Stepper::phases() const {
  return impl_->single.phases();
}

}  // namespace polhode
