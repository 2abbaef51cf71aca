// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/compile/solid_parts.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>

namespace polhode::io {
namespace {

/// Index of an object by name; an error that lists the existing names.
std::optional<int> read_name_of(ReadContext& context, const SourceNode& node,
                                const std::string& path, const char* what,
                                const std::unordered_map<std::string, int>& known,
                                const std::vector<std::string>& names) {
  const auto name = read_text(context, node, path);
  if (!name) return std::nullopt;
  if (const auto found = known.find(*name); found != known.end()) return found->second;
  context.fault(node, path, format("unknown {} {}", what, quote(*name)),
                did_you_mean(*name, names) +
                    (names.empty() ? format("The model has no {}s.", what)
                                   : sentence(format("{}s: {}", what, name_list(names)))));
  return std::nullopt;
}

/// Reader of one solid; errors go to the context.
class SolidReader {
 public:
  SolidReader(ReadContext& context, const SourceNode& node, SolidSpec& solid)
      : context_(context),
        node_(node),
        solid_(solid),
        section_(context, node, solid.place, "solids." + solid.name, solid_fields()) {}

  void read() {
    if (!node_.is_map()) return;
    if (const SourceNode* mesh = section_.find("mesh"))
      read_solid_mesh(context_, *mesh, section_.path("mesh"), solid_.mesh);
    read_element(section_, solid_.element);
    if (const SourceNode* value = section_.find("material"))
      if (const auto i = read_material_name(context_, *value, section_.path("material")))
        solid_.material = context_.model.materials[static_cast<std::size_t>(*i)].name;
    solid_.density = section_.number("density");
    if (const auto stress = section_.choice("stress")) solid_.stress = *stress;
    if (const SourceNode* regions = section_.find("regions")) read_regions(*regions);
    if (const SourceNode* list = section_.find("fibre_directions")) read_fibres(*list);
    if (const SourceNode* bonded = section_.find("bonded")) read_bonds(*bonded);
    if (const SourceNode* prescribed = section_.find("prescribed")) read_prescribed(*prescribed);
    if (const SourceNode* value = section_.find("contact"))
      read_solid_contact(context_, *value, section_.path("contact"), solid_);
    solid_.velocity = section_.vector("velocity");
    solid_.angular_velocity = section_.vector("angular_velocity");
  }

 private:
  static void read_element(Section& section, std::string& element) {
    const auto given = section.text("element");
    if (!given) return;
    const std::vector<std::string> names = solid_element_names();
    if (std::find(names.begin(), names.end(), *given) == names.end())
      section.fault("element", quote(*given) + " is not known",
                    did_you_mean(*given, names) + "Use one of: " + name_list(names) + ".");
    else
      element = *given;
  }

  void read_regions(const SourceNode& node) {
    const std::string path = section_.path("regions");
    if (node.kind == SourceNode::Kind::kEmpty) return;
    if (!node.is_map()) {
      context_.fault(node, path,
                     "expects a map from names to regions, but is " + node.description(),
                     "Write {core: {material: steel, within: {box: {...}}}}, for example.");
      return;
    }
    for (std::size_t k = 0; k < node.keys.size(); ++k) {
      const SourceNode::Key& key = node.keys[k];
      if (!check_name(context_, key, node.children[k], path)) continue;
      RegionSpec region;
      region.name = key.name;
      region.place = context_.tree.place_of(key, node.children[k]);
      Section section(context_, node.children[k], region.place, path + "." + key.name,
                      region_fields());
      if (!node.children[k].is_map()) continue;
      if (const SourceNode* value = section.find("material"))
        if (const auto i = read_material_name(context_, *value, section.path("material")))
          region.material = context_.model.materials[static_cast<std::size_t>(*i)].name;
      read_element(section, region.element);
      region.density = section.number("density");
      if (const SourceNode* value = section.find("within"))
        if (auto within = read_selections(context_, *value, section.path("within")))
          region.within = std::move(*within);
      if (const SourceNode* value = section.find("elements"))
        if (auto elements = read_indices(context_, *value, section.path("elements")))
          region.elements = std::move(*elements);
      if (section.misses("within") && section.misses("elements"))
        section.fault("has no elements", "Give within, a selection of nodes, or elements.");
      solid_.regions.push_back(std::move(region));
    }
  }

