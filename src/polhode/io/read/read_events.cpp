// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/compile/build_surface_contacts.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/model/switched_contacts.hpp>

namespace polhode::io {

namespace {

std::optional<ConditionSpec> read_condition(ReadContext& context, const SourceNode& node,
                                            const std::string& path) {
  Section section(context, node, context.tree.place_of(node), path, condition_fields());
  if (!node.is_map()) return std::nullopt;
  ConditionSpec condition;
  auto channel = read_channel(context, section);
  if (section.refuse_both("above", "below", "Give one of them.") || !channel) return std::nullopt;
  condition.channel = std::move(channel->spec);
  condition.above = !section.has("below");
  const std::string key = condition.above ? "above" : "below";
  const SourceNode* level = section.find(key);
  if (!level) {
    section.fault("has no level", "Give above or below.");
    return std::nullopt;
  }
  Field field = condition_fields().at(key);
  field.dimension = channel->dimension;
  const auto value = read_number(context, *level, section.path(key), field);
  if (!value) return std::nullopt;
  condition.level = *value;
  return condition;
}

/// First surface in contact with a body that is to be switched as a whole; contact with surfaces
/// cannot be switched.
std::optional<std::string> surface_met(const Model& model, const std::array<int, 2>& sides) {
  if (sides[1] != kEverySide) return std::nullopt;
  std::vector<InputError> told_elsewhere;
  for (const SurfacePair& pair : plan_surface_contacts(model, &told_elsewhere))
    if (pair.side == sides[0]) return model.side_name(pair.own);
  return std::nullopt;
}

void read_targets(ReadContext& context, Section& section, const char* key,
                  std::vector<std::string>& names) {
  const auto list = section.names(key);
  if (!list) return;
  for (const std::string& name : *list) {
    try {
      const auto sides = switched_contact(context.model, name);
      if (!sides && switched_controller(context.model, name) < 0)
        (void)switch_target(context.model, name);
      if (const auto surface = sides ? surface_met(context.model, *sides) : std::nullopt) {
        section.fault(key,
                      format("{} touches {}, a contact that cannot be switched", quote(name),
                             quote(*surface)),
                      "Name pairs of bodies instead, or exclude the two in contacts.");
        return;
      }
    } catch (const InputError& e) {
      section.fault(key, e.what_is_wrong(), e.hint() + ".");
      return;
    }
  }
  names = *list;
}

void read_event(ReadContext& context, const SourceNode& node, EventSpec& event) {
  Section section(context, node, event.place, "events." + event.name, event_fields());
  if (!node.is_map()) return;
  if (section.refuse_both("at", "when", "Give one of them.")) return;
  event.at = section.number("at");
  const SourceNode* when = section.find("when");
  if (when) event.when = read_condition(context, *when, section.path("when"));
  if (!section.has("at") && !when && !section.has_unknown_key())
    section.fault("never occurs", "Give at (a time) or when (a condition).");
  if (const auto after = section.text("after")) event.after = *after;
  read_targets(context, section, "off", event.off);
  read_targets(context, section, "on", event.on);
  event.repeat = section.boolean("repeat").value_or(false);
  event.stop = section.boolean("stop").value_or(false);
  if (event.repeat && event.at)
    section.fault("repeat", "cannot be combined with 'at'", "A time occurs once: give 'when'.");
  if (!section.has("on") && !section.has("off") && !event.stop && !section.has_unknown_key())
    section.fault("does nothing", "Give off, on, or stop: true.");
  for (const std::string& name : event.on)
    if (std::find(event.off.begin(), event.off.end(), name) != event.off.end())
      section.fault("on", format("{} is switched off by the same event", quote(name)),
                    "Name it once.");
}

}  // namespace

void read_events(ReadContext& context, const SourceNode& node) {
  for (std::size_t k = 0; k < node.keys.size(); ++k) {
    const SourceNode::Key& key = node.keys[k];
    if (!check_name(context, key, node.children[k], "events")) continue;
    EventSpec event;
    event.name = key.name;
    event.place = context.tree.place_of(key, node.children[k]);
    read_event(context, node.children[k], event);
    context.model.events.push_back(std::move(event));
  }
  for (const EventSpec& event : context.model.events) {
    if (event.after.empty()) continue;
    std::vector<std::string> names;
    for (const EventSpec& other : context.model.events)
      if (other.name != event.name) names.push_back(other.name);
    if (std::find(names.begin(), names.end(), event.after) != names.end()) continue;
    context.diagnostics.add(
        event.place, "events." + event.name + ".after",
        event.after == event.name ? "an event cannot wait for itself"
                                  : "unknown event " + quote(event.after),
        did_you_mean(event.after, names) + (names.empty() ? "The model has no other event."
                                                          : "Events: " + name_list(names) + "."));
  }
}

}  // namespace polhode::io
