// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <optional>

#include <polhode/compile/plan_solid.hpp>
#include <polhode/compile/solid_parts.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/solids/elements/registry.hpp>
#include <polhode/solids/materials/registry.hpp>
#include <polhode/solids/mesh/check_mesh.hpp>
#include <polhode/solids/mesh/generators.hpp>
#include <polhode/solids/mesh/read_mesh.hpp>

namespace polhode {

namespace {

/// A node in no selection so far.
constexpr int kNobody = -1;

class SolidPlanner {
 public:
  SolidPlanner(const Model& model, int solid, std::vector<InputError>* faults)
      : model_(model),
        solid_(model.solids.at(static_cast<std::size_t>(solid))),
        where_(format("solids.{}", solid_.name)),
        faults_(faults) {}

  SolidPlan plan() {
    try {
      plan_.mesh = mesh();
    } catch (const InputError& e) {
      fault(e);
      return std::move(plan_);
    }
    const Mat3 R = solid_.mesh.orientation.normalized().toRotationMatrix();
    for (const Vec3& X : plan_.mesh.nodes) plan_.start.push_back(solid_.mesh.position + R * X);
    if (!check_cells()) return std::move(plan_);
    if (!choose_materials()) return std::move(plan_);
    select_nodes_held();
    select_touching();
    measure();
    return std::move(plan_);
  }

 private:
  void fault(const InputError& e) {
    if (!faults_) throw e;
    faults_->push_back(e);
  }
  void fault(const std::string& key, const std::string& what, const std::string& hint) {
    fault(InputError(key.empty() ? where_ : where_ + "." + key, what, hint));
  }

  solids::Mesh mesh() {
    const MeshSpec& spec = solid_.mesh;
    const std::string where = where_ + ".mesh";
    if (spec.type == "file") return from_file(where);
    if (spec.type == "inline")
      return solids::inline_mesh(where, spec.nodes, spec.elements, spec.sets);
    return solids::make_mesh(where + "." + spec.type, spec.type, spec.parameters,
                             cell_of_element(solid_.element));
  }

  solids::Mesh from_file(const std::string& where) {
    solids::Mesh mesh;
    try {
      mesh = solids::read_mesh(solid_.mesh.file, solid_.mesh.scale);
    } catch (const InputError& e) {
      throw InputError(where + ".file", e.where() + ": " + e.what_is_wrong(), e.hint());
    }
    try {
      mesh = solids::part_of(mesh, solid_.mesh.group);
    } catch (const InputError& e) {
      throw InputError(where + ".group", e.what_is_wrong(), e.hint());
    }
    return mesh;
  }

  /// Whether there are solid cells, all valid and of the required kind.
  bool check_cells() {
    const solids::Mesh& mesh = plan_.mesh;
    bool sound = true;
    if (mesh.element_count() == 0) {
      fault("mesh", "the mesh has no solid elements", "Mesh a volume, not only its surface");
      return false;
    }
    for (const solids::ElementBlock& block : mesh.blocks) {
      if (block.shape().dimension != 3) {
        fault(
            "mesh",
            block.shape().dimension == 2
                ? format("{} is no solid element, and there are no shells (S3, S4 and their like)",
                         block.type)
                : format("{} is no solid element", block.type),
            "Use hexahedra, tetrahedra or wedges; for a plate one layer of hex20 or wedge15, for a "
            "slender part a beam");
        sound = false;
        continue;
      }
      const std::string wanted = cell_of_element(solid_.element);
      if (!wanted.empty() && wanted != block.type) {
        fault("element",
              format("'{}' has {} cells, but the mesh has {}", solid_.element, wanted, block.type),
              "Name an element of the mesh's cells, or leave it out");
        sound = false;
      }
    }
    for (const solids::MeshFault& one : solids::mesh_faults(mesh)) {
      const bool loose = one.kind == solids::MeshFault::Kind::kLooseNodes;
      if (one.fatal || loose) {
        fault(solid_.mesh.type == "file" ? "mesh.file" : "mesh", one.what,
              loose ? "Leave it out, or name it in an element" : one.hint);
        sound = false;
      } else {
        plan_.warnings.push_back(format("{}: {}. {}.", where_, one.what, one.hint));
      }
    }
    return sound;
  }

