// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/dynamics/momentum_step.hpp>
#include <polhode/dynamics/newmark_rotation.hpp>
#include <polhode/dynamics/newmark_translation.hpp>
#include <polhode/math/quaternion.hpp>

namespace polhode {

namespace {

/// Material angular acceleration at t_{n+1}. @eq{eq:td-Newmark-mrot}
Vec3 acceleration_n1(const BodyMotion& at_n, const BodyStep& step, const StepContext& context) {
  return newmark_rotation(step.Lambda_n1.transpose() * step.theta, {at_n.W, at_n.A}, context.ga,
                          context.dt)
      .A;
}

/// ḣ = ω × h + J α = Λ (W × J_r W + J_r A). @eq{ga-h-dot}
Vec3 kinematic_rate(const Mat3& Lambda, const Mat3& J_r, const Vec3& W, const Vec3& A) {
  return Lambda * (W.cross(J_r * W) + J_r * A);
}

/// ḣ_{n+αm} = κ (h_{n+1} − h_n)/Δt + (1 − κ) ḣ_n with κ = α_m/γ: Newmark in the momentum.
/// @eq{eq:ga-momenta-Newmark} @eq{ga-K-momentum-chain} @eq{ga-h-tangent} @eq{ga-K-momentum}
void momentum_form(const Mat3& J_r, const BodyMotion& at_n, const BodyStep& s,
                   const StepContext& context, MomentumRates& out) {
  const GeneralizedAlpha& ga = context.ga;
  const double dt = context.dt;
  const Vec3 h_n = s.Lambda_n * (J_r * s.W_n);
  const Vec3 h_n1 = s.Lambda_n1 * (J_r * s.W_n1);
  out.h_dot = ga.kappa / dt * (h_n1 - h_n) + (1.0 - ga.kappa) * at_n.h_dot;
  const Mat3 J = s.Lambda_n1 * J_r * s.Lambda_n1.transpose();
  const Mat3 D_h = ga.c / dt * J * cayley_tangent(s.theta) - hat(h_n1);
  out.K_theta = ga.kappa / dt * D_h;
}

/// Average of ω × h + J α as printed in the theory: first order for ρ∞ < 1, because A_n belongs
/// to t_n + δΔt and W_n to t_n. @eq{ga-h-dot} @eq{ga-K-kinematic}
void kinematic_form(const Mat3& J_r, const BodyMotion& at_n, const BodyStep& s,
                    const StepContext& context, MomentumRates& out) {
  const auto& [rho, alpha_f, alpha_m, beta, gamma, kappa, c, c_A, delta] = context.ga;
  const double dt = context.dt;
  const Vec3 h_dot_n = kinematic_rate(s.Lambda_n, J_r, s.W_n, at_n.A);
  const Vec3 h_dot_n1 = kinematic_rate(s.Lambda_n1, J_r, s.W_n1, acceleration_n1(at_n, s, context));
  out.h_dot = (1.0 - alpha_m) * h_dot_n + alpha_m * h_dot_n1;
  const Mat3 J = s.Lambda_n1 * J_r * s.Lambda_n1.transpose();
  const Vec3 omega = s.Lambda_n1 * s.W_n1, h = s.Lambda_n1 * (J_r * s.W_n1);
  const Mat3 D_rates = gamma * hat(omega) * J + J / dt - gamma * hat(h);
  out.K_theta = alpha_m * (1.0 / (beta * dt) * D_rates * cayley_tangent(s.theta) - hat(h_dot_n1));
}

/// Kinematic form with each term at its proper time: J α at t_{n+αm} in the averaged orientation, ω
/// × h at t_{n+αf}. Second order for every ρ∞. @eq{ga-K-kinematic-corrected}
void corrected_form(const Mat3& J_r, const BodyMotion& at_n, const BodyStep& s,
                    const StepContext& context, MomentumRates& out) {
  const GeneralizedAlpha& ga = context.ga;
  const double af = ga.alpha_f, am = ga.alpha_m, dt = context.dt;
  const Vec3 A_m = (1.0 - am) * at_n.A + am * acceleration_n1(at_n, s, context);
  const Mat3 Lambda_alpha = (1.0 - af) * s.Lambda_n + af * s.Lambda_n1;
  const Vec3 gyro_n1 = s.Lambda_n1 * s.W_n1.cross(J_r * s.W_n1);
  out.h_dot = Lambda_alpha * (J_r * A_m) + (1.0 - af) * s.Lambda_n * s.W_n.cross(J_r * s.W_n) +
              af * gyro_n1;
  const Mat3 J = s.Lambda_n1 * J_r * s.Lambda_n1.transpose(), T = cayley_tangent(s.theta);
  const Vec3 omega = s.Lambda_n1 * s.W_n1, h = s.Lambda_n1 * (J_r * s.W_n1);
  out.K_theta = am / (ga.beta * dt * dt) * Lambda_alpha * J_r * s.Lambda_n1.transpose() * T -
                af * hat(s.Lambda_n1 * (J_r * A_m)) +
                af * (ga.c / dt * (hat(omega) * J - hat(h)) * T - hat(gyro_n1));
}

}  // namespace

MomentumRate momentum_rate(std::string_view word) {
  if (word == "momentum") return MomentumRate::momentum;
  if (word == "kinematic") return MomentumRate::kinematic;
  if (word == "kinematic_corrected") return MomentumRate::kinematic_corrected;
  throw InputError("analysis.momentum_rate", format("'{}' is not known", word),
                   "Use one of: momentum, kinematic, kinematic_corrected");
}

BodyStep newmark_step(const BodyMotion& at_n, const Vec3& u, const Vec3& theta,
                      const StepContext& context) {
  BodyStep s;
  s.r_n = at_n.r;
  s.r_n1 = at_n.r + u;
  s.u = u;
  s.theta = theta;
  s.Lambda_n = at_n.Lambda();
  s.Lambda_n1 = cay(theta) * s.Lambda_n;
  s.v_n = at_n.v;
  s.a_n = at_n.a;
  s.v_n1 = newmark_translation(u, {at_n.v, at_n.a}, context.ga, context.dt).v;
  s.W_n = at_n.W;
  s.W_n1 =
      newmark_rotation(s.Lambda_n.transpose() * theta, {at_n.W, at_n.A}, context.ga, context.dt).W;
  s.alpha_f = context.ga.alpha_f;
  s.rate = context.ga.c / context.dt;
  return s;
}

MomentumRates momentum_rates(double mass, const Mat3& J_r, const BodyMotion& at_n,
                             const BodyStep& step, const StepContext& context, MomentumRate form) {
  const GeneralizedAlpha& ga = context.ga;
  const double dt = context.dt;
  MomentumRates out;
  // For translation Newmark in the momentum and m r̈ are the same. @eq{ga-p-tangent}
  out.p_dot = mass * (ga.kappa / dt * (step.v_n1 - step.v_n) + (1.0 - ga.kappa) * at_n.a);
  out.K_r = ga.alpha_m * mass / (ga.beta * dt * dt);
  switch (form) {
    case MomentumRate::momentum:
      momentum_form(J_r, at_n, step, context, out);
      break;
    case MomentumRate::kinematic:
      kinematic_form(J_r, at_n, step, context, out);
      break;
    case MomentumRate::kinematic_corrected:
      corrected_form(J_r, at_n, step, context, out);
      break;
  }
  return out;  // Neither rate depends on the other's increment. @eq{ga-h-dot-r-tangent}
               // @eq{ga-inertia-tangent}
}

BodyMotion end_motion(const Mat3& J_r, const BodyMotion& at_n, const BodyStep& step,
                      const StepContext& context, MomentumRate form) {
  const GeneralizedAlpha& ga = context.ga;
  const double dt = context.dt;
  BodyMotion end;
  end.r = step.r_n1;
  end.q = (quaternion_from_cayley(step.theta) * at_n.q).normalized();
  end.v = step.v_n1;
  end.a = newmark_translation(step.u, {at_n.v, at_n.a}, ga, dt).a;
  end.W = step.W_n1;
  end.A = acceleration_n1(at_n, step, context);
  if (form == MomentumRate::momentum) {
    const Vec3 h_n = step.Lambda_n * (J_r * step.W_n), h_n1 = step.Lambda_n1 * (J_r * step.W_n1);
    end.h_dot = (h_n1 - h_n) / (ga.gamma * dt) + (1.0 - 1.0 / ga.gamma) * at_n.h_dot;
  } else {
    end.h_dot = kinematic_rate(step.Lambda_n1, J_r, end.W, end.A);
  }
  return end;
}

}  // namespace polhode
