// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/contact/contact_point.hpp>

namespace polhode::contact {

/// Two balls about the centres of mass of their bodies, or one over a plane that stands: turns do
/// not change the gap. All that iterations ask of a point while nothing touches, side by side.
struct SpherePairCache {
  bool holds = false;          ///< This point is of that sort.
  int a = 0, b = 0;            ///< Among the steps; the ground's is the last.
  double gap_n = 0.0;          ///< [m]
  double reach = 0.0;          ///< Gaps from here on carry no force [m].
  double least_gap = 0.0;      ///< No step may go below [m].
  Vec3 offset = Vec3::Zero();  ///< Of the centres at t_n [m]; of a plane its normal.
  double distance = 0.0;       ///< Of the centres [m]; 0: a plane.

  /// From how far the balls moved, not from where they are: deep in the barrier the rounding of a
  /// position would count. @eq{contact-gap-change}
  [[nodiscard]] double gap_after(const Vec3& moved) const {
    if (distance == 0.0) return gap_n + offset.dot(moved);
    return gap_n + (2.0 * offset + moved).dot(moved) / (distance + (offset + moved).norm());
  }
  [[nodiscard]] double gap_n1(const BodyStep& on_a, const BodyStep& on_b) const {
    return gap_after(on_a.u - on_b.u);
  }
  /// Part of the increment `change` of one against the other that leaves the part `kept` of the
  /// room.
  [[nodiscard]] double part(const BodyStep& on_a, const BodyStep& on_b, const Vec3& change,
                            double kept) const;
};

/// Closed forms of the frequent points: a point of a against a ball or a half space, friction by a
/// round cone, ρ∞ = 1. They give what the general formulas give, in a fraction of the time.
[[nodiscard]] bool is_closed_form_point(const PointData& data);

/// How a plain point of two bodies' steps starts: of no use where `holds` is false.
[[nodiscard]] SpherePairCache sphere_pair_cache(const PointData& data, const BodyStep& a,
                                                const BodyStep& b);

/// Gap of a plain point at t_{n+1} [m]. @param gap_n  At t_n [m]. @eq{contact-gap-change}
[[nodiscard]] double closed_form_gap_n1(const PointData& data, double gap_n, const BodyStep& a,
                                        const BodyStep& b);

/// Force and spring of a plain point. @param gap_n  At t_n [m]. @param gap_n1  At t_{n+1} [m].
[[nodiscard]] PointForce closed_form_force(const PointData& data, double gap_n, double gap_n1,
                                           const BodyStep& a, const BodyStep& b,
                                           const StepContext& context,
                                           PointReport* report = nullptr);

}  // namespace polhode::contact
