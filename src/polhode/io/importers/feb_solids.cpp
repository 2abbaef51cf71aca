// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/feb_solids.hpp>

#include <algorithm>

#include <polhode/core/disjoint_sets.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_model.hpp>
#include <polhode/solids/mesh/generators.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Cells of a solid with the numbers of its own nodes.
std::vector<std::vector<int>> cells_of(const FebSolid& solid) {
  std::vector<std::vector<int>> cells;
  for (const FebPart* part : solid.parts)
    for (std::size_t e = 0; e < part->nodes.size(); e += static_cast<std::size_t>(part->size)) {
      std::vector<int> cell;
      for (int k = 0; k < part->size; ++k)
        cell.push_back(solid.place.at(part->nodes[e + static_cast<std::size_t>(k)]));
      cells.push_back(std::move(cell));
    }
  return cells;
}

}  // namespace

void FebSolids::choose_regions(FebSolid& solid) {
  const auto is_hex8 = [](const FebPart* part) { return part->shape == "hex8"; };
  const auto element = [&](const FebPart* part) -> std::string {
    if (!is_hex8(part)) return "";
    return materials_.at(part->material).uncoupled ? "hex8_q1p0" : "hex8_standard";
  };
  // Cells of one shape are those of the solid's element; of several, hexahedra are regions.
  const auto other = std::find_if_not(solid.parts.begin(), solid.parts.end(), is_hex8);
  const bool all_hex8 = other == solid.parts.end();
  const FebPart* base = all_hex8 ? solid.parts.front() : *other;
  solid.material = materials_.at(base->material).name;
  solid.element = element(base);
  std::set<std::string> taken;
  std::map<std::pair<std::string, bool>, std::size_t> region_of;
  int first = 0;
  for (const FebPart* part : solid.parts) {
    const int count = static_cast<int>(part->nodes.size()) / part->size, begin = first;
    first += count;
    if (part->material == base->material && is_hex8(part) == is_hex8(base)) continue;
    const auto [found, is_new] =
        region_of.try_emplace({part->material, is_hex8(part)}, solid.regions.size());
    if (is_new) {
      FebRegion region;
      region.name = model_.file.name(*part->at, part->name, taken);
      region.material = materials_.at(part->material).name;
      if (element(part) != solid.element) region.element = element(part);
      solid.regions.push_back(std::move(region));
    }
    for (int e = begin; e < first; ++e) solid.regions[found->second].elements.push_back(e);
  }
}

void FebSolids::assemble() {
  FebFile& file = model_.file;
  // Springs end on bodies and solids by their names.
  solid_names_.insert("ground");
  for (const FebBody& body : model_.bodies) solid_names_.insert(body.name);
  merge_ties();
  std::vector<const FebPart*> parts;
  for (const FebPart& part : model_.mesh.parts) {
    if (!materials_.contains(part.material)) continue;
    if (part.shape.empty() || !part.is_solid())
      file.refuse(*part.at, format("{} elements of a deformable solid are not read", part.type),
                  "Mesh the part with hex8, hex20, hex27, tet4, tet10, tet15, penta6 or penta15.");
    else if (!part.nodes.empty())
      parts.push_back(&part);
  }
  DisjointSets sets(parts.size());
  std::unordered_map<int, int> owner;
  for (int p = 0; p < static_cast<int>(parts.size()); ++p)
    for (const int n : parts[static_cast<std::size_t>(p)]->nodes)
      if (const auto [found, is_new] = owner.try_emplace(n, p); !is_new)
        sets.join(found->second, p);
  std::map<int, std::size_t> solid_of;
  for (int p = 0; p < static_cast<int>(parts.size()); ++p) {
    const FebPart& part = *parts[static_cast<std::size_t>(p)];
    const auto [found, is_new] = solid_of.try_emplace(sets.first_of(p), solids_.size());
    if (is_new) {
      FebSolid solid;
      solid.name = file.name(*part.at, part.name, solid_names_);
      solid.at = part.at;
      solids_.push_back(std::move(solid));
    }
    FebSolid& solid = solids_[found->second];
    solid.parts.push_back(&part);
    solid.nodes.insert(solid.nodes.end(), part.nodes.begin(), part.nodes.end());
  }
  for (FebSolid& solid : solids_) choose_regions(solid);
  for (FebSolid& solid : solids_) {
    std::sort(solid.nodes.begin(), solid.nodes.end());
    solid.nodes.erase(std::unique(solid.nodes.begin(), solid.nodes.end()), solid.nodes.end());
    std::vector<Vec3> X;
    for (const int n : solid.nodes) {
      solid.place.emplace(n, static_cast<int>(X.size()));
      X.push_back(model_.mesh.nodes[static_cast<std::size_t>(n)]);
    }
    try {
      solid.boundary = solids::boundary(solids::inline_mesh(solid.name, X, cells_of(solid), {}));
    } catch (const InputError& error) {
      file.xml.fault(*solid.at, error.what_is_wrong(), "Mend the mesh.");
    }
  }
  for (const FebBody& body : model_.bodies)
    for (const int n : body.nodes) attached_.emplace(n, body.name);
}

