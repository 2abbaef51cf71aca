// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/loads/registry.hpp>
#include <polhode/simulation/channel_reader.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode {

namespace {

std::vector<std::string> with_axes(const std::string& prefix) {
  return {prefix + "x", prefix + "y", prefix + "z"};
}

void add(std::vector<std::string>& list, const std::vector<std::string>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

std::vector<std::string> body_channels() {
  std::vector<std::string> list = with_axes("");
  for (const char* prefix : {"v", "a"}) add(list, with_axes(prefix));
  list.emplace_back("speed");
  return list;
}

std::vector<std::string> joint_channels(const Joint& joint) {
  std::vector<std::string> list = joint.coordinate_names();
  for (const std::string& name : joint.coordinate_names()) list.push_back("rate " + name);
  for (const char* prefix : {"f", "m"}) add(list, with_axes(prefix));
  add(list, {"force", "moment"});
  return list;
}

std::vector<std::string> load_channels(const std::string& type) {
  std::vector<std::string> list;
  for (const LoadChannel& c : load_kind(type).channels)
    add(list, c.size == 3 ? with_axes(c.name.substr(0, 1)) : std::vector<std::string>{c.name});
  return list;
}

}  // namespace

ChannelReader::ChannelReader(const Model& model, const SystemMap& map, const System& system,
                             const ChannelSpec& spec, const std::string& where)
    : spec_(spec), map_(&map), system_(&system) {
  std::vector<std::string> names;
  int positions = 0;
  if (spec.kind == "body") {
    index_ = model.body_index(spec.target);
    names = body_channels();
    positions = rate_step_ = 3;
    with_rate_ = 6;
  } else if (spec.kind == "joint") {
    index_ = model.joint_index(spec.target);
    const Joint& joint = joint_at(system, map.joint[static_cast<std::size_t>(index_)]);
    names = joint_channels(joint);
    positions = rate_step_ = with_rate_ = static_cast<int>(joint.coordinate_names().size());
  } else {
    index_ = model.load_index(spec.target);
    names = load_channels(model.loads[static_cast<std::size_t>(index_)].type);
  }
  const auto found = std::find(names.begin(), names.end(), spec.name);
  if (found == names.end())
    throw InputError(where,
                     format("'{}' is no channel of the {} '{}'", spec.name, spec.kind, spec.target),
                     did_you_mean(spec.name, names) + "Channels: " + name_list(names));
  component_ = static_cast<int>(found - names.begin());
  of_positions_ = component_ < positions;
}

ChannelReader ChannelReader::rate(const std::string& where) const {
  if (component_ >= with_rate_)
    throw InputError(where, format("asks for the rate of '{}', which is not reported", spec_.name),
                     "Name a coordinate of a joint, or position or velocity of a body");
  ChannelReader rate = *this;
  rate.component_ += rate_step_;
  rate.of_positions_ = false;
  return rate;
}

double ChannelReader::value(const Simulation& simulation) const {
  const State& state = simulation.state();
  const auto k = static_cast<std::size_t>(component_), index = static_cast<std::size_t>(index_);
  if (spec_.kind == "load") return simulation.load(index_)[k];
  if (spec_.kind == "body") {
    const int body = map_->body[index];
    if (of_positions_ && body != kGround) {
      const BodyMotion m = system_->motion(state, body);
      return (m.r + m.q * spec_.point)[component_];
    }
    const Simulation::PointMotion m = simulation.point(index_, spec_.point);
    if (k == 9) return m.velocity.norm();
    return (k < 3 ? m.position : k < 6 ? m.velocity : m.acceleration)[component_ % 3];
  }
  const int interaction = map_->joint[index];
  if (of_positions_) {
    const PairView view = system_->instant(
        state, system_->interactions()[static_cast<std::size_t>(interaction)], nullptr);
    return joint_at(*system_, interaction).coordinates(view.step()).value[k];
  }
  const JointReport report = simulation.joint(index_);
  const std::size_t count = report.coordinates.size();
  if (k < 2 * count) return report.rates[k - count];
  const int rest = component_ - 2 * static_cast<int>(count);
  if (rest >= 6) return rest == 6 ? report.force.norm() : report.moment.norm();
  return (rest < 3 ? report.force : report.moment)[rest % 3];
}

}  // namespace polhode
