// SPDX-License-Identifier: Apache-2.0
// Steps of a Simulation whose model has events or controllers.
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/simulation/simulation_impl.hpp>
#include <polhode/simulation/switch_contacts.hpp>

namespace polhode {

namespace {

/// Part of a step by which it is lengthened if an event seems to follow within it: this avoids a
/// tiny step.
constexpr double kReach = 0.9e-3;
/// Safety factor on the slope of a margin between evaluations [-].
constexpr double kMoreThanSecant = 1.5;
/// Accuracy of an event: margin as a part of its change over the step, or time as a part of the
/// step.
constexpr double kFound = 1e-13;
constexpr int kMaxLooks = 60;

}  // namespace

/// @eq{event-time}
StepReport Simulation::advance(double t_limit) {
  Impl& s = *impl_;
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
  double limit = std::min(t_limit, events.next_time(s.state));
  if (s.controllers)
    limit = std::min(limit, s.controllers->next_time(s.state, std::min(limit, s.end())));
  const bool watches = events.watches(s.state);
  const Impl::Reached before = s.reached();
  const double margin = watches ? events.margin(*this) : 0.0;
  report = s.take(limit);
  if (!report.accepted) return report;
  if (watches) s.find_event(*this, before, margin, limit, report);
  s.settle_step();
  events.rearm(*this, s.state);
  if (!let_events_come(report)) {
    s.go_to(before);
  } else if (s.controllers) {
    s.let_act(*this, report);
  }
  return report;
}

void Simulation::Impl::find_event(const Simulation& simulation, const Reached& before,
                                  double margin, double limit, StepReport& report) {
  const auto take_to = [&](double t) {
    go_to(before);
    StepReport r = take(t);
    return std::pair(r, r.accepted ? events->margin(simulation) : 0.0);
  };
  double beyond = events->margin(simulation);
  if (beyond < 0.0) {
    // An infinite margin, of an unknown gap, is not near.
    const double H = state.t - before.state.t, longer = state.t + kReach * H;
    if (std::isinf(beyond) || std::isinf(margin) ||
        beyond + kMoreThanSecant * kReach * (beyond - margin) < 0.0 || longer > limit)
      return;
    const Reached ordinary = reached();
    const auto [r, at_end] = take_to(longer);
    if (!r.accepted || at_end < 0.0) {
      go_to(ordinary);
      return;
    }
    report = r;
    beyond = at_end;
  }
  // Regula falsi with the Illinois modification; the state stays on the side where the condition
  // holds.
  Reached found = reached();
  const double t_0 = before.state.t;
  double low = 0.0, high = state.t - t_0, at_low = margin, at_high = beyond;
  const bool far = std::isinf(margin) || std::isinf(beyond);
  const double close = far ? 0.0 : kFound * (beyond - margin), H = high;
  const double same =
      std::max(kFound * H, 4.0 * std::numeric_limits<double>::epsilon() * std::abs(state.t));
  int side = 0;
  for (int k = 0; k < kMaxLooks && beyond > close && high - low > same; ++k) {
    const double secant = std::isinf(at_low) || std::isinf(at_high)
                              ? 0.5 * (low + high)
                              : (low * at_high - high * at_low) / (at_high - at_low);
    const double x = std::clamp(secant + 0.25 * same, low + 0.25 * same, high - 0.25 * same);
    const auto [r, m] = take_to(t_0 + x);
    if (!r.accepted) break;
    const double length = state.t - t_0;
    if (m >= 0.0) {
      high = length;
      at_high = beyond = m;
      found = reached();
      report = r;
      if (side > 0) at_low *= 0.5;
      side = 1;
    } else {
      low = length;
      at_low = m;
      if (side < 0) at_high *= 0.5;
      side = -1;
    }
  }
  go_to(found);
}

bool Simulation::let_events_come(StepReport& report) {
  Impl& s = *impl_;
  const EventWatch& events = *s.events;
  for (std::vector<int> due = events.due(*this); !due.empty(); due = events.due(*this))
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
      if (!at_start && (!event.on.empty() || !event.off.empty())) {
        done = s.stepper->switch_over(s.state, events.on(e), events.off(e));
        s.forget_instant();
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
