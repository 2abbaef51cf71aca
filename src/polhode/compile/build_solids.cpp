// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <memory>

#include <polhode/compile/build_solids.hpp>
#include <polhode/compile/solid_parts.hpp>
#include <polhode/compile/solid_point.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/loads/registry.hpp>
#include <polhode/solids/materials/registry.hpp>
#include <polhode/solids/solid_elements.hpp>

namespace polhode {

namespace {

/// Weight of a node below which it is rounding of a point at another node.
constexpr double kNoWeight = 1e-9;

/// A rigid-body motion at the start.
struct RigidMotion {
  Vec3 point = Vec3::Zero(), velocity = Vec3::Zero(), omega = Vec3::Zero();

  [[nodiscard]] Vec3 at(const Vec3& x) const { return velocity + omega.cross(x - point); }
};

/// Reference positions by the system's node numbers, for elements.
std::vector<Vec3> positions(const SolidPlan& plan, int first_node) {
  std::vector<Vec3> X(static_cast<std::size_t>(first_node), Vec3::Zero());
  X.insert(X.end(), plan.start.begin(), plan.start.end());
  return X;
}

class SolidBuilder {
 public:
  SolidBuilder(System& system, const Model& model, int solid, const std::vector<int>& body)
      : system_(system),
        model_(model),
        solid_(model.solids.at(static_cast<std::size_t>(solid))),
        body_(body) {
    map_.plan = plan_solid(model, solid);
    map_.first_node = system.nodes().count();
  }

  SolidMap build() {
    make_elements();
    weigh();
    add_nodes();
    for (auto& group : groups_) {
      map_.elements.push_back(group.get());
      map_.groups.push_back(system_.add_elements(std::move(group)));
    }
    return std::move(map_);
  }

 private:
  void make_elements() {
    std::map<int, std::shared_ptr<const solids::Material>> materials;
    const Quat orientation = solid_.mesh.orientation.normalized();
    const std::vector<Vec3> X = positions(map_.plan, map_.first_node);
    for (std::size_t b = 0; b < map_.plan.mesh.blocks.size(); ++b) {
      const int index = map_.plan.materials[b];
      const MaterialSpec& spec = model_.materials[static_cast<std::size_t>(index)];
      std::shared_ptr<const solids::Material>& material = materials[index];
      if (!material)
        material =
            solids::make_material(format("materials.{}", spec.name), material_description(spec));
      solids::SolidElementsDescription d{.name = format("solids.{}", solid_.name),
                                         .element = map_.plan.elements[b],
                                         .material = material,
                                         .density = map_.plan.densities[b],
                                         .conserving = solid_.stress == "conserving",
                                         .connectivity = map_.plan.mesh.blocks[b].nodes,
                                         .X = X,
                                         .isa = model_.analysis.isa};
      for (int& node : d.connectivity) node += map_.first_node;
      if (map_.plan.fibres[b].empty())
        for (const FibreSpec& fibre : spec.fibres)
          d.fibres.push_back(orientation * fibre.direction);
      for (const Vec3& direction : map_.plan.fibres[b]) d.fibres.push_back(orientation * direction);
      groups_.push_back(solids::make_solid_elements(std::move(d)));
      for (const std::string& warning : groups_.back()->warnings())
        map_.plan.warnings.push_back(warning);
    }
  }

  /// Computes mass and its centre by the rows of the consistent mass matrix: ∫ρ N_i.
  void weigh() {
    std::vector<double> M;
    Vec3 moment = Vec3::Zero();
    for (const auto& group : groups_) {
      const auto n = static_cast<std::size_t>(group->nodes_per_element());
      M.resize(n * n);
      for (int e = 0; e < group->size(); ++e) {
        group->mass(e, M.data());
        const std::span<const int> nodes = group->nodes(e);
        for (std::size_t i = 0; i < n; ++i)
          for (std::size_t j = 0; j < n; ++j) {
            map_.mass += M[i * n + j];
            moment += M[i * n + j] * start(nodes[i] - map_.first_node);
          }
      }
    }
    map_.centre = moment / map_.mass;
  }

  [[nodiscard]] const Vec3& start(int node) const {
    return map_.plan.start[static_cast<std::size_t>(node)];
  }

  /// Initial motion: as given, or that of the first body it is bonded to, or at rest.
  [[nodiscard]] RigidMotion initial_motion() const {
    if (solid_.velocity || solid_.angular_velocity)
      return {map_.centre, solid_.velocity.value_or(Vec3::Zero()),
              solid_.angular_velocity.value_or(Vec3::Zero())};
    if (solid_.bonded.empty() || solid_.bonded.front().body == kGround) return {};
    const BodySpec& body = model_.bodies[static_cast<std::size_t>(solid_.bonded.front().body)];
    return {body.position, body.velocity, body.angular_velocity};
  }

