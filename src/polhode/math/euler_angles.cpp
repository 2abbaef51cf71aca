// SPDX-License-Identifier: Apache-2.0
#include <polhode/math/euler_angles.hpp>

#include <cmath>
#include <utility>

namespace polhode {

namespace {

/// Sine below which the first and last axis coincide (gimbal lock).
constexpr double kTogether = 1e-12;

/// R = R_i(a) R_j(b) R_k(c).
std::array<double, 3> turning_along(const Mat3& R, int i, int j, int k) {
  const int l = 3 - i - j;  // the third axis; k if they are all different
  const double s = j == (i + 1) % 3 ? 1.0 : -1.0;
  if (i == k) {
    const double sine = std::hypot(R(i, j), R(i, l)), b = std::atan2(sine, R(i, i));
    if (sine < kTogether) return {std::atan2(s * R(l, j), R(j, j)), b, 0.0};
    return {std::atan2(R(j, i), -s * R(l, i)), b, std::atan2(R(i, j), s * R(i, l))};
  }
  const double cosine = std::hypot(R(i, i), R(i, j)), b = std::atan2(s * R(i, k), cosine);
  if (cosine < kTogether) return {std::atan2(s * R(k, j), R(j, j)), b, 0.0};
  return {std::atan2(-s * R(j, k), R(k, k)), b, std::atan2(-s * R(i, j), R(i, i))};
}

}  // namespace

std::array<double, 3> euler_angles(const Mat3& R, std::string_view sequence) {
  const bool at_rest = sequence[0] < 'a';
  std::array<int, 3> axis{};
  for (std::size_t n = 0; n < 3; ++n) axis[n] = sequence[n] - (at_rest ? 'X' : 'x');
  if (!at_rest) return turning_along(R, axis[0], axis[1], axis[2]);
  std::array<double, 3> angles = turning_along(R, axis[2], axis[1], axis[0]);
  std::swap(angles[0], angles[2]);
  return angles;
}

}  // namespace polhode
