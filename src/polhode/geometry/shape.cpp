// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/geometry/hull.hpp>
#include <polhode/geometry/polyhedron.hpp>
#include <polhode/geometry/shape.hpp>
#include <polhode/geometry/shape_checks.hpp>
#include <polhode/geometry/triangle_tree.hpp>

namespace polhode::geometry {

namespace {

/// Largest rounding of a sheet of triangles, as a part of its thickness.
constexpr double kRoundingOfSheets = 0.1;

}  // namespace

void check_positive(std::string_view where, std::string_view what, double value) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw InputError(where, format("the {} is {} m, not positive and finite", what, value),
                     "Give a length above zero");
}

void check_rounding(std::string_view where, double rounding, double most) {
  if (!(rounding >= 0.0) || rounding > most)
    throw InputError(where, format("the rounding is {} m, not between 0 and {} m", rounding, most),
                     "Give a smaller radius of edges and corners, or leave it out");
}

void set_bounds(Shape& s, const Vec3& centre, double radius) {
  s.bound_centre = centre;
  s.bound_radius = radius;
  s.size = radius;
  s.reach = centre.norm() + radius;
}

namespace {

void all_corners_meet(Shape& s) {
  for (int i = 0; i < static_cast<int>(s.corners.size()); ++i) s.points.push_back(i);
  s.face_points = s.points;
}

void bound_corners(Shape& s) {
  Vec3 low = s.corners[0], high = s.corners[0];
  for (const Vec3& x : s.corners) low = low.cwiseMin(x), high = high.cwiseMax(x);
  const Vec3 centre = 0.5 * (low + high);
  double radius = 0.0;
  for (const Vec3& x : s.corners) radius = std::max(radius, (x - centre).norm());
  set_bounds(s, centre, radius + s.rounding);
  s.reach = 0.0;
  for (const Vec3& x : s.corners) s.reach = std::max(s.reach, x.norm() + s.rounding);
}

TriangleSurface placed(TriangleSurface surface, const ShapePlace& place) {
  for (Vec3& x : surface.points) x = place.origin + place.axes * x;
  return surface;
}

/// Sizes beyond which products of lengths overflow or underflow [m].
constexpr double kMinSize = 1e-15, kLargestSize = 1e15;
/// Area of a triangle over the square of its longest edge, below which its corners are collinear.
constexpr double kNoArea = 1e-10;

/// Thickness of a hull over its extent, below which it is flat.
constexpr double kFlatShape = 1e-9;

/// Rejects points of which no shape can be made. @returns their extent [m].
double check_extent(std::string_view where, std::span<const Vec3> points) {
  double size = 0.0;
  for (const Vec3& x : points) size = std::max(size, (x - points[0]).cwiseAbs().maxCoeff());
  if (!(size >= kMinSize && size <= kLargestSize))
    throw InputError(where, format("its points are up to {:.3g} m apart", size),
                     "Check its unit of length, or give a scale");
  return size;
}

/// Surface without unused points.
TriangleSurface used_part(const TriangleSurface& surface) {
  TriangleSurface part;
  std::vector<int> number(surface.points.size(), -1);
  for (std::array<int, 3> t : surface.triangles) {
    for (int& corner : t) {
      int& known = number[corner];
      if (known < 0) {
        known = static_cast<int>(part.points.size());
        part.points.push_back(surface.points[corner]);
      }
      corner = known;
    }
    part.triangles.push_back(t);
  }
  return part;
}

void check_triangles(std::string_view where, const TriangleSurface& surface) {
  for (const auto& [i, j, k] : surface.triangles) {
    const Vec3 &a = surface.points[i], &b = surface.points[j], &c = surface.points[k];
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    if (!((b - a).cross(c - a).norm() > kNoArea * longest))
      throw InputError(where,
                       format("the triangle at ({:.6g}, {:.6g}, {:.6g}) m has no area: its corners "
                              "lie on a line",
                              a[0], a[1], a[2]),
                       "Let the program that made it remove degenerate triangles, or set "
                       "contact: {touches: false}");
  }
}

Shape polyhedron(std::string_view where, const TriangleSurface& outside, double rounding) {
  Shape s;
  s.solid = Solid::polyhedron;
  s.rounding = rounding;
  const TriangleSurface core = convex_hull(where, shrunk(outside, rounding).points);
  take_triangles(s, core);
  all_corners_meet(s);
  bound_corners(s);
  return s;
}

}  // namespace

Shape sphere(std::string_view where, double diameter, const ShapePlace& place) {
  check_positive(where, "diameter", diameter);
  Shape s;
  s.solid = Solid::ball;
  s.rounding = s.detail = 0.5 * diameter;
  s.centre = place.origin;
  s.corners = {place.origin};
  all_corners_meet(s);
  bound_corners(s);
  return s;
}

