// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/feb_mesh.hpp>

#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Errors of one kind after which the rest of a mesh is not read.
constexpr int kMostFaults = 20;

/// An element of FEBio: its nodes, and its shape in a model file.
struct FebElement {
  const char* type;
  int nodes;
  const char* shape;
};
constexpr FebElement kElements[] = {{"hex8", 8, "hex8"},    {"hex20", 20, "hex20"},
                                    {"hex27", 27, "hex27"}, {"tet4", 4, "tet4"},
                                    {"tet10", 10, "tet10"}, {"penta6", 6, "wedge6"},
                                    {"tet5", 5, ""},        {"tet15", 15, "tet15"},
                                    {"tet20", 20, ""},      {"penta15", 15, "wedge15"},
                                    {"pyra5", 5, ""},       {"pyra13", 13, ""},
                                    {"quad4", 4, ""},       {"quad8", 8, ""},
                                    {"quad9", 9, ""},       {"tri3", 3, ""},
                                    {"tri6", 6, ""},        {"tri7", 7, ""},
                                    {"q4ans", 4, ""},       {"q4eas", 4, ""},
                                    {"line2", 2, ""},       {"line3", 3, ""},
                                    {"truss2", 2, ""}};

/// Place of a node of hex27 in the order of a model file: of 20 to 26.
constexpr int kFaceNodesOfHex27[] = {22, 21, 23, 20, 24, 25, 26};

/// Reader of the sections of a mesh.
class MeshReader {
 public:
  MeshReader(FebFile& file, FebMesh& mesh) : file_(file), mesh_(mesh) {}

  void read_mesh(const Element& section) {
    if (const auto from = file_.xml.text(section, "from"))
      file_.xml.fault(section, format("the mesh is in another file, {}", quote(*from)),
                      "Export the model as one file.");
    for (const Element* e : file_.xml.children(section, "Nodes")) read_nodes(*e);
    for (const Element* e : file_.xml.children(section, "Elements")) read_elements(*e);
    for (const Element* e : file_.xml.children(section, "NodeSet"))
      if (std::vector<int>* set = add(mesh_.node_sets, *e))
        for (const std::int64_t n : file_.integers(*e))
          if (const int at = node(*e, n); at >= 0) set->push_back(at);
    for (const Element* e : file_.xml.children(section, "ElementSet"))
      if (std::vector<std::int64_t>* set = add(mesh_.element_sets, *e)) *set = file_.integers(*e);
    for (const char* tag : {"Surface", "Edge"})
      for (const Element* e : file_.xml.children(section, tag)) read_facets(*e);
    for (const Element* e : file_.xml.children(section, "SurfacePair")) {
      auto* pair = add(mesh_.surface_pairs, *e);
      const std::string primary = file_.text(*e, "primary"),
                        secondary = file_.text(*e, "secondary");
      if (pair != nullptr) *pair = {primary, secondary};
    }
    for (const Element* e : file_.xml.children(section, "DiscreteSet"))
      if (auto* set = add(mesh_.discrete_sets, *e))
        for (const Element* line : file_.xml.children(*e, "delem")) {
          const std::vector<std::int64_t> ends = file_.integers(*line);
          if (ends.size() != 2) {
            fault(*line, "<delem> has not two nodes", "Write <delem>1,2</delem>.");
            continue;
          }
          const int a = node(*line, ends[0]), b = node(*line, ends[1]);
          if (a >= 0 && b >= 0) set->push_back({a, b});
        }
    for (const char* tag : {"PartList", "Logfile"}) file_.ignored.skip(section, {tag});
  }

  void read_domains(const Element& section) {
    for (const char* tag : {"SolidDomain", "ShellDomain", "BeamDomain"})
      for (const Element* e : file_.xml.children(section, tag)) {
        const std::string name = file_.xml.required_text(*e, "name");
        const std::string material = file_.xml.required_text(*e, "mat");
        file_.ignored.attributes(*e, {"elem_type"});
        const auto part = std::find_if(mesh_.parts.begin(), mesh_.parts.end(),
                                       [&](const FebPart& p) { return p.name == name; });
        if (part != mesh_.parts.end()) {
          if (part->domain != nullptr)
            file_.xml.fault(*e, format("the elements {} are in two domains", quote(name)),
                            "Leave one of them out.");
          part->domain = e;
        }
        if (std::string_view(tag) == "ShellDomain") {
          file_.refuse(
              *e,
              format("the <ShellDomain> {} of {} elements is not read, as there are no "
                     "shells",
                     quote(name), part == mesh_.parts.end() ? "shell" : part->type),
              "Mesh its thickness with solid elements, one layer of hex20 or penta15 for a "
              "plate; a rigid part needs solid elements too, or none if all its freedoms "
              "are fixed.");
          continue;
        }
        if (part != mesh_.parts.end()) {
          part->material = material;
          part->area = file_.number(*e, "cross_sectional_area").value_or(0.0);
        } else if (!name.empty()) {
          file_.xml.fault(*e, format("there are no elements {}", quote(name)),
                          "Give the name of an <Elements>.");
        }
        domains_.push_back(e);
      }
  }

 private:
  /// A new set of the name of a tag; null after an error.
  template <class Sets>
  typename Sets::mapped_type* add(Sets& sets, const Element& e) {
    const std::string name = file_.xml.required_text(e, "name");
    if (name.empty()) return nullptr;
    const auto [found, is_new] = sets.try_emplace(name);
    if (!is_new) fault(e, format("the name {} stands twice", quote(name)), "Rename one of them.");
    return is_new ? &found->second : nullptr;
  }

  void fault(const Element& e, std::string what, std::string hint) {
    if (++faults_ <= kMostFaults) file_.xml.fault(e, std::move(what), std::move(hint));
  }

