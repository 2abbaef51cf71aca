// SPDX-License-Identifier: Apache-2.0
// Forces and moments along coordinates of joints that are set from Python between steps.
#include <algorithm>

#include <polhode/compile/build_system.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/held_value.hpp>
#include <polhode/core/names.hpp>
#include <polhode/joint_space/joint_space.hpp>

#include "compiled_model.hpp"

namespace polhode::python {

namespace {

/// A coordinate along which a motor can act.
struct Driven {
  std::string name, joint, coordinate;
  bool turns = false;
};

/// All of a model, by the names that JointSpace gives them.
std::vector<Driven> all_driven(const Model& model) {
  SystemMap map;
  const System system = build_system(model, &map);
  std::vector<Driven> list;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = joint_at(system, map.joint[i]);
    if (joint.frame_moves()) continue;
    const std::vector<std::string> names = joint.coordinate_names();
    for (const std::string& coordinate : names) {
      const bool turns = joint.free_angle(coordinate).has_value();
      if (!turns && !(coordinate.size() == 1 && joint.free_displacement(coordinate))) continue;
      list.push_back({names.size() == 1 ? joint.name : format("{}.{}", joint.name, coordinate),
                      joint.name, coordinate, turns});
    }
  }
  return list;
}

/// Those of some coordinates that can be independent together; none in a model without coordinates.
std::vector<std::string> independent(const Model& model, const std::vector<std::string>& wanted) {
  const auto fit = [&](const std::vector<std::string>& names) {
    try {
      (void)JointSpace(model, names);
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  if (fit(wanted)) return wanted;
  std::vector<std::string> chosen;
  if (!fit(chosen)) return chosen;
  for (const std::string& name : wanted) {
    chosen.push_back(name);
    if (!fit(chosen)) chosen.pop_back();
  }
  return chosen;
}

/// Adds motors whose moments or forces are held numbers.
/// @param wanted  Names of coordinates; none: all independent ones along which a motor can act.
/// @returns names of coordinates in the order of the numbers.
std::vector<std::string> add_held_loads(CompiledModel& compiled,
                                        const std::optional<std::vector<std::string>>& wanted) {
  Model& model = compiled.model;
  const std::vector<Driven> all = all_driven(model);
  std::vector<Driven> chosen;
  if (wanted) {
    std::vector<std::string> names;
    for (const Driven& d : all) names.push_back(d.name);
    for (const std::string& name : *wanted) {
      const auto found = std::ranges::find(names, name);
      if (found == names.end())
        throw InputError("tau",
                         format("'{}' is not a coordinate along which a motor can act", name),
                         names.empty() ? "There is none" : "There are: " + name_list(names));
      chosen.push_back(all[static_cast<std::size_t>(found - names.begin())]);
    }
    compiled.preferred = independent(model, *wanted);
  } else {
    const JointSpace space(model);
    for (const IndependentCoordinate& c : space.coordinates()) {
      const auto found = std::ranges::find(all, c.name, &Driven::name);
      if (found != all.end()) chosen.push_back(*found);
    }
  }
  const auto numbers = std::make_shared<HeldNumbers>();
  numbers->now.assign(chosen.size(), 0.0);
  numbers->used = numbers->now;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const Driven& d = chosen[k];
    LoadSpec load;
    load.name = "tau." + d.name;
    load.type = d.turns ? "rotary_motor" : "linear_motor";
    load.joint = d.joint;
    load.coordinate = d.coordinate;
    load.drive = d.turns ? "moment" : "force";
    load.value = std::make_shared<HeldValue>(numbers, k);
    for (const LoadSpec& other : model.loads)
      if (other.name == load.name)
        throw InputError("loads." + load.name, "has the name of a load that tau adds",
                         "Give it another name");
    model.loads.push_back(std::move(load));
    names.push_back(d.name);
  }
  return names;
}

}  // namespace

void bind_held_loads(nb::module_& m) {
  m.def("add_held_loads", &add_held_loads, nb::arg("model"), nb::arg("coordinates").none(),
        "Adds motors whose moments or forces are set between steps.");
}

}  // namespace polhode::python