Shape capsule(std::string_view where, double diameter, double length, const ShapePlace& place) {
  check_positive(where, "diameter", diameter);
  check_positive(where, "length", length);
  Shape s;
  s.solid = Solid::segment;
  s.rounding = s.detail = 0.5 * diameter;
  s.centre = place.origin;
  const Vec3 to_end = 0.5 * length * place.axes.col(2);
  s.corners = {place.origin - to_end, place.origin + to_end};
  s.edges.push_back({.i = 0, .j = 1});
  all_corners_meet(s);
  bound_corners(s);
  return s;
}

Shape box(std::string_view where, const Vec3& size, const ShapePlace& place, double rounding) {
  for (int i = 0; i < 3; ++i) check_positive(where, "size", size[i]);
  const Vec3 half = 0.5 * size;
  check_rounding(where, rounding, 0.5 * half.minCoeff());
  if (rounding == 0.0) rounding = kRounding * half.minCoeff();
  TriangleSurface outside;
  for (int k = 0; k < 8; ++k)
    outside.points.push_back(place.origin + place.axes * Vec3(k & 1 ? half[0] : -half[0],
                                                              k & 2 ? half[1] : -half[1],
                                                              k & 4 ? half[2] : -half[2]));
  outside = convex_hull(where, outside.points);
  Shape s = polyhedron(where, outside, rounding);
  s.detail = half.minCoeff();
  return s;
}

Shape plane(const ShapePlace& place) {
  Shape s;
  s.solid = Solid::half_space;
  s.centre = place.origin;
  s.axes = place.axes;
  s.bound_radius = s.size = s.detail = s.reach = std::numeric_limits<double>::infinity();
  return s;
}

Shape hull(std::string_view where, std::span<const Vec3> points, const ShapePlace& place,
           double rounding) {
  const double extent = check_extent(where, points);
  const TriangleSurface outside = placed(convex_hull(where, points), place);
  const double size = inner_size(outside);
  if (!(size > kFlatShape * extent))
    throw InputError(where, "the points lie almost in a plane, so their hull has no volume",
                     "Give points that do not lie in one plane");
  check_rounding(where, rounding, 0.5 * size);
  Shape s = polyhedron(where, outside, rounding == 0.0 ? kRounding * size : rounding);
  s.detail = size;
  return s;
}

Shape mesh(std::string_view where, const TriangleSurface& surface, const ShapePlace& place,
           double rounding) {
  check_extent(where, surface.points);
  const TriangleSurface used = used_part(surface);
  TriangleSurface outside = placed(used, place);
  join_equal_points(outside);
  check_closed(where, outside);
  check_triangles(where, outside);
  orient_outward(outside);
  const double edge = median_edge(outside);
  check_rounding(where, rounding, 0.25 * edge);
  // A sheet may be thinner than the rounding that goes by its triangles.
  Eigen::AlignedBox3d box;
  for (const Vec3& x : used.points) box.extend(x);
  Shape s;
  s.solid = Solid::surface;
  s.rounding = rounding;
  if (rounding == 0.0)
    s.rounding = std::min(kRounding * edge, kRoundingOfSheets * box.sizes().minCoeff());
  take_triangles(s, shrunk(outside, s.rounding));
  take_convex_corners(s);
  s.tree = std::make_shared<const TriangleTree>(s.corners, s.triangles);
  bound_corners(s);
  s.size = s.detail = edge;
  return s;
}

Shape height_field(std::string_view where, int columns, double spacing,
                   std::span<const double> heights, const ShapePlace& place, double rounding) {
  check_positive(where, "spacing", spacing);
  const int rows = columns < 2 ? 0 : static_cast<int>(heights.size()) / columns;
  if (rows < 2 || rows * columns != static_cast<int>(heights.size()))
    throw InputError(where,
                     format("{} heights do not fill rows of {} columns", heights.size(), columns),
                     "Give at least two rows and two columns, row by row");
  TriangleSurface field;
  for (int iy = 0; iy < rows; ++iy)
    for (int ix = 0; ix < columns; ++ix) {
      const double z = heights[iy * columns + ix];
      if (!std::isfinite(z))
        throw InputError(where, "a height is not finite", "Correct the table of heights");
      field.points.push_back(
          {spacing * (ix - 0.5 * (columns - 1)), spacing * (iy - 0.5 * (rows - 1)), z});
    }
  for (int iy = 0; iy + 1 < rows; ++iy)
    for (int ix = 0; ix + 1 < columns; ++ix) {
      const int a = iy * columns + ix, b = a + 1, c = a + columns, d = c + 1;
      field.triangles.push_back({a, b, d});
      field.triangles.push_back({a, d, c});
    }
  field = placed(std::move(field), place);
  check_rounding(where, rounding, 0.25 * spacing);
  Shape s;
  s.axes = place.axes;
  s.solid = Solid::surface;
  s.rounding = rounding == 0.0 ? kRounding * spacing : rounding;
  take_triangles(s, shrunk(field, s.rounding));
  take_convex_corners(s);
  s.tree = std::make_shared<const TriangleTree>(s.corners, s.triangles);
  bound_corners(s);
  s.size = s.detail = spacing;
  return s;
}

}  // namespace polhode::geometry
