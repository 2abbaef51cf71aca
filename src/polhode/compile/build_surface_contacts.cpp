// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <set>

#include <polhode/compile/build_surface_contacts.hpp>
#include <polhode/compile/cable_contact.hpp>
#include <polhode/compile/cable_pairs.hpp>
#include <polhode/compile/contact_sides.hpp>
#include <polhode/compile/rigid_surfaces.hpp>
#include <polhode/compile/solid_parts.hpp>
#include <polhode/compile/surface_overlaps.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/materials/registry.hpp>
#include <polhode/surface_contact/edge_contact.hpp>
#include <polhode/surface_contact/solid_contact.hpp>
#include <polhode/surface_contact/solid_inside.hpp>

namespace polhode {

namespace {

/// Tolerance of the gap, as a part of the smaller of edge and shape.
constexpr double kTolerance = 1e-3;
/// Tolerance of a cable against a solid, which deforms much more, as a part of its radius.
constexpr double kOnSolid = 1e-2;
/// Smallest pressure at gap zero, as a part of Young's modulus.
constexpr double kPressure = 0.02;
/// Smallest pressure of a cable at gap zero, as a part of Young's modulus: that of one per cent of
/// strain on a drum of fifteen times the cable's radius.
constexpr double kCablePressure = 1e-3;
/// Band of edges as a part of that of faces: faces in contact keep their edges farther apart than
/// that, so that edges add nothing to the pressure, even if their band ends at the initial gap.
constexpr double kEdgeBand = 0.1;

/// Potential between surfaces. Where the law is Hertz's it is the barrier, since the solid itself
/// has the compliance of that law.
contact::NormalPotential potential_between_surfaces(const std::string& word) {
  using contact::NormalPotential;
  const auto potential = contact::potential_of(word).value_or(NormalPotential::barrier);
  switch (potential) {
    case NormalPotential::barrier:
    case NormalPotential::linear:
      return potential;
    case NormalPotential::hertz:
      return NormalPotential::barrier;
  }
  return potential;
}

/// Young's modulus at small strains [Pa]: the smallest of a solid's materials.
double modulus(const Model& model, const SolidMap& solid) {
  double least = std::numeric_limits<double>::infinity();
  for (const int material : solid.plan.materials) {
    const MaterialSpec& spec = model.materials[static_cast<std::size_t>(material)];
    const solids::LinearModuli m =
        solids::make_material(format("materials.{}", spec.name), material_description(spec))
            ->linear();
    least = std::min(least, m.shear * (3.0 * m.lame + 2.0 * m.shear) / (m.lame + m.shear));
  }
  return least;
}

class SurfacesBuilder {
 public:
  SurfacesBuilder(System& system, const Model& model, const std::vector<int>& bodies,
                  const std::vector<SolidMap>& solids, ContactMap& map)
      : system_(system), model_(model), bodies_(bodies), solids_(solids), map_(map) {}

  void build() {
    const std::vector<SurfacePair> pairs = plan_surface_contacts(model_);
    for (const SurfacePair& pair : pairs) {
      if (pair.own.is_cable() && pair.side.is_cable())
        add_cables(pair);
      else if (pair.own.is_cable() && pair.side.is_solid())
        add_cable_on_solid(pair);
      else if (pair.own.is_cable())
        add_cable(pair);
      else if (pair.side.is_solid())
        add_solids(pair);
      else
        add(pair);
    }
    keep(pairs);
  }

 private:
  /// Adds elements to the system, and their owners to the map.
  template <class Elements>
  void add_elements(const SurfacePair& pair, std::unique_ptr<Elements> elements) {
    ContactMap::Surface surface{pair.own, pair.side, !pair.side.is_body() ? 0 : pair.shape};
    surface.touching = elements.get();
    if constexpr (std::same_as<Elements, surface_contact::SolidContact>)
      surface.on_mesh = elements.get();
    surface.group = system_.add_elements(std::move(elements));
    map_.surfaces.push_back(surface);
  }