SourceNode FebSolids::node_list(const NodeBuilder& make, const FebSolid& solid,
                                const std::vector<int>& nodes) const {
  SourceNode list = make.list(), selection = make.map();
  for (const int n : nodes) list.children.push_back(make.text(format("{}", solid.place.at(n))));
  make.put(selection, "nodes", std::move(list));
  return selection;
}

void FebSolids::put_bonds(const FebSolid& solid, const NodeBuilder& make, SourceNode& node) {
  std::map<std::string, std::vector<int>> bonds;
  // Nodes by condition and by the components that it holds, as bits.
  std::map<std::pair<int, int>, std::vector<int>> groups;
  bool both = false;
  for (const int n : solid.nodes) {
    const auto body = attached_.find(n);
    const auto held = held_.find(n);
    if (body != attached_.end()) {
      bonds[body->second].push_back(n);
      both = both || held != held_.end();
      continue;
    }
    if (held == held_.end()) continue;
    std::map<int, int> components;
    for (int k = 0; k < 3; ++k)
      if (const int h = held->second[static_cast<std::size_t>(k)]; h >= 0) components[h] |= 1 << k;
    for (const auto& [h, bits] : components) groups[{h, bits}].push_back(n);
  }
  if (both)
    model_.file.ignored.add(*solid.at, "a displacement of nodes of a rigid body",
                            "is given by the body");
  SourceNode bonded = make.map(), prescribed = make.map();
  for (const auto& [body, nodes] : bonds) make.put(bonded, body, node_list(make, solid, nodes));
  static const char* const names[] = {"x", "y", "z"};
  std::set<std::string> taken;
  for (const auto& [key, nodes] : groups) {
    const FebHold& hold = holds_[static_cast<std::size_t>(key.first)];
    SourceNode entry = make.map();
    make.put(entry, "nodes", node_list(make, solid, nodes));
    for (std::size_t k = 0; k < 3; ++k)
      if ((key.second >> k & 1) != 0) make.put(entry, names[k], hold_node(hold, k));
    std::string name = hold.name;
    for (int k = 2; !taken.insert(name).second; ++k) name = format("{}_{}", hold.name, k);
    make.put(prescribed, name, std::move(entry));
  }
  if (!bonded.keys.empty()) make.put(node, "bonded", std::move(bonded));
  if (!prescribed.keys.empty()) make.put(node, "prescribed", std::move(prescribed));
}

SourceNode FebSolids::write_solid(const FebSolid& solid) {
  const NodeBuilder make = model_.file.make(*solid.at);
  SourceNode node = make.map(), mesh = make.map(), nodes = make.list(), elements = make.list();
  for (const int n : solid.nodes)
    nodes.children.push_back(make.vector(model_.mesh.nodes[static_cast<std::size_t>(n)]));
  for (const std::vector<int>& cell : cells_of(solid)) {
    SourceNode list = make.list();
    for (const int n : cell) list.children.push_back(make.text(format("{}", n)));
    elements.children.push_back(std::move(list));
  }
  make.put(mesh, "nodes", std::move(nodes));
  make.put(mesh, "elements", std::move(elements));
  make.put(node, "mesh", std::move(mesh));
  if (!solid.element.empty()) make.put(node, "element", make.text(solid.element));
  make.put(node, "material", make.text(solid.material));
  SourceNode regions = make.map();
  for (const FebRegion& region : solid.regions) {
    SourceNode entry = make.map(), list = make.list();
    for (const int e : region.elements) list.children.push_back(make.text(format("{}", e)));
    make.put(entry, "material", make.text(region.material));
    if (!region.element.empty()) make.put(entry, "element", make.text(region.element));
    make.put(entry, "elements", std::move(list));
    make.put(regions, region.name, std::move(entry));
  }
  if (!regions.keys.empty()) make.put(node, "regions", std::move(regions));
  put_fibres(solid, make, node);
  // Left out, it would move with the first body to which it is bonded.
  if (model_.dynamic)
    make.put(node, "velocity", make.vector(solid.velocity.value_or(Vec3::Zero())));
  put_bonds(solid, make, node);
  put_contact(solid, make, node);
  return node;
}

void FebSolids::write(SourceNode& root) {
  const NodeBuilder make = model_.file.make(model_.file.xml.root());
  SourceNode materials = make.map(), solids = make.map();
  for (auto& [name, material] : materials_)
    make.put(materials, material.name, std::move(material.node));
  for (const FebSolid& solid : solids_) make.put(solids, solid.name, write_solid(solid));
  if (!solids_.empty()) {
    make.put(root, "materials", std::move(materials));
    make.put(root, "solids", std::move(solids));
  }
  if (sections_.kind == SourceNode::Kind::kMap) make.put(root, "sections", std::move(sections_));
  if (beams_.kind == SourceNode::Kind::kMap) make.put(root, "beams", std::move(beams_));
  if (contacts_.kind != SourceNode::Kind::kMap) return;
  SourceNode contacts = make.map();
  make.put(contacts, "pairs", std::move(contacts_));
  make.put(root, "contacts", std::move(contacts));
}

}  // namespace polhode::io
