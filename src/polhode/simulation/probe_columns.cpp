// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/compile/joint_resistance.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/joints/joint.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/loads/registry.hpp>
#include <polhode/model/velocity_jumps.hpp>
#include <polhode/simulation/body_columns.hpp>
#include <polhode/simulation/momentum_columns.hpp>
#include <polhode/simulation/probe_columns.hpp>

namespace polhode {

namespace {

std::vector<std::string> vector_header(const std::string& prefix, const std::string& unit) {
  std::vector<std::string> cells;
  for (const char* axis : {"x", "y", "z"}) cells.push_back(format("{}{} [{}]", prefix, axis, unit));
  return cells;
}

void append(std::vector<std::string>& list, const std::vector<std::string>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

/// Columns of friction and stops.
void extend_by_resistance(std::vector<std::string>& header, const JointResistance& resistance,
                          const std::vector<std::string>& coordinates) {
  const auto unit = [](const std::string& name) { return name[0] == 'r' ? "N m" : "N"; };
  if (resistance.friction) {
    for (const std::string& name : coordinates)
      header.push_back(format("friction {} [{}]", name, unit(name)));
    header.emplace_back("slips [-]");
  }
  if (resistance.slide)
    header.emplace_back(coordinates.front() == "distance" ? "stop distance [N]" : "stop z [N]");
  if (resistance.turn) header.emplace_back("stop rz [N m]");
}

/// Free coordinates of a joint, whose names do not depend on its position.
std::vector<std::string> coordinates_of(const JointSpec& spec) {
  JointParameters parameters{.free = spec.free, .values = spec.parameters};
  parameters.values.try_emplace("distance", 1.0);
  const JointRecipe recipe = joint_kind(spec.type).recipe({}, parameters);
  return Joint(spec.name, spec.type, {0, kGround}, recipe).coordinate_names();
}

std::vector<std::string> joint_header(const Model& model, const JointSpec& spec) {
  std::vector<std::string> header;
  append(header, vector_header("f", "N"));
  append(header, vector_header("m", "N m"));
  const std::vector<std::string> names = coordinates_of(spec);
  for (const char* quantity : {"", "rate "})
    for (const std::string& name : names)
      header.push_back(format("{}{} [{}{}]", quantity, name, name[0] == 'r' ? "rad" : "m",
                              *quantity == '\0' ? "" : "/s"));
  if (spec.friction || spec.limits || spec.angle_limits)
    extend_by_resistance(header, joint_resistance(model, spec), names);
  if (spec.motion) header.insert(header.end(), {"power [W]", "work [J]"});
  if (!velocities_may_jump(model)) return header;
  append(header, vector_header("impulse ", "N s"));
  append(header, vector_header("angular impulse ", "N m s"));
  return header;
}

std::vector<std::string> load_header(const LoadSpec& spec) {
  std::vector<std::string> header;
  for (const LoadChannel& channel : load_kind(spec.type).channels) {
    if (channel.size == 3)  // by its letter, which is an acceleration's of an angular momentum
      append(header,
             vector_header(channel.unit == "N m s" ? channel.name + " " : channel.name.substr(0, 1),
                           channel.unit));
    else
      header.push_back(format("{} [{}]", channel.name, channel.unit));
  }
  return header;
}

std::vector<std::string> solid_header(bool interface, bool stress) {
  std::vector<std::string> header;
  if (interface) {
    append(header, vector_header("f", "N"));
    append(header, vector_header("m", "N m"));
    return header;
  }
  append(header, vector_header("", "m"));
  append(header, vector_header("u", "m"));
  append(header, vector_header("v", "m/s"));
  if (!stress) return header;
  for (const char* component : {"xx", "yy", "zz", "xy", "yz", "xz"})
    header.push_back(format("s{} [Pa]", component));
  header.emplace_back("von_mises [Pa]");
  return header;
}

std::vector<std::string> beam_header() {
  std::vector<std::string> header;
  append(header, vector_header("f", "N"));
  append(header, vector_header("m", "N m"));
  append(header, vector_header("strain ", "-"));
  append(header, vector_header("curvature ", "1/m"));
  return header;
}

std::vector<std::string> contact_header() {
  std::vector<std::string> header{"gap [m]", "normal [N]"};
  append(header, vector_header("f", "N"));
  append(header, vector_header("ft", "N"));
  append(header, vector_header("p", "m"));
  append(header, std::vector<std::string>{"points [-]", "status [-]", "impulse [N s]", "lost [J]"});
  return header;
}

std::vector<std::string> cable_header(const CableLineSpec& cable) {
  std::vector<std::string> header{"tension [N]", "length [m]"};
  if (cable.slides) header.insert(header.end(), {"rate [m/s]", "energy [J]"});
  if (cable.muscle)
    header.insert(header.end(), {"fibre_length [m]", "activation [-]", "passive [N]"});
  return header;
}

/// A vector whose magnitude has its own name.
struct Magnitude {
  const char *prefix, *name;
};
constexpr Magnitude kMagnitudes[] = {{"v", "speed"}, {"f", "force"}, {"m", "moment"}};

/// Description of the object of a channel.
std::string thing_of(const Model& model, const ProbeSpec& spec) {
  return spec.kind == "contact" ? format("contact of '{}' and '{}'", model.side_name(spec.pair[0]),
                                         model.side_name(spec.pair[1]))
                                : format("{} '{}'", spec.kind, spec.target);
}

}  // namespace

std::vector<std::string> probe_columns(const Model& model, const ProbeSpec& spec) {
  const auto of = [&](const auto& list, int index) -> const auto& {
    return list[static_cast<std::size_t>(index)];
  };
  if (spec.kind == "body") return body_columns(spec);
  if (spec.kind == "momentum") return momentum_columns();
  if (spec.kind == "joint")
    return joint_header(model, of(model.joints, model.joint_index(spec.target)));
  if (spec.kind == "load") return load_header(of(model.loads, model.load_index(spec.target)));
  if (spec.kind == "solid") return solid_header(!spec.reaction_of.empty(), spec.stress);
  if (spec.kind == "beam") return beam_header();
  if (spec.kind == "cable") return cable_header(of(model.cables, model.cable_index(spec.target)));
  if (spec.kind == "contact") return contact_header();
  return {"setpoint [SI]", "channel [SI]", "output [SI]"};
}

std::vector<ProbeNumber> channel_columns(const Model& model, const ProbeSpec& spec) {
  std::vector<ProbeNumber> list;
  for (const std::string& header : probe_columns(model, spec)) {
    const std::size_t bracket = header.rfind(" [");
    list.push_back({header.substr(0, bracket),
                    header.substr(bracket + 2, header.size() - bracket - 3),
                    static_cast<int>(list.size()), 1});
  }
  const auto find = [&](const std::string& name) {
    return std::find_if(list.begin(), list.end(), [&](const auto& c) { return c.name == name; });
  };
  for (const Magnitude& m : kMagnitudes) {
    const auto first = find(format("{}x", m.prefix));
    if (first == list.end() || find(m.name) != list.end()) continue;
    const ProbeNumber whole{m.name, first->unit, first->column, 3};
    list.push_back(whole);
  }
  return list;
}

ProbeNumber find_channel(const Model& model, const ChannelSpec& channel, const std::string& where) {
  const std::vector<ProbeNumber> columns = channel_columns(model, channel.of);
  std::vector<std::string> names;
  for (const ProbeNumber& c : columns) {
    if (c.name == channel.name) return c;
    names.push_back(c.name);
  }
  throw InputError(
      where, format("'{}' is no channel of the {}", channel.name, thing_of(model, channel.of)),
      did_you_mean(channel.name, names) + "Channels: " + name_list(names, names.size()));
}

bool is_mean_of_step(const ChannelSpec& channel) {
  return channel.of.kind == "contact" && channel.name != "gap" && channel.name != "impulse" &&
         channel.name != "lost";
}

}  // namespace polhode