  void add(const SurfacePair& pair) {
    const int own = pair.own.index;
    const SolidMap& solid = solids_[static_cast<std::size_t>(own)];
    const BodySpec& body = model_.bodies[static_cast<std::size_t>(pair.side.index)];
    const ShapeSpec& shape = body.shapes[pair.shape];
    const int carrier = bodies_[static_cast<std::size_t>(pair.side.index)];
    const std::vector<solids::LoadedFaces> faces = faces_of(solid);
    // Nodes bonded to a body are not in contact with its shapes.
    std::vector<int> left_out;
    for (int k = 0; k < solid.node_count(); ++k)
      if (system_.nodes()[solid.first_node + k].body == carrier)
        left_out.push_back(solid.first_node + k);
    const surface_contact::SurfacePlace place = place_of(body, shape, carrier);
    const std::vector<Vec3> X = positions();
    for (const solids::LoadedFaces& block : faces) {
      const std::string where = name_of(pair);
      const double edge = surface_contact::median_edge(block, X);
      const surface_contact::SurfaceLaw law = law_of(
          pair.law, material_of({own}), edge, std::min(edge, smallest_detail(shape)), Band::below);
      surface_contact::SurfacePoints points;
      try {
        points = surface_contact::surface_points(where, block, X, left_out);
      } catch (const InputError&) {
        continue;  // all of it is bonded to the body
      }
      add_elements(pair, std::make_unique<surface_contact::SurfaceContact>(
                             where, std::move(points), X,
                             rigid_surface(where, shape, law.normal.tolerance), place, law));
    }
  }

  /// Name of a pair: "rope on post".
  [[nodiscard]] std::string name_of(const SurfacePair& pair) const {
    const BodySpec& body = model_.bodies[static_cast<std::size_t>(pair.side.index)];
    return format("{} on {}", model_.side_name(pair.own),
                  body.shapes.size() > 1 ? format("{}.{}", body.name, pair.shape) : body.name);
  }

  const CableLine& line_of(const Side& side) {
    auto [at, fresh] = lines_.try_emplace(side);
    if (fresh) at->second = add_cable_line(system_, model_, cable_of(side), bodies_);
    return at->second;
  }
  [[nodiscard]] const CableLineSpec& cable_of(const Side& side) const {
    return model_.cables[static_cast<std::size_t>(side.index)];
  }

  /// Adds two cables, or one with itself.
  void add_cables(const SurfacePair& pair) {
    const CableSide a{cable_of(pair.own), line_of(pair.own)},
        b{cable_of(pair.side), line_of(pair.side)};
    const double radius = std::min(a.line.radius, b.line.radius);
    const surface_contact::SurfaceLaw law =
        law_of(pair.law, lesser(material_of(a.cable), material_of(b.cable)), 2.0 * radius, radius,
               Band::about);
    const std::vector<Vec3> X = positions();
    const std::vector<int> carriers = this->carriers();
    std::vector<int> nodes = a.line.nodes;
    nodes.insert(nodes.end(), b.line.nodes.begin(), b.line.nodes.end());
    const surface_contact::SolidContactStart start{
        .X = X,
        .carriers = carriers,
        .edge = std::min(mean_piece(a.line), mean_piece(b.line)),
        .way = way_of_step(nodes),
        .self = pair.own == pair.side};
    add_elements(pair, std::make_unique<surface_contact::EdgeContact>(
                           format("{} on {}", a.cable.name, start.self ? "itself" : b.cable.name),
                           cable_sides(model_, a, b, X, law.normal.tolerance), law, start));
  }

  /// Adds the centre line of a cable, which stays at its radius from the other surface.
  void add_cable(const SurfacePair& pair) {
    const CableLineSpec& cable = model_.cables[static_cast<std::size_t>(pair.own.index)];
    const BodySpec& body = model_.bodies[static_cast<std::size_t>(pair.side.index)];
    const ShapeSpec& shape = body.shapes[pair.shape];
    const CableLine& line = line_of(pair.own);
    const CableSizes sizes = cable_sizes(shape, line.radius);
    const surface_contact::SurfaceLaw law =
        law_of(pair.law, material_of(cable), 2.0 * line.radius, sizes.smallest, Band::about);
    const std::string where = name_of(pair);
    const surface_contact::RigidSurface surface = rigid_surface(where, shape, law.normal.tolerance);
    CablePoints points = cable_points(line, spacing(shape, line.radius));
    points.points.through = sizes.through;
    const surface_contact::SurfacePlace place =
        place_of(body, shape, bodies_[static_cast<std::size_t>(pair.side.index)]);
    const std::vector<Vec3> X = positions();
    const std::vector<double> gaps =
        surface_contact::SurfaceContact(where, points.points, X, surface, place, law).gaps(X);
    leave_out_attachments(
        points, cable, line,
        [&](const AttachmentSpec& a) { return is_fastened_to(model_, a, pair.side.index); },
        [&](int point) {
          return gaps[static_cast<std::size_t>(point)] < -0.5 * law.normal.tolerance;
        });
    if (points.arc.empty()) return;
    add_elements(pair, std::make_unique<surface_contact::SurfaceContact>(
                           where, std::move(points.points), X, surface, place, law));
  }

