// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

#include <polhode/solids/loads/loaded_faces.hpp>

namespace polhode::surface_contact {

/// Contact points of the surface of a solid, or of a cable: p = Σ N_a x_a, each with its tributary
/// reference area.
struct SurfacePoints {
  static constexpr int kMaxNodes = 9;
  struct Point {
    double area = 0.0;  ///< [m²]
    double N[kMaxNodes]{};
    double span = 0.0;  ///< Of a cable: part of its segment between it and the next point.
  };
  int nodes_per_point = 1;
  std::vector<Point> points;
  std::vector<int> nodes;  ///< Numbers, nodes_per_point of each point.
  double radius = 0.0;     ///< Of the round section about the points [m].
  /// Largest distance of points; through a wider one the shape could pass [m].
  double most_apart = std::numeric_limits<double>::infinity();
  /// Of a cable: depth in the shape at which the straight displacement of a step is a pass-through
  /// [m].
  double through = std::numeric_limits<double>::infinity();
};

/// The nodes of faces with straight edges, with their tributary areas, and Gauss points of curved
/// faces. Both integrate a uniform pressure exactly.
/// @param X         Reference positions by number [m].
/// @param left_out  Ascending numbers of nodes that are no points; a curved face is left out if all
/// its nodes are among them.
/// @throws InputError if no point remains.
[[nodiscard]] SurfacePoints surface_points(const std::string& where,
                                           const solids::LoadedFaces& faces,
                                           const std::vector<Vec3>& X,
                                           const std::vector<int>& left_out = {});

/// Median length of the faces' edges, corner to corner [m].
[[nodiscard]] double median_edge(const solids::LoadedFaces& faces, const std::vector<Vec3>& X);

}  // namespace polhode::surface_contact
