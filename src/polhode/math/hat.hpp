// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode {

/// Antisymmetric matrix with axial vector v: hat(v) * u == v × u.
/// @eq{eq:rbr-antisymmetric-tensor}
[[nodiscard]] inline Mat3 hat(const Vec3& v) {
  Mat3 m;
  m << 0.0, -v.z(), v.y(),  //
      v.z(), 0.0, -v.x(),   //
      -v.y(), v.x(), 0.0;
  return m;
}

/// Axial vector of the antisymmetric part of M: vee(hat(v)) == v.
[[nodiscard]] inline Vec3 vee(const Mat3& M) {
  return 0.5 * Vec3(M(2, 1) - M(1, 2), M(0, 2) - M(2, 0), M(1, 0) - M(0, 1));
}

/// hat(f) * hat(z) == z fᵀ − (f·z) I, the tangent of a moment f × z by a rotation; with f = z it
/// is @eq{eq:rbr-identity-2}.
[[nodiscard]] inline Mat3 hat_hat(const Vec3& f, const Vec3& z) {
  Mat3 m = z * f.transpose();
  m.diagonal().array() -= f.dot(z);
  return m;
}

}  // namespace polhode
