// SPDX-License-Identifier: Apache-2.0
#include <polhode/math/helical_axis.hpp>

#include <cmath>

#include <polhode/math/quaternion.hpp>

namespace polhode {

namespace {

/// Rotations below this are rounding.
constexpr double kNoTurn = 1e-14;

HelicalAxis of_translation(const Vec3& d) {
  const double length = d.norm();
  if (!(length > 0.0)) return {};
  return {d / length, Vec3::Zero(), 0.0, length};
}

}  // namespace

HelicalAxis helical_axis(const Vec3& r, const Vec3& v, const Vec3& omega) {
  const double turn = omega.norm();
  if (!(turn > kNoTurn)) return of_translation(v);
  const Vec3 n = omega / turn;
  const Vec3 point = r + n.cross(v) / turn;
  return {n, point - point.dot(n) * n, turn, v.dot(n)};
}

HelicalAxis finite_helical_axis(const Mat3& R, const Vec3& d) {
  const Vec3 chi = rotation_vector(Quat(R).normalized());
  const double turn = chi.norm();
  if (!(turn > kNoTurn)) return of_translation(d);
  const Vec3 n = chi / turn;
  const double slide = d.dot(n);
  const Vec3 across = d - slide * n;
  // (I − R) p = d normal to the axis.
  return {n, 0.5 * (across + n.cross(across) / std::tan(0.5 * turn)), turn, slide};
}

}  // namespace polhode
