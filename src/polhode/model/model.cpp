// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

namespace {

template <class Spec>
int index_of(const std::vector<Spec>& specs, const std::string& name, const char* what,
             const char* plural, std::vector<std::string> names) {
  for (std::size_t i = 0; i < specs.size(); ++i)
    if (specs[i].name == name) return static_cast<int>(i);
  for (const Spec& spec : specs) names.push_back(spec.name);
  const std::string known = specs.empty() ? format("The model has no {}", plural)
                                          : format("Use one of: {}", name_list(names));
  throw InputError(plural, format("unknown {} '{}'", what, name),
                   did_you_mean(name, names) + known);
}

}  // namespace

int Model::body_index(const std::string& name) const {
  return name == "ground" ? kGround : index_of(bodies, name, "body", "bodies", {"ground"});
}

const std::string& Model::body_name(int body) const {
  static const std::string ground = "ground";
  return body == kGround ? ground : bodies.at(static_cast<std::size_t>(body)).name;
}

const std::string& Model::side_name(const Side& side) const {
  if (side.is_cable()) return cables.at(static_cast<std::size_t>(side.index)).name;
  if (side.is_solid()) return solids.at(static_cast<std::size_t>(side.index)).name;
  return body_name(side.index);
}

int Model::joint_index(const std::string& name) const {
  return index_of(joints, name, "joint", "joints", {});
}

int Model::material_index(const std::string& name) const {
  return index_of(materials, name, "material", "materials", {});
}

int Model::solid_index(const std::string& name) const {
  return index_of(solids, name, "solid", "solids", {});
}

int Model::beam_index(const std::string& name) const {
  return index_of(beams, name, "beam", "beams", {});
}

int Model::cable_index(const std::string& name) const {
  return index_of(cables, name, "cable", "cables", {});
}

int Model::controller_index(const std::string& name) const {
  return index_of(controllers, name, "controller", "controllers", {});
}

int Model::probe_index(const std::string& name) const {
  return index_of(output.probes, name, "probe", "probes", {});
}

int Model::load_index(const std::string& name) const {
  return index_of(loads, name, "load", "loads", {});
}

std::vector<Reported> reported(const Model& model) {
  std::vector<Reported> list;
  for (const ProbeSpec& probe : model.output.probes)
    list.push_back({format("output.probes.{}", probe.name), &probe});
  for (const EventSpec& event : model.events)
    if (event.when) list.push_back({format("events.{}.when", event.name), &event.when->channel.of});
  for (const ControllerSpec& controller : model.controllers)
    list.push_back({format("controllers.{}", controller.name), &controller.channel.of});
  return list;
}

}  // namespace polhode
