// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/dynamics/generalized_alpha.hpp>
#include <polhode/math/cayley.hpp>

namespace polhode {

/// Common data of the current step: method, times and form of the potentials.
struct StepContext {
  GeneralizedAlpha ga;
  double t_n = 0.0;          ///< Start of the step [s].
  double dt = 0.0;           ///< Length of the step [s]; negative in stages of orders 4 to 8.
  bool conserving = true;    ///< Potentials in discrete-gradient form.
  double load_factor = 1.0;  ///< Factor of all loads and of gravity in statics. [-]
  /// Statics: that of the last equilibrium [-], and the time that passes over the load step for
  /// materials whose stress relaxes, infinite where they relax fully [s].
  double load_factor_n = 1.0, relaxation_time = 0.0;
  bool tangents = true;  ///< Tangents and G are needed; else only wrenches and values.
  /// Geometric stiffness from the stress stored in histories, not from that of the iterate:
  /// statics.
  bool mixed_point = false;

  [[nodiscard]] double t_alpha() const { return t_n + ga.alpha_f * dt; }  ///< t_{n+αf} [s].
  [[nodiscard]] double t_n1() const { return t_n + dt; }                  ///< [s]
};

/// A body-fixed vector, or a point's position, at the three times of a step.
///
/// Its tangents are known: a body-fixed vector z has D z_{n+αf}[Δθ] = −α_f ẑ_{n+1}, a point x has
/// in addition D x_{n+αf}[Δr] = α_f I. @eq{ga-z-tangent}
struct Carried {
  Vec3 at_n, at_alpha, at_n1;
};

/// Motion of one rigid body over the current step, the only input of joints, loads, springs and
/// contacts. The ground is a BodyStep at rest.
///
/// Capital letters are body components, small ones world components.
struct BodyStep {
  Vec3 r_n = Vec3::Zero(), r_n1 = Vec3::Zero();  ///< Centre of mass [m].
  Mat3 Lambda_n = Mat3::Identity(), Lambda_n1 = Mat3::Identity();
  Vec3 u = Vec3::Zero();                         ///< r_{n+1} − r_n, stored separately [m].
  Vec3 theta = Vec3::Zero();                     ///< Cayley vector of the step, world [-].
  Vec3 v_n = Vec3::Zero(), v_n1 = Vec3::Zero();  ///< [m/s]
  Vec3 W_n = Vec3::Zero(), W_n1 = Vec3::Zero();  ///< Material angular velocity [rad/s].
  Vec3 a_n = Vec3::Zero();  ///< Newmark acceleration of t_n + δΔt [m/s²]; used for ρ∞ < 1 only.
  double alpha_f = 0.5;     ///< Weight of t_{n+1} [-].
  double rate = 0.0;        ///< γ/(βΔt): D v_{n+1}/D r [1/s].
  bool moves = true;        ///< False for the ground.

  /// The vector Z fixed in the body. z_{n+αf} is the average of z_n and z_{n+1}, shorter
  /// than Z: Λ_{n+αf} is no rotation. @eq{ga-z-interpolation}
  [[nodiscard]] Carried vector(const Vec3& Z) const {
    const Vec3 z_n = Lambda_n * Z;
    const Vec3 z_n1 = Lambda_n1 * Z;
    return {z_n, (1.0 - alpha_f) * z_n + alpha_f * z_n1, z_n1};
  }

  /// The point r + Z fixed in the body [m]. @eq{eq:rbm-position}
  [[nodiscard]] Carried point(const Vec3& Z) const {
    Carried x = vector(Z);
    x.at_n += r_n;
    x.at_alpha += (1.0 - alpha_f) * r_n + alpha_f * r_n1;
    x.at_n1 += r_n1;
    return x;
  }

  /// Velocity of the centre of mass at t_{n+αf} [m/s]; D v_α[Δr] = α_f·rate·I.
  [[nodiscard]] Vec3 velocity_alpha() const { return (1.0 - alpha_f) * v_n + alpha_f * v_n1; }

  /// Acceleration of the centre of mass at t_{n+αm} [m/s²]; its derivative by Δr is
  /// αm/(βΔt²) I. @eq{eq:ga-momenta-Newmark}
  [[nodiscard]] Vec3 acceleration_m(const StepContext& context) const {
    return context.ga.kappa / context.dt * (v_n1 - v_n) + (1.0 - context.ga.kappa) * a_n;
  }

  /// Angular velocity at t_{n+αf}, world [rad/s]: Λ_α W_α, which is θ/Δt exactly at ρ∞ = 1.
  [[nodiscard]] Vec3 omega_alpha() const {
    return ((1.0 - alpha_f) * Lambda_n + alpha_f * Lambda_n1) * W_alpha();
  }

  /// D ω_α[Δθ] (3×3) [1/s].
  [[nodiscard]] Mat3 omega_alpha_tangent() const {
    const Mat3 Lambda_alpha = (1.0 - alpha_f) * Lambda_n + alpha_f * Lambda_n1;
    return alpha_f * (rate * Lambda_alpha * Lambda_n1.transpose() * cayley_tangent(theta) -
                      hat(Lambda_n1 * W_alpha()));
  }

  /// Material angular velocity at t_{n+αf} [rad/s].
  [[nodiscard]] Vec3 W_alpha() const { return (1.0 - alpha_f) * W_n + alpha_f * W_n1; }

  /// Degenerate step at one instant: a state as seen by an interaction.
  [[nodiscard]] static BodyStep at_instant(const Vec3& r, const Mat3& Lambda, const Vec3& v,
                                           const Vec3& W) {
    BodyStep s;
    s.r_n = s.r_n1 = r;
    s.Lambda_n = s.Lambda_n1 = Lambda;
    s.v_n = s.v_n1 = v;
    s.W_n = s.W_n1 = W;
    s.alpha_f = 1.0;
    return s;
  }

  /// The ground, at rest; alpha_f as of the step.
  [[nodiscard]] static BodyStep ground(double alpha_f) {
    BodyStep s;
    s.alpha_f = alpha_f;
    s.moves = false;
    return s;
  }
};

}  // namespace polhode
