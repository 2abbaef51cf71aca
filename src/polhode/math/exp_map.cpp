// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <polhode/math/exp_map.hpp>
#include <polhode/math/hat.hpp>
#include <polhode/math/quaternion.hpp>

namespace polhode {

Mat3 exp_map(const Vec3& chi) {
  const double angle = chi.norm();
  const double half = 0.5 * angle;
  const bool tiny = angle < 1e-4;  // series: the next terms are below 1e-17
  const double sinc = tiny ? 1.0 - angle * angle / 6.0 : std::sin(angle) / angle;
  const double sinc_half = tiny ? 1.0 - half * half / 6.0 : std::sin(half) / half;
  const Mat3 chi_hat = hat(chi);
  return Mat3::Identity() + sinc * chi_hat + 0.5 * sinc_half * sinc_half * chi_hat * chi_hat;
}

Vec3 log_map(const Mat3& Lambda) { return rotation_vector(Quat(Lambda)); }

Vec3 rotation_vector_rate(const Vec3& chi, const Vec3& omega) {
  const double angle = chi.norm(), half = 0.5 * angle;
  const double factor =
      angle < 1e-4 ? 1.0 / 12.0 : (1.0 - half * std::cos(half) / std::sin(half)) / (angle * angle);
  const Vec3 across = chi.cross(omega);
  return omega - 0.5 * across + factor * chi.cross(across);
}

}  // namespace polhode
