// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/contact/contact_set.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/simulation/channel_reader.hpp>
#include <polhode/simulation/separate_overlaps.hpp>

namespace polhode {

namespace {

/// Possible names of the derivative of a number, in order of preference.
std::vector<std::string> rates_of(const std::string& name) {
  std::vector<std::string> names = {"rate " + name};
  if (name == "x" || name == "y" || name == "z") names.push_back("v" + name);
  if (name == "ux" || name == "uy" || name == "uz") names.push_back("v" + name.substr(1));
  if (name == "vx" || name == "vy" || name == "vz") names.push_back("a" + name.substr(1));
  if (name == "wx" || name == "wy" || name == "wz") names.push_back("alpha" + name.substr(1));
  if (name == "length" || name == "angle") names.emplace_back("rate");
  return names;
}

}  // namespace

ChannelReader::ChannelReader(const Simulation& simulation, const SystemMap& map,
                             const ChannelSpec& spec, const std::string& where)
    : target_(probe_target(simulation, spec.of, where)),
      column_(find_channel(simulation.model(), spec, where + ".channel")),
      map_(&map) {
  const std::string& kind = spec.of.kind;
  if (kind == "body") of_positions_ = spec.of.seen_from == kGround && column_.column < 3;
  if (kind == "joint") {
    const Joint& joint =
        joint_at(simulation.system(), map.joint[static_cast<std::size_t>(target_.index)]);
    const std::vector<std::string> names = joint.coordinate_names();
    const auto found = std::find(names.begin(), names.end(), spec.name);
    of_positions_ = found != names.end();
    coordinate_ = static_cast<std::size_t>(found - names.begin());
  }
}

ChannelReader ChannelReader::rate(const Simulation& simulation, const std::string& where) const {
  const std::vector<ProbeNumber> columns = channel_columns(simulation.model(), target_.spec);
  for (const std::string& name : rates_of(column_.name)) {
    const auto found = std::find_if(columns.begin(), columns.end(),
                                    [&](const ProbeNumber& c) { return c.name == name; });
    if (found == columns.end()) continue;
    ChannelReader rate = *this;
    rate.column_ = *found;
    rate.of_positions_ = false;
    return rate;
  }
  throw InputError(where, format("needs the rate of '{}', which is not available", column_.name),
                   "Name a coordinate of a joint, or position or velocity of a body or solid");
}

double ChannelReader::value(const Simulation& simulation) const {
  const State& state = simulation.state();
  const System& system = simulation.system();
  const auto index = static_cast<std::size_t>(target_.index);
  if (of_positions_ && target_.spec.kind == "joint") {
    const int interaction = map_->joint[index];
    const PairView view = system.instant(
        state, system.interactions()[static_cast<std::size_t>(interaction)], nullptr);
    return joint_at(system, interaction).coordinates(view.step()).value[coordinate_];
  }
  if (of_positions_ && map_->body[index] != kGround) {
    const BodyMotion m = system.motion(state, map_->body[index]);
    return (m.r + m.q * target_.spec.point)[column_.column];
  }
  const std::vector<double> row = probe_row(target_, simulation);
  const double* numbers = row.data() + 1 + column_.column;
  if (column_.size == 3) return Vec3(numbers[0], numbers[1], numbers[2]).norm();
  return std::isnan(*numbers) ? far_gap(simulation) : *numbers;
}

/// Gap of shapes that are far apart: contacts compute gaps of nearby shapes only.
double ChannelReader::far_gap(const Simulation& simulation) const {
  const auto [a, b] = target_.spec.pair;
  const contact::ContactSet* contacts = simulation.contact_set();
  if (target_.spec.kind != "contact" || !contacts || !a.is_body() || !b.is_body())
    return std::numeric_limits<double>::infinity();
  return contacts->distance(a.index, b.index, instants_of(simulation.system(), simulation.state()));
}

}  // namespace polhode
