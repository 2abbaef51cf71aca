// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/format.hpp>
#include <polhode/stepping/contradiction.hpp>
#include <polhode/stepping/local_error.hpp>
#include <polhode/stepping/stepper_impl.hpp>

namespace polhode {

/// Goes to limits that are nearer than any step is short, without a step.
/// @returns whether t_limit is reached.
bool Stepper::Impl::skip(State& state, double t_limit) {
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

/// Plans the next step after an accepted one. @param kept  Lower bound of its length [s].
void Stepper::Impl::accept(State& state, double H, const Verdict& verdict, int iterations,
                           double kept) {
  if (automatic()) {
    if (verdict.columns > 0) state.columns = verdict.columns;
    const double shortest = std::min(least_step(), H);
    state.dt_next = std::min(most_step(), std::max({kept, shortest, verdict.factor * H}));
    reach.count(state.t, verdict.error, requested_error(H), verdict.noise);
    return;
  }
  const int single_steps = extrapolates() ? ExtrapolationTable::substeps(columns(state))
                                          : static_cast<int>(stages.size());
  const int per_stage = iterations / single_steps;
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
  choose_scheme(state, limit - state.t);
  if (automatic() && (state.dt_next <= 0.0 || state.easy_steps == kFindAnew)) {
    if (!composed())
      find_length(state, landing(ahead) - state.t);
    else if (state.dt_next <= 0.0)
      state.dt_next = first_step(state);
    state.easy_steps = 0;
  }
  const double planned = state.dt_next;
  double wanted = next_length(state, t_limit, landing(ahead));
  cut_short = wanted < kCutShort * planned;
  bool fresh = false;
  Refused refused;
  int kinked = 0;   // trials refused for kinks of forces
  std::string gap;  // left by the first trial whose rows did not all hold
  for (;;) {
    const double H = wanted;
    if (composed() || automatic()) before = state;
    // Later trials may be accepted for their noise.
    give_up_above =
        automatic() && refused.count == 0 && H > least_step() ? allowed_error(state, H) : 0.0;
    to_break = stands_at(ahead, before.t + H);
    report.newton = run_stages(state, stages, H, fresh);
    const bool met_stop = extrapolates() && table->met_stop();
    // Jumps below the wanted error do not disturb its estimate.
    const bool jumped = !composed() && watches_jumps() && single.jumped();
    const bool impact = jumped && (!system.contacts() ||
                                   (automatic() && H * single.jump() > allowed_error(before, H)));
    const bool stopped = impact || (!composed() && !system.contacts() && single.stopped());
    Verdict verdict{.fine = report.newton.converged && !met_stop, .factor = 0.5};
    ForceKinks::Ends ends;  // pieces at both ends, at order 2 alone
    if (verdict.fine && automatic() && !composed() && watches_jumps())
      ends = force_kinks.ends(before, state);
    // Slip that ends jumps to zero, but is located like a turn.
    const bool turned = ends.turn < 1.0 || ends.stopped > 0.0;
    const std::optional<double> kink = verdict.fine && (!impact || turned) && kinked < kTrialsOfKink
                                           ? to_kink(before, state, H, planned, ends)
                                           : std::nullopt;
    if (kink) {
      verdict = {.fine = false};
    } else if (verdict.fine && automatic()) {
      const Verdict by_stop = stopped ? judge_stop(before, state, H) : Verdict{.fine = false};
      const auto passage = impact ? std::nullopt : judge_passage(before, state, H, planned, ends);
      verdict = passage                  ? *passage
                : impact || by_stop.fine ? by_stop
                                         : judge(before, state, H, fresh, refused);
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
      if (table && automatic()) count_scheme(state, H, columns(before));
      if (report.newton.hard) record_hard(state);
      if (automatic() ? impact : jumped && system.contacts()) state.past_count = 0;
      record(state, H, verdict.error);
      pass(state, ahead);
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
    if (kink) {
      ++kinked;
      wanted = std::max(*kink * H, least_step());
      cut_short = wanted < kCutShort * planned;
      if (!composed()) prepare_short_step(state, wanted);
      continue;
    }
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
    if (extrapolates() && automatic()) {
      if (verdict.columns > 0) state.columns = verdict.columns;
      if (gives_way(state, wanted, refused.count)) {
        StepReport instead = advance(state, t_limit);
        instead.rejected += report.rejected;
        return instead;
      }
    }
    state.easy_steps = 0;
    fresh = !report.newton.converged;
    ++refused.count;
    if (verdict.kink) prepare_short_step(state, wanted);
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

bool Stepper::took_whole_order() const { return impl_->composed(); }

const NewtonEngine& Stepper::engine() const { return impl_->single.engine(); }

Balance Stepper::balance(const State& state) const { return impl_->single.ledger().balance(state); }

std::vector<std::string> Stepper::warnings() const {
  std::vector<std::string> list = impl_->vibration_warning();
  for (std::string& text : impl_->reach.warnings(impl_->control.tolerance, impl_->control.order))
    list.push_back(std::move(text));
  return list;
}

std::vector<std::pair<std::string, double>> Stepper::phases() const {
  std::vector<std::pair<std::string, double>> phases = impl_->single.phases();
  if (impl_->table) phases[1].second += impl_->table->waited();  // for iterations
  return phases;
}

}  // namespace polhode