  /// Place of a node; -1 after an error.
  int node(const Element& e, std::int64_t id) {
    const auto found = mesh_.place.find(id);
    if (found != mesh_.place.end()) return found->second;
    fault(e, format("there is no node {}", id), "Give it in <Nodes>.");
    return -1;
  }

  void read_nodes(const Element& section) {
    const auto name = file_.xml.text(section, "name");
    std::vector<int>* set = name && !name->empty() ? add(mesh_.node_sets, section) : nullptr;
    for (const Element* e : file_.xml.children(section, "node")) {
      if (faults_ > kMostFaults) return;
      const auto id = file_.id(*e);
      const auto x = file_.numbers(*e, 3, 3);
      if (!id || !x) {
        ++faults_;
        continue;
      }
      const int at = static_cast<int>(mesh_.nodes.size());
      if (!mesh_.place.try_emplace(*id, at).second) {
        fault(*e, format("the node {} stands twice", *id), "Renumber one of them.");
        continue;
      }
      mesh_.nodes.emplace_back((*x)[0], (*x)[1], (*x)[2]);
      mesh_.labels.push_back(*id);
      if (set != nullptr) set->push_back(at);
    }
  }

  void read_elements(const Element& section) {
    FebPart part;
    part.at = &section;
    part.name = file_.xml.required_text(section, "name");
    part.type = file_.type(section);
    file_.ignored.attributes(section, {"mat"});
    if (part.type.empty()) return;
    const std::string plain = part.type.substr(0, part.type.find('g'));
    const auto* found =
        std::find_if(std::begin(kElements), std::end(kElements),
                     [&](const FebElement& k) { return part.type == k.type || plain == k.type; });
    if (found == std::end(kElements)) {
      file_.xml.fault(
          section, format("the type of elements {} is not known", quote(part.type)),
          "Types are hex8, hex20, hex27, tet4, tet10, tet15, penta6, penta15 and others.");
      return;
    }
    part.type = found->type;
    part.shape = found->shape;
    part.size = found->nodes;
    for (const FebPart& other : mesh_.parts)
      if (other.name == part.name && !part.name.empty())
        fault(section, format("the elements {} stand twice", quote(part.name)),
              "Rename one of them.");
    for (const Element* e : file_.xml.children(section, "elem")) {
      if (faults_ > kMostFaults) break;
      const auto id = file_.id(*e);
      const std::vector<std::int64_t> ids = file_.integers(*e);
      if (static_cast<int>(ids.size()) != part.size) {
        fault(
            *e,
            format("an element of type {} has {} nodes, not {}", part.type, ids.size(), part.size),
            "Give all of them.");
        continue;
      }
      std::vector<int> nodes;
      for (const std::int64_t n : ids) nodes.push_back(node(*e, n));
      if (!id || std::find(nodes.begin(), nodes.end(), -1) != nodes.end()) continue;
      if (part.shape == "hex27") {
        const std::vector<int> given = nodes;
        for (std::size_t k = 0; k < 7; ++k)
          nodes[static_cast<std::size_t>(kFaceNodesOfHex27[k])] = given[20 + k];
      }
      part.ids.push_back(*id);
      part.nodes.insert(part.nodes.end(), nodes.begin(), nodes.end());
    }
    mesh_.parts.push_back(std::move(part));
  }

  void read_facets(const Element& section) {
    std::vector<std::vector<int>>* surface = add(mesh_.surfaces, section);
    for (const Element* e : file_.children(section)) {
      if (faults_ > kMostFaults) return;
      file_.ignored.attributes(*e, {"id"});
      const std::vector<std::int64_t> ids = file_.integers(*e);
      std::vector<int> nodes;
      for (const std::int64_t n : ids) nodes.push_back(node(*e, n));
      const std::string name = e->Name();
      if (nodes.size() < 2 || nodes.size() > 9 || name.empty() ||
          name.back() - '0' != static_cast<int>(nodes.size()))
        fault(*e, format("<{}> has {} nodes", name, nodes.size()), "Give all nodes of the facet.");
      else if (surface != nullptr && std::find(nodes.begin(), nodes.end(), -1) == nodes.end())
        surface->push_back(std::move(nodes));
    }
  }

  FebFile& file_;
  FebMesh& mesh_;
  std::vector<const Element*> domains_;
  int faults_ = 0;
};

}  // namespace

bool FebPart::is_solid() const {
  return type.starts_with("hex") || type.starts_with("tet") || type.starts_with("penta") ||
         type.starts_with("pyra");
}

void FebMesh::replace(const std::map<int, int>& twins) {
  std::vector<int> by(nodes.size());
  for (std::size_t k = 0; k < by.size(); ++k) by[k] = static_cast<int>(k);
  for (const auto& [from, to] : twins) by[static_cast<std::size_t>(from)] = to;
  const auto in = [&](auto& list) {
    for (int& node : list) node = by[static_cast<std::size_t>(node)];
  };
  for (FebPart& part : parts) in(part.nodes);
  for (auto& [name, set] : node_sets) in(set);
  for (auto& [name, facets] : surfaces)
    for (std::vector<int>& facet : facets) in(facet);
  for (auto& [name, pairs] : discrete_sets)
    for (std::array<int, 2>& ends : pairs) in(ends);
  for (auto& [label, node] : place) node = by[static_cast<std::size_t>(node)];
}

FebMesh read_feb_mesh(FebFile& file, const Element* mesh, const Element* domains) {
  FebMesh result;
  MeshReader reader(file, result);
  if (mesh != nullptr) reader.read_mesh(*mesh);
  if (domains != nullptr) reader.read_domains(*domains);
  return result;
}

}  // namespace polhode::io
