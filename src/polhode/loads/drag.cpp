// SPDX-License-Identifier: Apache-2.0
#include <numbers>

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

void Drag::pieces(const PairStep& step, ForcePieces& pieces) const {
  static const Vec3 across(1.0, std::numbers::phi - 1.0, std::numbers::sqrt2 - 1.0);
  pieces.add(step.b.v_n1.dot(across) > 0.0 ? 1.0 : 0.0);
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
      c_turn_(load.value("turning_damping", 0.0)),
      on_b_(load.bodies.b != kGround) {
  name = load.name;
  bodies = load.bodies;
}

VectorDamper::Slip VectorDamper::slip(const PairStep& step) const {
  const BodyStep &a = step.a, &b = step.b;
  const auto centre = [](const BodyStep& body) { return Vec3(body.r_n + body.alpha_f * body.u); };
  Slip s;
  const Vec3 place = on_b_ ? b.point(Z_b_).at_alpha : a.point(Z_a_).at_alpha;
  s.arm_a = place - centre(a);
  s.arm_b = place - centre(b);
  s.turning = b.omega_alpha() - a.omega_alpha();
  s.velocity = b.velocity_alpha() + b.omega_alpha().cross(s.arm_b) - a.velocity_alpha() -
               a.omega_alpha().cross(s.arm_a);
  return s;
}

void VectorDamper::evaluate(const PairStep& step, PairTerms& t) const {
  const BodyStep &a = step.a, &b = step.b;
  const Slip s = slip(step);
  const Vec3 F = -c_ * s.velocity, M = -c_turn_ * s.turning;
  t.wrench_b << F, s.arm_b.cross(F) + M;
  t.wrench_a << -F, -s.arm_a.cross(F) - M;
  if (step.context.tangents) {
    using Block = Eigen::Matrix<double, 3, 6>;
    const auto of = [](const Mat3& by_place, const Mat3& by_turn) {
      Block D;
      D << by_place, by_turn;
      return D;
    };
    const double af = b.alpha_f;
    const Mat3 I = Mat3::Identity(), none = Mat3::Zero();
    // Derivatives of the common point, the arms and the velocity by the motions of a and b.
    const BodyStep& owner = on_b_ ? b : a;
    const Block place = af * of(I, -hat(owner.vector(on_b_ ? Z_b_ : Z_a_).at_n1));
    const Block shift = af * of(I, none);
    const Block place_a = on_b_ ? Block(Block::Zero()) : place, place_b = place - place_a;
    const Mat3 turning = hat(s.turning);
    const Block v_a = turning * place_a - of(af * a.rate * I - af * hat(a.omega_alpha()),
                                             -hat(s.arm_a) * a.omega_alpha_tangent());
    const Block v_b = turning * place_b + of(af * b.rate * I - af * hat(b.omega_alpha()),
                                             -hat(s.arm_b) * b.omega_alpha_tangent());
    const Mat3 by_force_a = hat(s.arm_a), by_force_b = hat(s.arm_b), force = hat(F);
    t.D_ba << -c_ * v_a, -c_ * by_force_b * v_a - force * place_a;
    t.D_bb << -c_ * v_b, -c_ * by_force_b * v_b - force * (place_b - shift);
    t.D_aa << c_ * v_a, c_ * by_force_a * v_a + force * (place_a - shift);
    t.D_ab << c_ * v_b, c_ * by_force_a * v_b + force * place_b;
    const Mat3 M_a = c_turn_ * a.omega_alpha_tangent(), M_b = -c_turn_ * b.omega_alpha_tangent();
    t.D_ba.bottomRightCorner<3, 3>() += M_a;
    t.D_bb.bottomRightCorner<3, 3>() += M_b;
    t.D_aa.bottomRightCorner<3, 3>() -= M_a;
    t.D_ab.bottomRightCorner<3, 3>() -= M_b;
  }
  clear_ground_sides(step, t);
}

Work VectorDamper::work(const PairStep& step) const {
  const Slip s = slip(step);
  return {.dissipated = step.context.dt *
                        (c_ * s.velocity.squaredNorm() + c_turn_ * s.turning.squaredNorm())};
}

std::vector<double> VectorDamper::report(const PairStep& step) const {
  const Slip s = slip(step);
  std::vector<double> list = numbers(-c_ * s.velocity);
  const Vec3 moment = -c_turn_ * s.turning;
  list.insert(list.end(), moment.data(), moment.data() + 3);
  return list;
}

void add_drag(System& system, const LoadDescription& load) { system.group<Drag>().add(load); }

void add_vector_damper(System& system, const LoadDescription& load) {
  system.group<VectorDamper>().add(load);
}

}  // namespace polhode
