// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include <polhode/compile/contact_shapes.hpp>
#include <polhode/compile/contact_sides.hpp>
#include <polhode/compile/surface_overlaps.hpp>
#include <polhode/core/format.hpp>
#include <polhode/dynamics/placement.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/solids/mesh/selection.hpp>
#include <polhode/surface_contact/solid_contact.hpp>
#include <polhode/surface_contact/solid_inside.hpp>

namespace polhode {

namespace {

/// Distance of test points along the edges of a shape, as a part of a face of the solid.
constexpr double kSpacing = 0.5;
constexpr int kMaxParts = 1000;  ///< Of an edge.
/// Gap of solids without force, in tolerances.
constexpr double kFree = 2.0;

/// Test points of a shape: balls of its rounding about these points are inside it.
std::vector<Vec3> places_within(const geometry::Shape& shape, double spacing) {
  std::vector<Vec3> list = shape.corners;
  if (shape.solid == geometry::Solid::polyhedron)
    list.push_back(std::accumulate(list.begin(), list.end(), Vec3(Vec3::Zero())) /
                   static_cast<double>(list.size()));
  for (const geometry::Shape::Edge& edge : shape.edges) {
    const Vec3 &p = shape.corners[static_cast<std::size_t>(edge.i)],
               &q = shape.corners[static_cast<std::size_t>(edge.j)];
    const int parts = static_cast<int>(std::min(1.0 * kMaxParts, (q - p).norm() / spacing));
    for (int k = 1; k < parts; ++k) list.emplace_back(p + (q - p) * k / parts);
  }
  if (!shape.round()) return list;
  for (int k = 0; k < 3; ++k)
    for (const double sign : {-1.0, 0.0, 1.0})
      list.emplace_back(shape.centre + sign * shape.chords[k] * shape.axes.col(k));
  return list;
}

class Finder {
 public:
  Finder(const Model& model, const System& system, const SystemMap& map, const State& state)
      : model_(model), system_(system), map_(map), state_(state) {}

  std::vector<SideOverlap> find() {
    const NodeStep instant = node_instant(system_, state_, still_);
    for (const ContactMap::Surface& surface : map_.contact.surfaces) {
      free_gap_ = kFree * surface.touching->law().normal.tolerance;
      if (const auto found = surface.touching->overlap(instant))
        note(surface.own, surface.side, *found);
      if (surface.own.is_solid() && surface.side.is_body())
        look_for_body(surface);
      else if (surface.on_mesh)
        look_for_points(surface, *surface.on_mesh);
    }
    return std::move(list_);
  }

 private:
  /// Finds overlaps of a shape of a body with a solid, which may have no point in the shape. Parts
  /// bonded to the body are ignored.
  void look_for_body(const ContactMap::Surface& surface) {
    const auto& bonds = model_.solids[static_cast<std::size_t>(surface.own.index)].bonded;
    if (std::any_of(bonds.begin(), bonds.end(),
                    [&](const BondSpec& bond) { return surface.side == bond.body; }))
      return;
    if (!seen_.emplace(surface.own, surface.side, surface.shape).second) return;
    const BodySpec& body = model_.bodies[static_cast<std::size_t>(surface.side.index)];
    const ShapeSpec& spec = body.shapes[surface.shape];
    if (spec.type == "plane") return;  // a half space
    const geometry::Shape shape =
        contact_shape(shape_path(body, surface.shape), shape_place(body, spec), spec);
    const int carrier = map_.body[static_cast<std::size_t>(surface.side.index)];
    const BodyStep at =
        carrier == kGround ? BodyStep::ground(1.0) : system_.instant(state_, carrier);
    const surface_contact::SolidInside& solid = inside(surface.own);
    for (const Vec3& Z : places_within(shape, kSpacing * solid.size())) {
      if (const auto found = solid.overlap(at.r_n + at.Lambda_n * Z, shape.rounding))
        note(surface.side, surface.own, *found);
    }
  }

  /// Finds overlaps of points of a solid or of a cable with another solid.
  void look_for_points(const ContactMap::Surface& surface,
                       const surface_contact::SolidContact& contact) {
    const surface_contact::SolidInside& solid = inside(surface.side);
    if (surface.own == surface.side) {
      if (const auto found = solid.overlap_with_itself()) note(surface.own, surface.side, *found);
      return;
    }
    for (const surface_contact::MeshPoint& point : contact.points())
      if (const auto found = solid.overlap(point.at(state_.node_x.data()), contact.radius()))
        note(surface.own, surface.side, *found);
  }

  const surface_contact::SolidInside& inside(const Side& side) {
    const int solid = side.index;
    const auto known = inside_.find(solid);
    if (known != inside_.end()) return known->second;
    const surface_contact::MeshSurface boundary =
        solid_boundary(map_.solids[static_cast<std::size_t>(solid)]);
    return inside_.try_emplace(solid, boundary, state_.node_x.data()).first->second;
  }

  void note(const Side& own, const Side& side, const surface_contact::SurfaceOverlap& found) {
    const auto known = std::find_if(list_.begin(), list_.end(), [&](const SideOverlap& o) {
      return std::minmax(o.own, o.side) == std::minmax(own, side);
    });
    const SideOverlap overlap{own, side, found.depth, found.out, free_gap_};
    if (known == list_.end())
      list_.push_back(overlap);
    else if (found.depth > known->depth)
      *known = overlap;
  }

  const Model& model_;
  const System& system_;
  const SystemMap& map_;
  const State& state_;
  StepContext still_;
  double free_gap_ = 0.0;  ///< Of the present surface [m].
  std::vector<SideOverlap> list_;
  std::set<std::tuple<Side, Side, std::size_t>> seen_;
  std::map<int, surface_contact::SolidInside> inside_;  ///< By Model::solids.
};

}  // namespace

surface_contact::MeshSurface solid_boundary(const SolidMap& solid) {
  return surface_contact::triangulated(
      system_faces(solid, solids::select_faces("", solid.plan.mesh, {})));
}

std::vector<SideOverlap> surface_overlaps(const Model& model, const System& system,
                                          const SystemMap& map, const State& state) {
  return Finder(model, system, map, state).find();
}

std::string overlap_text(const Model& model, const SideOverlap& overlap) {
  const std::string own = model.side_name(overlap.own),
                    other = overlap.own == overlap.side ? "itself" : model.side_name(overlap.side);
  return overlap.depth > 0.0 ? format("{} in {} by {:.3g} m", own, other, overlap.depth)
                             : format("{} touches {}", own, other);
}

}  // namespace polhode