  /// Number of a material of the model; nothing after an error.
  std::optional<int> material_of(const std::string& key, const std::string& name) {
    try {
      return model_.material_index(name);
    } catch (const InputError& e) {
      fault(key, e.what_is_wrong(), e.hint());
      return std::nullopt;
    }
  }

  /// Part of each element: 0 with the solid's material, or one more than the number of its region.
  std::vector<int> parts_by_element() {
    std::vector<int> part(static_cast<std::size_t>(plan_.mesh.element_count()), 0);
    for (std::size_t k = 0; k < solid_.regions.size(); ++k) {
      const RegionSpec& region = solid_.regions[k];
      const std::string key = format("regions.{}", region.name);
      std::vector<int> elements = region.elements;
      for (std::size_t s = 0; s < region.within.size(); ++s) {
        const std::string at =
            region.within.size() > 1 ? format("{}.within.{}", key, s) : format("{}.within", key);
        try {
          const std::vector<int> more =
              solids::select_elements(where_ + "." + at, plan_.mesh, {region.within[s]});
          elements.insert(elements.end(), more.begin(), more.end());
        } catch (const InputError& e) {
          fault(at, e.what_is_wrong(), e.hint());
        }
      }
      for (const int e : elements) {
        if (e < 0 || e >= static_cast<int>(part.size())) {
          fault(key + ".elements", format("element {} does not exist", e),
                format("The mesh has {} elements; the first is 0", part.size()));
          break;
        }
        int& own = part[static_cast<std::size_t>(e)];
        if (own != 0 && own != static_cast<int>(k) + 1) {
          fault(key,
                format("element {} is in '{}' already", e,
                       solid_.regions[static_cast<std::size_t>(own - 1)].name),
                "An element has one material: choose regions without common elements");
          break;
        }
        own = static_cast<int>(k) + 1;
      }
    }
    return part;
  }

  /// Chooses material, density and kind of element of each block; false after an error.
  bool choose_materials() {
    solids::SplitBlocks split;
    if (solid_.regions.empty()) {
      split.parts.assign(plan_.mesh.blocks.size(), 0);
    } else {
      split = solids::split_blocks(plan_.mesh, parts_by_element());
    }
    std::vector<std::optional<int>> materials{material_of("material", solid_.material)};
    for (const RegionSpec& region : solid_.regions)
      materials.push_back(material_of(format("regions.{}.material", region.name), region.material));
    for (std::size_t k = 0; k < materials.size(); ++k) {
      if (!materials[k]) return false;
      const RegionSpec* region = k == 0 ? nullptr : &solid_.regions[k - 1];
      const std::string key = region ? format("regions.{}", region->name) : "";
      const std::optional<double> given = region ? region->density : solid_.density;
      const double density = given.value_or(material(*materials[k]).density);
      if (!(density > 0.0))
        fault(given ? (region ? key + ".density" : "density") : key,
              format("the density is {:g} kg/m^3", density),
              "Give the material or the solid a density above zero");
      for (std::size_t b = 0; b < split.parts.size(); ++b) {
        if (split.parts[b] != static_cast<int>(k)) continue;
        plan_.materials.resize(split.parts.size());
        plan_.densities.resize(split.parts.size());
        plan_.materials[b] = *materials[k];
        plan_.densities[b] = density;
      }
    }
    return choose_elements(split.parts) && place_fibres(split.former);
  }

  [[nodiscard]] const MaterialSpec& material(int index) const {
    return model_.materials[static_cast<std::size_t>(index)];
  }

