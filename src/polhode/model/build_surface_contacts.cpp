// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <polhode/base/format.hpp>
#include <polhode/fe/materials/registry.hpp>
#include <polhode/model/build_surface_contacts.hpp>
#include <polhode/model/contact_sides.hpp>
#include <polhode/model/solid_parts.hpp>

namespace polhode {

namespace {

/// Part of the smaller of edge and shape that the tolerance of the gap is.
constexpr double kTolerance = 1e-3;
/// Part of Young's modulus that a pressure at gap zero is, at least.
constexpr double kPressure = 0.02;
/// Part of the smallest half size by which edges of boxes and cylinders are rounded, at least.
constexpr double kRounding = 1e-3;

bool is_known(const std::string& shape) {
  return shape == "plane" || shape == "sphere" || shape == "capsule" || shape == "box" ||
         shape == "cylinder";
}

/// What a law asks for that surfaces of solids cannot do; empty if nothing. Constants of the force
/// of a point, which surfaces choose for themselves, do not matter.
std::string strange_key(const ContactLawSpec& law) {
  if (law.static_friction > law.friction) return "static_friction";
  if (law.friction_across > 0.0 && law.friction_across != law.friction) return "friction_across";
  if (law.rolling > 0.0) return "rolling_friction";
  if (law.torsion > 0.0) return "torsional_friction";
  return {};
}

class Planner {
 public:
  Planner(const Model& model, std::vector<InputError>* faults)
      : model_(model), faults_(faults), groups_(model) {
    for (const auto& [a, b] : model.contacts.excluded) excluded_.insert(std::minmax(a, b));
    for (const ContactPairSpec& pair : model.contacts.pairs)
      if (!pair.of_materials) named_.insert(std::minmax(pair.a, pair.b));
  }

  std::vector<SurfacePair> plan() {
    for (std::size_t s = 0; s < model_.solids.size(); ++s) {
      const ContactSide solid = contact_side(model_.solids[s]);
      if (!solid.touches) continue;
      for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
        if (!sides_meet(static_cast<int>(s), static_cast<int>(b))) continue;
        for (std::size_t k = 0; k < model_.bodies[b].shapes.size(); ++k) {
          const ContactSide shape = contact_side(model_.bodies[b], k);
          if (!shape.touches || !(groups_.of(shape) & groups_.met_by(solid)) ||
              !(groups_.of(solid) & groups_.met_by(shape)))
            continue;
          add(static_cast<int>(s), solid, static_cast<int>(b), k, shape);
        }
      }
    }
    return std::move(list_);
  }

 private:
  /// Neither excluded nor bonded; a pair that is named is meant.
  [[nodiscard]] bool sides_meet(int solid, int body) const {
    const std::pair<int, int> key = std::minmax(side_of_solid(solid), body);
    if (excluded_.contains(key)) return false;
    if (named_.contains(key) || model_.contacts.joint_neighbours) return true;
    const auto& bonds = model_.solids[static_cast<std::size_t>(solid)].bonded;
    return std::none_of(bonds.begin(), bonds.end(),
                        [&](const BondSpec& bond) { return bond.body == body; });
  }

  void add(int solid, const ContactSide& of_solid, int body, std::size_t shape,
           const ContactSide& of_shape) {
    const BodySpec& spec = model_.bodies[static_cast<std::size_t>(body)];
    const std::string& name = model_.solids[static_cast<std::size_t>(solid)].name;
    if (!is_known(spec.shapes[shape].type))
      fault(shape_path(spec, shape),
            format("the surface of '{}' meets it, which surfaces of solids cannot do with a {}",
                   name, spec.shapes[shape].type),
            "They can with plane, sphere, capsule, box and cylinder. Exclude the pair, or set "
            "contact: {touches: false}");
    const StatedLaw stated =
        law_between(model_.contacts, {material_of(model_.contacts, of_solid), side_of_solid(solid)},
                    {material_of(model_.contacts, of_shape), body});
    const std::string where =
        stated.pair ? format("contacts.pairs.{}", stated.pair->name) : "contacts.default";
    if (const std::string key = strange_key(stated.law); !key.empty())
      fault(where,
            format("'{}' and '{}' meet by a law with {}, which surfaces of solids do not know",
                   name, spec.name, key),
            "Give the pair a law of its own in contacts.pairs, without it or with one that is as "
            "friction, or zero");
    if (model_.analysis.type != "dynamics" && stated.law.friction > 0.0)
      fault(
          where,
          format("'{}' and '{}' meet with friction, which statics does not know", name, spec.name),
          "Set friction: 0, or let the model come to rest in dynamics");
    list_.push_back({solid, body, shape, stated.law});
  }

