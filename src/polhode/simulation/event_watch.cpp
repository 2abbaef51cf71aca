// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/loads/registry.hpp>
#include <polhode/simulation/event_watch.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode {

namespace {

/// Two times closer than this part of a step are the same.
constexpr double kSameEventTime = 1e-9;

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

EventWatch::EventWatch(const Model& model, const SystemMap& map, const System& system)
    : model_(&model), map_(&map), system_(&system), events_(&map.events) {
  for (const EventSpec& event : *events_) {
    Watched w;
    for (const auto& [names, list] : {std::pair(&event.on, &w.on), std::pair(&event.off, &w.off)})
      for (const std::string& name : *names) {
        const SwitchTarget target = switch_target(model, name);
        list->push_back((target.joint ? map.joint : map.load)[at(target.index)]);
      }
    if (event.when) w.channel = channel(event);
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

EventWatch::Channel EventWatch::channel(const EventSpec& event) const {
  const ChannelSpec& spec = event.when->channel;
  Channel c;
  std::vector<std::string> names;
  std::size_t positions = 0;
  if (spec.kind == "body") {
    c.index = model_->body_index(spec.target);
    names = body_channels();
    positions = 3;
  } else if (spec.kind == "joint") {
    c.index = model_->joint_index(spec.target);
    const Joint& joint = joint_at(*system_, map_->joint[at(c.index)]);
    names = joint_channels(joint);
    positions = joint.coordinate_names().size();
  } else {
    c.index = model_->load_index(spec.target);
    names = load_channels(model_->loads[at(c.index)].type);
  }
  const auto found = std::find(names.begin(), names.end(), spec.name);
  if (found == names.end())
    throw InputError(format("events.{}.when.channel", event.name),
                     format("'{}' is no channel of the {} '{}'", spec.name, spec.kind, spec.target),
                     did_you_mean(spec.name, names) + "Channels: " + name_list(names));
  c.component = static_cast<int>(found - names.begin());
  c.of_positions = at(c.component) < positions;
  return c;
}

double EventWatch::value(const Simulation& simulation, const ChannelSpec& spec,
                         const Channel& channel) const {
  const State& state = simulation.state();
  const std::size_t k = at(channel.component);
  if (spec.kind == "load") return simulation.load(channel.index)[k];
  if (spec.kind == "body") {
    const int body = map_->body[at(channel.index)];
    if (channel.of_positions && body != kGround) {
      const BodyMotion m = system_->motion(state, body);
      return (m.r + m.q * spec.point)[channel.component];
    }
    const Simulation::PointMotion m = simulation.point(channel.index, spec.point);
    if (k == 9) return m.velocity.norm();
    return (k < 3 ? m.position : k < 6 ? m.velocity : m.acceleration)[channel.component % 3];
  }
  const int interaction = map_->joint[at(channel.index)];
  if (channel.of_positions) {
    const PairView view =
        system_->instant(state, system_->interactions()[at(interaction)], nullptr);
    return joint_at(*system_, interaction).coordinates(view.step()).value[k];
  }
  const JointReport report = simulation.joint(channel.index);
  const std::size_t count = report.coordinates.size();
  if (k < 2 * count) return report.rates[k - count];
  const int rest = channel.component - 2 * static_cast<int>(count);
  if (rest >= 6) return rest == 6 ? report.force.norm() : report.moment.norm();
  return (rest < 3 ? report.force : report.moment)[rest % 3];
}

double EventWatch::beyond(const Simulation& simulation, int event) const {
  const ConditionSpec& c = *(*events_)[at(event)].when;
  const double x = value(simulation, c.channel, watched_[at(event)].channel);
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

double EventWatch::margin(const Simulation& simulation) const {
  double first = -std::numeric_limits<double>::infinity();
  for (int e = 0; e < static_cast<int>(events_->size()); ++e)
    if ((*events_)[at(e)].when && ready(simulation.state(), e))
      first = std::max(first, beyond(simulation, e));
  return first;
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