  /// @param parts  By block.
  bool choose_elements(const std::vector<int>& parts) {
    for (std::size_t b = 0; b < plan_.mesh.blocks.size(); ++b) {
      const RegionSpec* region =
          parts[b] == 0 ? nullptr : &solid_.regions[static_cast<std::size_t>(parts[b] - 1)];
      const bool own = region != nullptr && !region->element.empty();
      const std::string key = own ? format("regions.{}.element", region->name) : "element";
      const std::string& wanted = own ? region->element : solid_.element;
      const std::string& type = plan_.mesh.blocks[b].type;
      try {
        if (own && cell_of_element(wanted) != type)
          throw InputError(key,
                           format("'{}' has {} cells, but the region has {}", wanted,
                                  cell_of_element(wanted), type),
                           "Name an element of the region's cells, or leave it out");
        const bool uncoupled = solids::material_kind(material(plan_.materials[b]).type).uncoupled;
        plan_.elements.push_back(solids::choose_element(where_, wanted, type, uncoupled).name);
      } catch (const InputError& e) {
        fault(key, e.what_is_wrong(), e.hint());
        return false;
      }
    }
    const auto& kinds = plan_.elements;
    if (std::find(kinds.begin(), kinds.end(), "hex8_q1p0") != kinds.end() && one_layer())
      plan_.warnings.push_back(
          format("{}: hex8_q1p0 is inaccurate in bending with one element through the thickness. "
                 "Use two or three.",
                 where_));
    return true;
  }

  /// Gives each block its directions of fibres. @param former  Numbers of elements before they were
  /// split by materials; empty: they are the same.
  bool place_fibres(const std::vector<int>& former) {
    plan_.fibres.resize(plan_.mesh.blocks.size());
    if (solid_.fibre_directions.empty()) return true;
    const auto count = static_cast<std::size_t>(plan_.mesh.element_count());
    std::vector<std::size_t> families(count);
    for (std::size_t e = 0; e < count; ++e) {
      const std::size_t given = former.empty() ? e : static_cast<std::size_t>(former[e]);
      const auto b = static_cast<std::size_t>(plan_.mesh.place(static_cast<int>(e)).block);
      families[given] = material(plan_.materials[b]).fibres.size();
    }
    std::vector<std::size_t> first(count + 1, 0);
    for (std::size_t e = 0; e < count; ++e) first[e + 1] = first[e] + families[e];
    if (first[count] != solid_.fibre_directions.size()) {
      fault("fibre_directions",
            format("has {} directions, but the elements have {} families of fibres",
                   solid_.fibre_directions.size(), first[count]),
            "Give one direction for each family of each element, in the order of the elements");
      return false;
    }
    for (std::size_t e = 0; e < count; ++e) {
      const std::size_t given = former.empty() ? e : static_cast<std::size_t>(former[e]);
      const auto b = static_cast<std::size_t>(plan_.mesh.place(static_cast<int>(e)).block);
      const auto at = solid_.fibre_directions.begin();
      plan_.fibres[b].insert(plan_.fibres[b].end(), at + static_cast<std::ptrdiff_t>(first[given]),
                             at + static_cast<std::ptrdiff_t>(first[given + 1]));
    }
    return true;
  }

  /// Whether there is a single layer of cells: every node lies on the boundary.
  [[nodiscard]] bool one_layer() const {
    return solids::boundary(plan_.mesh).nodes().size() == plan_.mesh.nodes.size();
  }

  void select_nodes_held() {
    std::vector<int> holder(plan_.mesh.nodes.size(), kNobody);
    for (std::size_t k = 0; k < solid_.bonded.size(); ++k) {
      const BondSpec& bond = solid_.bonded[k];
      const std::string key = "bonded." + model_.body_name(bond.body);
      const std::vector<int> nodes = select(key, bond.nodes);
      if (bond.body != kGround) {
        const BodySpec& body = model_.bodies[static_cast<std::size_t>(bond.body)];
        if (body.point_mass && !body.fixed)
          fault(key, format("'{}' is a point mass, which has no rotation", body.name),
                "Give it an inertia, or join the solid to another body");
      }
      std::vector<int> taken;
      for (const int node : nodes) {
        int& held = holder[static_cast<std::size_t>(node)];
        if (held != kNobody) taken.push_back(node);
        if (held == kNobody) held = static_cast<int>(k);
      }
      if (!taken.empty()) {
        const auto first =
            static_cast<std::size_t>(holder[static_cast<std::size_t>(taken.front())]);
        fault(key,
              format("{} bonded to '{}' already", nodes_text(taken),
                     model_.body_name(solid_.bonded[first].body)),
              "A node can be bonded to one body: choose selections without common nodes");
      }
      plan_.bonded.push_back(nodes);
    }
    select_prescribed(holder);
  }