  void fault(const std::string& where, const std::string& what, const std::string& mend) {
    if (!faults_) throw InputError(where, what, mend);
    if (told_.insert(where + what).second) faults_->emplace_back(where, what, mend);
  }

  const Model& model_;
  std::vector<InputError>* faults_;
  ContactGroups groups_;
  std::set<std::pair<int, int>> excluded_, named_;
  std::set<std::string> told_;
  std::vector<SurfacePair> list_;
};

RigidSurface rigid_surface(const ShapeSpec& shape, double tolerance) {
  RigidSurface s;
  const std::vector<double>& size = shape.sizes;
  const auto rounding = [&] {
    return std::clamp(tolerance, kRounding * s.half.minCoeff(), 0.5 * s.half.minCoeff());
  };
  if (shape.type == "sphere") {
    s.kind = RigidSurface::Kind::sphere;
    s.radius = 0.5 * size[0];
  } else if (shape.type == "capsule") {
    s.kind = RigidSurface::Kind::capsule;
    s.radius = 0.5 * size[0];
    s.half[2] = 0.5 * std::max(0.0, size[1] - size[0]);
  } else if (shape.type == "cylinder") {
    s.kind = RigidSurface::Kind::cylinder;
    s.radius = 0.5 * size[0];
    s.half = Vec3(s.radius, s.radius, 0.5 * size[1]);
    s.rounding = rounding();
  } else if (shape.type == "box") {
    s.kind = RigidSurface::Kind::box;
    s.half = 0.5 * Vec3(size[0], size[1], size[2]);
    s.rounding = rounding();
  }
  return s;
}

/// Half the smallest extent of a shape; infinite for a plane.
double radius_of(const ShapeSpec& shape) {
  if (shape.type == "plane") return std::numeric_limits<double>::infinity();
  return 0.5 * *std::min_element(shape.sizes.begin(), shape.sizes.end());
}

/// Young's modulus of small strains [Pa].
double modulus(const Model& model, const SolidSpec& solid) {
  const MaterialSpec& spec =
      model.materials[static_cast<std::size_t>(model.material_index(solid.material))];
  const LinearModuli m =
      make_material(format("materials.{}", spec.name), material_description(spec))->linear();
  return m.shear * (3.0 * m.lame + 2.0 * m.shear) / (m.lame + m.shear);
}

class SurfacesBuilder {
 public:
  SurfacesBuilder(System& system, const Model& model, const std::vector<int>& bodies,
                  const std::vector<SolidMap>& solids, ContactMap& map)
      : system_(system), model_(model), bodies_(bodies), solids_(solids), map_(map) {}

  void build() {
    const std::vector<SurfacePair> pairs = plan_surface_contacts(model_);
    for (const SurfacePair& pair : pairs) add(pair);
    keep(pairs);
  }

 private:
  void add(const SurfacePair& pair) {
    const SolidMap& solid = solids_[static_cast<std::size_t>(pair.solid)];
    const BodySpec& body = model_.bodies[static_cast<std::size_t>(pair.body)];
    const ShapeSpec& shape = body.shapes[pair.shape];
    const int carrier = bodies_[static_cast<std::size_t>(pair.body)];
    std::vector<LoadedFaces> faces;
    for (const FaceBlock& block : solid.plan.touching.blocks) {
      faces.push_back({block.type, block.nodes});
      for (int& node : faces.back().nodes) node += solid.first_node;
    }
    // What is bonded to a body does not touch its shapes.
    std::vector<int> left_out;
    for (int k = 0; k < solid.node_count(); ++k)
      if (system_.nodes()[solid.first_node + k].body == carrier)
        left_out.push_back(solid.first_node + k);
    const SurfacePlace place = place_of(body, shape, carrier);
    const std::vector<Vec3> X = positions();
    for (const LoadedFaces& block : faces) {
      const std::string where =
          format("{} on {}", model_.solids[static_cast<std::size_t>(pair.solid)].name,
                 body.shapes.size() > 1 ? format("{}.{}", body.name, pair.shape) : body.name);
      const SurfaceLaw law = law_of(pair, shape, median_edge(block, X));
      SurfacePoints points;
      try {
        points = surface_points(where, block, X, left_out);
      } catch (const InputError&) {
        continue;  // everything there is bonded to the body
      }
      const int group = system_.add_elements(std::make_unique<SurfaceContact>(
          where, std::move(points), X, rigid_surface(shape, law.normal.tolerance), place, law));
      map_.surfaces.push_back({pair.solid, pair.body, pair.shape, group});
    }
  }

