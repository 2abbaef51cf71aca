// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <polhode/surface_contact/mesh_surface.hpp>

namespace polhode::surface_contact {

/// Width on either side of the edge between two quadrilaterals within which the surface is rounded,
/// as a part of their size across it.
inline constexpr double kRoundedEdge = 0.25;

/// Likewise of triangles: barycentric coordinate.
inline constexpr double kRoundedTriangle = 0.125;

/// Smooth surface over a face: bilinear over a quadrilateral, and within a width ω of an edge to
/// another quadrilateral bent so that both have one tangent plane there, the mean of theirs. Over a
/// triangle it is plane, and within a width of its sides and corners a mean of the planes there.
///
/// Positions are linear in those of the vertices, with weights that sum to one: a surface that is
/// plane stays plane. @eq{patch-weights} @eq{patch-triangles}
struct SurfacePatch {
  static constexpr int kSize = 16;
  /// Of a quadrilateral, the corners (1, 1), (2, 1), (2, 2), (1, 2) of a grid, at 4 j + i, and in
  /// its outer rows those of its neighbours; of a triangle the first three, and those of the faces
  /// beside it. −1: none.
  std::array<int, kSize> vertex;
  /// Size of the face across its sides ξ = 0, ξ = 1, η = 0, η = 1 over that of the neighbour there;
  /// 0: the side is not rounded.
  std::array<double, 4> ratio{};
  int corners = 4;
  int first_triangle = 0;
  /// A triangle about a corner of this one.
  struct Beside {
    std::array<int, 3> at;  ///< Its corners in `vertex`.
    double of[3][3];        ///< Its barycentric coordinates by 1, ξ and η of this one, unfolded.
  };
  std::vector<Beside> beside;
  /// Of a triangle, by opposite corner: a side goes on smoothly to another triangle.
  std::array<bool, 3> goes_on{};

  [[nodiscard]] int triangles() const { return corners == 4 ? 4 : 1; }
  /// Upper bound of Σ|M|.
  [[nodiscard]] double stretch() const;
};

/// Patches of a surface, one per face. Edges at which it turns by more than 30 degrees are sharp.
/// @param x  Positions of vertices at the start.
[[nodiscard]] std::vector<SurfacePatch> smooth_patches(const MeshSurface& surface,
                                                       const std::vector<Vec3>& x);

/// Nearest point of a patch: Σ M_a(ξ, η) x_a. Its weights minimise the distance, so that this has
/// the gradient −M_a n.
struct PatchFoot {
  using Weights = std::array<double, SurfacePatch::kSize>;
  int patch = -1;
  int triangle = -1;  ///< Of the patch, the nearest one.
  double xi = 0.0, eta = 0.0;
  double distance = 0.0;  ///< [m]
  double rounding = 0.0;  ///< Of the distance [m].
  /// Way along the surface to the nearest point where that lies beyond a rounded edge of the patch,
  /// on the neighbour [m].
  double outwards = 0.0;
  Weights M{};
  /// Derivatives of M by the directions in which the point is free, and their second derivatives,
  /// by 1 and 1, 1 and 2, 2 and 2.
  int free_count = 0;
  Weights along[2]{}, bend[3]{};
};

/// @param x  Positions of its vertices, those of no vertex aside.
/// @param width  ω, as a part of the faces.
[[nodiscard]] PatchFoot nearest_of_patch(const SurfacePatch& patch, const Vec3& p,
                                         const Vec3 (&x)[SurfacePatch::kSize], double width);

/// Whether the foot a of a point is the nearest point, rather than b on another patch.
[[nodiscard]] bool is_nearer(const PatchFoot& a, const PatchFoot& b);

/// Largest width with which a point of a patch has the weights of its face alone, as it is rounded
/// otherwise. A point over an edge to `rounding` has no part in it.
[[nodiscard]] double clear_width(const SurfacePatch& patch, double xi, double eta, double rounding);

/// Lower bound of the distance, without search.
[[nodiscard]] double least_distance(const SurfacePatch& patch, const Vec3& p,
                                    const Vec3 (&x)[SurfacePatch::kSize]);

}  // namespace polhode::surface_contact