  void read_fibres(const SourceNode& list) {
    const std::string path = section_.path("fibre_directions");
    if (!list.is_list()) {
      context_.fault(list, path, "expects a list of directions, but is " + list.description(),
                     "Write [[1, 0, 0], [0.8, 0.6, 0], ...], one for each element.");
      return;
    }
    for (const SourceNode& child : list.children)
      if (const auto direction = read_direction(context_, child, path))
        solid_.fibre_directions.push_back(*direction);
  }

  void read_bonds(const SourceNode& node) {
    const std::string path = section_.path("bonded");
    if (node.kind == SourceNode::Kind::kEmpty) return;
    if (!node.is_map()) {
      context_.fault(node, path,
                     "expects a map from bodies to selections, but is " + node.description(),
                     "Write {base: {plane: {axis: z, at: min}}}, for example.");
      return;
    }
    for (std::size_t k = 0; k < node.keys.size(); ++k) {
      const SourceNode::Key& key = node.keys[k];
      BondSpec bond;
      bond.place = context_.tree.place_of(key, node.children[k]);
      const auto found = context_.bodies.find(key.name);
      if (key.name != "ground" && found == context_.bodies.end()) {
        const std::vector<std::string> names = context_.body_names();
        context_.diagnostics.add(
            bond.place, path, "unknown body " + quote(key.name),
            did_you_mean(key.name, names) + "Bodies: " + name_list(names) + ".");
        continue;
      }
      if (key.name != "ground") bond.body = found->second;
      auto nodes = read_selections(context_, node.children[k], path + "." + key.name);
      if (!nodes) continue;
      bond.nodes = std::move(*nodes);
      solid_.bonded.push_back(std::move(bond));
    }
  }

  void read_prescribed(const SourceNode& node) {
    const std::string path = section_.path("prescribed");
    if (node.kind == SourceNode::Kind::kEmpty) return;
    if (!node.is_map()) {
      context_.fault(node, path,
                     "expects a map from names to displacements, but is " + node.description(),
                     "Write {clamp: {nodes: left, x: 0, y: 0, z: 0}}, for example.");
      return;
    }
    for (std::size_t k = 0; k < node.keys.size(); ++k) {
      const SourceNode::Key& key = node.keys[k];
      if (!check_name(context_, key, node.children[k], path)) continue;
      PrescribedSpec spec;
      spec.name = key.name;
      spec.place = context_.tree.place_of(key, node.children[k]);
      Section section(context_, node.children[k], spec.place, path + "." + key.name,
                      prescribed_fields());
      if (!node.children[k].is_map()) continue;
      std::optional<std::vector<solids::Selection>> nodes;
      if (const SourceNode* value = section.find("nodes"))
        nodes = read_selections(context_, *value, section.path("nodes"));
      bool any = false;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::string axis(1, "xyz"[c]);
        any = any || section.has(axis);
        spec.displacement[c] = section.time_number(axis);
      }
      if (!any && !section.has_unknown_key())
        section.fault("prescribes no component", "Give x, y or z; 0 fixes it.");
      if (!nodes) continue;
      spec.nodes = std::move(*nodes);
      solid_.prescribed.push_back(std::move(spec));
    }
  }

  ReadContext& context_;
  const SourceNode& node_;
  SolidSpec& solid_;
  Section section_;
};

}  // namespace

std::optional<int> read_material_name(ReadContext& context, const SourceNode& node,
                                      const std::string& path) {
  return read_name_of(context, node, path, "material", context.materials, context.material_names());
}

std::optional<int> read_solid_name(ReadContext& context, const SourceNode& node,
                                   const std::string& path) {
  return read_name_of(context, node, path, "solid", context.solids, context.solid_names());
}

void read_solids(ReadContext& context, const SourceNode& node) {
  for (std::size_t k = 0; k < node.keys.size(); ++k) {
    const SourceNode::Key& key = node.keys[k];
    if (!check_name(context, key, node.children[k], "solids")) continue;
    context.solids.emplace(key.name, static_cast<int>(context.model.solids.size()));
    SolidSpec solid;
    solid.name = key.name;
    solid.place = context.tree.place_of(key, node.children[k]);
    const std::size_t before = context.diagnostics.size();
    SolidReader(context, node.children[k], solid).read();
    context.solid_is_sound.push_back(context.diagnostics.size() == before);
    context.model.solids.push_back(std::move(solid));
  }
}

}  // namespace polhode::io
