// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <polhode/geometry/triangle_tree.hpp>
#include <polhode/surface_contact/mesh_surface.hpp>
#include <polhode/surface_contact/surface_law.hpp>

namespace polhode::surface_contact {

/// Interior of a solid at an instant, at any distance from its surface.
class SolidInside {
 public:
  /// @param boundary  The whole boundary, closed.
  /// @param x  Positions of nodes.
  SolidInside(const MeshSurface& boundary, const double* x);

  /// Overlap of a ball with the solid. Penetration of a face by less than a tenth of the face's
  /// size is ignored: triangles and contact points are no closer to curved faces than that.
  /// @param radius  [m]; 0: a point.
  [[nodiscard]] std::optional<SurfaceOverlap> overlap(const Vec3& centre, double radius) const;

  /// Overlap of the deepest face that lies in another part of the solid, if any does; see
  /// overlap(). The direction of exit is not known.
  [[nodiscard]] std::optional<SurfaceOverlap> overlap_with_itself() const;

  /// Median of the triangles' longest edges [m].
  [[nodiscard]] double size() const;

 private:
  [[nodiscard]] double distance_to_others(const Vec3& x, const std::array<int, 3>& face) const;

  std::vector<Vec3> corners_;
  std::vector<std::array<int, 3>> triangles_;
  geometry::TriangleTree tree_;
};

}  // namespace polhode::surface_contact
