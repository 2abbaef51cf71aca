// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <polhode/base/format.hpp>
#include <polhode/fe/contact/edge_contact.hpp>
#include <polhode/fe/contact/solid_contact.hpp>
#include <polhode/fe/materials/registry.hpp>
#include <polhode/model/build_surface_contacts.hpp>
#include <polhode/model/contact_sides.hpp>
#include <polhode/model/rigid_surfaces.hpp>
#include <polhode/model/solid_parts.hpp>

namespace polhode {

namespace {

/// Part of the smaller of edge and shape that the tolerance of the gap is.
constexpr double kTolerance = 1e-3;
/// Part of Young's modulus that a pressure at gap zero is, at least.
constexpr double kPressure = 0.02;
/// Of the band of faces, that of edges: faces that lie on each other keep their edges farther apart
/// than that, so that these add nothing to a pressure.
constexpr double kEdgeBand = 0.25;

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
    for (std::size_t s = 0; s < model_.solids.size(); ++s)
      for (std::size_t t = s; t < model_.solids.size(); ++t)
        add_solids(static_cast<int>(s), static_cast<int>(t));
    check_named();
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
    const StatedLaw stated =
        law_between(model_.contacts, {material_of(model_.contacts, of_solid), side_of_solid(solid)},
                    {material_of(model_.contacts, of_shape), body});
    const std::string where =
        stated.pair ? format("contacts.pairs.{}", stated.pair->name) : "contacts.default";
    check_tolerance(where, name, spec, shape, stated.law);
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

  /// A band that is wide against the triangles of a shape would reach through them.
  void check_tolerance(const std::string& where, const std::string& solid, const BodySpec& body,
                       std::size_t k, const ContactLawSpec& law) {
    const ShapeSpec& shape = body.shapes[k];
    if (!(law.gap_tolerance > 0.0) || law.potential == "linear") return;
    const double most = widest_tolerance(shape);
    if (law.gap_tolerance > most)
      fault(where,
            format("'{}' meets the {} of '{}' with a gap_tolerance of {:.3g} m, above a quarter of "
                   "the median edge of its triangles, {:.3g} m",
                   solid, shape.type, body.name, law.gap_tolerance, most),
            "Give the pair a smaller gap_tolerance in contacts.pairs, or leave it out");
  }

  /// Two solids; or one with itself, if it says so.
  void add_solids(int s, int t) {
    const SolidSpec &one = model_.solids[static_cast<std::size_t>(s)],
                    &two = model_.solids[static_cast<std::size_t>(t)];
    const ContactSide a = contact_side(one), b = contact_side(two);
    if (!a.touches || !b.touches || (s == t && !one.self_contact)) return;
    if (s != t && (!(groups_.of(a) & groups_.met_by(b)) || !(groups_.of(b) & groups_.met_by(a))))
      return;
    if (excluded_.contains(std::minmax(side_of_solid(s), side_of_solid(t)))) return;
    const StatedLaw stated =
        law_between(model_.contacts, {material_of(model_.contacts, a), side_of_solid(s)},
                    {material_of(model_.contacts, b), side_of_solid(t)});
    const std::string where =
        stated.pair ? format("contacts.pairs.{}", stated.pair->name) : "contacts";
    const std::string who = s == t ? format("'{}' meets itself", one.name)
                                   : format("'{}' and '{}' meet", one.name, two.name);
    if (model_.analysis.type != "dynamics" && stated.law.friction > 0.0)
      fault(where, format("{} with friction, which statics does not know", who),
            "Set friction: 0, or let the model come to rest in dynamics");
    if (const std::string key = strange_key(stated.law); !key.empty())
      fault(where, format("{} by a law with {}, which surfaces of solids do not know", who, key),
            "Give the pair a law of its own in contacts.pairs, without it or with one that is as "
            "friction, or zero");
    if (stated.law.potential == "linear")
      fault(where, format("{} by the linear law, which lets meshes pass", who),
            "Give the pair a law of its own in contacts.pairs, with law: barrier");
    list_.push_back({s, side_of_solid(t), 0, stated.law});
  }

