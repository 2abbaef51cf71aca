// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode::surface_contact {

/// The vector y = Σ c_i x_i between the nearest points of two features with four points in total: a
/// point and a triangle, c = (1, −w), or two edges, c = (1 − a, a, b − 1, −b).
///
/// With s_ij = |x_i − x_j|² the distance is |y|² = −Σ_{i<j} c_i c_j s_ij. As the c of the nearest
/// points minimise it, its derivative by s_ij is only −c_i c_j: forces between the four points
/// along their connecting lines. @eq{four-point-distance}
struct NearestFour {
  static constexpr int kLengths = 6;
  /// The two points of each length.
  static constexpr int kEnds[kLengths][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  using Lengths = Eigen::Matrix<double, kLengths, 1>;

  Eigen::Vector4d c = Eigen::Vector4d::Zero();
  /// Directions in which c is free, where the nearest points are not corners.
  Eigen::Vector4d free[2] = {Eigen::Vector4d::Zero(), Eigen::Vector4d::Zero()};
  int free_count = 0;
  double distance = 0.0;  ///< [m]

  /// ∂|y|²/∂s.
  [[nodiscard]] Lengths gradient() const;
  /// ∂²|y|²/∂s² including the motion of the nearest points, at the present four points.
  [[nodiscard]] Eigen::Matrix<double, kLengths, kLengths> hessian(const Vec3 (&x)[4]) const;
};

/// Nearest points of x_0 and the triangle of the others.
[[nodiscard]] NearestFour nearest_of_triangle(const Vec3 (&x)[4]);

/// Nearest points of x_0 and the edge x_a x_b.
[[nodiscard]] NearestFour nearest_of_edge(const Vec3 (&x)[4], int a, int b);
/// The points x_0 and x_a.
[[nodiscard]] NearestFour nearest_of_corner(const Vec3 (&x)[4], int a);

/// Nearest points of the edges x_0 x_1 and x_2 x_3, or of given points on them.
/// @param e_place, f_place  From 0 to 1: only this point of the first, the second edge; −1: all.
[[nodiscard]] NearestFour nearest_of_edges(const Vec3 (&x)[4], double e_place = -1.0,
                                           double f_place = -1.0);

}  // namespace polhode::surface_contact
