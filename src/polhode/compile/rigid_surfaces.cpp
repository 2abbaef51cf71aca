// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

#include <polhode/compile/contact_shapes.hpp>
#include <polhode/compile/rigid_surfaces.hpp>
#include <polhode/compile/shape_surface.hpp>
#include <polhode/contact/round_solids/round_solid.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/geometry/polyhedron.hpp>

namespace polhode {

namespace {

/// Smallest rounding of edges, as a part of the smallest half size, or of the edges of triangles.
constexpr double kRounding = 1e-3;
/// Largest rounding in the same units: of boxes and cylinders, of cones and hulls, and of
/// triangles.
constexpr double kMaxOfBoxes = 0.5, kMaxOfHulls = 0.2, kMaxOfTriangles = 0.25;
/// Largest part of the radius of a cable for its band: its points, at most 1.6 radii apart, then
/// let nothing through between them.
constexpr double kMaxOfRadius = 0.125;

bool has_triangles(const ShapeSpec& shape) {
  return shape.type == "mesh" || shape.type == "height_field" || shape.type == "tube";
}

/// Whether the surface is that of a convex solid without a form of its own in RigidSurface.
bool is_other_convex(const ShapeSpec& shape) {
  return shape.type == "hull" || contact::find_round_solid(shape.type);
}

geometry::TriangleSurface triangles_of(const ShapeSpec& shape) {
  return shape_surface(shape.type, shape, kTubeSegments);
}

}  // namespace

double half_size(const ShapeSpec& shape) {
  if (shape.type == "plane") return std::numeric_limits<double>::infinity();
  if (shape.type != "hull" && !has_triangles(shape))
    return 0.5 * *std::min_element(shape.sizes.begin(), shape.sizes.end());
  Eigen::AlignedBox3d box;
  for (const Vec3& x : shape.type == "hull" ? hull_points(shape) : triangles_of(shape).points)
    box.extend(x);
  return 0.5 * box.sizes().minCoeff();
}

double smallest_detail(const ShapeSpec& shape) {
  if (shape.type == "height_field") return shape.spacing;
  return has_triangles(shape) ? geometry::median_edge(triangles_of(shape)) : half_size(shape);
}

double widest_tolerance(const ShapeSpec& shape, double radius) {
  if (!has_triangles(shape)) return std::numeric_limits<double>::infinity();
  return kMaxOfTriangles * smallest_detail(shape) + widest_tolerance(radius);
}

double widest_tolerance(double radius) { return kMaxOfRadius * radius; }

CableSizes cable_sizes(const ShapeSpec& shape, double radius) {
  if (has_triangles(shape)) return {radius, 0.5 * radius};
  const double half = half_size(shape);
  return {std::min(radius, half), 0.5 * (radius + half)};
}

surface_contact::RigidSurface rigid_surface(const std::string& where, const ShapeSpec& shape,
                                            double tolerance) {
  surface_contact::RigidSurface s;
  const std::vector<double>& size = shape.sizes;
  const auto rounding = [&](double length, double most) {
    return std::clamp(tolerance, kRounding * length, most * length);
  };
  if (shape.type == "sphere") {
    s.kind = surface_contact::RigidSurface::Kind::sphere;
    s.radius = 0.5 * size[0];
  } else if (shape.type == "capsule") {
    s.kind = surface_contact::RigidSurface::Kind::capsule;
    s.radius = 0.5 * size[0];
    s.half[2] = 0.5 * std::max(0.0, size[1] - size[0]);
  } else if (shape.type == "cylinder") {
    s.kind = surface_contact::RigidSurface::Kind::cylinder;
    s.radius = 0.5 * size[0];
    s.half = Vec3(s.radius, s.radius, 0.5 * size[1]);
    s.rounding = rounding(s.half.minCoeff(), kMaxOfBoxes);
  } else if (shape.type == "box") {
    s.kind = surface_contact::RigidSurface::Kind::box;
    s.half = 0.5 * Vec3(size[0], size[1], size[2]);
    s.rounding = rounding(s.half.minCoeff(), kMaxOfBoxes);
  } else if (shape.type == "tube") {
    s.kind = surface_contact::RigidSurface::Kind::tube;
    s.radius = 0.5 * size[0];
    s.half = Vec3(s.radius, 0.5 * size[1], 0.5 * size[2]);
    s.rounding = rounding(0.5 * std::min(s.radius - s.half[1], size[2]), kMaxOfBoxes);
  } else if (has_triangles(shape)) {
    s.kind = surface_contact::RigidSurface::Kind::mesh;
    s.triangles = std::make_shared<surface_contact::RigidMesh>(
        contact_shape(where, {}, shape, rounding(smallest_detail(shape), kMaxOfTriangles)));
  } else if (shape.type == "plane") {
    s.kind = surface_contact::RigidSurface::Kind::plane;
  } else if (is_other_convex(shape)) {
    s.kind = surface_contact::RigidSurface::Kind::convex;
    s.solid = std::make_shared<geometry::Shape>(
        contact_shape(where, {}, shape, rounding(half_size(shape), kMaxOfHulls)));
  } else {
    throw InputError(where,
                     format("solids and cables cannot touch the shape {}", quote(shape.type)),
                     "Give the body a mesh of that shape, or exclude the pair from contact");
  }
  return s;
}

}  // namespace polhode