  void select_prescribed(const std::vector<int>& holder) {
    std::vector<std::array<int, 3>> given(holder.size(), {kNobody, kNobody, kNobody});
    for (std::size_t k = 0; k < solid_.prescribed.size(); ++k) {
      const PrescribedSpec& spec = solid_.prescribed[k];
      const std::string key = format("prescribed.{}.nodes", spec.name);
      const std::vector<int> nodes = select(key, spec.nodes);
      std::vector<int> bonded, twice;
      std::string other;
      for (const int node : nodes) {
        const auto i = static_cast<std::size_t>(node);
        if (holder[i] != kNobody) {
          bonded.push_back(node);
          continue;
        }
        for (std::size_t c = 0; c < 3; ++c) {
          if (!spec.displacement[c]) continue;
          if (given[i][c] != kNobody && (twice.empty() || twice.back() != node)) {
            twice.push_back(node);
            other = solid_.prescribed[static_cast<std::size_t>(given[i][c])].name;
          }
          given[i][c] = static_cast<int>(k);
        }
      }
      if (!bonded.empty())
        fault(key, format("{} bonded to a body already", nodes_text(bonded)),
              "A bonded node cannot be prescribed: choose selections without common nodes");
      if (!twice.empty())
        fault(
            key,
            format("{} prescribed by '{}' in the same direction already", nodes_text(twice), other),
            "Prescribe each component of a node once");
      plan_.prescribed.push_back(nodes);
    }
  }

  /// Description of nodes: "node 3 at (0, 0, 1) and 7 others are", "node 3 at (0, 0, 1) is".
  [[nodiscard]] std::string nodes_text(const std::vector<int>& nodes) const {
    const Vec3& X = plan_.mesh.nodes[static_cast<std::size_t>(nodes.front())];
    std::string text =
        format("node {} at ({:.6g}, {:.6g}, {:.6g})", nodes.front(), X[0], X[1], X[2]);
    if (nodes.size() == 1) return text + " is";
    return text + format(" and {} other{} are", nodes.size() - 1, nodes.size() == 2 ? "" : "s");
  }

  std::vector<int> select(const std::string& key,
                          const std::vector<solids::Selection>& selections) {
    std::vector<int> nodes;
    for (std::size_t k = 0; k < selections.size(); ++k) {
      try {
        const std::vector<int> one =
            solids::select_nodes(where_ + "." + key, plan_.mesh, {selections[k]});
        nodes.insert(nodes.end(), one.begin(), one.end());
      } catch (const InputError& e) {
        const std::string at = selections.size() > 1 ? format("{}.{}", key, k) : key;
        fault(at, e.what_is_wrong(), e.hint());
      }
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  }

  void select_touching() {
    if (!model_.contacts.present || !solid_.contact.touches.value_or(true)) return;
    try {
      plan_.touching =
          solids::select_faces(where_ + ".contact.surface", plan_.mesh, solid_.contact_surface);
    } catch (const InputError& e) {
      fault(e);
    }
  }

  void measure() {
    const solids::Mesh& mesh = plan_.mesh;
    plan_.least_jacobian = std::numeric_limits<double>::infinity();
    std::vector<Vec3> X;
    for (int e = 0; e < mesh.element_count(); ++e) {
      plan_.volume += solids::element_volume(mesh, e);
      X.clear();
      for (const int node : mesh.element_nodes(e))
        X.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
      const double least = solids::least_jacobian(mesh.element_shape(e), X.data());
      if (least >= plan_.least_jacobian) continue;
      plan_.least_jacobian = least;
      plan_.least_element = e;
    }
  }

  const Model& model_;
  const SolidSpec& solid_;
  std::string where_;
  std::vector<InputError>* faults_;
  SolidPlan plan_;
};

}  // namespace

SolidPlan plan_solid(const Model& model, int solid, std::vector<InputError>* faults) {
  return SolidPlanner(model, solid, faults).plan();
}

}  // namespace polhode
