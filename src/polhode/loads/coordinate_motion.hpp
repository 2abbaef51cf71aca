// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include <polhode/system/free_coordinate.hpp>
#include <polhode/system/pair_terms.hpp>

namespace polhode {

/// A free coordinate of a joint: its angle with counted turns, or its displacement.
using JointCoordinate = std::variant<FreeAngle, FreeDisplacement>;

/// A coordinate of the relative motion of two bodies over a step, with the derivatives needed by
/// all forces along it: μ·(Δq_a, Δq_b) is its change over the step exactly at ρ∞ = 1.
struct CoordinateMotion {
  double at_n = 0.0, at_alpha = 0.0, at_n1 = 0.0;
  Vec6 mu_a, mu_b;              ///< Discrete gradient by (r, θ) of a, of b.
  Vec6 alpha_a, alpha_b;        ///< D of at_alpha.
  Vec6 at_n1_a, at_n1_b;        ///< D of at_n1.
  Mat6 D_aa, D_ab, D_ba, D_bb;  ///< D_ij: of mu_i by the increment of j.

  /// The coordinate motion with exchanged roles of the bodies.
  [[nodiscard]] CoordinateMotion exchanged() const {
    return {at_n,    at_alpha, at_n1, mu_b, mu_a, alpha_b, alpha_a,
            at_n1_b, at_n1_a,  D_bb,  D_ba, D_ab, D_aa};
  }
};

/// Coordinate over a step with its tangents. @eq{free-angle-gradient} @eq{joint-plane}
/// @param at_n  Angle at t_n with counted turns; not used for a displacement.
[[nodiscard]] CoordinateMotion coordinate_motion(const JointCoordinate& coordinate,
                                                 const BodyStep& a, const BodyStep& b, double at_n,
                                                 bool conserving);

/// Value at t_{n+1}. @param near  Angle to which the number of turns is matched.
[[nodiscard]] double coordinate_at_n1(const JointCoordinate& coordinate, const BodyStep& a,
                                      const BodyStep& b, double near);
[[nodiscard]] double coordinate_rate_at_n1(const JointCoordinate& coordinate, const BodyStep& a,
                                           const BodyStep& b);

/// A body at the start of its step, as an instant.
[[nodiscard]] BodyStep body_at_start(const BodyStep& body);

/// Rate of a coordinate at t_{n+αf}, which is its change over Δt at ρ∞ = 1, with its tangents.
struct RateStep {
  double value = 0.0;
  Vec6 by_a, by_b;
};
[[nodiscard]] RateStep rate_step(const CoordinateMotion& q, const BodyStep& a, const BodyStep& b);

/// Adds a force along a coordinate, positive on b, with its tangent as long as it is constant.
void add_force(const CoordinateMotion& q, double force, const PairStep& step, PairTerms& terms);
/// Adds the tangent of a force along q that changes with the motion.
void add_force_change(const CoordinateMotion& q, const Vec6& by_a, const Vec6& by_b,
                      PairTerms& terms);

/// World components of a force along a coordinate on b: force [N] of a displacement, moment [N m]
/// of an angle.
[[nodiscard]] Vec3 on_b(const JointCoordinate& coordinate, const CoordinateMotion& q, double force);

}  // namespace polhode
