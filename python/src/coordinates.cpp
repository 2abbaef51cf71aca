// SPDX-License-Identifier: Apache-2.0
#include "coordinates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <polhode/compile/build_system.hpp>
#include <polhode/system/unilateral_row.hpp>

namespace polhode::python {

namespace {

/// The angle of a joint in a state, with the turns counted there.
template <class SomeState, class Angle>
auto& counted(const System& system, SomeState& state, const Angle& angle) {
  const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(angle.interaction)];
  return state.history[static_cast<std::size_t>(ref.first_history + angle.history)];
}

/// Interactions with rows that a state can switch off.
std::vector<int> switched_rows(const System& system) {
  std::vector<int> list;
  for (int i = 0; i < static_cast<int>(system.interactions().size()); ++i) {
    const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(i)];
    if (ref.rows > 0 && system.traits(ref).off >= 0) list.push_back(i);
  }
  return list;
}

std::vector<int> off_of(const System& system, const State& state, const std::vector<int>& among) {
  std::vector<int> list;
  for (const int i : among)
    if (system.is_off(state, i)) list.push_back(i);
  return list;
}

std::vector<std::string> names_of(const System& system, const std::vector<int>& interactions) {
  std::vector<std::string> names;
  for (const int i : interactions)
    names.push_back(system.name(system.interactions()[static_cast<std::size_t>(i)]));
  return names;
}

}  // namespace

Coordinates::Coordinates(const Model& model, const System& system, const State& state,
                         const std::vector<std::string>& preferred)
    : switched_(switched_rows(system)),
      off_(off_of(system, state, switched_)),
      space_(model, preferred, names_of(system, off_)),
      limits_(coordinate_limits(model, space_)),
      fixed_(space_.model_motions()) {
  int moving = 0;
  for (const BodySpec& body : model.bodies) body_.push_back(body.fixed ? kGround : moving++);
  std::vector<int> joints;
  const auto& all = system.interactions();
  for (int i = 0; i < static_cast<int>(all.size()); ++i)
    if (std::string(system.group(all[static_cast<std::size_t>(i)].group).kind()) == Joint::kKind)
      joints.push_back(i);
  for (std::size_t k = 0; k < size(); ++k) {
    const IndependentCoordinate& c = space_.coordinates()[k];
    play_.push_back(0.0);
    if (c.joint < 0) continue;
    if (const Resistance* r =
            joint_at(system, joints.at(static_cast<std::size_t>(c.joint))).resistance()) {
      // As at the start of a model.
      const std::optional<JointLimits>& limits = c.turns ? r->data().turn : r->data().slide;
      if (limits && limits->by_rows)
        play_.back() = kOverlapGaps * system.touching_gap() / limits->radius;
      else if (limits)
        play_.back() = limits->law.tolerance;
    }
    if (!c.turns) continue;
    const int interaction = joints.at(static_cast<std::size_t>(c.joint));
    const Joint& joint = joint_at(system, interaction);
    if (!joint.free_angle(c.coordinate)) continue;  // a component of a rotation vector
    const std::vector<std::string> names = joint.coordinate_names();
    Angle angle{.coordinate = k, .interaction = interaction};
    for (std::size_t i = 0; names[i] != c.coordinate; ++i)
      if (joint.free_angle(names[i])) ++angle.history;
    angles_.push_back(angle);
  }
}

bool Coordinates::are_of(const System& system, const State& state) const {
  return off_of(system, state, switched_) == off_;
}

JointSpace::Motions Coordinates::motions(const System& system, const State& state) const {
  JointSpace::Motions motions = fixed_;
  for (std::size_t i = 0; i < motions.size(); ++i)
    if (body_[i] != kGround) motions[i] = system.motion(state, body_[i]);
  return motions;
}

std::vector<double> Coordinates::positions(const System& system, const State& state,
                                           const JointSpace::Motions& motions) const {
  std::vector<double> near(size(), 0.0);
  // Turns that were counted some steps ago: joints count them again before half of one has passed.
  for (const Angle& angle : angles_) near[angle.coordinate] = counted(system, state, angle);
  return space_.positions(motions, near);
}

void Coordinates::set_turns(const System& system, State& state,
                            const std::vector<double>& positions) const {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  for (const Angle& angle : angles_) {
    double& angle_there = counted(system, state, angle);
    angle_there += kTurn * std::round((positions[angle.coordinate] - angle_there) / kTurn);
  }
}

}  // namespace polhode::python
