// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <polhode/surface_contact/mesh_surface.hpp>

namespace polhode::surface_contact {

/// Straight edges for crossing contact: sharp edges of a solid's surface, segments of a cable.
struct EdgeLines {
  std::vector<MeshPoint> vertices;
  std::vector<std::array<int, 2>> edges;
  /// Points of a round edge: equal parts with points at their ends, which contact parallel edges,
  /// and the area of a part. Sharp edges have none.
  struct Points {
    int parts = 0;
    double area = 0.0;  ///< [m²]
  };
  std::vector<Points> points;

  /// Shared part of each vertex's contribution: (n − 1)/n if n edges end there.
  [[nodiscard]] std::vector<double> shared() const;
};

/// Sharp edges of a surface: convex edges of more than 30 degrees, and its border.
/// @param X  Positions at the start by number [m].
[[nodiscard]] EdgeLines sharp_edges(const MeshSurface& surface, const std::vector<Vec3>& X);

}  // namespace polhode::surface_contact
