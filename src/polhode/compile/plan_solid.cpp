// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

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
    choose_material();
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
        fault("mesh", format("{} is no solid element", block.type),
              "Use hexahedra, tetrahedra or wedges");
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

  void choose_material() {
    const MaterialSpec* material = nullptr;
    try {
      const int index = model_.material_index(solid_.material);
      material = &model_.materials[static_cast<std::size_t>(index)];
    } catch (const InputError& e) {
      fault("material", e.what_is_wrong(), e.hint());
      return;
    }
    plan_.density = solid_.density.value_or(material->density);
    if (!(plan_.density > 0.0))
      fault(solid_.density ? "density" : "", format("the density is {:g} kg/m^3", plan_.density),
            "Give the material or the solid a density above zero");
    for (const solids::ElementBlock& block : plan_.mesh.blocks) {
      try {
        const bool uncoupled = solids::material_kind(material->type).uncoupled;
        plan_.elements.push_back(
            solids::choose_element(where_, solid_.element, block.type, uncoupled).name);
      } catch (const InputError& e) {
        fault("element", e.what_is_wrong(), e.hint());
        return;
      }
    }
    const auto& kinds = plan_.elements;
    if (std::find(kinds.begin(), kinds.end(), "hex8_q1p0") != kinds.end() && one_layer())
      plan_.warnings.push_back(
          format("{}: hex8_q1p0 is inaccurate in bending with one element through the thickness. "
                 "Use two or three.",
                 where_));
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
