// SPDX-License-Identifier: Apache-2.0
// Steps of a Simulation whose model has events or controllers.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <polhode/simulation/first_crossing.hpp>
#include <polhode/simulation/simulation_impl.hpp>
#include <polhode/simulation/switch_contacts.hpp>

namespace polhode {

namespace {

/// Part of a step by which it is lengthened if an event seems to follow within it: this avoids a
/// tiny step.
constexpr double kReach = 0.9e-3;
/// Safety factor on the slope of a margin between evaluations [-].
constexpr double kMoreThanSecant = 1.5;
/// Accuracy of an event in time, as a part of the step.
constexpr double kSameInstant = 1e-13;
/// Shortest steps from the start of a step within which an event is at the start.
constexpr double kAtTheStart = 2.0;

bool any_reached(const std::vector<double>& margins) {
  return std::any_of(margins.begin(), margins.end(), [](double m) { return m >= 0.0; });
}

/// Whether a margin seems to reach zero within kReach of a step after its end. An infinite margin,
/// of an unknown gap, is not near.
bool any_near(const std::vector<double>& start, const std::vector<double>& end) {
  for (std::size_t e = 0; e < end.size(); ++e)
    if (std::isfinite(start[e]) && std::isfinite(end[e]) &&
        end[e] + kMoreThanSecant * kReach * (end[e] - start[e]) >= 0.0)
      return true;
  return false;
}

}  // namespace

StepReport Simulation::advance(double t_limit) {
  Impl& s = *impl_;
  s.notice_held();
  if (!s.events && !s.controllers) return s.advance(t_limit);
  StepReport report;
  if (!s.events) {
    report =
        s.advance(std::min(t_limit, s.controllers->next_time(s.state, std::min(t_limit, s.end()))));
    if (report.accepted) s.let_act(*this, report);
    return report;
  }
  if (s.state.ledger.steps == 0 && !let_events_come(report)) return report;
  const EventWatch& events = *s.events;
  for (;;) {
    double limit = std::min(t_limit, events.next_time(s.state));
    if (s.controllers)
      limit = std::min(limit, s.controllers->next_time(s.state, std::min(limit, s.end())));
    const Impl::Reached before = s.reached();
    const bool watches = events.watches(s.state);
    const std::vector<double> margins = watches ? events.margins(*this) : std::vector<double>{};
    report = s.take(limit);
    if (!report.accepted) return report;
    if (watches) {
      s.due_at_start = s.find_event(*this, before, margins, limit, report);
      if (!s.due_at_start.empty()) {
        s.go_to(before);
        if (!let_events_come(report)) return report;
        report = StepReport{};
        report.accepted = true;
        report.t = s.state.t;
        if (s.controllers) s.let_act(*this, report);
        if (report.accepted && !s.stopped()) continue;
        return report;
      }
    }
    if (report.dt != 0.0) s.settle_step();
    // One that occurred just before its margin was zero stays spent until a step has passed that.
    if (report.dt != 0.0) events.rearm(*this, s.state);
    if (!let_events_come(report)) {
      s.go_to(before);
    } else if (s.controllers) {
      s.let_act(*this, report);
    }
    return report;
  }
}

/// @eq{event-time}
std::vector<int> Simulation::Impl::find_event(const Simulation& simulation, const Reached& before,
                                              const std::vector<double>& start, double limit,
                                              StepReport& report) {
  if (report.dt == 0.0) return {};  // the limit was reached without a step
  const double t_0 = before.state.t;
  std::vector<double> now = events->margins(simulation);
  const auto take_to = [&](double t) {
    go_to(before);
    const StepReport r = take(t);
    if (r.accepted) now = events->margins(simulation);
    return r;
  };
  if (!any_reached(now)) {
    const double longer = state.t + kReach * (state.t - t_0);
    if (longer > limit || !any_near(start, now)) return {};
    const Reached ordinary = reached();
    const StepReport r = take_to(longer);
    if (!r.accepted || !any_reached(now)) {
      go_to(ordinary);
      return {};
    }
    report = r;
  }
  Reached found = reached();
  const Reached whole = found;
  const StepReport of_whole = report;
  const double H = state.t - t_0, shortest = shortest_step(before.state);
  FirstCrossing first(
      start, now, H,
      std::max(kSameInstant * H, 4.0 * std::numeric_limits<double>::epsilon() * std::abs(state.t)));
  while (!first.found()) {
    const double least = kAtTheStart * shortest;
    if (first.far_side() <= least) break;
    const StepReport r = take_to(t_0 + std::max(first.next(), least));
    if (!r.accepted) break;
    if (!first.add(state.t - t_0, now)) continue;
    found = reached();
    report = r;
  }
  if (first.far_side() <= kAtTheStart * shortest * (1.0 + kReach)) return first.crossed();
  // What is nearer to the end of the step than any step is short is there.
  const bool at_end = whole.state.t - found.state.t < shortest;
  if (at_end) report = of_whole;
  go_to(at_end ? whole : found);
  return {};
}

bool Simulation::let_events_come(StepReport& report) {
  Impl& s = *impl_;
  const EventWatch& events = *s.events;
  std::vector<int> due = std::exchange(s.due_at_start, {});
  if (due.empty()) due = events.due(*this);
  for (; !due.empty(); due = events.due(*this))
    for (const int e : due) {
      SwitchReport done;
      const EventSpec& event = events.events()[static_cast<std::size_t>(e)];
      const bool at_start = event.at && *event.at <= 0.0;  // the start was assembled with it
      if (!at_start && s.map.contacts) {
        const auto overlaps = switch_contacts(s.system, *s.map.contacts, s.state,
                                              events.contacts_on(e), events.contacts_off(e));
        if (!overlaps.empty()) {
          report.accepted = false;
          report.message = s.cannot_touch(event, overlaps);
          return false;
        }
      }
      if (s.controllers && !events.controllers(e).empty()) {
        s.controllers->switch_over(s.state, events.controllers(e));
        s.stepper->forces_jump(s.state);
      }
      if (!at_start && (!event.on.empty() || !event.off.empty())) {
        done = s.stepper->switch_over(s.state, events.on(e), events.off(e));
        s.forget_instant();
        if (s.statics) s.statics->switched(s.state);
      }
      if (done.worst >= 0 || !done.solved) {
        report.accepted = false;
        report.message = s.cannot_switch(event, done);
        return false;
      }
      events.note(s.state, e, done.lost, done.impulse);
    }
  return true;
}

}  // namespace polhode
