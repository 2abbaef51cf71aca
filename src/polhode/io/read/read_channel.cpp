// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/loads/registry.hpp>

namespace polhode {

Dimension channel_dimension(const ReadContext& context, const ChannelSpec& channel) {
  using namespace dimensions;
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

std::optional<ChannelSpec> read_channel(ReadContext& context, Section& section) {
  ChannelSpec channel;
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
  if (!name) return std::nullopt;
  channel.name = *name;
  return channel;
}

}  // namespace polhode
