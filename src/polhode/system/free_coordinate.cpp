// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <polhode/system/angle_gradient.hpp>
#include <polhode/system/angle_quotient.hpp>
#include <polhode/system/free_coordinate.hpp>

namespace polhode {

namespace {

/// Directions of the angle at one time: e, f of the base body, d of the other.
struct Directions {
  Vec3 e, f, d;
  [[nodiscard]] double cosine() const { return e.dot(d); }
  [[nodiscard]] double sine() const { return f.dot(d); }
  [[nodiscard]] double angle() const { return std::atan2(sine(), cosine()); }
  /// ∂φ = gradient·(∂θ_other − ∂θ_base) when d is fixed to the other body.
  [[nodiscard]] Vec3 gradient() const {
    const double C = cosine(), S = sine();
    return d.cross(C * f - S * e) / (C * C + S * S);
  }
};

/// mu with tangents by the base's and the other body's rotation.
struct Gradient {
  double alpha = 0.0;
  Vec3 mu, D_alpha_base, D_alpha_other;
  Mat3 D_mu_base, D_mu_other;
};

Gradient discrete_gradient(const Directions& q_alpha, const Directions& q_n1, double phi_n,
                           double phi_n1, double alpha_f) {
  Gradient out;
  out.alpha = (1.0 - alpha_f) * phi_n + alpha_f * phi_n1;
  const double c = std::cos(out.alpha), s = std::sin(out.alpha);
  const auto [w, w_x] = over_sine(0.5 * (phi_n1 - phi_n));
  const Vec3 b = c * q_alpha.f - s * q_alpha.e;
  const Vec3 n = q_alpha.d.cross(b);
  out.mu = w * n;
  const Vec3 phi_gradient = q_n1.gradient();
  out.D_alpha_other = alpha_f * phi_gradient;
  out.D_alpha_base = -out.D_alpha_other;
  const Vec3 b_alpha = -s * q_alpha.f - c * q_alpha.e;
  const Mat3 through_phi = n * (0.5 * w_x * phi_gradient).transpose() +
                           w * q_alpha.d.cross(b_alpha) * out.D_alpha_other.transpose();
  out.D_mu_other = through_phi + w * alpha_f * hat_hat(b, q_n1.d);
  out.D_mu_base = -through_phi - w * alpha_f * hat_hat(q_alpha.d, c * q_n1.f - s * q_n1.e);
  return out;
}

Gradient plain_gradient(const Directions& q_alpha, const Directions& q_n1, double phi_n,
                        double phi_n1, double alpha_f) {
  Gradient out;
  const double C = q_alpha.cosine(), S = q_alpha.sine(), q = C * C + S * S;
  out.alpha = nearest_turn(std::atan2(S, C), (1.0 - alpha_f) * phi_n + alpha_f * phi_n1);
  out.mu = q_alpha.gradient();
  const Vec3 n = C * q_alpha.f - S * q_alpha.e;
  // Dot products of averaged directions: D(x_α·y_α) by the rotation of x is α_f x_{n+1} × y_α.
  const Vec3 C_other = alpha_f * q_n1.d.cross(q_alpha.e),
             C_base = alpha_f * q_n1.e.cross(q_alpha.d);
  const Vec3 S_other = alpha_f * q_n1.d.cross(q_alpha.f),
             S_base = alpha_f * q_n1.f.cross(q_alpha.d);
  out.D_alpha_other = (C * S_other - S * C_other) / q;
  out.D_alpha_base = (C * S_base - S * C_base) / q;
  const auto tangent = [&](const Vec3& D_C, const Vec3& D_S, const Mat3& turned) -> Mat3 {
    const Mat3 D_n = q_alpha.f * D_C.transpose() - q_alpha.e * D_S.transpose();
    return (hat(q_alpha.d) * D_n + turned) / q -
           out.mu * (2.0 / q * (C * D_C + S * D_S)).transpose();
  };
  out.D_mu_other = tangent(C_other, S_other, alpha_f * hat_hat(n, q_n1.d));
  out.D_mu_base = tangent(C_base, S_base, -alpha_f * hat_hat(q_alpha.d, C * q_n1.f - S * q_n1.e));
  return out;
}

Directions directions_at_n1(const FreeAngle& x, const BodyStep& a, const BodyStep& b) {
  const BodyStep& base = x.on_b ? b : a;
  const BodyStep& other = x.on_b ? a : b;
  return {base.Lambda_n1 * x.E, base.Lambda_n1 * x.F, other.Lambda_n1 * x.D};
}

}  // namespace

double FreeAngle::at_n1(const BodyStep& a, const BodyStep& b, double near) const {
  return nearest_turn(directions_at_n1(*this, a, b).angle(), near);
}

double FreeAngle::rate_at_n1(const BodyStep& a, const BodyStep& b) const {
  const Vec3 omega = b.Lambda_n1 * b.W_n1 - a.Lambda_n1 * a.W_n1;
  const double rate = directions_at_n1(*this, a, b).gradient().dot(omega);
  return on_b ? -rate : rate;
}

double FreeAngle::acceleration_at_n1(const BodyStep& a, const BodyStep& b) const {
  const BodyStep& base = on_b ? b : a;
  const BodyStep& other = on_b ? a : b;
  const Directions q = directions_at_n1(*this, a, b);
  const Vec3 omega_base = base.Lambda_n1 * base.W_n1, omega_other = other.Lambda_n1 * other.W_n1;
  const Vec3 e_dot = omega_base.cross(q.e), f_dot = omega_base.cross(q.f);
  const Vec3 d_dot = omega_other.cross(q.d);
  const double C = q.cosine(), S = q.sine(), size = C * C + S * S;
  const double C_dot = e_dot.dot(q.d) + q.e.dot(d_dot), S_dot = f_dot.dot(q.d) + q.f.dot(d_dot);
  const Vec3 n = C * q.f - S * q.e;
  const Vec3 n_dot = C_dot * q.f + C * f_dot - S_dot * q.e - S * e_dot;
  const Vec3 gradient = q.d.cross(n) / size;
  const Vec3 change =
      (d_dot.cross(n) + q.d.cross(n_dot)) / size - 2.0 * (C * C_dot + S * S_dot) / size * gradient;
  return change.dot(omega_other - omega_base);
}

AngleStep angle_gradient(const FreeAngle& angle, const BodyStep& a, const BodyStep& b, double at_n,
                         bool conserving) {
  const BodyStep& base = angle.on_b ? b : a;
  const BodyStep& other = angle.on_b ? a : b;
  const Carried e = base.vector(angle.E), f = base.vector(angle.F), d = other.vector(angle.D);
  const Directions q_alpha{e.at_alpha, f.at_alpha, d.at_alpha};
  const Directions q_n1{e.at_n1, f.at_n1, d.at_n1};
  AngleStep s;
  s.at_n = at_n;
  s.at_n1 = nearest_turn(q_n1.angle(), at_n);
  const Gradient g =
      (conserving ? discrete_gradient : plain_gradient)(q_alpha, q_n1, s.at_n, s.at_n1, a.alpha_f);
  s.at_alpha = g.alpha;
  const double sign = angle.on_b ? -1.0 : 1.0;
  s.mu = sign * g.mu;
  s.D_mu_a = sign * (angle.on_b ? g.D_mu_other : g.D_mu_base);
  s.D_mu_b = sign * (angle.on_b ? g.D_mu_base : g.D_mu_other);
  s.D_alpha_a = angle.on_b ? g.D_alpha_other : g.D_alpha_base;
  s.D_alpha_b = angle.on_b ? g.D_alpha_base : g.D_alpha_other;
  return s;
}

AngleStep angle_step(const FreeAngle& angle, const BodyStep& a, const BodyStep& b, double at_n,
                     bool conserving) {
  AngleStep s = angle_gradient(angle, a, b, at_n, conserving);
  const Vec3 omega = b.omega_alpha() - a.omega_alpha();
  s.rate = s.mu.dot(omega);
  s.D_rate_a = s.D_mu_a.transpose() * omega - a.omega_alpha_tangent().transpose() * s.mu;
  s.D_rate_b = s.D_mu_b.transpose() * omega + b.omega_alpha_tangent().transpose() * s.mu;
  return s;
}

double FreeDisplacement::at_n1(const BodyStep& a, const BodyStep& b) const {
  return (a.Lambda_n1 * D).dot(b.point(Z_b).at_n1 - a.point(Z_a).at_n1);
}

double FreeDisplacement::rate_at_n1(const BodyStep& a, const BodyStep& b) const {
  const Vec3 d = a.Lambda_n1 * D, u = b.point(Z_b).at_n1 - a.point(Z_a).at_n1;
  const Vec3 omega_a = a.Lambda_n1 * a.W_n1, omega_b = b.Lambda_n1 * b.W_n1;
  const Vec3 u_dot =
      b.v_n1 + omega_b.cross(b.vector(Z_b).at_n1) - a.v_n1 - omega_a.cross(a.vector(Z_a).at_n1);
  return d.dot(u_dot) + omega_a.cross(d).dot(u);
}

double FreeDisplacement::acceleration_at_n1(const BodyStep& a, const BodyStep& b) const {
  const Vec3 omega_a = a.Lambda_n1 * a.W_n1, omega_b = b.Lambda_n1 * b.W_n1;
  const Vec3 z_a = a.vector(Z_a).at_n1, z_b = b.vector(Z_b).at_n1;
  const Vec3 d = a.Lambda_n1 * D, d_dot = omega_a.cross(d);
  const Vec3 u = b.point(Z_b).at_n1 - a.point(Z_a).at_n1;
  const Vec3 u_dot = b.v_n1 + omega_b.cross(z_b) - a.v_n1 - omega_a.cross(z_a);
  const Vec3 centripetal = omega_b.cross(omega_b.cross(z_b)) - omega_a.cross(omega_a.cross(z_a));
  return omega_a.cross(d_dot).dot(u) + 2.0 * d_dot.dot(u_dot) + d.dot(centripetal);
}

DisplacementStep displacement_step(const FreeDisplacement& displacement, const BodyStep& a,
                                   const BodyStep& b) {
  const Carried d = a.vector(displacement.D);
  const Carried z_a = a.vector(displacement.Z_a), z_b = b.vector(displacement.Z_b);
  const Vec3 u_n = (b.r_n - a.r_n) + (z_b.at_n - z_a.at_n);
  const Vec3 u_n1 = (b.r_n1 - a.r_n1) + (z_b.at_n1 - z_a.at_n1);
  const double af = a.alpha_f;
  const Vec3 y_alpha = (1.0 - af) * u_n + af * u_n1 + z_a.at_alpha, y_n1 = u_n1 + z_a.at_n1;
  DisplacementStep s;
  s.at_n1 = d.at_n1.dot(u_n1);
  s.mu_a << -d.at_alpha, -y_alpha.cross(d.at_alpha);
  s.mu_b << d.at_alpha, z_b.at_alpha.cross(d.at_alpha);
  s.at_n1_a << -d.at_n1, -y_n1.cross(d.at_n1);
  s.at_n1_b << d.at_n1, z_b.at_n1.cross(d.at_n1);
  for (Mat6* D : {&s.D_aa, &s.D_ab, &s.D_ba, &s.D_bb}) D->setZero();
  s.D_bb.bottomRightCorner<3, 3>() = af * hat_hat(d.at_alpha, z_b.at_n1);
  s.D_ba.topRightCorner<3, 3>() = -af * hat(d.at_n1);
  s.D_ba.bottomRightCorner<3, 3>() = -af * hat_hat(z_b.at_alpha, d.at_n1);
  s.D_aa.topRightCorner<3, 3>() = af * hat(d.at_n1);
  s.D_aa.bottomLeftCorner<3, 3>() = -af * hat(d.at_alpha);
  s.D_aa.bottomRightCorner<3, 3>() = af * hat_hat(y_alpha, d.at_n1);
  s.D_ab.bottomLeftCorner<3, 3>() = af * hat(d.at_alpha);
  s.D_ab.bottomRightCorner<3, 3>() = -af * hat_hat(d.at_alpha, z_b.at_n1);
  return s;
}

}  // namespace polhode
