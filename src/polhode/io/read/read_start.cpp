// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/joint_space/joint_space.hpp>

namespace polhode::io {

namespace {

Field number_of(const std::string& coordinate, bool is_rate) {
  const bool turns = coordinate.size() == 2;
  Field field{.name = coordinate, .kind = FieldKind::kNumber};
  if (is_rate)
    field.dimension = turns ? dimensions::kAngularVelocity : dimensions::kVelocity;
  else
    field.dimension = turns ? dimensions::kAngle : dimensions::kLength;
  return field;
}

/// The coordinate of a joint among those of a joint space; −1 if it is not independent.
int index_of(const JointSpace& space, const JointStart& start) {
  for (int k = 0; k < space.size(); ++k) {
    const IndependentCoordinate& c = space.coordinates()[static_cast<std::size_t>(k)];
    if (c.joint == start.joint && c.coordinate == start.coordinate) return k;
  }
  return -1;
}

void fault(ReadContext& context, const JointStart& start, const std::string& what,
           const std::string& hint) {
  context.diagnostics.add(start.place, start.path, what, sentence(hint));
}

}  // namespace

void read_start(ReadContext& context, const Section& section, const std::string& key,
                const std::string& joint, const std::vector<std::string>& names) {
  const SourceNode& node = *section.find(key);
  const auto add = [&](const SourceNode& value, const std::string& path,
                       const std::string& coordinate) {
    const bool is_rate = key == "start_rate";
    const auto number = read_number(context, value, path, number_of(coordinate, is_rate));
    if (!number) return;
    constexpr double kHalfTurn = std::numbers::pi * (1.0 + 1e-12);
    if (!is_rate && coordinate.size() == 2 && std::abs(*number) > kHalfTurn)
      context.fault(value, path, format("is {:.6g} deg", *number * 180.0 / std::numbers::pi),
                    "Angles start between -180 and 180 deg; shift the joint's zero by x_axis_body, "
                    "or turn the body that is described.");
    else
      context.starts.push_back(
          {.joint = static_cast<int>(context.model.joints.size()),
           .coordinate = coordinate,
           .name = names.size() == 1 ? joint : format("{}.{}", joint, coordinate),
           .path = path,
           .place = context.tree.place_of(value),
           .value = *number,
           .is_rate = is_rate});
  };
  if (names.empty()) {
    context.fault(node, section.path(key), "the joint has no free coordinate", "Leave it out.");
    return;
  }
  if (!node.is_map()) {
    if (names.size() == 1)
      add(node, section.path(key), names.front());
    else
      context.fault(node, section.path(key),
                    format("the joint has {} coordinates: {}", names.size(), name_list(names)),
                    format("Write {{{}: ...}}.", names.front()));
    return;
  }
  for (std::size_t k = 0; k < node.keys.size(); ++k) {
    const std::string& name = node.keys[k].name;
    if (std::ranges::find(names, name) != names.end())
      add(node.children[k], section.path(key) + "." + name, name);
    else
      context.fault(node.children[k], section.path(key), format("'{}' is not free", name),
                    "Free are: " + name_list(names) + ".");
  }
}

namespace {

bool is_moving(const Model& model) {
  return std::ranges::any_of(model.bodies, [](const BodySpec& b) {
    return !b.fixed && !(b.velocity.isZero(0.0) && b.angular_velocity.isZero(0.0));
  });
}

void take(const JointSpace::Motions& motions, Model& model) {
  for (std::size_t i = 0; i < motions.size(); ++i) {
    BodySpec& body = model.bodies[i];
    if (body.fixed) continue;
    body.position = motions[i].r;
    body.orientation = motions[i].q;
    body.velocity = motions[i].v;
    body.angular_velocity = motions[i].omega();
  }
}

std::vector<std::string> names_of(const std::vector<JointStart>& starts) {
  std::vector<std::string> names;
  for (const JointStart& start : starts) names.push_back(start.name);
  return names;
}

/// Places bodies at coordinates, with the rates that they have as described.
void place_at(const std::vector<JointStart>& starts, Model& model) {
  const JointSpace space(model, names_of(starts));
  std::vector<double> q = space.positions(space.model_motions()), rates;
  if (is_moving(model)) rates = space.rates(space.model_motions());
  for (const JointStart& start : starts)
    q.at(static_cast<std::size_t>(index_of(space, start))) = start.value;
  take(space.place(space.model_motions(), q, rates), model);
}

/// Sets rates of coordinates at the present position.
void set_rates(const std::vector<JointStart>& starts, Model& model) {
  const JointSpace space(model, names_of(starts));
  const std::vector<double> q = space.positions(space.model_motions());
  std::vector<double> rates = space.rates(space.model_motions());
  for (const JointStart& start : starts)
    rates.at(static_cast<std::size_t>(index_of(space, start))) = start.value;
  take(space.place(space.model_motions(), q, rates), model);
}

}  // namespace

void place_starts(ReadContext& context) {
  std::vector<JointStart> starts = std::move(context.starts), rates;
  context.starts.clear();
  if (starts.empty() || !context.diagnostics.empty()) return;
  const auto first_rate = std::stable_partition(
      starts.begin(), starts.end(), [](const JointStart& start) { return !start.is_rate; });
  rates.assign(first_rate, starts.end());
  starts.erase(first_rate, starts.end());
  const std::vector<JointStart>* used = &starts;
  try {
    if (!starts.empty()) place_at(starts, context.model);
    used = &rates;
    if (!rates.empty()) set_rates(rates, context.model);
  } catch (const InputError& error) {
    const auto named = std::ranges::find(*used, error.where(), &JointStart::name);
    if (named != used->end())
      fault(context, *named, error.what_is_wrong(), error.hint());
    else
      fault(context, used->front(), format("{} {}", error.where(), error.what_is_wrong()),
            error.hint());
  }
}

}  // namespace polhode::io
