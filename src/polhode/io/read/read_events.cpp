// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/loads/registry.hpp>

namespace polhode {

namespace {

using namespace dimensions;

/// Dimension of a channel's number; none for names that do not exist, which are told later.
Dimension dimension_of(const ReadContext& context, const ChannelSpec& channel) {
  const std::string& name = channel.name;
  if (channel.kind == "load") {
    const auto found = context.loads.find(channel.target);
    if (found == context.loads.end()) return kNone;
    const LoadSpec& load = context.model.loads[static_cast<std::size_t>(found->second)];
    if (load.solid >= 0) return kNone;
    for (const LoadChannel& c : load_kind(load.type).channels)
      if (c.name == name || (c.size == 3 && name.size() == 2 && name[0] == c.name[0]))
        return read_unit(c.unit).unit.value_or(Unit{}).dimension;
    return kNone;
  }
  if (channel.kind == "body")
    return name == "speed" || name.starts_with('v') ? kVelocity
           : name.starts_with('a')                  ? kAcceleration
                                                    : kLength;
  if (name.starts_with("rate ")) return name.starts_with("rate r") ? kAngularVelocity : kVelocity;
  if (name.starts_with('f')) return kForce;
  if (name.starts_with('m')) return kMoment;
  return name.starts_with('r') ? kAngle : kLength;
}

std::optional<ConditionSpec> read_condition(ReadContext& context, const SourceNode& node,
                                            const std::string& path) {
  Section section(context, node, context.tree.place_of(node), path, condition_fields());
  if (!node.is_map()) return std::nullopt;
  ConditionSpec condition;
  ChannelSpec& channel = condition.channel;
  int targets = 0;
  for (const char* kind : {"body", "joint", "load"})
    if (section.has(kind)) {
      channel.kind = kind;
      ++targets;
    }
  if (targets != 1) {
    section.fault(targets == 0 ? "names nothing that reports" : "names more than one thing",
                  "Give one of: body, joint, load.");
    return std::nullopt;
  }
  if (section.has("point") && channel.kind != "body")
    section.fault("point", format("does not go with '{}'", channel.kind), "It belongs to a body.");
  if (channel.kind == "body") {
    const auto body = section.body("body");
    const auto point = section.vector("point");
    if (!body) return std::nullopt;
    if (*body == kGround) {
      section.fault("body", "the ground does not move", "Name a body.");
      return std::nullopt;
    }
    const BodySpec& spec = context.model.bodies[static_cast<std::size_t>(*body)];
    channel.target = spec.name;
    channel.point = point.value_or(Vec3::Zero()) - spec.com;
    if (!point) channel.point.setZero();
  } else {
    const auto name = section.text(channel.kind);
    if (!name) return std::nullopt;
    const bool joint = channel.kind == "joint";
    const auto& known = joint ? context.joints : context.loads;
    const std::vector<std::string> names = joint ? context.joint_names() : context.load_names();
    if (!known.contains(*name)) {
      section.fault(channel.kind, format("unknown {} {}", channel.kind, quote(*name)),
                    did_you_mean(*name, names) +
                        (names.empty() ? format("The model has no {}s.", channel.kind)
                                       : format("Known are: {}.", name_list(names))));
      return std::nullopt;
    }
    channel.target = *name;
    if (!joint && context.model.loads[static_cast<std::size_t>(known.at(*name))].solid >= 0) {
      section.fault("load", format("{} acts on a solid and reports nothing", quote(*name)),
                    "Name a load on bodies.");
      return std::nullopt;
    }
  }
  const auto name = section.text("channel");
  if (section.refuse_both("above", "below", "Give one of them.") || !name) return std::nullopt;
  channel.name = *name;
  condition.above = !section.has("below");
  const std::string key = condition.above ? "above" : "below";
  const SourceNode* level = section.find(key);
  if (!level) {
    section.fault("has no level", "Give above or below.");
    return std::nullopt;
  }
  Field field = condition_fields().at(key);
  field.dimension = dimension_of(context, channel);
  const auto value = read_number(context, *level, section.path(key), field);
  if (!value) return std::nullopt;
  condition.level = *value;
  return condition;
}

void read_targets(ReadContext& context, Section& section, const char* key,
                  std::vector<std::string>& names) {
  const auto list = section.names(key);
  if (!list) return;
  for (const std::string& name : *list) {
    try {
      (void)switch_target(context.model, name);
    } catch (const InputError& e) {
      section.fault(key, e.what_is_wrong(), e.mend() + ".");
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
    section.fault("never comes", "Give at (a time) or when (a condition).");
  if (const auto after = section.text("after")) event.after = *after;
  read_targets(context, section, "off", event.off);
  read_targets(context, section, "on", event.on);
  event.repeat = section.boolean("repeat").value_or(false);
  event.stop = section.boolean("stop").value_or(false);
  if (event.repeat && event.at)
    section.fault("repeat", "does not go with 'at'", "A time comes once: give when.");
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
        event.after == event.name ? "an event does not wait for itself"
                                  : "unknown event " + quote(event.after),
        did_you_mean(event.after, names) + (names.empty() ? "The model has no other event."
                                                          : "Events: " + name_list(names) + "."));
  }
}

}  // namespace polhode
