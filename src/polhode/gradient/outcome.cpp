// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <map>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/gradient/outcome.hpp>
#include <polhode/gradient/step_derivative.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/stepping/instant.hpp>

namespace polhode {

namespace {

/// Step of differences by places, as a part of the mechanism's size or in radians.
/// Its fourth power is the truncation error of order four, 1e-12; round-off is 1e-16 over it.
constexpr double kStateStep = 1e-3;

int component_of(const std::string& name) {
  return name.size() == 1 && name[0] >= 'x' && name[0] <= 'z' ? name[0] - 'x' : -1;
}

/// The channel with its list and its quantity replaced by the closest there are.
std::string nearest_channel(const std::string& channel) {
  std::string near = channel;
  const auto mend = [&near](std::size_t from, std::size_t to,
                            const std::vector<std::string>& known) {
    if (const std::string word = closest(near.substr(from, to - from), known); !word.empty())
      near.replace(from, to - from, word);
  };
  const std::size_t last = near.rfind('.');
  if (last == std::string::npos) return {};
  const std::size_t before = near.rfind('.', last - 1);
  const std::size_t first = near.find('.');
  if (before != std::string::npos && before > first)
    mend(before + 1, last, {"position", "velocity", "angular_velocity", "coordinates"});
  mend(0, first, {"bodies", "probes", "joints"});
  return near == channel ? std::string() : near;
}

[[noreturn]] void refuse_channel(const std::string& channel) {
  const std::string near = nearest_channel(channel);
  throw InputError(
      "the outcome", format("'{}' is not a position or velocity", channel),
      (near.empty() ? std::string() : format("Did you mean '{}'? ", near)) +
          "Name bodies.NAME.position.x, bodies.NAME.velocity.x, bodies.NAME.angular_velocity.x, "
          "probes.NAME.x, probes.NAME.vx or joints.NAME.COORDINATE; forces and accelerations have "
          "no "
          "gradient yet");
}

}  // namespace

Outcome parse_outcome(const std::string& text) {
  Outcome outcome{.text = text, .channel = text};
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos) return outcome;
  outcome.channel = text.substr(0, at);
  const std::string when = text.substr(at + 1);
  if (when == "end") return outcome;
  for (const auto& [name, of_run] :
       {std::pair("mean", Outcome::At::mean), std::pair("integral", Outcome::At::integral),
        std::pair("max", Outcome::At::maximum), std::pair("min", Outcome::At::minimum)})
    if (when == name) {
      outcome.at = of_run;
      return outcome;
    }
  char* end = nullptr;
  outcome.time = std::strtod(when.c_str(), &end);
  if (when.empty() || *end != '\0' || !(outcome.time >= 0.0))
    throw InputError(
        "the outcome", format("'{}' has an unknown time '{}'", text, when),
        "Write CHANNEL@end, CHANNEL@mean, CHANNEL@integral, CHANNEL@max, CHANNEL@min, or "
        "CHANNEL@0.25 with a time in seconds");
  outcome.at = Outcome::At::time;
  return outcome;
}

OutcomeReader::OutcomeReader(const Model& model, const SystemMap& map, const std::string& channel)
    : channel_(channel) {
  const std::size_t first = channel.find('.'), last = channel.rfind('.');
  if (first == std::string::npos || last == first) refuse_channel(channel);
  const std::string list = channel.substr(0, first), end = channel.substr(last + 1);
  std::string name = channel.substr(first + 1, last - first - 1);
  if (list == "bodies") {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos) refuse_channel(channel);
    const std::string quantity = name.substr(dot + 1);
    name = name.substr(0, dot);
    component_ = component_of(end);
    what_ = quantity == "velocity"           ? What::velocity
            : quantity == "angular_velocity" ? What::turn
                                             : What::position;
    if (component_ < 0 || (what_ == What::position && quantity != "position"))
      refuse_channel(channel);
    set_body(model, map, name);
  } else if (list == "probes") {
    const ProbeSpec& probe = model.output.probes[static_cast<std::size_t>(model.probe_index(name))];
    if (probe.kind == "joint") {
      set_joint(model, map, probe.target, end);
      return;
    }
    if (probe.kind != "body" || probe.seen_from != kGround) refuse_channel(channel);
    const bool v = end.size() == 2 && end[0] == 'v', w = end.size() == 2 && end[0] == 'w';
    if (w && probe.axes == "body") refuse_channel(channel);
    what_ = v ? What::velocity : w ? What::turn : What::position;
    component_ = component_of(v || w ? end.substr(1) : end);
    if (component_ < 0) refuse_channel(channel);
    set_body(model, map, probe.target);
    Z_ = probe.point;
  } else if (list == "joints") {
    const std::string whole = ".coordinates";  // by number, as in results
    const bool numbered = name.size() > whole.size() && name.ends_with(whole);
    if (numbered) name.resize(name.size() - whole.size());
    set_joint(model, map, name, end);
    if (numbered) set_number(model, end);
  } else {
    refuse_channel(channel);
  }
  if (what_ != What::coordinate)
    unit_ = what_ == What::position ? "m" : what_ == What::velocity ? "m/s" : "rad/s";
}

void OutcomeReader::set_body(const Model& model, const SystemMap& map, const std::string& name) {
  const int body = model.body_index(name);
  body_ = body == kGround ? kGround : map.body[static_cast<std::size_t>(body)];
  if (body_ == kGround)
    throw InputError("the outcome",
                     format("'{}' is of a fixed body, which depends on nothing", channel_),
                     "Name a moving body");
}

