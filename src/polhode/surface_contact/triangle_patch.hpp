// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/surface_contact/surface_patch.hpp>

namespace polhode::surface_contact {

/// M and its derivatives by ξ, η, ξξ, ξη, ηη.
struct PatchWeights {
  PatchFoot::Weights of[6];
};

/// Faces about the corners of each triangle, unfolded into its plane, see SurfacePatch::Beside.
/// @param smooth  Cosine of the largest angle between the normals of faces without a sharp edge.
void add_faces_beside(const MeshSurface& surface, const std::vector<Vec3>& x, double smooth,
                      std::vector<SurfacePatch>& patches);

/// @param xi  Barycentric coordinates of the second and third corner.
[[nodiscard]] PatchWeights triangle_weights(const SurfacePatch& patch, const Eigen::Vector2d& xi,
                                            double width);

/// Nearest point over a triangle, from a place near it.
/// @param from  Positions of vertices relative to the point. @param rounding  Of these.
/// @returns the number of directions in which it is free.
int descend_triangle(const SurfacePatch& patch, const Vec3 (&from)[SurfacePatch::kSize],
                     double width, double rounding, Eigen::Vector2d& xi, Eigen::Vector2d (&free)[2],
                     double& outwards);

}  // namespace polhode::surface_contact
