// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/gradient/located_run.hpp>
#include <polhode/model/endless.hpp>

namespace polhode {

namespace {

/// Gap at which a closing is located, in gaps that count as touching: the row is still open and
/// without impulse, and its impact follows; and the bounds of it.
constexpr double kAimedGap = 0.5, kLeastGap = 0.05;
/// Trials of one location.
constexpr int kMostTrials = 100;
/// Parts of the way to a predicted closing that are tried, one after the other, behind it.
constexpr double kShorterWays[] = {0.9, 0.7, 0.5};
/// Times, as a part of a step, between two closings that cannot be told apart.
constexpr double kSameClosing = 1e-9;
/// Speed of approach, as a part of the bodies' speeds, below which a body only grazes; and that of
/// a row that stays closed.
constexpr double kGrazing = 1e-3, kStill = 1e-9;
/// Rest of a step behind a closing, as a part of it, that is joined to the next step.
constexpr double kShortRest = 1e-6;
/// Impacts within one step of the grid that are a body that comes to rest.
constexpr int kMostImpacts = 20;
/// Part of the run within which two times are the same.
constexpr double kSameEnd = 1e-12;

/// The state at the end of a step with the velocities of its motion, before an impact there.
State before_impact(const System& system, const State& from, const State& to, double dt) {
  State state = to;
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyMotion m = system.motion(from, b);
    BodyMotion n = system.motion(to, b);
    const Quat turn = m.q.conjugate() * n.q;
    n.v = 2.0 / dt * (n.r - m.r) - m.v;
    n.W = 4.0 / dt / turn.w() * turn.vec() - m.W;
    state.set_motion(system.slot(b), n);
  }
  return state;
}

/// Steps that end at closings.
class Locator {
 public:
  explicit Locator(const Simulation& simulation)
      : system_(simulation.system()),
        step_(*simulation.model().analysis.step),
        recorder_(simulation),
        rows_(simulation.system(), step_) {}

  TapeRecorder& recorder() { return recorder_; }
  /// Takes a step of at most this length, which becomes its own. @returns the row that closes.
  std::optional<InstantRow> take(State& state, double& length);

 private:
  enum class Side { before, at, beyond };
  /// An end of a trial: the row that may close first, with its gap and rate.
  struct Look {
    double at = 0.0;
    std::optional<InstantRow> row;
    double rate = 0.0;
  };
  [[noreturn]] void refuse(const InstantRow& row, const std::string& what,
                           const std::string& hint) const {
    throw InputError(rows_.name(row), what, hint);
  }
  [[nodiscard]] Look look(const State& state, double at, double time);
  Side trial(const State& from, double length, State& state);
  [[nodiscard]] double next(double low, double high, std::size_t misses) const;
  void check(const InstantRow& row, const State& before, const State& after);