  /// Adds the centre line of a cable against the triangles of a solid.
  void add_cable_on_solid(const SurfacePair& pair) {
    const CableLineSpec& cable = model_.cables[static_cast<std::size_t>(pair.own.index)];
    const int s = pair.side.index;
    const SolidSpec& solid = model_.solids[static_cast<std::size_t>(s)];
    const CableLine& line = line_of(pair.own);
    const std::vector<Vec3> X = positions();
    const std::vector<solids::LoadedFaces> faces = faces_of(solids_[static_cast<std::size_t>(s)]);
    const surface_contact::MeshSurface surface = surface_contact::triangulated(faces);
    if (surface.triangles.empty()) return;
    const surface_contact::SurfaceLaw law =
        law_of(pair.law, lesser(material_of({s}), material_of(cable)), 2.0 * line.radius,
               kOnSolid / kTolerance * line.radius, Band::about);
    const std::vector<int> carriers = this->carriers();
    std::vector<int> moving = nodes_of({s});
    moving.insert(moving.end(), line.nodes.begin(), line.nodes.end());
    const surface_contact::SolidContactStart start{
        .X = X, .carriers = carriers, .edge = smallest_edge(faces, X), .way = way_of_step(moving)};
    const std::string where = format("{} on {}", cable.name, solid.name);
    const auto contact = [&](const CablePoints& points) {
      return std::make_unique<surface_contact::SolidContact>(
          where, mesh_points(points.points), surface, law, start, round_line(points.points));
    };
    CablePoints points = cable_points(line, 0.5 * line.radius);
    const std::vector<double> gaps = contact(points)->gaps_at_start();
    const std::vector<surface_contact::MeshPoint> places = mesh_points(points.points);
    const surface_contact::SolidInside inside(solid_boundary(solids_[static_cast<std::size_t>(s)]),
                                              X[0].data());
    leave_out_attachments(
        points, cable, line,
        [&](const AttachmentSpec& a) {
          return std::any_of(solid.bonded.begin(), solid.bonded.end(), [&](const BondSpec& bond) {
            return is_fastened_to(model_, a, bond.body);
          });
        },
        [&](int point) {
          const auto p = static_cast<std::size_t>(point);
          return gaps[p] < -0.5 * law.normal.tolerance ||
                 inside.overlap(places[p].at(X[0].data()), line.radius);
        });
    if (points.arc.empty()) return;
    add_elements(pair, contact(points));
  }

  /// Body of each node.
  [[nodiscard]] std::vector<int> carriers() const {
    std::vector<int> list;
    list.reserve(system_.nodes().count());
    for (int i = 0; i < system_.nodes().count(); ++i) list.push_back(system_.nodes()[i].body);
    return list;
  }

  [[nodiscard]] static double smallest_edge(const std::vector<solids::LoadedFaces>& faces,
                                            const std::vector<Vec3>& X) {
    double edge = std::numeric_limits<double>::infinity();
    for (const solids::LoadedFaces& block : faces)
      edge = std::min(edge, surface_contact::median_edge(block, X));
    return edge;
  }

  /// Largest distance of points of a cable. Over a plane the straight segments are highest and
  /// lowest at nodes; elsewhere bends around the shape must be resolved.
  [[nodiscard]] static double spacing(const ShapeSpec& shape, double radius) {
    if (shape.type == "plane") return std::numeric_limits<double>::infinity();
    const bool round = shape.type == "sphere" || shape.type == "capsule";
    return 0.5 * (radius + (round ? 0.5 * shape.sizes[0] : 0.0));
  }

