// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <polhode/dynamics/body_motion.hpp>
#include <polhode/dynamics/body_step.hpp>

namespace polhode {

/// Forms of the rate of angular momentum at t_{n+αm}.
///
/// At ρ∞ = 1 only `momentum` conserves; for ρ∞ < 1 it and `kinematic_corrected` are of second
/// order, `kinematic` (as the theory prints it, kept for comparison) of first.
enum class MomentumRate { momentum, kinematic, kinematic_corrected };

/// Form from its name in a model file: momentum, kinematic, kinematic_corrected.
/// @throws InputError if it is none of them.
[[nodiscard]] MomentumRate momentum_rate(std::string_view word);

/// Rates of momentum of one body at t_{n+αm} and their tangents by (Δr, Δθ).
struct MomentumRates {
  Vec3 p_dot;        ///< [N], world.
  Vec3 h_dot;        ///< [N m], world, about the centre of mass.
  double K_r = 0.0;  ///< D p_dot[Δr] = K_r I [N/m].
  Mat3 K_theta;      ///< D h_dot[Δθ] [N m].
};

/// The step of one body with its rates at t_{n+1} by Newmark.
///
/// @param at_n   Motion at t_n; its a, A and h_dot belong to t_n + δΔt.
/// @param u      r_{n+1} − r_n [m].
/// @param theta  Cayley vector of the step, world [-].
[[nodiscard]] BodyStep newmark_step(const BodyMotion& at_n, const Vec3& u, const Vec3& theta,
                                    const StepContext& context);

/// Rates of momentum at t_{n+αm} with the inertia tangent; the residual of the body is its wrench
/// minus these. @eq{eq:ga-residual-vector} @eq{eq:ga-momenta-interpolation}
///
/// @param mass  [kg]
/// @param J_r   Inertia about the centre of mass, body components [kg m²].
[[nodiscard]] MomentumRates momentum_rates(double mass, const Mat3& J_r, const BodyMotion& at_n,
                                           const BodyStep& step, const StepContext& context,
                                           MomentumRate form = MomentumRate::momentum);

/// The body's motion at t_{n+1}, all rates updated. The quaternion is composed from the step's
/// Cayley vector and normalised.
[[nodiscard]] BodyMotion end_motion(const Mat3& J_r, const BodyMotion& at_n, const BodyStep& step,
                                    const StepContext& context,
                                    MomentumRate form = MomentumRate::momentum);

}  // namespace polhode
