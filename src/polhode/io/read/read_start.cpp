// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

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
    if (const auto number = read_number(context, value, path, number_of(coordinate, is_rate)))
      context.starts.push_back(
          {.joint = static_cast<int>(context.model.joints.size()),
           .coordinate = coordinate,
           .name = names.size() == 1 ? joint : format("{}.{}", joint, coordinate),
           .path = path,
           .place = context.tree.place_of(value),
           .value = *number,
           .is_rate = is_rate});
  };
  if (!node.is_map()) {
    if (names.size() == 1)
      add(node, section.path(key), names.front());
    else
      context.fault(node, section.path(key),
                    format("the joint has {} coordinates: {}", names.size(), name_list(names)),
                    format("Write {{{}: ...}}.", names.empty() ? "x" : names.front()));
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

void place_starts(ReadContext& context) {
  const std::vector<JointStart> starts = std::move(context.starts);
  context.starts.clear();
  if (starts.empty() || !context.diagnostics.empty()) return;
  Model& model = context.model;
  std::vector<std::string> wanted;
  for (const JointStart& start : starts)
    if (!start.is_rate) wanted.push_back(start.name);
  try {
    const JointSpace space(model, wanted);
    std::vector<double> q = space.positions(space.model_motions());
    for (const JointStart& start : starts)
      if (!start.is_rate) q[static_cast<std::size_t>(index_of(space, start))] = start.value;
    JointSpace::Motions motions = space.place(space.model_motions(), q);
    for (std::size_t i = 0; i < motions.size(); ++i) {
      motions[i].v = model.bodies[i].velocity;
      motions[i].W = motions[i].q.conjugate() * model.bodies[i].angular_velocity;
    }
    if (std::ranges::any_of(starts, &JointStart::is_rate)) {
      std::vector<double> rates = space.rates(motions);
      for (const JointStart& start : starts) {
        if (!start.is_rate) continue;
        const int k = index_of(space, start);
        if (k < 0) {
          fault(context, start, "the rate follows from those of other joints of the loop",
                "Give the rate of one of those");
          return;
        }
        rates[static_cast<std::size_t>(k)] = start.value;
      }
      motions = space.place(motions, q, rates);
    }
    for (std::size_t i = 0; i < motions.size(); ++i) {
      BodySpec& body = model.bodies[i];
      if (body.fixed) continue;
      body.position = motions[i].r;
      body.orientation = motions[i].q;
      body.velocity = motions[i].v;
      body.angular_velocity = motions[i].omega();
    }
  } catch (const InputError& error) {
    const auto named = std::ranges::find_if(
        starts, [&](const JointStart& s) { return !s.is_rate && s.name == error.where(); });
    if (named != starts.end())
      fault(context, *named, error.what_is_wrong(), error.hint());
    else
      fault(context, starts.front(), format("{} {}", error.where(), error.what_is_wrong()),
            error.hint());
  }
}

}  // namespace polhode::io
