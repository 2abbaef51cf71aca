// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <polhode/core/clock.hpp>
#include <polhode/core/version.hpp>
#include <polhode/model/endless.hpp>
#include <polhode/simulation/finite_functions.hpp>
#include <polhode/simulation/simulation_impl.hpp>
#include <polhode/simulation/trust.hpp>
#include <polhode/system/state_archive.hpp>

namespace polhode {

namespace {

/// Difference of times, as a part of the output interval, below which they are equal.
constexpr double kSameTime = 1e-9;
/// Relative difference of a time from the last moment before it, and from its rounding [-].
constexpr double kRoundingOfTime = 4e-15;
/// Length of a step below which its time is taken from the wall clock, which is read ten times as
/// fast as that of the processor [s].
constexpr double kShortWork = 1e-4;
/// Length of a run that has none [s].
constexpr double kUsualRun = 1.0;
constexpr const char* kSeeAtStart = "Use a channel that is available at the start";

/// Refuses a start at which a function of time has no value.
void refuse_infinite_start(const Model& model) {
  const NotFinite found = not_finite_at_start(model);
  if (!found.place.empty()) throw InputError(found.place, found.text, "Correct its function");
}

/// Refuses a start at which a drive has no finite rate.
void refuse_endless_rate(const Model& model, const System& system) {
  // Of an endless run, the rate in what a second is to others.
  const NotFinite found =
      endless_rate_at_start(model, system, system.initial_state(),
                            is_endless(model.analysis) ? kUsualRun : model.analysis.duration);
  if (!found.place.empty())
    throw InputError(found.place, found.text, "Begin with a finite rate, as 'smoothstep' does");
}

}  // namespace

Simulation::Simulation(Model model) : impl_(std::make_unique<Impl>(std::move(model))) {
  refuse_infinite_start(impl_->model);
  if (!impl_->statics) refuse_endless_rate(impl_->model, impl_->system);
  impl_->watch(*this);
  impl_->start_consistently();
  impl_->begin_control(*this);
}

Simulation::Simulation(Model model, State state) : impl_(std::make_unique<Impl>(std::move(model))) {
  if (state.blocks.size() != impl_->system.initial_state().blocks.size() ||
      state.node_x.size() != impl_->system.initial_state().node_x.size() ||
      state.lambda.size() != impl_->system.initial_state().lambda.size())
    throw InputError("restart", "the state belongs to another model",
                     "Restart with the model it was saved from");
  impl_->watch(*this);
  impl_->state = std::move(state);
  impl_->contacts.resume(impl_->state);
  if (!impl_->controllers) return;
  impl_->controllers->resume(impl_->state);
  impl_->begin_control(*this);
}

/// Lets controllers act that have not done so yet.
void Simulation::Impl::begin_control(const Simulation& simulation) {
  if (!controllers || !controllers->begin(state)) return;
  StepReport report;
  let_act(simulation, report);
  if (!report.message.empty()) throw InputError("controllers", report.message, kSeeAtStart);
}

/// Names the load that makes a step fail by having no value, if one does.
void Simulation::Impl::explain(StepReport& report) {
  if (report.accepted) return;
  // From the last step on, which may have ended where a function is not finite: forces are taken
  // within steps.
  const double from = std::max(0.0, state.t - state.dt_last);
  const double rest =
      (statics ? model.analysis.history.value_or(1.0) : model.analysis.duration) - state.t;
  const double step = state.dt_last > 0.0 ? state.dt_last : rest;
  const double to = state.t + (statics ? rest : model.analysis.step.value_or(step));
  NotFinite cause = not_finite_in(model, from, to);
  if (cause.place.empty())
    cause = not_finite_ahead(model, system, map, state, at_instant(), statics ? state.t : to);
  if (!cause.place.empty()) report.message = cause.text;
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;

const Model& Simulation::model() const { return impl_->model; }
const System& Simulation::system() const { return impl_->system; }
const State& Simulation::state() const { return impl_->state; }
const StartReport& Simulation::start_report() const { return impl_->start_report; }

StepReport Simulation::step(double t_limit) {
  if (!(t_limit > time()))
    throw InputError(
        "the end of the step",
        format("is {:.6g}, but must be after the present time, {:.6g}", t_limit, time()),
        "Give a later time; beyond the end of the analysis, a longer duration, or none");
  const bool is_short = impl_->last_work < kShortWork;
  const double wall = wall_clock(), cpu = is_short ? 0.0 : cpu_clock();
  StepReport report = advance(t_limit);
  impl_->explain(report);
  const double work = wall_clock() - wall;
  impl_->last_work = work;
  impl_->advance_seconds += work;
  impl_->figures.wall_time_s += work;
  impl_->figures.cpu_time_s += is_short ? std::min(work, kShortWork) : cpu_clock() - cpu;
  return report;
}

RunSummary Simulation::run(const std::function<void(Simulation&)>& observe,
                           const std::function<void(Simulation&)>& on_step,
                           const std::atomic<bool>* stop) {
  Impl& s = *impl_;
  require_end(s.model.analysis);
  const double end = s.end();
  const bool in_time = !s.statics || s.model.analysis.history;
  const std::optional<double> every = in_time ? s.model.output.every : std::nullopt;
  const bool automatic = !s.model.analysis.step;
  const double wall = wall_clock(), cpu = cpu_clock();
  double looked = -std::numeric_limits<double>::infinity();
  const auto look = [&] {
    if (s.state.t == looked) return;  // an event has ended the run where the last step ended
    looked = s.state.t;
    const double t0 = wall_clock();
    s.at_instant();  // computes the velocity residual for the figures
    s.watch_stretches();
    watch_stress();
    if (observe) observe(*this);
    s.output_seconds += wall_clock() - t0;
  };
  const auto output_after = [&](double t) {
    return every ? (std::floor(t / *every + kSameTime) + 1.0) * *every : end;
  };
  if (s.state.ledger.steps == 0) look();
  s.figures.end = RunEnd::finished;
  double next = output_after(s.state.t);
  const bool dense = every && s.has_dense_output();
  // A step may end at a break of a function of time, the last moment before it.
  const auto is_just_before = [&](double t) {
    return s.state.t < t && t - s.state.t <= kRoundingOfTime * t;
  };
  const auto look_at = [&](double t) {
    const double reached = std::exchange(s.state.t, t);
    s.forget_reports();
    s.between_steps = true;
    look();
    s.between_steps = false;
    s.state.t = reached;
    s.forget_reports();
  };
  const auto look_between = [&](double t) {
    const double t0 = wall_clock();
    State reached = std::exchange(s.state, s.dense->at(t));
    s.forget_reports();
    s.output_seconds += wall_clock() - t0;
    s.between_steps = true;
    look();
    s.between_steps = false;
    s.state = std::move(reached);
    s.forget_reports();
  };
  if (s.statics) s.statics->set_stop(stop);
  while (s.state.t < end * (1.0 - kSameTime) && !s.stopped()) {
    if (stop && stop->load()) {
      s.figures.end = RunEnd::interrupted;
      break;
    }
    if (dense) s.dense->start(s.state);
    const double before = wall_clock();
    StepReport report = advance(automatic && !dense ? std::min(next, end) : end);
    s.advance_seconds += wall_clock() - before;
    if (!report.accepted && stop && stop->load()) {
      s.figures.end = RunEnd::interrupted;
      break;
    }
    if (!report.accepted) {
      s.explain(report);
      s.figures.end = RunEnd::not_converged;
      s.figures.message = report.message;
      s.watch_stretches();
      watch_stress();
      break;
    }
    if (dense) {
      s.dense->finish(s.state, s.stepper->took_whole_order());
      for (; next < s.state.t * (1.0 - kSameTime); next = output_after(next)) look_between(next);
    }
    const bool finished = s.state.t >= end * (1.0 - kSameTime) || s.stopped();
    if (!every || finished || s.state.t >= next * (1.0 - kSameTime)) {
      if (automatic && !finished && is_just_before(next))
        look_at(next);
      else
        look();
      next = output_after(s.state.t);
    }
    if (!on_step) continue;
    const double recorded = wall_clock();
    on_step(*this);  // After the output: a checkpoint of this state has it behind it.
    s.output_seconds += wall_clock() - recorded;
  }
  if (s.stopped() && s.figures.end == RunEnd::finished) {
    const EventSpec& event = s.map.events[static_cast<std::size_t>(s.events->stopped(s.state))];
    s.figures.message = format("stopped by event '{}' at t = {:.9g} s", event.name, s.state.t);
  }
  if (!s.statics) s.pole = endless_in(s.model, s.state.t).text;
  s.figures.wall_time_s += wall_clock() - wall;
  s.figures.cpu_time_s += cpu_clock() - cpu;
  return summary();
}

RunSummary Simulation::summary() const {
  const Impl& s = *impl_;
  const Ledger& l = s.state.ledger;
  RunSummary r = s.figures;
  r.t = s.state.t;
  r.steps = l.steps;
  r.rejected_steps = l.rejected;
  r.newton_iterations = l.iterations;
  const Drifts drifts = polhode::drifts(l);
  r.energy_drift = drifts.energy;
  r.linear_momentum_drift = drifts.linear_momentum;
  r.angular_momentum_drift = drifts.angular_momentum;
  r.constraint_residual_max = l.constraint_max;
  if (l.errors.steps > 0 && !s.statics)
    r.errors = {l.errors.largest, l.errors.sum, l.errors.time, s.whose_error(),
                std::min(l.errors.steps, l.steps)};
  r.phases = {{"start", s.start_seconds}};
  double rest = s.advance_seconds;
  for (const auto& phase : s.stepper->phases()) {
    r.phases.push_back(phase);
    rest -= phase.second;
  }
  // Ledger, step control, events and controllers; of statics all that solves.
  r.phases.emplace_back(s.statics ? "load steps" : "between", std::max(0.0, rest));
  r.phases.emplace_back("output", s.output_seconds);
  r.result_hash = state_hash();
  r.solver = s.engine_name;
  r.instruction_set = s.method.kernels->name;
  r.version = version();
  r.order = s.method.control.order;
  r.scheme = s.method.scheme;
  r.narration = s.narration;
  r.warnings = s.warnings();
  if (!s.statics)
    r.distrust = reasons_for_distrust(s.model, s.system, l, s.method.control.extrapolated);
  if (!s.pole.empty()) r.distrust.push_back(s.pole);
  for (const std::string& reason : r.distrust) r.warnings.push_back("not trusted: " + reason);
  for (int e = 0; e < static_cast<int>(s.map.events.size()); ++e) {
    const auto of = [&](EventMemory::Entry k) { return s.events->memory(s.state, e, k); };
    r.events.push_back({s.map.events[static_cast<std::size_t>(e)].name,
                        static_cast<std::int64_t>(of(EventMemory::kCount)), of(EventMemory::kTime),
                        of(EventMemory::kLost), of(EventMemory::kImpulse)});
  }
  for (std::size_t i = 0; i < s.solid_watches.size(); ++i) {
    const Impl::SolidWatch& w = s.solid_watches[i];
    r.solids.push_back(
        {s.model.solids[i].name, w.part(w.error_energy), w.part(w.largest_error), w.t_largest});
  }
  if (s.statics) {
    r.statics = s.statics->report();
    r.strain_energy = s.statics->strain_energy(s.state);
    for (const std::string& text : s.mesh_instabilities(*r.statics)) r.warnings.push_back(text);
  }
  if (has_contacts()) {
    const ContactLosses lost = contact_losses();
    const Balance b = balance();
    r.contacts = RunSummary::Contacts{
        .shapes = static_cast<int>(s.map.contact.body.size()),
        .surfaces = static_cast<int>(s.map.contact.surfaces.size()),
        .touching =
            s.contacts.touching() + surface_figures(s.system, s.state, s.map.contact).touching,
        .least_gap = std::fmin(s.contacts.least_gap(), s.surface_gap),
        .lost_in_impacts = lost.impacts,
        .lost_by_friction = lost.friction,
        .numerical = b.kinetic + b.potential - l.initial_energy - b.put_in + b.dissipated,
        .sweeps = {}};
    if (const double short_ones = s.contacts.unresolved(); short_ones > 0.0)
      r.warnings.push_back(
          format("contacts: {:.0f} impacts took fewer than twenty steps: speeds after them are "
                 "right, forces and contact times are not. Take shorter steps",
                 short_ones));
    if (const ContactStatistics::NearFloor deep = s.contacts.near_floor(); deep.steps > 0)
      r.warnings.push_back(format(
          "contacts: '{}' and '{}' penetrated each other in {} steps so far that the contact "
          "was stiffer than given. Give a larger stiffness",
          deep.first_shape, deep.second_shape, deep.steps));
    if (s.model.contacts.nonsmooth()) {
      const ImpulseFigures search = s.contacts.impulse_figures();
      r.contacts->sweeps = {search.sweeps / static_cast<double>(std::max<std::int64_t>(l.steps, 1)),
                            static_cast<std::int64_t>(search.unconverged)};
      if (search.unconverged > 0.0)
        r.warnings.push_back(
            format("contacts: {:.0f} of {} steps ended above sweep_tolerance. Raise "
                   "contacts.sweeps, or take shorter steps",
                   search.unconverged, l.steps));
    }
  }
  return r;
}
bool Simulation::between_steps() const { return impl_->between_steps; }

std::string Simulation::state_hash() const {
  return polhode::state_hash(impl_->system, impl_->state);
}

}  // namespace polhode