  const System& system_;
  double step_;
  TapeRecorder recorder_;
  InstantRows rows_;
  Look low_;                   ///< At the longest step that ends before a closing.
  std::optional<Look> lower_;  ///< At the one before.
};

/// The row that is reached first at the present rates.
Locator::Look Locator::look(const State& state, double at, double time) {
  Look look{.at = at, .row = {}, .rate = 0.0};
  double first = std::numeric_limits<double>::infinity();
  for (InstantRow& row : rows_.ahead(state, time)) {
    const double rate = rows_.speed(state, row);
    if (!(rate < 0.0) || !(row.gap / -rate < first)) continue;
    first = row.gap / -rate;
    look.rate = rate;
    look.row = std::move(row);
  }
  return look;
}

Locator::Side Locator::trial(const State& from, double length, State& state) {
  state = from;
  try {
    recorder_.take(state, {length, 1});
  } catch (const SolveError&) {
    state = from;
    return Side::beyond;
  }
  const bool touched = recorder_.touched();
  const State end = before_impact(system_, from, state, length);
  if (touched) {
    const double touching = system_.touching_gap();
    double least = std::numeric_limits<double>::infinity();
    for (const InstantRow& row : rows_.ahead(end, step_)) least = std::min(least, row.gap);
    return least >= kLeastGap * touching && least <= touching ? Side::at : Side::beyond;
  }
  lower_ = low_;
  low_ = look(end, length, step_);
  return Side::before;
}

/// Length of the next trial: that at which the gap is as aimed at, by its rate and the change of
/// this. @param misses  Number of trials since the last one that ended before the closing.
double Locator::next(double low, double high, std::size_t misses) const {
  const double middle = 0.5 * (low + high);
  if (!low_.row || misses > std::size(kShorterWays)) return middle;
  const double gap = low_.row->gap - kAimedGap * system_.touching_gap();
  double way = gap / -low_.rate;
  if (lower_ && lower_->row && lower_->row->interaction == low_.row->interaction &&
      lower_->row->number == low_.row->number && low_.at > lower_->at) {
    // gap + rate s + a s²/2 = 0
    const double a = (low_.rate - lower_->rate) / (low_.at - lower_->at);
    const double square = low_.rate * low_.rate - 2.0 * a * gap;
    if (square > 0.0) way = 2.0 * gap / (-low_.rate + std::sqrt(square));
  }
  if (misses > 0) way *= kShorterWays[misses - 1];
  const double length = low + way;
  return length > low && length < high ? length : middle;
}

std::optional<InstantRow> Locator::take(State& state, double& length) {
  const State from = state;
  double low = 0.0, high = length;
  lower_.reset();
  low_ = look(from, 0.0, length);
  Side side = trial(from, length, state);
  if (side == Side::before) return std::nullopt;
  for (const InstantRow& row : rows_.ahead(from, length))
    if (row.gap <= system_.touching_gap() &&
        rows_.speed(from, row) <= kStill * rows_.size_of_speed(from, row))
      refuse(row, format("is closed at t = {:.6g} s: one that lasts has no derivative yet", from.t),
             "Start with a gap, and end the run before it comes to rest");
  low_ = look(from, 0.0, length);
  std::size_t misses = 0;
  for (int k = 0; side != Side::at; ++k) {
    if (k == kMostTrials || high - low <= 1e-15 * high)
      throw InputError("contacts",
                       format("close at t = {:.6g} s in a way that is not located: a row acts "
                              "before its gap is zero, or the step is not accepted",
                              from.t + low),
                       "Take a shorter step, or compare runs");
    const double at = next(low, high, misses);
    side = trial(from, at, state);
    if (side == Side::before) {
      low = at;
      misses = 0;
    } else if (side == Side::beyond) {
      high = at;
      ++misses;
    }
    length = at;
  }
  State before = before_impact(system_, from, state, length);
  Look found = look(before, length, step_);
  if (found.row) {  // so that runs with neighbouring numbers end at the same gap
    const double at = length + (found.row->gap - kAimedGap * system_.touching_gap()) / -found.rate;
    State again;
    if (at > low && at < high && trial(from, at, again) == Side::at) {
      state = std::move(again);
      length = at;
      before = before_impact(system_, from, state, length);
      found = look(before, length, step_);
    }
  }
  if (!found.row)
    throw InputError("contacts", format("close at t = {:.6g} s without any approach", state.t),
                     "Look for bodies that only graze");
  check(*found.row, before, state);
  return found.row;
}

/// Refuses closings without a derivative.
void Locator::check(const InstantRow& row, const State& before, const State& after) {
  const double t = before.t;
  for (const InstantRow& other : rows_.ahead(before, step_)) {
    const bool same =
        other.interaction == row.interaction && other.number == row.number &&
        (!row.is_contact() || (other.place == row.place && other.a == row.a && other.b == row.b));
    const double rate = rows_.speed(before, other);
    if (same || !(rate < 0.0) || other.gap > -rate * kSameClosing * step_) continue;
    refuse(row,
           format("closes at t = {:.6g} s together with {}: which of both is first depends on the "
                  "parameters, and the derivative is one-sided",
                  t, rows_.name(other)),
           "Move one of them, so that they close one after the other");
  }
  if (row.friction > 0.0)
    refuse(row,
           format("has friction, and closes at t = {:.6g} s: impacts with friction have no "
                  "derivative yet",
                  t),
           "Leave friction out, or compare runs");
  if (-rows_.speed(before, row) <= kGrazing * rows_.size_of_speed(before, row))
    refuse(row, format("only grazes at t = {:.6g} s, where there is no derivative", t),
           "Choose a motion that touches clearly, or not at all");
  if (rows_.speed(after, row) <= kStill * rows_.size_of_speed(before, row))
    refuse(row,
           format("stays closed from t = {:.6g} s on: one that lasts has no derivative yet", t),
           "Give it a restitution, or end the run before");
}

}  // namespace

