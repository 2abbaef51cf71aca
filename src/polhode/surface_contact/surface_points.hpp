// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

#include <polhode/solids/loads/solid_loads.hpp>

namespace polhode {

/// Where the surface of a solid, or a cable, is looked at: p = Σ N_a x_a, each point with its share
/// of the reference area.
struct SurfacePoints {
  static constexpr int kMaxNodes = 9;
  struct Point {
    double area = 0.0;  ///< [m²]
    double N[kMaxNodes]{};
    double span = 0.0;  ///< Of a cable: part of its piece that lies between it and the next point.
  };
  int nodes_per_point = 1;
  std::vector<Point> points;
  std::vector<int> nodes;  ///< Numbers, nodes_per_point of each point.
  double radius = 0.0;     ///< Of what is round about the points: it touches that far ahead [m].
  /// Points farther apart than this would let the shape pass between them [m].
  double most_apart = std::numeric_limits<double>::infinity();
  /// Of a cable: a step whose straight way gets so deep into the shape goes through it [m].
  double through = std::numeric_limits<double>::infinity();
};

/// The nodes, with their share of the area, of faces with straight edges; Gauss points of curved
/// ones. Both carry a uniform pressure exactly.
/// @param X         Reference positions by number [m].
/// @param left_out  Ascending numbers of nodes that are no points; a curved face is left out if all
///                  its nodes are among them.
/// @throws InputError if nothing is left.
[[nodiscard]] SurfacePoints surface_points(const std::string& where, const LoadedFaces& faces,
                                           const std::vector<Vec3>& X,
                                           const std::vector<int>& left_out = {});

/// Middle one of the lengths of the faces' edges, corner to corner [m].
[[nodiscard]] double median_edge(const LoadedFaces& faces, const std::vector<Vec3>& X);

}  // namespace polhode
