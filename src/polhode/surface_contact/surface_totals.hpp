// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include <polhode/surface_contact/surface_law.hpp>
#include <polhode/system/body_contacts.hpp>

namespace polhode {

/// Numbers of a surface contact behind those of its points: sums since the start, then results of
/// the last step. Its report needs no others.
struct SurfaceTotals {
  double impulse, friction_loss, normal_loss;  // since the start
  double gap, normal_force, area, pressure, sticking, slipping;
  double force[3], friction[3], point[3];

  static constexpr std::size_t kCount = 18;

  /// @param numbers  kCount of them, in the order above.
  [[nodiscard]] static SurfaceReport report(const double* numbers) {
    SurfaceTotals t;
    std::copy_n(numbers, kCount, &t.impulse);
    SurfaceReport r;
    r.least_gap = t.gap;
    r.normal_force = t.normal_force;
    r.force = Vec3(t.force);
    r.friction = Vec3(t.friction);
    r.point = Vec3(t.point);
    r.area = t.area;
    r.largest_pressure = t.pressure;
    r.sticking = static_cast<int>(t.sticking);
    r.slipping = static_cast<int>(t.slipping);
    r.impulse = t.impulse;
    r.friction_loss = t.friction_loss;
    r.normal_loss = t.normal_loss;
    return r;
  }
  /// Adds an impulse at the end of the last step as its mean force over it.
  static void add_impulse(const Vec3& normal, const ResolvedImpact& settled, double dt,
                          double* numbers) {
    SurfaceTotals t;
    std::copy_n(numbers, kCount, &t.impulse);
    t.impulse += settled.normal;
    t.normal_loss += settled.normal_loss;
    t.friction_loss += settled.friction_loss;
    t.normal_force += settled.normal / dt;
    for (int k = 0; k < 3; ++k) {
      t.friction[k] += settled.friction[k] / dt;
      t.force[k] += (settled.normal * normal[k] + settled.friction[k]) / dt;
    }
    std::copy_n(&t.impulse, kCount, numbers);
  }
};
static_assert(sizeof(SurfaceTotals) == SurfaceTotals::kCount * sizeof(double));

}  // namespace polhode
