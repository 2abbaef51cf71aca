// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/gradient/event_margin.hpp>

namespace polhode {

namespace {

[[noreturn]] void refuse_watched(const EventSpec& event) {
  throw InputError(
      format("events.{}.when", event.name),
      format("watches '{}', whose time has no derivative yet", event.when->channel.name),
      "Watch a position or a velocity of a body, or a coordinate of a joint");
}

/// Reader of the channel that an event watches, by a probe of its own.
OutcomeReader reader_of(const Model& model, const SystemMap& map, const EventSpec& event) {
  Model with_probe = model;
  ProbeSpec probe = event.when->channel.of;
  probe.name = "of event " + event.name;
  with_probe.output.probes.push_back(probe);
  try {
    return OutcomeReader(with_probe, map,
                         format("probes.{}.{}", probe.name, event.when->channel.name));
  } catch (const InputError&) {
    refuse_watched(event);
  }
}

}  // namespace

EventMargin::EventMargin(const Model& model, const SystemMap& map, const EventSpec& event)
    : reader_(reader_of(model, map, event)),
      sign_(event.when->above ? 1.0 : -1.0),
      level_(event.when->level) {}

std::vector<std::optional<EventMargin>> event_margins(const Model& model, const SystemMap& map) {
  std::vector<std::optional<EventMargin>> margins;
  for (const EventSpec& event : model.events) {
    margins.emplace_back();
    if (event.when) margins.back().emplace(model, map, event);
  }
  return margins;
}

std::vector<double> event_counts(const System& system, const State& state, std::size_t events) {
  std::vector<double> counts;
  for (std::size_t e = 0; e < events; ++e)
    counts.push_back(state.history[static_cast<std::size_t>(system.memory()) +
                                   EventMemory::kSize * e + EventMemory::kCount]);
  return counts;
}

void require_differentiable_events(const Model& model, const System& system, const SystemMap& map) {
  const auto refuse = [](const EventSpec& event, const char* key, const std::string& what,
                         const char* hint) {
    throw InputError(format("events.{}{}", event.name, key), what, hint);
  };
  for (const EventSpec& event : model.events) {
    if (!event.on.empty() && !(event.at && *event.at <= 0.0))
      refuse(event, ".on", "switches on, with a jump of velocities that has no derivative yet",
             "Switch off only, or compare runs");
    if (event.repeat)
      refuse(event, ".repeat", "makes it occur again, which has no derivative yet",
             "Write an event for each time");
    for (const std::string& name : event.off) try {
        (void)switch_target(model, name);
      } catch (const InputError&) {
        refuse(event, ".off",
               format("switches '{}' off, which is no joint or load: no derivative yet", name),
               "Switch joints and loads");
      }
  }
  const std::vector<std::optional<EventMargin>> margins = event_margins(model, map);
  for (std::size_t e = 0; e < margins.size(); ++e) try {
      if (margins[e]) (void)margins[e]->value(system, system.initial_state());
    } catch (const InputError&) {
      refuse_watched(model.events[e]);
    }
}

}  // namespace polhode
