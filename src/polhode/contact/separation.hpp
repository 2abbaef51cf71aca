// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/geometry/shape.hpp>

namespace polhode::contact {

/// Two unit vectors normal to n.
void tangents(const Vec3& n, Vec3& e, Vec3& f);

/// Direction of largest separation of two round solids, the maximum of F(n) = n·(x_a(−n) − x_b(n))
/// over the unit sphere, at the finest blur.
struct Separation {
  Vec3 n;
  double distance = 0.0;  ///< F [m].
  Eigen::Matrix2d M;      ///< Negative derivative of the tangential part of x_a − x_b by the two
                          ///< tangential increments of n.
};

/// Newton's method from a blurred maximum to finer ones.
/// @param axes_a, axes_b  In the world. @param between  From the centre of b to that of a.
/// @param start  Approximate direction from b to a, of any length.
[[nodiscard]] Separation separate(const geometry::Shape& a, const geometry::Shape& b,
                                  const Mat3& axes_a, const Mat3& axes_b, const Vec3& between,
                                  const Vec3& start);

}  // namespace polhode::contact
