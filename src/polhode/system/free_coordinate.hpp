// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/dynamics/body_step.hpp>

namespace polhode {

/// Rotation angle of body b relative to body a about an axis fixed to both.
///
///   φ = atan2(f·d, e·d) + 2π·turns,   e, f on one body, d on the other, all ⟂ to the axis.
///
/// On a revolute axis e, f are the joint's x, y on a and d is its x on b. When the angle is
/// measured in the other sense (`on_b`: e, f on b, d on a), choose e × f opposite to the axis, so
/// that φ still increases as b rotates about +axis.
struct FreeAngle {
  Vec3 E = Vec3::UnitX(), F = Vec3::UnitY();  ///< Body components, unit.
  Vec3 D = Vec3::UnitX();                     ///< Of the other body.
  bool on_b = false;                          ///< E, F belong to b and D to a.

  /// Angle at t_{n+1}, with the number of turns that brings it nearest to `near` [rad].
  [[nodiscard]] double at_n1(const BodyStep& a, const BodyStep& b, double near) const;
  /// dφ/dt at t_{n+1} [rad/s].
  [[nodiscard]] double rate_at_n1(const BodyStep& a, const BodyStep& b) const;
  /// Part of d²φ/dt² due to the bodies' velocities, in addition to ∂φ·(α_b − α_a) [rad/s²].
  [[nodiscard]] double acceleration_at_n1(const BodyStep& a, const BodyStep& b) const;
};

/// Angle over the step with the derivatives that a moment about the axis needs.
///
/// mu is its discrete gradient: μ·(θ_b − θ_a) = φ_{n+1} − φ_n exactly at α_f = ½ when d lies
/// in the plane of e and f at both ends of the step; so a moment M μ does exactly M Δφ.
struct AngleStep {
  double at_n = 0.0, at_alpha = 0.0, at_n1 = 0.0;  ///< Turns counted [rad].
  double rate = 0.0;                               ///< At t_{n+αf} [rad/s]; Δφ/Δt at α_f = ½.
  Vec3 mu;                                         ///< Discrete gradient [-].
  Vec3 D_alpha_a, D_alpha_b;                       ///< Dφ_α by Δθ of a, of b [-].
  Vec3 D_rate_a, D_rate_b;                         ///< D of the rate [1/s].
  Mat3 D_mu_a, D_mu_b;                             ///< D of mu [-].
};

/// The angle over a step with its tangents. @eq{free-angle-gradient}
/// @param at_n        Angle at t_n, turns counted [rad].
/// @param conserving  Discrete gradient and mean angle; else both from the averaged directions.
[[nodiscard]] AngleStep angle_step(const FreeAngle& angle, const BodyStep& a, const BodyStep& b,
                                   double at_n, bool conserving);

/// Displacement of a point of b along a direction of a: s = d·(x_b − x_a).
struct FreeDisplacement {
  Vec3 Z_a = Vec3::Zero(), Z_b = Vec3::Zero();  ///< Points from the centres of mass [m].
  Vec3 D = Vec3::UnitZ();                       ///< Direction, body-a components, unit.

  [[nodiscard]] double at_n1(const BodyStep& a, const BodyStep& b) const;       ///< [m]
  [[nodiscard]] double rate_at_n1(const BodyStep& a, const BodyStep& b) const;  ///< [m/s]
  /// Part of d²s/dt² due to the bodies' velocities, in addition to ∂s·(accelerations) [m/s²].
  [[nodiscard]] double acceleration_at_n1(const BodyStep& a, const BodyStep& b) const;
};

/// Displacement over the step with the derivatives that a force along it needs. It is quadratic, so
/// that its gradient at averaged positions does exactly the work F Δs at α_f = ½.
struct DisplacementStep {
  double at_n1 = 0.0;           ///< At t_{n+1} [m].
  Vec6 mu_a, mu_b;              ///< Gradient at t_{n+αf}, by (r, θ) of a, of b.
  Vec6 at_n1_a, at_n1_b;        ///< At t_{n+1}.
  Mat6 D_aa, D_ab, D_ba, D_bb;  ///< D_ij: of mu_i by the increment of j.
};

/// Displacement over a step with its tangents. @eq{joint-plane}
[[nodiscard]] DisplacementStep displacement_step(const FreeDisplacement& displacement,
                                                 const BodyStep& a, const BodyStep& b);

}  // namespace polhode
