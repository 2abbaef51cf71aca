// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>

#include <polhode/compile/plan_solid.hpp>
#include <polhode/compile/solid_point.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/solids/loads/registry.hpp>

namespace polhode::io {
namespace {

/// Components of a path such as solids.pad.mesh.elements[3].
std::vector<std::string> parts_of(std::string_view path) {
  std::vector<std::string> parts(1);
  for (const char c : path) {
    if (c == ']') continue;
    if (c == '.' || c == '[')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

/// Checks that a load's nodes or faces exist.
void check_load(const LoadSpec& load, const SolidPlan& plan, std::vector<InputError>& faults) {
  const std::string where = format("loads.{}", load.name);
  if (load.has_end_on_solid()) return;
  try {
    switch (solids::solid_load_kind(where + ".type", load.type).place) {
      case solids::SolidLoadPlace::faces:
        static_cast<void>(solids::select_faces(where + ".surface", plan.mesh, load.selection));
        break;
      case solids::SolidLoadPlace::nodes:
        static_cast<void>(solids::select_nodes(where + ".nodes", plan.mesh, load.selection));
        break;
      case solids::SolidLoadPlace::elements:
        break;
    }
  } catch (const InputError& e) {
    faults.push_back(e);
  }
}

/// Checks that the ends of a load between points lie in the solid.
void check_ends(const LoadSpec& load, int solid, const SolidPlan& plan,
                std::vector<InputError>& faults) {
  for (std::size_t k = 0; k < 2; ++k) {
    if (load.end_solids[k] != solid) continue;
    try {
      static_cast<void>(
          solid_point(format("loads.{}.at", load.name), plan.mesh, k == 0 ? load.Z_a : load.Z_b));
    } catch (const InputError& e) {
      faults.push_back(e);
    }
  }
}

/// Checks that a probe's point lies in the solid.
void check_probe(const ProbeSpec& probe, const std::string& where, const SolidPlan& plan,
                 std::vector<InputError>& faults) {
  if (probe.node && *probe.node >= static_cast<int>(plan.mesh.nodes.size())) {
    faults.emplace_back(where + ".node", format("node {} does not exist", *probe.node),
                        format("The solid has {} nodes; the first is 0", plan.mesh.nodes.size()));
  } else if (!probe.node && probe.reaction_of.empty()) {
    try {
      static_cast<void>(solid_point(where + ".point", plan.mesh, probe.point));
    } catch (const InputError& e) {
      faults.push_back(e);
    }
  }
}

}  // namespace

SourceLocation place_of_path(const ReadContext& context, const SourceNode& root,
                             std::string_view path) {
  const std::vector<std::string> keys = parts_of(path);
  if (keys.size() > 1)
    for (const PartSource& part : context.parts) {
      const SourceNode* things = part.root->find(keys[0]);
      if (!things || !keys[1].starts_with(part.prefix) ||
          !things->find(keys[1].substr(part.prefix.size())))
        continue;
      std::string own(path);
      own.erase(keys[0].size() + 1, part.prefix.size());
      const ReadContext inside{.tree = *part.tree, .diagnostics = context.diagnostics};
      return place_of_path(inside, *part.root, own);
    }
  const SourceNode* node = &root;
  SourceLocation place = context.tree.place_of(root);
  for (const std::string& part : keys) {
    if (node->is_map()) {
      const auto key = std::find_if(node->keys.begin(), node->keys.end(),
                                    [&](const auto& k) { return k.name == part; });
      if (key == node->keys.end()) break;
      node = &node->children[static_cast<std::size_t>(key - node->keys.begin())];
      // For a map the name is meant, for a value the value itself.
      place = node->is_map() ? context.tree.place_of(*key, *node) : context.tree.place_of(*node);
    } else if (node->is_list()) {
      std::size_t index = 0;
      const auto end = part.data() + part.size();
      if (std::from_chars(part.data(), end, index).ptr != end || index >= node->children.size())
        break;
      node = &node->children[index];
      place = context.tree.place_of(*node);
    } else {
      break;
    }
  }
  return place;
}

void check_solids(ReadContext& context, const SourceNode& root) {
  const Model& model = context.model;
  std::vector<InputError> faults;
  for (std::size_t s = 0; s < model.solids.size(); ++s) {
    const SolidSpec& solid = model.solids[s];
    if (!context.solid_is_sound[s]) continue;
    const auto is_sound = [&](const std::string& material) {
      return context.material_is_sound[static_cast<std::size_t>(context.materials.at(material))];
    };
    if (!is_sound(solid.material) ||
        !std::all_of(solid.regions.begin(), solid.regions.end(),
                     [&](const RegionSpec& region) { return is_sound(region.material); }))
      continue;
    const std::size_t before = faults.size();
    const SolidPlan plan = plan_solid(model, static_cast<int>(s), &faults);
    if (model.analysis.type == "statics" && solid.bonded.empty() && solid.prescribed.empty())
      faults.emplace_back(format("solids.{}", solid.name), "nothing holds the solid",
                          "In statics bond it to a body or to ground, or prescribe nodes.");
    if (faults.size() > before) continue;
    for (const LoadSpec& load : model.loads) {
      if (load.solid == static_cast<int>(s)) check_load(load, plan, faults);
      check_ends(load, static_cast<int>(s), plan, faults);
    }
    for (const Reported& asked : reported(model))
      if (asked.of->kind == "solid" && asked.of->target == solid.name)
        check_probe(*asked.of, asked.where, plan, faults);
  }
  for (const InputError& e : faults)
    context.diagnostics.add(place_of_path(context, root, e.where()), e.where(), e.what_is_wrong(),
                            sentence(e.hint()));
}

}  // namespace polhode::io