  /// A solid with itself, named without that it touches itself.
  void check_named() {
    for (const ContactPairSpec& pair : model_.contacts.pairs) {
      if (pair.of_materials || pair.a != pair.b || !is_solid_side(pair.a)) continue;
      const SolidSpec& solid = model_.solids[static_cast<std::size_t>(solid_of_side(pair.a))];
      if (!solid.self_contact)
        fault(format("contacts.pairs.{}", pair.name),
              format("'{}' does not touch itself", solid.name),
              format("Set solids.{}.contact: {{self: true}}, or leave the pair out", solid.name));
    }
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
    for (const SurfacePair& pair : pairs) is_solid_side(pair.side) ? add_solids(pair) : add(pair);
    keep(pairs);
  }

 private:
  void add(const SurfacePair& pair) {
    const SolidMap& solid = solids_[static_cast<std::size_t>(pair.solid)];
    const BodySpec& body = model_.bodies[static_cast<std::size_t>(pair.side)];
    const ShapeSpec& shape = body.shapes[pair.shape];
    const int carrier = bodies_[static_cast<std::size_t>(pair.side)];
    const std::vector<LoadedFaces> faces = faces_of(solid);
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
      const double edge = median_edge(block, X);
      const SurfaceLaw law =
          law_of(pair.law, {pair.solid}, edge, std::min(edge, smallest_detail(shape)));
      SurfacePoints points;
      try {
        points = surface_points(where, block, X, left_out);
      } catch (const InputError&) {
        continue;  // everything there is bonded to the body
      }
      const int group = system_.add_elements(std::make_unique<SurfaceContact>(
          where, std::move(points), X, rigid_surface(where, shape, law.normal.tolerance), place,
          law));
      map_.surfaces.push_back({pair.solid, pair.side, pair.shape, group});
    }
  }

  /// By the system's numbers.
  [[nodiscard]] static std::vector<LoadedFaces> faces_of(const SolidMap& solid) {
    std::vector<LoadedFaces> faces;
    for (const FaceBlock& block : solid.plan.touching.blocks) {
      faces.push_back({block.type, block.nodes});
      for (int& node : faces.back().nodes) node += solid.first_node;
    }
    return faces;
  }

  /// Points of each of both surfaces on the triangles of the other, at half their area.
  void add_solids(const SurfacePair& pair) {
    const int partner = solid_of_side(pair.side);
    const bool self = partner == pair.solid;
    const std::vector<Vec3> X = positions();
    const int solids[2] = {pair.solid, partner};
    std::vector<LoadedFaces> faces[2];
    MeshSurface surfaces[2];
    double edge[2];
    for (int k = 0; k < 2; ++k) {
      faces[k] = faces_of(solids_[static_cast<std::size_t>(solids[k])]);
      surfaces[k] = triangulated(faces[k]);
      edge[k] = std::numeric_limits<double>::infinity();
      for (const LoadedFaces& block : faces[k]) edge[k] = std::min(edge[k], median_edge(block, X));
    }
    if (surfaces[0].triangles.empty() || surfaces[1].triangles.empty()) return;
    const double least = std::min(edge[0], edge[1]);
    const SurfaceLaw law = law_of(pair.law, {solids[0], solids[1]}, least, least);
    std::vector<int> carriers;
    carriers.reserve(system_.nodes().count());
    for (int i = 0; i < system_.nodes().count(); ++i) carriers.push_back(system_.nodes()[i].body);
    const auto& name = [&](int side) -> const std::string& {
      return model_.solids[static_cast<std::size_t>(solids[side])].name;
    };
    const SolidContactStart start{.X = X,
                                  .carriers = carriers,
                                  .edge = least,
                                  .way = way_of_step(solids[0], solids[1]),
                                  .self = self};
    for (int k = 0; k < (self ? 1 : 2); ++k) {
      const std::string where = format("{} on {}", name(k), name(1 - k));
      std::vector<MeshPoint> points =
          contact_points(where, faces[k], X, self ? nullptr : &surfaces[1 - k]);
      for (MeshPoint& p : points) p.area *= 0.5;
      const int group = system_.add_elements(
          std::make_unique<SolidContact>(where, std::move(points), surfaces[1 - k], law, start));
      map_.surfaces.push_back({solids[k], side_of_solid(solids[1 - k]), 0, group});
    }
    EdgeContact::Sides sides{sharp_edges(surfaces[0], X), sharp_edges(surfaces[1], X),
                             least * least};
    if (sides.first.edges.empty() || sides.second.edges.empty()) return;
    SurfaceLaw of_edges = law;
    of_edges.normal.tolerance *= kEdgeBand;
    of_edges.normal.stiffness /= kEdgeBand;
    const int group = system_.add_elements(std::make_unique<EdgeContact>(
        format("edges of {} on {}", name(0), self ? "itself" : name(1)), std::move(sides), of_edges,
        start));
    map_.surfaces.push_back({solids[0], side_of_solid(solids[1]), 0, group});
  }

