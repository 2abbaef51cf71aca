// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <polhode/solids/loads/solid_loads.hpp>
#include <polhode/system/node_step.hpp>

namespace polhode {

/// A point of a mesh: Σ N_a x_a.
struct MeshPoint {
  static constexpr int kMaxNodes = 9;
  int count = 0;
  int node[kMaxNodes]{};
  double N[kMaxNodes]{};
  double area = 0.0;  ///< Its share of the reference area [m²].

  /// Weights that are zero add nothing.
  void add(int number, double weight);
  [[nodiscard]] Vec3 at(const double* field) const {
    Vec3 sum = Vec3::Zero();
    for (int a = 0; a < count; ++a) sum += N[a] * NodeStep::at(field, node[a]);
    return sum;
  }
};

/// Faces of a solid as triangles: quadrilaterals are parted in four about their middle, so that a
/// pressure which is uniform reaches the corners of a parallelogram as it should; faces with nodes
/// on their edges in as many triangles as these nodes ask for.
struct MeshSurface {
  std::vector<MeshPoint> vertices;
  std::vector<std::array<int, 3>> triangles;  ///< Counterclockwise seen from outside.
};
[[nodiscard]] MeshSurface triangulated(const std::vector<LoadedFaces>& faces);

/// Where the potential of contact is looked at: the nodes of faces with straight edges, each with
/// its share of the area, and Gauss points of curved faces.
///
/// Where a flat face lies at the start opposite to triangles of `other`, parallel to them and no
/// farther away than a tenth of its own size, the overlap of the two is cut out instead, and each
/// triangle of it has points at its corners and in its middle (weights 1/12 and 3/4, exact for
/// quadratic functions): a pressure that is uniform then loads both meshes exactly, whatever their
/// sizes.
/// @param X  Positions at the start by number [m].
[[nodiscard]] std::vector<MeshPoint> contact_points(const std::string& where,
                                                    const std::vector<LoadedFaces>& faces,
                                                    const std::vector<Vec3>& X,
                                                    const MeshSurface* other);

}  // namespace polhode
