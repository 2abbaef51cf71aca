// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/contact/contact_set.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/model/switched_contacts.hpp>
#include <polhode/simulation/event_watch.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode {

namespace {

/// Difference of times, as a part of a step, below which they are equal.
constexpr double kSameEventTime = 1e-9;

/// Rejects bodies that are also in contact with surfaces of solids, whose contact cannot be
/// switched.
void refuse_surfaces(const Simulation& simulation, const EventSpec& event, const std::string& name,
                     int body, int other) {
  if (other != kEverySide) return;
  for (const ContactMap::Surface& surface : simulation.contact_map().surfaces)
    if (surface.side == body)
      throw InputError(format("events.{}", event.name),
                       format("'{}' touches '{}', a contact that cannot be switched", name,
                              simulation.model().side_name(surface.own)),
                       "Name pairs of bodies instead, or exclude the two in contacts");
}

}  // namespace

EventWatch::EventWatch(const Simulation& simulation, const SystemMap& map)
    : system_(&simulation.system()), events_(&map.events) {
  const Model& model = simulation.model();
  for (const EventSpec& event : *events_) {
    Watched w;
    const auto add = [&](const std::vector<std::string>& names, std::vector<int>& interactions,
                         std::vector<int>& contacts, std::vector<int>& controllers) {
      for (const std::string& name : names) {
        if (const auto sides = switched_contact(model, name)) {
          const auto [a, b] = *sides;
          refuse_surfaces(simulation, event, name, a, b);
          if (map.contacts)
            contacts.push_back(
                map.contacts->switch_of(a, b == kEverySide ? contact::kEveryOwner : b));
          continue;
        }
        if (const int controller = switched_controller(model, name); controller >= 0) {
          controllers.push_back(controller);
          continue;
        }
        const SwitchTarget target = switch_target(model, name);
        interactions.push_back((target.joint ? map.joint : map.load)[at(target.index)]);
      }
    };
    add(event.on, w.on, w.contacts_on, w.controllers.on);
    add(event.off, w.off, w.contacts_off, w.controllers.off);
    if (event.when)
      w.channel =
          ChannelReader(simulation, map, event.when->channel, format("events.{}.when", event.name));
    if (!event.after.empty()) {
      std::vector<std::string> names;
      for (const EventSpec& other : *events_) {
        if (other.name == event.after) w.after = static_cast<int>(names.size());
        names.push_back(other.name);
      }
      if (w.after < 0)
        throw InputError(format("events.{}.after", event.name),
                         format("unknown event '{}'", event.after),
                         did_you_mean(event.after, names) + "Events: " + name_list(names));
    }
    watched_.push_back(std::move(w));
  }
}

double EventWatch::beyond(const Simulation& simulation, int event) const {
  const ConditionSpec& c = *(*events_)[at(event)].when;
  const double x = watched_[at(event)].channel.value(simulation);
  return c.above ? x - c.level : c.level - x;
}

bool EventWatch::ready(const State& state, int event) const {
  const int after = watched_[at(event)].after;
  return memory(state, event, EventMemory::kSpent) == 0.0 &&
         (after < 0 || memory(state, after, EventMemory::kCount) > 0.0);
}

double EventWatch::next_time(const State& state) const {
  double next = std::numeric_limits<double>::infinity();
  for (int e = 0; e < static_cast<int>(events_->size()); ++e)
    if ((*events_)[at(e)].at && ready(state, e)) next = std::min(next, *(*events_)[at(e)].at);
  return next;
}

bool EventWatch::watches(const State& state) const {
  for (int e = 0; e < static_cast<int>(events_->size()); ++e)
    if ((*events_)[at(e)].when && ready(state, e)) return true;
  return false;
}

std::vector<double> EventWatch::margins(const Simulation& simulation) const {
  std::vector<double> list(events_->size(), std::numeric_limits<double>::quiet_NaN());
  for (int e = 0; e < static_cast<int>(events_->size()); ++e)
    if ((*events_)[at(e)].when && ready(simulation.state(), e)) list[at(e)] = beyond(simulation, e);
  return list;
}

std::vector<int> EventWatch::due(const Simulation& simulation) const {
  const State& state = simulation.state();
  std::vector<int> list;
  for (int e = 0; e < static_cast<int>(events_->size()); ++e) {
    const EventSpec& event = (*events_)[at(e)];
    if (!ready(state, e)) continue;
    const bool now = event.at ? *event.at <= state.t + kSameEventTime * state.dt_last
                              : event.when && beyond(simulation, e) >= 0.0;
    if (now) list.push_back(e);
  }
  return list;
}

void EventWatch::rearm(const Simulation& simulation, State& state) const {
  for (int e = 0; e < static_cast<int>(events_->size()); ++e)
    if ((*events_)[at(e)].repeat && memory(state, e, EventMemory::kSpent) != 0.0 &&
        beyond(simulation, e) < 0.0)
      state.history[place(e, EventMemory::kSpent)] = 0.0;
}

void EventWatch::note(State& state, int event, double lost, double impulse) const {
  state.history[place(event, EventMemory::kCount)] += 1.0;
  state.history[place(event, EventMemory::kTime)] = state.t;
  state.history[place(event, EventMemory::kSpent)] = 1.0;
  state.history[place(event, EventMemory::kLost)] = lost;
  state.history[place(event, EventMemory::kImpulse)] = impulse;
}

int EventWatch::stopped(const State& state) const {
  for (int e = 0; e < static_cast<int>(events_->size()); ++e)
    if ((*events_)[at(e)].stop && memory(state, e, EventMemory::kCount) > 0.0) return e;
  return -1;
}

}  // namespace polhode
