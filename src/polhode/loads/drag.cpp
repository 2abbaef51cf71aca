// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/drag.hpp>

namespace polhode {

Drag::Drag(const LoadDescription& load)
    : linear_(load.value("linear", 0.0)),
      quadratic_(load.value("quadratic", 0.0)),
      turning_(load.value("turning", 0.0)),
      per_mass_(load.value("per_mass", 0.0)),
      mass_(load.mass_b),
      inertia_(load.inertia_b) {
  name = load.name;
  bodies = load.bodies;
}

void Drag::evaluate(const PairStep& step, PairTerms& t) const {
  const BodyStep& b = step.b;
  const double af = b.alpha_f;
  const Vec3 v = b.velocity_alpha(), omega = b.omega_alpha();
  const double size = v.norm(), c = linear_ + per_mass_ * mass_ + quadratic_ * size;
  // Mean of the inertia at both ends: the moment never does positive work.
  const Mat3 J_n1 = b.Lambda_n1 * inertia_ * b.Lambda_n1.transpose();
  const Mat3 J = (1.0 - af) * b.Lambda_n * inertia_ * b.Lambda_n.transpose() + af * J_n1;
  t.wrench_b << -c * v, -turning_ * omega - per_mass_ * (J * omega);
  if (step.context.tangents) {
    Mat3 by_v = -c * Mat3::Identity();
    if (size > 0.0) by_v -= quadratic_ / size * v * v.transpose();
    t.D_bb.topLeftCorner<3, 3>() = af * b.rate * by_v;
    t.D_bb.bottomRightCorner<3, 3>() =
        -(turning_ * Mat3::Identity() + per_mass_ * J) * b.omega_alpha_tangent() +
        per_mass_ * af * (hat(J_n1 * omega) - J_n1 * hat(omega));
  }
  clear_ground_sides(step, t);
}

Work Drag::work(const PairStep& step) const {
  PairTerms t;
  t.set_zero();
  evaluate(step, t);
  return {.dissipated = -step.context.dt * (t.wrench_b.head<3>().dot(step.b.velocity_alpha()) +
                                            t.wrench_b.tail<3>().dot(step.b.omega_alpha()))};
}

std::vector<double> Drag::report(const PairStep& step) const {
  PairTerms t;
  t.set_zero();
  evaluate(step, t);
  return {t.wrench_b.data(), t.wrench_b.data() + 6};
}

VectorDamper::VectorDamper(const LoadDescription& load)
    : Z_a_(load.Z_a),
      Z_b_(load.Z_b),
      c_(load.value("damping", 0.0)),
      c_turn_(load.value("turning_damping", 0.0)) {
  name = load.name;
  bodies = load.bodies;
}

void VectorDamper::evaluate(const PairStep& step, PairTerms& t) const {
  const BodyStep &a = step.a, &b = step.b;
  const Carried z_a = a.vector(Z_a_), z_b = b.vector(Z_b_);
  const Vec3 w_a = a.omega_alpha(), w_b = b.omega_alpha();
  const Vec3 F = -c_ * (b.velocity_alpha() + w_b.cross(z_b.at_alpha) - a.velocity_alpha() -
                        w_a.cross(z_a.at_alpha));
  const Vec3 M = -c_turn_ * (w_b - w_a);
  t.wrench_b << F, z_b.at_alpha.cross(F) + M;
  t.wrench_a << -F, -z_a.at_alpha.cross(F) - M;
  if (step.context.tangents) {
    const auto by = [&](const BodyStep& body, const Carried& z) {
      Eigen::Matrix<double, 3, 6> D;
      D << body.alpha_f * body.rate * Mat3::Identity(),
          -hat(z.at_alpha) * body.omega_alpha_tangent() -
              body.alpha_f * hat_hat(body.omega_alpha(), z.at_n1);
      return D;
    };
    const Eigen::Matrix<double, 3, 6> F_a = c_ * by(a, z_a), F_b = -c_ * by(b, z_b);
    t.D_ba << F_a, hat(z_b.at_alpha) * F_a;
    t.D_bb << F_b, hat(z_b.at_alpha) * F_b;
    t.D_aa << -F_a, -hat(z_a.at_alpha) * F_a;
    t.D_ab << -F_b, -hat(z_a.at_alpha) * F_b;
    t.D_bb.bottomRightCorner<3, 3>() += b.alpha_f * hat_hat(F, z_b.at_n1);
    t.D_aa.bottomRightCorner<3, 3>() -= a.alpha_f * hat_hat(F, z_a.at_n1);
    const Mat3 M_a = c_turn_ * a.omega_alpha_tangent(), M_b = -c_turn_ * b.omega_alpha_tangent();
    t.D_ba.bottomRightCorner<3, 3>() += M_a;
    t.D_bb.bottomRightCorner<3, 3>() += M_b;
    t.D_aa.bottomRightCorner<3, 3>() -= M_a;
    t.D_ab.bottomRightCorner<3, 3>() -= M_b;
  }
  clear_ground_sides(step, t);
}

Work VectorDamper::work(const PairStep& step) const {
  const BodyStep &a = step.a, &b = step.b;
  const Vec3 w_a = a.omega_alpha(), w_b = b.omega_alpha();
  const Vec3 u_dot = b.velocity_alpha() + w_b.cross(b.vector(Z_b_).at_alpha) - a.velocity_alpha() -
                     w_a.cross(a.vector(Z_a_).at_alpha);
  return {.dissipated =
              step.context.dt * (c_ * u_dot.squaredNorm() + c_turn_ * (w_b - w_a).squaredNorm())};
}

std::vector<double> VectorDamper::report(const PairStep& step) const {
  const BodyStep &a = step.a, &b = step.b;
  const Vec3 w_a = a.omega_alpha(), w_b = b.omega_alpha();
  const Vec3 u_dot = b.velocity_alpha() + w_b.cross(b.vector(Z_b_).at_alpha) - a.velocity_alpha() -
                     w_a.cross(a.vector(Z_a_).at_alpha);
  std::vector<double> list = numbers(-c_ * u_dot);
  const Vec3 moment = -c_turn_ * (w_b - w_a);
  list.insert(list.end(), moment.data(), moment.data() + 3);
  return list;
}

void add_drag(System& system, const LoadDescription& load) { system.group<Drag>().add(load); }

void add_vector_damper(System& system, const LoadDescription& load) {
  system.group<VectorDamper>().add(load);
}

}  // namespace polhode
