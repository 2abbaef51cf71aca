// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/contact/contact_point.hpp>

namespace polhode::contact {

/// Data of a contact point between two balls about the centres of mass of their bodies, or between
/// such a ball and a fixed plane. Rotations do not change its gap. It holds all that an iteration
/// needs while the gap is open, contiguous in memory.
struct SpherePairCache {
  bool holds = false;          ///< Whether this point is of that kind.
  int a = 0, b = 0;            ///< Indices of the steps; the last one is the ground's.
  double gap_n = 0.0;          ///< [m]
  double reach = 0.0;          ///< Activation distance: larger gaps carry no force [m].
  double least_gap = 0.0;      ///< No step may end below this gap [m].
  Vec3 offset = Vec3::Zero();  ///< From centre to centre at t_n [m]; for a plane its normal.
  double distance = 0.0;       ///< Between the centres [m]; 0 for a plane.

  /// Gap after a relative displacement, computed from the displacement and not from positions: deep
  /// in the barrier the rounding of a position would matter. @eq{contact-gap-change}
  [[nodiscard]] double gap_after(const Vec3& moved) const {
    if (distance == 0.0) return gap_n + offset.dot(moved);
    return gap_n + (2.0 * offset + moved).dot(moved) / (distance + (offset + moved).norm());
  }
  [[nodiscard]] double gap_n1(const BodyStep& on_a, const BodyStep& on_b) const {
    return gap_after(on_a.u - on_b.u);
  }
  /// Fraction of the relative increment `change` that leaves the part `kept` of the clearance.
  [[nodiscard]] double part(const BodyStep& on_a, const BodyStep& on_b, const Vec3& change,
                            double kept) const;
};

/// Whether a contact point is of a frequent kind with closed forms: a point of a against a ball or
/// a half space, an isotropic friction cone, ρ∞ = 1. The closed forms give the results of the
/// general formulas in a fraction of the time.
[[nodiscard]] bool is_closed_form_point(const PointData& data);

/// Cache of a closed-form point in a step; not usable where `holds` is false.
[[nodiscard]] SpherePairCache sphere_pair_cache(const PointData& data, const BodyStep& a,
                                                const BodyStep& b);

/// Gap of a closed-form point at t_{n+1} [m]. @param gap_n  At t_n [m]. @eq{contact-gap-change}
[[nodiscard]] double closed_form_gap_n1(const PointData& data, double gap_n, const BodyStep& a,
                                        const BodyStep& b);

/// Force and spring of a closed-form point. @param gap_n  At t_n [m]. @param gap_n1  At t_{n+1}
/// [m].
[[nodiscard]] PointForce closed_form_force(const PointData& data, double gap_n, double gap_n1,
                                           const BodyStep& a, const BodyStep& b,
                                           const StepContext& context,
                                           PointReport* report = nullptr);

}  // namespace polhode::contact