void OutcomeReader::set_joint(const Model& model, const SystemMap& map, const std::string& name,
                              const std::string& coordinate) {
  const int index = model.joint_index(name);
  joint_ = map.joint[static_cast<std::size_t>(index)];
  what_ = What::coordinate;
  coordinate_ = coordinate;
  unit_ = coordinate.empty() || coordinate[0] == 'r' ? "rad" : "m";
}

void OutcomeReader::set_number(const Model& model, const std::string& number) {
  const System system = build_system(model);
  const std::vector<std::string> names = joint_at(system, joint_).coordinate_names();
  const std::size_t i = number.size() == 1 && number[0] >= '0' && number[0] <= '5'
                            ? static_cast<std::size_t>(number[0] - '0')
                            : names.size();
  if (i >= names.size()) refuse_channel(channel_);
  coordinate_ = names[i];
  unit_ = coordinate_[0] == 'r' ? "rad" : "m";
}

double OutcomeReader::value(const System& system, const State& state) const {
  if (!of_velocity()) return value_there(system, state);
  State projected = state;
  (void)project_velocities(system, projected);
  return value_there(system, projected);
}

double OutcomeReader::value_there(const System& system, const State& state) const {
  if (what_ == What::coordinate) return coordinate(system, state);
  const BodyMotion m = system.motion(state, body_);
  if (what_ == What::position) return (m.r + m.q * Z_)[component_];
  const Vec3 omega = m.omega();
  return (what_ == What::turn ? omega : Vec3(m.v + omega.cross(m.q * Z_)))[component_];
}

double OutcomeReader::coordinate(const System& system, const State& state) const {
  const Joint& joint = joint_at(system, joint_);
  const std::vector<std::string> names = joint.coordinate_names();
  const auto found = std::find(names.begin(), names.end(), coordinate_);
  if (found == names.end()) {
    std::string known;
    for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
    throw InputError("the outcome",
                     format("joint '{}' has no coordinate '{}'", joint.name, coordinate_),
                     known.empty() ? std::string("Name a position of a body")
                                   : format("Its coordinates: {}", known));
  }
  const PairView view =
      system.instant(state, system.interactions()[static_cast<std::size_t>(joint_)], nullptr);
  return joint.coordinates(view.step()).value[static_cast<std::size_t>(found - names.begin())];
}

std::vector<OutcomeReader> readers_of(const Model& model, const SystemMap& map,
                                      const std::vector<Outcome>& outcomes) {
  std::map<std::string, OutcomeReader> known;
  std::vector<OutcomeReader> readers;
  for (const Outcome& outcome : outcomes)
    readers.push_back(
        known.try_emplace(outcome.channel, model, map, outcome.channel).first->second);
  return readers;
}

OutcomeSlope OutcomeReader::slope(const System& system, const State& state) const {
  if (!of_velocity()) return {.by_state = by_state_there(system, state), .at = state};
  ProjectionDerivative projection(system);
  projection.linearize_velocities(state);
  OutcomeSlope slope{.by_state = by_state_there(system, projection.projected()),
                     .at = projection.projected()};
  slope.by_inputs = projection.pull(slope.by_state);
  slope.stages = projection.stages();
  return slope;
}

/// Derivative by the state whose velocities are read as they are.
Vec OutcomeReader::by_state_there(const System& system, const State& state) const {
  if (what_ == What::coordinate) return coordinate_by_state(system, state);
  Vec by = Vec::Zero(kStateNumbers * system.body_count());
  const BodyMotion m = system.motion(state, body_);
  const Vec3 e = Vec3::Unit(component_), z = m.q * Z_, omega = m.omega();
  const int at = kStateNumbers * body_;
  if (what_ == What::position) {
    by.segment<3>(at) = e;
    by.segment<3>(at + 3) = z.cross(e);
  } else if (what_ == What::turn) {
    by.segment<3>(at + 3) = omega.cross(e);
    by.segment<3>(at + 9) = m.q.conjugate() * e;
  } else {
    by.segment<3>(at + 3) = omega.cross(z.cross(e)) + z.cross(e.cross(omega));
    by.segment<3>(at + 6) = e;
    by.segment<3>(at + 9) = m.q.conjugate() * z.cross(e);
  }
  return by;
}

Vec OutcomeReader::coordinate_by_state(const System& system, const State& state) const {
  Vec by = Vec::Zero(kStateNumbers * system.body_count());
  const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(joint_)];
  State moved = state;
  for (const int b : {ref.a, ref.b}) {
    if (b == kGround) continue;
    const BodyMotion m = system.motion(state, b);
    const int slot = system.slot(b);
    for (int i = 0; i < 6; ++i) {
      const double d = kStateStep * (i < 3 ? system.length_scale() : 1.0);
      const auto at = [&](double x) {
        BodyMotion n = m;
        const Vec3 step = x * Vec3::Unit(i % 3);
        if (i < 3)
          n.r += step;
        else
          n.q = (quaternion_from_rotation_vector(step) * m.q).normalized();
        moved.set_motion(slot, n);
        return value_there(system, moved);
      };
      by[kStateNumbers * b + i] =
          (2.0 / 3.0 * (at(d) - at(-d)) - 1.0 / 12.0 * (at(2.0 * d) - at(-2.0 * d))) / d;
    }
    moved.set_motion(slot, m);
  }
  return by;
}

}  // namespace polhode
