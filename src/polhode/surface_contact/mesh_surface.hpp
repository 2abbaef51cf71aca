// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <polhode/solids/loads/loaded_faces.hpp>
#include <polhode/system/node_step.hpp>

namespace polhode::surface_contact {

/// A point of a mesh: Σ N_a x_a.
struct MeshPoint {
  /// Nodes of two points on patches and of a point of a face, together.
  static constexpr int kMaxNodes = 65;
  int count = 0;
  int node[kMaxNodes]{};
  double N[kMaxNodes]{};
  double area = 0.0;  ///< Tributary reference area [m²].

  /// Adds a node; zero weights are skipped.
  void add(int number, double weight);
  [[nodiscard]] Vec3 at(const double* field) const {
    Vec3 sum = Vec3::Zero();
    for (int a = 0; a < count; ++a) sum += N[a] * NodeStep::at(field, node[a]);
    return sum;
  }
};

/// Faces of a solid as triangles. Quadrilaterals are split in four about their centre, so that a
/// uniform pressure gives the consistent corner forces of a parallelogram; faces with midside nodes
/// in as many triangles as these require.
struct MeshSurface {
  /// Corners of a face, and the triangles it is divided into.
  struct Face {
    int corners = 3;              ///< Or 4.
    std::array<int, 4> vertex{};  ///< Counterclockwise seen from outside.
    int first_triangle = 0;
  };
  std::vector<MeshPoint> vertices;
  std::vector<std::array<int, 3>> triangles;  ///< Counterclockwise seen from outside.
  /// Quadrilaterals, and the triangles of all other faces, in the order of `triangles`.
  std::vector<Face> faces;
};
[[nodiscard]] MeshSurface triangulated(const std::vector<solids::LoadedFaces>& faces);

/// Quadrature points of the contact potential: the nodes of faces with straight edges with their
/// tributary areas, and Gauss points of curved faces.
///
/// Where a flat face is at the start opposite to triangles of `other`, parallel to them and at most
/// a tenth of its own size away, the overlap of the two is used instead. Each triangle of the
/// overlap has points at its corners and in its middle (weights 1/12 and 3/4, exact for quadratic
/// functions), or inside of it where the overlap reaches a border of `other`: a uniform pressure
/// then loads both meshes exactly, whatever their sizes.
/// @param X  Positions at the start by number [m].
[[nodiscard]] std::vector<MeshPoint> contact_points(const std::string& where,
                                                    const std::vector<solids::LoadedFaces>& faces,
                                                    const std::vector<Vec3>& X,
                                                    const MeshSurface* other);

}  // namespace polhode::surface_contact