  [[nodiscard]] static std::vector<solids::LoadedFaces> faces_of(const SolidMap& solid) {
    return system_faces(solid, solid.plan.touching);
  }

  /// Adds points of each of both surfaces against the triangles of the other, at half their area.
  void add_solids(const SurfacePair& pair) {
    const int own = pair.own.index, partner = pair.side.index;
    const bool self = partner == own;
    const std::vector<Vec3> X = positions();
    const int solids[2] = {own, partner};
    std::vector<solids::LoadedFaces> faces[2];
    surface_contact::MeshSurface surfaces[2];
    double edge[2];
    for (int k = 0; k < 2; ++k) {
      faces[k] = faces_of(solids_[static_cast<std::size_t>(solids[k])]);
      surfaces[k] = surface_contact::triangulated(faces[k]);
      edge[k] = smallest_edge(faces[k], X);
    }
    if (surfaces[0].triangles.empty() || surfaces[1].triangles.empty()) return;
    const double least = std::min(edge[0], edge[1]);
    surface_contact::SurfaceLaw law =
        law_of(pair.law, material_of({solids[0], solids[1]}), least, least, Band::about);
    const std::vector<int> carriers = this->carriers();
    const auto& name = [&](int side) -> const std::string& {
      return model_.solids[static_cast<std::size_t>(solids[side])].name;
    };
    const surface_contact::SolidContactStart start{
        .X = X,
        .carriers = carriers,
        .edge = least,
        .way = way_of_step(nodes_of({solids[0], solids[1]})),
        .self = self};
    const auto contact = [&](int k) {
      const std::string where = format("{} on {}", name(k), name(1 - k));
      std::vector<surface_contact::MeshPoint> points =
          surface_contact::contact_points(where, faces[k], X, self ? nullptr : &surfaces[1 - k]);
      for (surface_contact::MeshPoint& p : points) p.area *= 0.5;
      return std::make_unique<surface_contact::SolidContact>(where, std::move(points),
                                                             surfaces[1 - k], law, start);
    };
    for (int k = 0; k < (self ? 1 : 2); ++k) {
      SurfacePair sides = pair;
      sides.own = Side::of_solid(solids[k]);
      sides.side = Side::of_solid(solids[1 - k]);
      add_elements(sides, contact(k));
    }
    add_edges(pair, surfaces, X, law, start);
  }

  /// Adds the sharp edges of both surfaces against each other.
  void add_edges(const SurfacePair& pair, const surface_contact::MeshSurface (&surfaces)[2],
                 const std::vector<Vec3>& X, surface_contact::SurfaceLaw law,
                 const surface_contact::SolidContactStart& start) {
    surface_contact::EdgeContact::Sides sides{surface_contact::sharp_edges(surfaces[0], X),
                                              surface_contact::sharp_edges(surfaces[1], X),
                                              start.edge * start.edge};
    if (sides.first.edges.empty() || sides.second.edges.empty()) return;
    law.normal.tolerance *= kEdgeBand;
    law.normal.stiffness /= kEdgeBand;
    add_elements(pair, std::make_unique<surface_contact::EdgeContact>(
                           format("edges of {} on {}", model_.side_name(pair.own),
                                  start.self ? "itself" : model_.side_name(pair.side)),
                           std::move(sides), law, start));
  }

  [[nodiscard]] std::vector<int> nodes_of(const std::vector<int>& solids) const {
    std::vector<int> list;
    for (const int s : solids) {
      const SolidMap& solid = solids_[static_cast<std::size_t>(s)];
      for (int k = 0; k < solid.node_count(); ++k) list.push_back(solid.first_node + k);
    }
    return list;
  }

  /// Relative displacement of nodes in the first step [m].
  [[nodiscard]] double way_of_step(const std::vector<int>& nodes) const {
    Vec3 mean = Vec3::Zero();
    for (const int i : nodes) mean += system_.nodes()[i].velocity;
    mean /= static_cast<double>(nodes.size());
    double most = 0.0;
    for (const int i : nodes) most = std::max(most, (system_.nodes()[i].velocity - mean).norm());
    return most * model_.analysis.step.value_or(0.0);
  }