  /// How far nodes of two solids go against each other in the first step [m].
  [[nodiscard]] double way_of_step(int a, int b) const {
    Vec3 mean = Vec3::Zero();
    int count = 0;
    const auto each = [&](auto&& visit) {
      for (const int s : {a, b}) {
        const SolidMap& solid = solids_[static_cast<std::size_t>(s)];
        for (int k = 0; k < solid.node_count(); ++k)
          visit(system_.nodes()[solid.first_node + k].velocity);
      }
    };
    each([&](const Vec3& v) { mean += v, ++count; });
    mean /= count;
    double most = 0.0;
    each([&](const Vec3& v) { most = std::max(most, (v - mean).norm()); });
    return most * model_.analysis.step.value_or(0.0);
  }

  /// On the ground, or carried by four nodes that are bonded to the body.
  SurfacePlace place_of(const BodySpec& body, const ShapeSpec& shape, int carrier) {
    const contact::ShapePlace own = shape_place(body, shape);
    SurfacePlace place;
    place.origin = own.origin;
    place.axes = own.axes;
    if (carrier == kGround) return place;
    const double radius = half_size(shape);
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
    X.reserve(system_.nodes().count());
    for (int i = 0; i < system_.nodes().count(); ++i) X.push_back(system_.nodes()[i].position);
    return X;
  }

  /// Of several solids the softest and lightest counts. @eq{surface-stiffness}
  /// @param smallest  Of edges and half sizes of the shape [m].
  [[nodiscard]] SurfaceLaw law_of(const ContactLawSpec& spec, const std::vector<int>& solids,
                                  double edge, double smallest) const {
    SurfaceLaw law;
    if (spec.potential == "linear") law.normal.potential = contact::NormalPotential::linear;
    law.normal.tolerance = spec.gap_tolerance > 0.0 ? spec.gap_tolerance : kTolerance * smallest;
    double E = std::numeric_limits<double>::infinity(), density = E;
    for (const int s : solids) {
      E = std::min(E, modulus(model_, model_.solids[static_cast<std::size_t>(s)]));
      density = std::min(density, solids_[static_cast<std::size_t>(s)].plan.density);
    }
    const double dt = model_.analysis.type == "dynamics" ? model_.analysis.step.value_or(0.0) : 0.0;
    double& k = law.normal.stiffness;
    if (spec.reference_pressure > 0.0) {
      k = 1.5 * spec.reference_pressure / (2.0 * law.normal.tolerance);
    } else {
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
    for (const SurfacePair& pair : pairs) keep(side_of_solid(pair.solid), pair.side);
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