RunTape run_onto_located_tape(Simulation& simulation) {
  const Model& model = simulation.model();
  require_end(model.analysis);
  const double end = model.analysis.duration, h = *model.analysis.step;
  RunTape tape;
  Locator locator(simulation);
  TapeMemory memory(simulation.state());
  memory.expect(end / h);
  State state = simulation.state();
  tape.ends.push_back(state);
  int impacts = 0;
  for (double point = 1.0; state.t < end * (1.0 - kSameEnd);) {
    const double grid = std::min(point * h, end);
    const bool last = grid >= end * (1.0 - kSameEnd);
    double length = (last ? end : grid) - state.t;
    if (length <= kShortRest * h) {
      if (last)
        throw InputError("analysis.duration",
                         format("ends at an impact, t = {:.6g} s, where the outcome jumps", end),
                         "End the run a little earlier or later");
      ++point;
      continue;
    }
    const std::optional<InstantRow> closing = locator.take(state, length);
    if (!closing) {
      state.t = last ? end : grid;
      ++point;
      impacts = 0;
    } else if (++impacts > kMostImpacts) {
      throw InputError("contacts",
                       format("close more than {} times within the step before t = {:.6g} s: a "
                              "body comes to rest, which has no derivative yet",
                              kMostImpacts, grid),
                       "End the run before, or take a shorter step");
    }
    tape.members.push_back(locator.recorder().record(tape.ends.back(), {length, 1}));
    tape.sequence.push_back({length, 1});
    tape.closings.push_back(closing);
    tape.events.push_back(-1);
    tape.ends.push_back(state);
    memory.add(tape.members.back());
  }
  return tape;
}

/// @eq{located-step}
RunTape run_onto_event_tape(Simulation& simulation, const SystemMap& map) {
  const Model& model = simulation.model();
  require_end(model.analysis);
  const System& system = simulation.system();
  const double end = model.analysis.duration;
  RunTape tape;
  tape.margins = event_margins(model, map);
  TapeRecorder recorder(simulation);
  TapeMemory memory(simulation.state());
  memory.expect(end / *model.analysis.step);
  tape.ends.push_back(simulation.state());
  while (simulation.time() < end * (1.0 - kSameEnd) && !simulation.stopped()) {
    const std::vector<double> before = event_counts(system, tape.ends.back(), model.events.size());
    const StepReport report = simulation.step(end);
    if (!report.accepted)
      throw SolveError(report.message, "The run must end before it has a gradient");
    const State& reached = simulation.state();
    const std::vector<double> after = event_counts(system, reached, model.events.size());
    int event = -1, count = 0;
    for (std::size_t e = 0; e < after.size(); ++e) {
      if (after[e] == before[e]) continue;
      ++count;
      if (model.events[e].when) event = static_cast<int>(e);
    }
    if (event >= 0 && (count > 1 || report.dt == 0.0))
      throw InputError(
          format("events.{}", model.events[static_cast<std::size_t>(event)].name),
          format("occurs at t = {:.6g} s {}, where the derivative is one-sided", reached.t,
                 count > 1 ? "together with another one" : "at the start of a step"),
          "Take another step, or move one of them");
    if (report.dt == 0.0) {
      tape.ends.back() = reached;
      continue;
    }
    // The multipliers of joints that are switched off now are those of the step before that.
    tape.members.push_back(recorder.record(tape.ends.back(), {report.dt, 1}));
    if (count > 0) {
      State own = tape.ends.back();
      recorder.take(own, {report.dt, 1});
      tape.members.back().front().states.push_back(std::move(own));
    }
    tape.sequence.push_back({report.dt, 1});
    tape.closings.emplace_back();
    tape.events.push_back(event);
    tape.ends.push_back(reached);
    memory.add(tape.members.back());
  }
  return tape;
}

}  // namespace polhode