  /// Placement on the ground, or carried by four nodes bonded to the body.
  surface_contact::SurfacePlace place_of(const BodySpec& body, const ShapeSpec& shape,
                                         int carrier) {
    const geometry::ShapePlace own = shape_place(body, shape);
    surface_contact::SurfacePlace place;
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

  /// Positions at the start, by the system's numbers.
  [[nodiscard]] std::vector<Vec3> positions() const {
    std::vector<Vec3> X;
    X.reserve(system_.nodes().count());
    for (int i = 0; i < system_.nodes().count(); ++i) X.push_back(system_.nodes()[i].position);
    return X;
  }

  /// Properties that determine the stiffness of a surface.
  struct SurfaceMaterial {
    double E = std::numeric_limits<double>::infinity();  ///< Young's modulus [Pa].
    double pressure = E;                                 ///< Smallest pressure at gap zero [Pa].
  };
  /// Material of the softest of several solids.
  [[nodiscard]] SurfaceMaterial material_of(const std::vector<int>& solids) const {
    SurfaceMaterial material;
    for (const int s : solids) {
      material.E = std::min(material.E, modulus(model_, solids_[static_cast<std::size_t>(s)]));
      material.pressure = kPressure * material.E;
    }
    return material;
  }
  [[nodiscard]] static SurfaceMaterial lesser(const SurfaceMaterial& a, const SurfaceMaterial& b) {
    return {std::min(a.E, b.E), std::min(a.pressure, b.pressure)};
  }
  /// Material of a cable as a solid round bar that is not flattened. @eq{cable-stiffness}
  [[nodiscard]] static SurfaceMaterial material_of(const CableLineSpec& cable) {
    const double area = std::numbers::pi * cable.contact->radius * cable.contact->radius;
    return {0.0, kCablePressure * cable.stiffness / area};
  }

  /// Position of the band in which surfaces act: below those of rigid shapes, which have an inside.
  enum class Band { below, about };

  /// @param edge  Of the mesh, or the diameter of a cable [m].
  /// @param smallest  Of edges, radii and half sizes of the shape [m]. @eq{surface-stiffness}
  [[nodiscard]] surface_contact::SurfaceLaw law_of(const ContactLawSpec& spec,
                                                   const SurfaceMaterial& material, double edge,
                                                   double smallest, Band place) const {
    surface_contact::SurfaceLaw law;
    law.normal.potential = potential_between_surfaces(spec.potential);
    law.normal.tolerance = spec.gap_tolerance > 0.0 ? spec.gap_tolerance : kTolerance * smallest;
    const bool barrier = !law.normal.is_spring();
    if (barrier && place == Band::below) law.normal.upper = 0.0;
    const double band = barrier ? law.normal.band() : 2.0 * law.normal.tolerance;
    double& k = law.normal.stiffness;
    k = spec.reference_pressure > 0.0 ? 1.5 * spec.reference_pressure / band
                                      : 1.5 * std::max(material.E / edge, material.pressure / band);
    law.end_share = 0.5 * (1.0 - spec.restitution);
    law.mu = spec.friction;
    law.bristle = k;
    return law;
  }

  /// Records pairs: named ones first, then all others unless there are too many.
  void keep(const std::vector<SurfacePair>& pairs) {
    std::set<std::pair<Side, Side>> kept;
    const auto keep = [&](const Side& a, const Side& b) {
      if ((!a.is_body() || !b.is_body()) && kept.insert(std::minmax(a, b)).second)
        map_.pairs.push_back({a, b, ""});
    };
    for (const ContactPairSpec& pair : model_.contacts.pairs)
      if (!pair.of_materials) keep(pair.a, pair.b);
    for (const Reported& asked : reported(model_))
      if (asked.of->kind == "contact") keep(asked.of->pair[0], asked.of->pair[1]);
    if (!model_.contacts.record.value_or(true)) return;
    for (const SurfacePair& pair : pairs) keep(pair.own, pair.side);
  }

  System& system_;
  const Model& model_;
  const std::vector<int>& bodies_;
  const std::vector<SolidMap>& solids_;
  ContactMap& map_;
  std::map<Side, CableLine> lines_;  ///< By side.
};

}  // namespace

void add_surface_contacts(System& system, const Model& model, const std::vector<int>& bodies,
                          const std::vector<SolidMap>& solids, ContactMap& map) {
  if (model.contacts.present) SurfacesBuilder(system, model, bodies, solids, map).build();
}

}  // namespace polhode
