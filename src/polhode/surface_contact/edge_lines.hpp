// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <polhode/surface_contact/mesh_surface.hpp>

namespace polhode {

/// Straight edges that may be crossed: the sharp ones of a solid's surface, the pieces of a cable.
struct EdgeLines {
  std::vector<MeshPoint> vertices;
  std::vector<std::array<int, 2>> edges;
  /// Of round edges, each by itself: equal parts at whose ends points meet edges that lie along
  /// it, and the area of a part. Sharp edges have none.
  struct Points {
    int parts = 0;
    double area = 0.0;  ///< [m²]
  };
  std::vector<Points> points;

  /// For each vertex the part of what it does that is shared with further edges, (n − 1)/n for the
  /// n that end there.
  [[nodiscard]] std::vector<double> shared() const;
};

/// Where the surface turns outwards by more than 30 degrees, and its border.
/// @param X  Positions at the start by number [m].
[[nodiscard]] EdgeLines sharp_edges(const MeshSurface& surface, const std::vector<Vec3>& X);

}  // namespace polhode