  /// On the ground, or carried by four nodes that are bonded to the body.
  SurfacePlace place_of(const BodySpec& body, const ShapeSpec& shape, int carrier) {
    const contact::ShapePlace own = shape_place(body, shape);
    SurfacePlace place;
    place.origin = own.origin;
    place.axes = own.axes;
    if (carrier == kGround) return place;
    const double radius = radius_of(shape);
    place.size = std::isfinite(radius) ? 2.0 * radius : 1.0;
    const Quat q = body.orientation.normalized();
    for (int k = 0; k < 4; ++k) {
      NodeData node;
      node.Z = own.origin + (k == 0 ? Vec3(Vec3::Zero()) : Vec3(place.size * own.axes.col(k - 1)));
      const Vec3 arm = q * node.Z;
      node.position = body.position + arm;
      node.velocity = body.velocity + body.angular_velocity.cross(arm);
      node.body = carrier;
      place.nodes[static_cast<std::size_t>(k)] = system_.add_node(node);
    }
    return place;
  }

  /// At the start, by the system's numbers.
  [[nodiscard]] std::vector<Vec3> positions() const {
    std::vector<Vec3> X;
    for (int i = 0; i < system_.nodes().count(); ++i) X.push_back(system_.nodes()[i].position);
    return X;
  }

  /// @eq{surface-stiffness}
  [[nodiscard]] SurfaceLaw law_of(const SurfacePair& pair, const ShapeSpec& shape,
                                  double edge) const {
    const ContactLawSpec& spec = pair.law;
    const SolidSpec& solid = model_.solids[static_cast<std::size_t>(pair.solid)];
    SurfaceLaw law;
    if (spec.potential == "linear") law.normal.potential = contact::NormalPotential::linear;
    law.normal.tolerance = spec.gap_tolerance > 0.0 ? spec.gap_tolerance
                                                    : kTolerance * std::min(edge, radius_of(shape));
    const double density = solids_[static_cast<std::size_t>(pair.solid)].plan.density;
    const double dt = model_.analysis.type == "dynamics" ? model_.analysis.step.value_or(0.0) : 0.0;
    double& k = law.normal.stiffness;
    if (spec.reference_pressure > 0.0) {
      k = 1.5 * spec.reference_pressure / (2.0 * law.normal.tolerance);
    } else {
      const double E = modulus(model_, solid);
      k = 1.5 * std::max(E / edge, kPressure * E / (2.0 * law.normal.tolerance));
      if (dt > 0.0) k = std::max(k, density * edge / (dt * dt));
    }
    law.end_share = 0.5 * (1.0 - spec.restitution);
    law.mu = spec.friction;
    law.bristle = k;
    return law;
  }

  /// Pairs that are named come first; all others follow, unless few are wanted.
  void keep(const std::vector<SurfacePair>& pairs) {
    std::set<std::pair<int, int>> kept;
    const auto keep = [&](int a, int b) {
      if ((is_solid_side(a) || is_solid_side(b)) && kept.insert(std::minmax(a, b)).second)
        map_.pairs.push_back({a, b, ""});
    };
    for (const ContactPairSpec& pair : model_.contacts.pairs)
      if (!pair.of_materials) keep(pair.a, pair.b);
    for (const ProbeSpec& probe : model_.output.probes)
      if (probe.kind == "contact") keep(probe.pair[0], probe.pair[1]);
    if (!model_.contacts.record.value_or(true)) return;
    for (const SurfacePair& pair : pairs) keep(side_of_solid(pair.solid), pair.body);
  }

  System& system_;
  const Model& model_;
  const std::vector<int>& bodies_;
  const std::vector<SolidMap>& solids_;
  ContactMap& map_;
};

}  // namespace

std::vector<SurfacePair> plan_surface_contacts(const Model& model,
                                               std::vector<InputError>* faults) {
  if (!model.contacts.present) return {};
  return Planner(model, faults).plan();
}

void add_surface_contacts(System& system, const Model& model, const std::vector<int>& bodies,
                          const std::vector<SolidMap>& solids, ContactMap& map) {
  if (model.contacts.present && !model.solids.empty())
    SurfacesBuilder(system, model, bodies, solids, map).build();
}

}  // namespace polhode
