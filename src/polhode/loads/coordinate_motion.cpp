// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/coordinate_motion.hpp>
#include <polhode/system/angle_gradient.hpp>

namespace polhode {

namespace {

CoordinateMotion step_of(const FreeAngle& angle, const BodyStep& a, const BodyStep& b, double at_n,
                         bool conserving) {
  const AngleStep s = angle_gradient(angle, a, b, at_n, conserving);
  CoordinateMotion c;
  c.at_n = s.at_n;
  c.at_alpha = s.at_alpha;
  c.at_n1 = s.at_n1;
  c.mu_a << Vec3::Zero(), -s.mu;
  c.mu_b << Vec3::Zero(), s.mu;
  c.alpha_a << Vec3::Zero(), s.D_alpha_a;
  c.alpha_b << Vec3::Zero(), s.D_alpha_b;
  c.at_n1_a = c.alpha_a / a.alpha_f;
  c.at_n1_b = c.alpha_b / a.alpha_f;
  for (Mat6* D : {&c.D_aa, &c.D_ab, &c.D_ba, &c.D_bb}) D->setZero();
  c.D_aa.bottomRightCorner<3, 3>() = -s.D_mu_a;
  c.D_ab.bottomRightCorner<3, 3>() = -s.D_mu_b;
  c.D_ba.bottomRightCorner<3, 3>() = s.D_mu_a;
  c.D_bb.bottomRightCorner<3, 3>() = s.D_mu_b;
  return c;
}

CoordinateMotion step_of(const FreeDisplacement& displacement, const BodyStep& a, const BodyStep& b,
                         double, bool) {
  const DisplacementStep s = displacement_step(displacement, a, b);
  CoordinateMotion c;
  const Vec3 u_n =
      (b.r_n - a.r_n) + (b.vector(displacement.Z_b).at_n - a.vector(displacement.Z_a).at_n);
  c.at_n = a.vector(displacement.D).at_n.dot(u_n);
  c.at_n1 = s.at_n1;
  c.at_alpha = (1.0 - a.alpha_f) * c.at_n + a.alpha_f * c.at_n1;
  c.mu_a = s.mu_a;
  c.mu_b = s.mu_b;
  c.at_n1_a = s.at_n1_a;
  c.at_n1_b = s.at_n1_b;
  c.alpha_a = a.alpha_f * s.at_n1_a;
  c.alpha_b = a.alpha_f * s.at_n1_b;
  c.D_aa = s.D_aa;
  c.D_ab = s.D_ab;
  c.D_ba = s.D_ba;
  c.D_bb = s.D_bb;
  return c;
}

Vec6 velocity_alpha(const BodyStep& body) {
  return (Vec6() << body.velocity_alpha(), body.omega_alpha()).finished();
}

/// μ through the tangent of the body's velocities at t_{n+αf}.
Vec6 through_velocity(const BodyStep& body, const Vec6& mu) {
  Vec6 by;
  by << body.alpha_f * body.rate * mu.head<3>(),
      body.omega_alpha_tangent().transpose() * mu.tail<3>();
  return by;
}

}  // namespace

CoordinateMotion coordinate_motion(const JointCoordinate& coordinate, const BodyStep& a,
                                   const BodyStep& b, double at_n, bool conserving) {
  return std::visit([&](const auto& q) { return step_of(q, a, b, at_n, conserving); }, coordinate);
}

double coordinate_at_n1(const JointCoordinate& coordinate, const BodyStep& a, const BodyStep& b,
                        double near) {
  if (const auto* angle = std::get_if<FreeAngle>(&coordinate)) return angle->at_n1(a, b, near);
  return std::get<FreeDisplacement>(coordinate).at_n1(a, b);
}

double coordinate_rate_at_n1(const JointCoordinate& coordinate, const BodyStep& a,
                             const BodyStep& b) {
  return std::visit([&](const auto& q) { return q.rate_at_n1(a, b); }, coordinate);
}

BodyStep body_at_start(const BodyStep& body) {
  BodyStep start = BodyStep::at_instant(body.r_n, body.Lambda_n, body.v_n, body.W_n);
  start.moves = body.moves;
  return start;
}

RateStep rate_step(const CoordinateMotion& q, const BodyStep& a, const BodyStep& b) {
  const Vec6 v_a = velocity_alpha(a), v_b = velocity_alpha(b);
  RateStep s;
  s.value = q.mu_a.dot(v_a) + q.mu_b.dot(v_b);
  s.by_a = q.D_aa.transpose() * v_a + q.D_ba.transpose() * v_b + through_velocity(a, q.mu_a);
  s.by_b = q.D_ab.transpose() * v_a + q.D_bb.transpose() * v_b + through_velocity(b, q.mu_b);
  return s;
}

void add_force(const CoordinateMotion& q, double force, const PairStep& step, PairTerms& t) {
  t.wrench_a += force * q.mu_a;
  t.wrench_b += force * q.mu_b;
  if (!step.context.tangents) return;
  t.D_aa += force * q.D_aa;
  t.D_ab += force * q.D_ab;
  t.D_ba += force * q.D_ba;
  t.D_bb += force * q.D_bb;
}

void add_force_change(const CoordinateMotion& q, const Vec6& by_a, const Vec6& by_b, PairTerms& t) {
  t.D_aa += q.mu_a * by_a.transpose();
  t.D_ab += q.mu_a * by_b.transpose();
  t.D_ba += q.mu_b * by_a.transpose();
  t.D_bb += q.mu_b * by_b.transpose();
}

Vec3 on_b(const JointCoordinate& coordinate, const CoordinateMotion& q, double force) {
  return force * (std::holds_alternative<FreeAngle>(coordinate) ? Vec3(q.at_n1_b.tail<3>())
                                                                : Vec3(q.at_n1_b.head<3>()));
}

}  // namespace polhode
