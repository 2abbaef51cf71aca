// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <polhode/geometry/mass_properties.hpp>
#include <polhode/geometry/triangle_surface.hpp>

namespace polhode::geometry {

/// A size of a shape in the model file.
struct ShapeSize {
  std::string name;     ///< e.g. "diameter"; a full length [m].
  std::string meaning;  ///< One line for the reference page.
};

/// A kind of solid with closed formulas. Sizes are full lengths; cylinder, capsule, cone and tube
/// lie along z; the origin is the centroid of each.
struct ShapeKind {
  std::string name;
  std::string meaning;  ///< One line for the reference page.
  std::vector<ShapeSize> sizes;

  /// Error of sizes that are each positive, e.g. an inner diameter above the outer one; empty if
  /// none. May be null.
  std::string (*misfit)(std::span<const double> sizes);
  /// Volume [m³] as mass, volume moments [m⁵] as inertia: the shape at density 1.
  MassProperties (*unit_mass_properties)(std::span<const double> sizes);
  /// Closed, outward triangles with corners on the shape, for pictures.
  TriangleSurface (*surface)(std::span<const double> sizes, int segments);
};

/// Every kind of shape, in the order of the reference page.
[[nodiscard]] const std::vector<ShapeKind>& shape_kinds();

/// The kind of that name, or null.
[[nodiscard]] const ShapeKind* find_shape_kind(std::string_view name);

/// Rejects a wrong number of sizes, sizes that are not positive and finite, or inconsistent sizes.
/// @param where  Path of the shape in the user's model, first part of the message.
/// @throws InputError
void check_shape_sizes(std::string_view where, const ShapeKind& kind,
                       std::span<const double> sizes);

/// Mass properties of a shape about its centroid, in its own axes.
/// @param where    Path of the shape in the user's model.
/// @param density  [kg/m³]; positive.
/// @throws InputError as check_shape_sizes(), and for a density that is not positive and finite.
[[nodiscard]] MassProperties shape_mass_properties(std::string_view where, const ShapeKind& kind,
                                                   std::span<const double> sizes, double density);

/// Closed, outward triangles of a shape, for pictures.
/// @param segments  Around the full circle [-]; at least 3. The corners lie on the shape.
[[nodiscard]] TriangleSurface shape_surface(const ShapeKind& kind, std::span<const double> sizes,
                                            int segments = 32);

}  // namespace polhode::geometry
