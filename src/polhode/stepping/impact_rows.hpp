// SPDX-License-Identifier: Apache-2.0
// Rows of ImpactResolver; included only by its source files.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include <polhode/stepping/impact_resolver.hpp>

namespace polhode {

/// Whether friction alone acts at the end of a step: without restitution until the normal velocity
/// reverses, since the step itself dissipates.
inline bool friction_alone(const ImpactCourse& course) {
  return !course.turns && course.restitution == 0.0;
}

/// Impulse at a point, along its normal and two tangents, that changes the velocity at the end of
/// the step to that of Routh's method from the energy stored at t_n to that at t_{n+1}. @eq{routh}
/// @param K  Mobility. @param before  Velocity without the normal impulse of the step.
/// @param now  At its end.
[[nodiscard]] Vec3 impulse_by_routh(const Mat3& K, const Eigen::Vector2d& mu,
                                    const ImpactCourse& course, const Vec3& before,
                                    const Vec3& now);

/// A relative velocity J v, and the island's response to a unit impulse along it.
struct ImpactResolver::Row {
  int impact = 0;  ///< Its number.
  /// J, by position in the island: of its bodies, then of its nodes, which have no rotation.
  std::vector<std::pair<int, Vec6>> on;
  std::vector<std::pair<int, Vec6>> answer;  ///< By position: X = M⁻¹ Jᵀ under G v = 0.
  double mobility = 0.0;                     ///< J X.
  double before = 0.0, impulse = 0.0;        ///< Initial J v [m/s]; [N s].
  bool has_friction = false;                 ///< It is the first of two tangents.
  bool turns = false;                        ///< Torsional or rolling friction.

  [[nodiscard]] double speed(const std::vector<Vec6>& v) const {
    double sum = 0.0;
    for (const auto& [place, J] : on) sum += J.dot(v[static_cast<std::size_t>(place)]);
    return sum;
  }
  /// Velocity by a unit impulse along another row of the same bodies.
  [[nodiscard]] double speed_by(const Row& other) const {
    double sum = 0.0;
    for (const auto& [place, x] : other.answer)
      for (const auto& [own, J] : on)
        if (own == place) sum += J.dot(x);
    return sum;
  }
  void apply(double p, std::vector<Vec6>& v) {
    impulse += p;
    for (const auto& [place, x] : answer) v[static_cast<std::size_t>(place)] += p * x;
  }
};

}  // namespace polhode
