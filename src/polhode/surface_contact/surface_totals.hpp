// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/surface_contact/surface_law.hpp>
#include <polhode/system/body_contacts.hpp>
#include <polhode/system/history_record.hpp>

namespace polhode::surface_contact {

/// History of a surface contact behind that of its points: sums since the start, then results of
/// the last step. Its report needs no others.
struct SurfaceTotals {
  double impulse, friction_loss, normal_loss;  // since the start
  double gap, normal_force, area, pressure, sticking, slipping;
  double force[3], friction[3], point[3];

  static constexpr std::size_t kCount = 18;

  /// Of a new step: the sums since the start alone.
  [[nodiscard]] static SurfaceTotals sums_of(const double* history) {
    const auto before = read_record<SurfaceTotals>(history);
    SurfaceTotals t{};
    t.impulse = before.impulse;
    t.friction_loss = before.friction_loss;
    t.normal_loss = before.normal_loss;
    return t;
  }
  [[nodiscard]] static SurfaceReport report(const double* history) {
    const auto t = read_record<SurfaceTotals>(history);
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
                          double* history) {
    auto t = read_record<SurfaceTotals>(history);
    t.impulse += settled.normal;
    t.normal_loss += settled.normal_loss;
    t.friction_loss += settled.friction_loss;
    t.normal_force += settled.normal / dt;
    for (int k = 0; k < 3; ++k) {
      t.friction[k] += settled.friction[k] / dt;
      t.force[k] += (settled.normal * normal[k] + settled.friction[k]) / dt;
    }
    write_record(t, history);
  }
  /// Energy that an impact took.
  static void add_normal_loss(double energy, double* history) {
    auto t = read_record<SurfaceTotals>(history);
    t.normal_loss += energy;
    write_record(t, history);
  }
  /// Of the start.
  static void set_gap(double gap, double* history) {
    auto t = read_record<SurfaceTotals>(history);
    t.gap = gap;
    write_record(t, history);
  }
};
static_assert(kNumbersOf<SurfaceTotals> == SurfaceTotals::kCount);

}  // namespace polhode::surface_contact
