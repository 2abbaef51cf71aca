// SPDX-License-Identifier: Apache-2.0
#include <polhode/compile/shape_surface.hpp>
#include <polhode/geometry/hull.hpp>
#include <polhode/geometry/read_surface.hpp>
#include <polhode/geometry/shapes.hpp>

namespace polhode {

namespace {

geometry::TriangleSurface field_surface(const ShapeSpec& shape) {
  geometry::TriangleSurface field;
  const int columns = shape.columns, rows = static_cast<int>(shape.heights.size()) / columns;
  for (int iy = 0; iy < rows; ++iy)
    for (int ix = 0; ix < columns; ++ix)
      field.points.emplace_back(shape.spacing * (ix - 0.5 * (columns - 1)),
                                shape.spacing * (iy - 0.5 * (rows - 1)),
                                shape.heights[iy * columns + ix]);
  for (int iy = 0; iy + 1 < rows; ++iy)
    for (int ix = 0; ix + 1 < columns; ++ix) {
      const int a = iy * columns + ix, b = a + 1, c = a + columns, d = c + 1;
      field.triangles.push_back({a, b, d});
      field.triangles.push_back({a, d, c});
    }
  return field;
}

}  // namespace

std::vector<Vec3> hull_points(const ShapeSpec& shape) {
  if (shape.file.empty()) return shape.points;
  return geometry::scaled(geometry::read_surface(shape.file), shape.scale).points;
}

geometry::TriangleSurface shape_surface(std::string_view where, const ShapeSpec& shape,
                                        int segments) {
  if (const geometry::ShapeKind* kind = geometry::find_shape_kind(shape.type))
    return geometry::shape_surface(*kind, shape.sizes, segments);
  if (shape.type == "hull") return geometry::convex_hull(where, hull_points(shape));
  if (shape.type == "height_field") return field_surface(shape);
  if (shape.type != "mesh") return {};
  geometry::TriangleSurface surface =
      geometry::scaled(geometry::read_surface(shape.file), shape.scale);
  geometry::check_closed(shape.file, surface);
  geometry::orient_outward(surface);
  return surface;
}

}  // namespace polhode
