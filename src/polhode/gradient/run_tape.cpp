// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/dynamics/extrapolation.hpp>
#include <polhode/gradient/run_tape.hpp>
#include <polhode/model/endless.hpp>
#include <polhode/stepping/step_control.hpp>

namespace polhode {

namespace {

/// Largest memory for the states of a run [bytes].
constexpr double kMostMemory = 4e9;
/// Part of the run within which two times at which steps end are the same.
constexpr double kSameStop = 1e-12;

double bytes_of(const State& state) {
  return static_cast<double>(state.blocks.size() * sizeof(BodyBlock) +
                             8 * (state.lambda.size() + state.history.size()));
}

[[noreturn]] void refuse_memory(double bytes) {
  throw InputError("analysis.duration",
                   format("is too long for a gradient: its states need {:.1f} GB", 1e-9 * bytes),
                   "Take longer steps, or a shorter run");
}

/// Members of the step that ended at a state: the last single step is one of the member with the
/// most.
int members_of(const State& reached, double H) {
  return std::max(1, static_cast<int>(std::lround(0.5 * H / reached.dt_last)));
}

std::unique_ptr<NewtonEngine> engine_of(const Simulation& simulation) {
  return std::move(choose_method(simulation.system(), simulation.model()).engine);
}

}  // namespace

TapeMemory::TapeMemory(const State& state) : bytes_(bytes_of(state)) {}

void TapeMemory::expect(double states) const {
  if (bytes_ * states > kMostMemory) refuse_memory(bytes_ * states);
}

void TapeMemory::add(const std::vector<TapeMember>& members) {
  for (const TapeMember& m : members) states_ += static_cast<double>(m.states.size());
  states_ += 1.0;
  expect(states_);
}

std::int64_t RunTape::single_steps() const {
  std::size_t sum = 0;
  for (const std::vector<TapeMember>& step : members)
    for (const TapeMember& member : step) sum += member.lengths.size();
  return static_cast<std::int64_t>(sum);
}

TapeRecorder::TapeRecorder(const Simulation& simulation)
    : system_(&simulation.system()),
      single_(simulation.system(), engine_of(simulation),
              GeneralizedAlpha::from_spectral_radius(simulation.model().analysis.rho_inf),
              lane_kernels(simulation.model().analysis.isa),
              simulation.model().analysis.conserving) {
  const Method method = choose_method(simulation.system(), simulation.model());
  ga_ = method.ga;
  control_ = method.control;
  if (control_.extrapolated)
    table_ = std::make_unique<ExtrapolationTable>(simulation.system(), control_.order, single_);
  else if (control_.order > 2)
    stages_ =
        composition_stages(control_.order, control_.order > 4 && simulation.system().rows() > 0);
}

TapeMember TapeRecorder::chain(const State& from, const std::vector<double>& lengths,
                               SingleStep::Predictor predictor, std::size_t kept) {
  TapeMember member{.lengths = lengths, .states = {}};
  State next = from;
  for (std::size_t k = 0; k < kept; ++k) {
    NewtonReport report = single_.take(next, lengths[k], control_.newton, predictor);
    if (!report.converged) report = single_.take(next, lengths[k], control_.newton, {-1});
    if (!report.converged) throw SolveError(report.text(), "Take a shorter step");
    member.states.push_back(next);
  }
  single_.ledger().forget();
  return member;
}

std::vector<TapeMember> TapeRecorder::record(const State& from, const TakenStep& step) {
  std::vector<TapeMember> members;
  if (step.members == 1) {
    std::vector<double> lengths = table_ ? std::vector<double>{1.0} : stages_;
    for (double& length : lengths) length *= step.length;
    members.push_back(chain(from, lengths, {-1, false, false}, lengths.size() - 1));
    return members;
  }
  for (const int n : extrapolation_substeps(2 * step.members)) {
    const auto count = static_cast<std::size_t>(n);
    members.push_back(chain(from, std::vector<double>(count, step.length / n),
                            {step_control::kMemberDegree, false, true}, count));
  }
  return members;
}

void TapeRecorder::take(State& state, const TakenStep& step) {
  const State before = state;
  NewtonReport report;
  for (const bool fresh : {false, true}) {  // a prediction may fail with other parameters
    state = before;
    if (step.members > 1) {
      report = table_->advance(state, {1.0}, step.length, single_, control_.newton,
                               {.columns = step.members, .allowed = 0.0, .fresh = fresh});
    } else {
      const std::vector<double> one{1.0};
      for (const double part : table_ ? one : stages_) {
        report =
            single_.take(state, part * step.length, control_.newton, {fresh ? -1 : 1, false, true});
        if (!report.converged) break;
      }
    }
    single_.ledger().forget();
    if (report.converged) break;
  }
  if (!report.converged) throw SolveError(report.text(), "Take a shorter step");
  state.t = before.t + step.length;
}

bool TapeRecorder::touched() const {
  const BodyContacts* contacts = system_->contacts().get();
  return single_.jumped() || single_.stopped() || (contacts && contacts->touched());
}

RunTape run_onto_tape(Simulation& simulation, const std::vector<double>& stops) {
  RunTape tape;
  const Model& model = simulation.model();
  require_end(model.analysis);
  const double end = model.analysis.duration;
  TapeRecorder recorder(simulation);
  TapeMemory memory(simulation.state());
  if (model.analysis.step) memory.expect(end / *model.analysis.step);
  const bool extrapolates = choose_method(simulation.system(), model).control.extrapolated;
  tape.ends.push_back(simulation.state());
  std::size_t stop = 0;
  while (simulation.time() < end * (1.0 - 1e-9)) {
    while (stop < stops.size() && stops[stop] <= simulation.time() + kSameStop * end) ++stop;
    const double limit =
        model.analysis.step || stop == stops.size() ? end : std::min(stops[stop], end);
    const StepReport report = simulation.step(limit);
    if (!report.accepted)
      throw SolveError(report.message, "The run must end before it has a gradient");
    if (recorder.method().delta != 0.0 && simulation.state().rates_dt == 0.0 &&
        simulation.time() < end * (1.0 - 1e-9))
      throw InputError("analysis.rho_inf",
                       format("is {:g}, and at t = {:.6g} s a function has a break: accelerations "
                              "begin anew there, which has no derivative yet",
                              recorder.method().rho_inf, simulation.time()),
                       "Use rho_inf: 1, or a smooth function");
    if (report.dt == 0.0) {
      tape.ends.back().t = simulation.time();
      continue;
    }
    const State& reached = simulation.state();
    const TakenStep step{report.dt, extrapolates ? members_of(reached, report.dt) : 1};
    tape.members.push_back(recorder.record(tape.ends.back(), step));
    tape.sequence.push_back(step);
    tape.ends.push_back(reached);
    memory.add(tape.members.back());
  }
  return tape;
}

RunTape replay(const Simulation& simulation, const StepSequence& sequence) {
  RunTape tape;
  TapeRecorder recorder(simulation);
  TapeMemory memory(simulation.state());
  State state = simulation.state();
  tape.ends.push_back(state);
  tape.sequence = sequence;
  for (const TakenStep& step : sequence) {
    tape.members.push_back(recorder.record(tape.ends.back(), step));
    recorder.take(state, step);
    tape.ends.push_back(state);
    memory.add(tape.members.back());
  }
  return tape;
}

StepSequence halved(const StepSequence& sequence) {
  StepSequence halves;
  for (const TakenStep& step : sequence)
    halves.insert(halves.end(), 2, {0.5 * step.length, step.members});
  return halves;
}

}  // namespace polhode
