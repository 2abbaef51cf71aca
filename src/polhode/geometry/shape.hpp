// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <polhode/geometry/triangle_surface.hpp>

namespace polhode::contact {
struct RoundSolid;
}

namespace polhode::geometry {

class TriangleTree;

/// Kinds of the solid of a shape for a nearby point.
enum class Solid {
  ball,
  segment,
  polyhedron,
  round,  ///< Cylinder, cone, ellipsoid, ...: see RoundSolid.
  half_space,
  surface
};

/// Placement of a shape in its body: origin and axes in body coordinates, from the centre of mass.
struct ShapePlace {
  Vec3 origin = Vec3::Zero();
  Mat3 axes = Mat3::Identity();
};

/// A contact shape, in the coordinates of its body (origin: the centre of mass).
///
/// A shape is the Minkowski sum of a core and a ball of radius `rounding`. A sphere's core is a
/// point, a capsule's a segment; all others are first shrunk by a small rounding, so that faces
/// keep their position and edges and corners are rounded. Cores never touch, so their distance
/// always has a direction. The core's corners and edges are contact features with an index.
struct Shape {
  struct Edge {
    int i = 0, j = 0;         ///< Corners.
    Vec3 out = Vec3::Zero();  ///< Unit, outward: bisector of the two faces.
    /// Cosine of half the angle between the normals of the faces; −1: any direction across.
    double cone = -1.0;
    bool convex = true;  ///< Paired with other edges; else it only corrects sums of triangles.
    bool open = false;   ///< One triangle only (border of a height field).
    bool flat = false;   ///< Both faces in one plane.
  };
  struct Plane {
    Vec3 normal = Vec3::UnitZ();
    double offset = 0.0;
  };
  /// Disc across the third axis.
  struct FlatEnd {
    double height = 0.0;  ///< Along the axis, from the centre [m].
    double radius = 0.0;
  };

  Solid solid = Solid::ball;
  double rounding = 0.0;  ///< ρ [m].

  std::vector<Vec3> corners;  ///< Of the core.
  std::vector<int> points;    ///< Corners against other solids ...
  /// ... if they have faces; of a rim slightly inside it.
  std::vector<int> face_points;
  std::vector<Edge> edges;                         ///< Of the core.
  std::vector<char> border_corner;                 ///< Of a surface: lies on an open edge.
  std::vector<std::array<int, 3>> triangles;       ///< Of polyhedron and surface, outward.
  std::vector<std::array<int, 3>> triangle_edges;  ///< Edge k lies from corner k to k + 1.
  std::vector<Plane> planes;                       ///< Of polyhedron, by triangle.
  std::shared_ptr<const TriangleTree> tree;        ///< Of a surface.

  const contact::RoundSolid* round_solid = nullptr;  ///< Formulas of Solid::round.
  std::vector<FlatEnd> flat_ends;  ///< Of a round solid or tube; an ellipsoid has none.
  int rim_corners = 0;             ///< Number of corners, the first ones, on rims of a round solid.

  Vec3 centre = Vec3::Zero();        ///< Of sphere, round solid (mid height), tube ...
  Mat3 axes = Mat3::Identity();      ///< Columns; round solids lie along the third.
  Vec3 half = Vec3::Zero();          ///< Semi-axes; cylinder and cone: (R, R, half height).
  Vec3 chords = Vec3::Zero();        ///< Round solid: from its centre to its surface, along axes.
  Vec3 bound_centre = Vec3::Zero();  ///< Bounding ball; a plane has none.
  double bound_radius = 0.0;         ///< [m]; infinite for a plane.
  double size = 0.0;                 ///< L: bounding radius, of a surface its median edge [m].
  double detail = 0.0;  ///< Smallest half size, of a surface its median edge; of a plane ∞ [m].
  double reach = 0.0;   ///< Largest distance from the centre of mass [m].

  [[nodiscard]] bool bounded() const { return solid != Solid::half_space; }
  /// Whether it has a smooth convex surface besides corners and edges.
  [[nodiscard]] bool round() const { return solid == Solid::round; }
};

/// Lengths are those of the model file: diameters and full lengths; along z of the placement.
/// @throws InputError if a size is not positive and finite.
[[nodiscard]] Shape sphere(std::string_view where, double diameter, const ShapePlace& place = {});
/// @param length  Between the centres of the end spheres.
[[nodiscard]] Shape capsule(std::string_view where, double diameter, double length,
                            const ShapePlace& place = {});
/// @param rounding  Radius of edges and corners; 0: 1e-3 of the smallest half size.
[[nodiscard]] Shape box(std::string_view where, const Vec3& size, const ShapePlace& place = {},
                        double rounding = 0.0);
/// Half space below z = 0 of the placement.
[[nodiscard]] Shape plane(const ShapePlace& place = {});
/// Convex hull of points, which must span a volume.
[[nodiscard]] Shape hull(std::string_view where, std::span<const Vec3> points,
                         const ShapePlace& place = {}, double rounding = 0.0);
/// Closed surface of triangles. @throws InputError if it is open or turned inside out.
[[nodiscard]] Shape mesh(std::string_view where, const TriangleSurface& surface,
                         const ShapePlace& place = {}, double rounding = 0.0);
/// Heights over a grid: z(ix, iy) = heights[iy · columns + ix] at (ix·spacing, iy·spacing),
/// centred.
[[nodiscard]] Shape height_field(std::string_view where, int columns, double spacing,
                                 std::span<const double> heights, const ShapePlace& place = {},
                                 double rounding = 0.0);

}  // namespace polhode::geometry
