// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <polhode/geometry/triangle_tree.hpp>
#include <polhode/surface_contact/mesh_surface.hpp>
#include <polhode/surface_contact/surface_law.hpp>

namespace polhode {

/// The inside of a solid at an instant, however far that is from its surface.
class SolidInside {
 public:
  /// @param boundary  All of it, closed.
  /// @param x         Positions of nodes.
  SolidInside(const MeshSurface& boundary, const double* x);

  /// How a ball lies in the solid. What reaches through a face by less than a tenth of the face is
  /// not in it: triangles are no nearer to curved faces, and points of contact no nearer to each
  /// other.
  /// @param radius  [m]; 0: a point.
  [[nodiscard]] std::optional<SurfaceOverlap> overlap(const Vec3& centre, double radius) const;

  /// The deepest face that lies in another part of the solid, if any does, as overlap() has it. The
  /// way out is not known.
  [[nodiscard]] std::optional<SurfaceOverlap> overlap_with_itself() const;

  /// Median of the triangles' longest edges [m].
  [[nodiscard]] double size() const;

 private:
  [[nodiscard]] double distance_to_others(const Vec3& x, const std::array<int, 3>& face) const;

  std::vector<Vec3> corners_;
  std::vector<std::array<int, 3>> triangles_;
  contact::TriangleTree tree_;
};

}  // namespace polhode