  void add_nodes() {
    const RigidMotion motion = initial_motion();
    std::vector<NodeData> nodes(map_.plan.start.size());
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      nodes[k].position = map_.plan.start[k];
      nodes[k].velocity = motion.at(map_.plan.start[k]);
    }
    for (std::size_t b = 0; b < solid_.bonded.size(); ++b)
      for (const int node : map_.plan.bonded[b])
        bond(nodes[static_cast<std::size_t>(node)], solid_.bonded[b].body);
    for (const NodeData& node : nodes) system_.add_node(node);
    for (std::size_t p = 0; p < solid_.prescribed.size(); ++p)
      for (const int node : map_.plan.prescribed[p])
        for (int c = 0; c < 3; ++c)
          if (const TimeFunctionPtr& f =
                  solid_.prescribed[p].displacement[static_cast<std::size_t>(c)])
            system_.prescribe(map_.first_node + node, c, f);
  }

  void bond(NodeData& node, int body) const {
    const int index = body == kGround ? kGround : body_.at(static_cast<std::size_t>(body));
    node.body = index;
    if (index == kGround) {
      node.velocity.setZero();
      return;
    }
    const BodySpec& spec = model_.bodies[static_cast<std::size_t>(body)];
    const Vec3 arm = node.position - spec.position;
    node.Z = spec.orientation.normalized().conjugate() * arm;
    node.velocity = spec.velocity + spec.angular_velocity.cross(arm);
  }

  System& system_;
  const Model& model_;
  const SolidSpec& solid_;
  const std::vector<int>& body_;
  SolidMap map_;
  std::vector<std::unique_ptr<solids::SolidElements>> groups_;
};

}  // namespace

SolidMap add_solid(System& system, const Model& model, int solid, const std::vector<int>& body) {
  return SolidBuilder(system, model, solid, body).build();
}

std::vector<solids::LoadedFaces> system_faces(const SolidMap& solid, const solids::Surface& faces) {
  std::vector<solids::LoadedFaces> list;
  for (const solids::FaceBlock& block : faces.blocks) {
    list.push_back({block.type, block.nodes});
    for (int& node : list.back().nodes) node += solid.first_node;
  }
  return list;
}

std::vector<int> add_solid_load(System& system, const LoadSpec& load, const SolidMap& solid) {
  const std::string where = format("loads.{}", load.name);
  const solids::SolidLoadKind& kind = solids::solid_load_kind(where + ".type", load.type);
  const auto require = [&](const std::optional<TimeParameter>& key, bool given) {
    if (key && !given)
      throw InputError(where, format("'{}' is missing", key->name), "Give its value");
  };
  require(kind.value, load.value != nullptr);
  require(kind.vector, load.vector.has_value());
  const solids::Mesh& mesh = solid.plan.mesh;
  solids::SolidLoadDescription d{.name = where,
                                 .value = load.value,
                                 .vector = load.vector.value_or(TimeVector{}),
                                 .values = load.parameters,
                                 .X = positions(solid.plan, solid.first_node)};
  for (const Parameter& p : kind.parameters)
    if (p.standard) d.values.try_emplace(p.name, *p.standard);
  if (load.follower)
    d.follower =
        load.keeps == "work" ? solids::FollowerRule::kWork : solids::FollowerRule::kMomentum;
  std::vector<int> groups;
  const auto add = [&] {
    for (std::unique_ptr<ElementGroup>& group : kind.make(d))
      groups.push_back(system.add_elements(std::move(group)));
  };
  switch (kind.place) {
    case solids::SolidLoadPlace::faces:
      d.faces = system_faces(solid, solids::select_faces(where + ".surface", mesh, load.selection));
      break;
    case solids::SolidLoadPlace::nodes:
      d.nodes = solids::select_nodes(where + ".nodes", mesh, load.selection);
      for (int& node : d.nodes) node += solid.first_node;
      break;
    case solids::SolidLoadPlace::elements:
      for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
        d.density = solid.plan.densities[b];
        d.elements = {{solid.plan.elements[b], mesh.blocks[b].nodes}};
        for (int& node : d.elements.back().nodes) node += solid.first_node;
        add();
      }
      return groups;
  }
  add();
  return groups;
}

NodePoint node_point(const SolidMap& solid, const std::string& where, const Vec3& X) {
  const SolidPoint point = solid_point(where, solid.plan.mesh, X);
  NodePoint result;
  for (std::size_t k = 0; k < point.nodes.size(); ++k) {
    if (std::abs(point.weights[k]) <= kNoWeight) continue;
    result.nodes.push_back(solid.first_node + point.nodes[k]);
    result.weights.push_back(point.weights[k]);
  }
  return result;
}

}  // namespace polhode
