// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <polhode/geometry/mass_properties.hpp>

namespace polhode::geometry {

/// A surface of triangles. Seen from outside, the corners of a triangle are counterclockwise.
struct TriangleSurface {
  std::vector<Vec3> points;                   ///< [m]
  std::vector<std::array<int, 3>> triangles;  ///< Indices into points.
};

/// Report on the edges of a surface. An edge is valid when exactly two triangles share it with
/// opposite directions.
struct EdgeReport {
  int open = 0;       ///< Edges of one triangle only.
  int shared = 0;     ///< Edges of three triangles or more.
  int opposed = 0;    ///< Edges of two triangles with opposite orientation.
  std::string first;  ///< Description of the first invalid edge; empty if there is none.

  [[nodiscard]] bool closed() const { return open + shared + opposed == 0; }
};

/// Counts the edges at which the surface is not closed or not consistently oriented.
[[nodiscard]] EdgeReport edge_report(const TriangleSurface& surface);

/// Rejects a surface without triangles, one that is not closed, one that encloses no volume, and a
/// shell within another that faces the same way.
/// @param where  File or path in the user's model, first part of the message.
/// @throws InputError that counts the invalid edges and says where the first one is.
void check_closed(std::string_view where, const TriangleSurface& surface);

/// Volume enclosed [m³]; negative when the triangles face inward.
[[nodiscard]] double signed_volume(const TriangleSurface& surface);

/// Turns the triangles outward if they all face inward.
/// @returns whether they were turned, for a note to the user.
bool orient_outward(TriangleSurface& surface);

/// Mass properties of the solid inside a closed, outward-facing surface, exact to rounding.
///
/// The volume integrals of 1, x and x⊗x over the tetrahedra between the triangles and one point are
/// polynomials of the corners; parts outside the solid cancel (divergence theorem).
///
/// @param density  [kg/m³]
[[nodiscard]] MassProperties mass_properties(const TriangleSurface& surface, double density);

/// The surface with every coordinate multiplied by factor, which must be positive.
[[nodiscard]] TriangleSurface scaled(TriangleSurface surface, double factor);

/// Merges corners with equal coordinates and drops triangles that collapse thereby.
void join_equal_points(TriangleSurface& surface);

}  // namespace polhode::geometry
