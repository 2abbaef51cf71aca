// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode {

/// Mean angular velocity ω̄ = θ/Δt of a step in which the angular momentum about the centre of mass
/// changes by tau: cay(Δt ω̄) J (2 ω̄ − ω_n) − J ω_n = τ, all in space. @eq{nonsmooth-step}
///
/// @param J        Inertia at t_n [kg m²]. @param omega_n  At t_n [rad/s].
/// @param tau      Moment times the step [N m s]. @param dt  [s].
/// @param mean  Initially a guess, then ω̄ [rad/s].
/// @returns false if Newton's iterations do not converge: the body rotates too far.
[[nodiscard]] bool try_mean_turn(const Mat3& J, const Vec3& omega_n, const Vec3& tau, double dt,
                                 Vec3& mean);

/// Mean angular velocity for isotropic inertia: with q = τ/J the condition is linear, ω̄ + ¼Δt ω̄ ×
/// q = ω_n + ½q.
[[nodiscard]] inline Vec3 mean_turn_of_a_ball(double J, const Vec3& omega_n, const Vec3& tau,
                                              double dt) {
  const Vec3 q = tau / J, s = omega_n + 0.5 * q, c = 0.25 * dt * q;
  return (s + c.cross(s) + c.dot(s) * c) / (1.0 + c.squaredNorm());
}

}  // namespace polhode
