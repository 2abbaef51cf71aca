// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <polhode/solids/elements/quadrature.hpp>
#include <polhode/solids/elements/reference_data.hpp>
#include <polhode/solids/mesh/shapes.hpp>

namespace polhode::solids {

/// Faces of one shape: tri3, tri6, quad4, quad8, quad9. Seen from outside the solid, their corners
/// are counterclockwise.
struct LoadedFaces {
  std::string shape;
  std::vector<int> nodes;  ///< Numbers of nodes, face after face.
};

/// Checks that there are faces, and that their nodes are complete.
/// @param name  Path of the load in the user's model.
/// @throws InputError if there are no faces, or faces of an unknown shape.
void check_faces(const std::string& name, std::span<const LoadedFaces> faces);

/// A quadrature point of an undeformed face.
struct FacePoint {
  Vec3 area;  ///< Outward vector area per reference area [m²].
  Vec3 X;     ///< Position [m].
};

/// Calls use(node, N_a w, point) for the points of undeformed faces and all nodes of the face.
/// @param X  Reference positions of all nodes [m].
template <class Use>
void for_each_face_point(std::span<const LoadedFaces> faces, std::span<const Vec3> X,
                         const Use& use) {
  for (const LoadedFaces& f : faces) {
    const CellShape& shape = cell_shape(f.shape);
    const int n = shape.size();
    for (const QuadraturePoint& q : face_rule(f.shape)) {
      const Vec N = shape_functions(shape, q.xi);
      const Mat D = shape_gradients(shape, q.xi);
      for (std::size_t first = 0; first < f.nodes.size(); first += n) {
        const Mat3 J = reference_jacobian(D, std::span(f.nodes).subspan(first, n), X);
        FacePoint point{.area = J.col(0).cross(J.col(1)), .X = Vec3::Zero()};
        for (int a = 0; a < n; ++a) point.X += N[a] * X[f.nodes[first + a]];
        for (int a = 0; a < n; ++a) use(f.nodes[first + a], N[a] * q.weight, point);
      }
    }
  }
}

}  // namespace polhode::solids
