// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/coordinate_motion.hpp>
#include <polhode/loads/spring_damper.hpp>

namespace polhode {

namespace {

/// Newton's constant of gravitation, CODATA 2018 [m³/(kg s²)].
constexpr double kGravitation = 6.67430e-11;

using Row12 = Eigen::Matrix<double, 1, 12>;  ///< Derivative by (Δr_a, Δθ_a, Δr_b, Δθ_b).
using Mat3x12 = Eigen::Matrix<double, 3, 12>;

/// Distance, as a part of a metre, below which it is round-off and has no direction.
constexpr double kNoLength = 1e-14;

/// Velocity of a point of a body at t_{n+αf}, and its tangent.
Vec3 point_velocity(const BodyStep& body, const Carried& z) {
  return body.velocity_alpha() + body.omega_alpha().cross(z.at_alpha);
}

Mat3 point_velocity_by_turn(const BodyStep& body, const Carried& z) {
  return -hat(z.at_alpha) * body.omega_alpha_tangent() -
         body.alpha_f * hat_hat(body.omega_alpha(), z.at_n1);
}

}  // namespace

/// Connection of the points over the step.
struct SpringDamper::Stretch {
  Carried z_a, z_b;
  Vec3 u_alpha, u_n1, u_dot;
  double l_n = 0.0, l_n1 = 0.0, l_alpha = 0.0, rate = 0.0;
  bool has_direction = true;
};

SpringDamper::SpringDamper(const LoadDescription& load)
    : Z_a_(load.Z_a),
      Z_b_(load.Z_b),
      l_0_(load.value("free_length", load.start_length)),
      spring_(load, "spring_force"),
      damper_(load, "damper_force"),
      pull_(load.drive == "pull" ? load.function : nullptr) {
  if (const auto* f = std::get_if<CoordinateFunction>(&load.of_motion)) of_motion_ = *f;
  name = load.name;
  bodies = load.bodies;
}

SpringDamper::Stretch SpringDamper::stretch(const PairStep& step) const {
  const BodyStep &a = step.a, &b = step.b;
  const double af = a.alpha_f;
  Stretch s;
  s.z_a = a.vector(Z_a_);
  s.z_b = b.vector(Z_b_);
  const Vec3 u_n = (b.r_n - a.r_n) + (s.z_b.at_n - s.z_a.at_n);
  s.u_n1 = (b.r_n1 - a.r_n1) + (s.z_b.at_n1 - s.z_a.at_n1);
  s.u_alpha = (1.0 - af) * u_n + af * s.u_n1;
  s.l_n = u_n.norm();
  s.l_n1 = s.u_n1.norm();
  s.l_alpha = step.context.conserving ? (1.0 - af) * s.l_n + af * s.l_n1 : s.u_alpha.norm();
  s.has_direction = s.l_alpha > kNoLength;
  s.u_dot = point_velocity(b, s.z_b) - point_velocity(a, s.z_a);
  if (s.has_direction) s.rate = s.u_alpha.dot(s.u_dot) / s.l_alpha;
  return s;
}

void SpringDamper::evaluate(const PairStep& step, PairTerms& t) const {
  const BodyStep &a = step.a, &b = step.b;
  const double af = a.alpha_f;
  const Stretch s = stretch(step);

  Mat3x12 D_u_n1;
  D_u_n1 << -Mat3::Identity(), hat(s.z_a.at_n1), Mat3::Identity(), -hat(s.z_b.at_n1);
  const Mat3x12 D_u = af * D_u_n1;

  Vec3 F = Vec3::Zero();
  Mat3x12 D_F = Mat3x12::Zero();
  if (s.has_direction) {
    const LawValue spring = tension(step, s);
    const StepRates v = rates(step, s);
    const LawValue damper = damper_.smooth(v);
    const CoordinateValue given = pull(step, s, step.context.tangents);
    const double N =
        spring.value + damper.value + damper_.of_rows(v, step.lambda, step.history) + given.value;
    const Vec3 n = s.u_alpha / s.l_alpha;
    Row12 D_l = Row12::Zero();
    if (!step.context.conserving)
      D_l = n.transpose() * D_u;
    else if (s.l_n1 > kNoLength)
      D_l = s.u_n1.transpose() * D_u / s.l_n1;
    // The slope of the law is by l_{n+1}; without the discrete gradient by l_α.
    Row12 D_N =
        ((step.context.conserving ? spring.slope / af : spring.slope) + given.by_value) * D_l;
    if (!damper_.is_zero() || of_motion_) {
      Mat3x12 D_u_dot;
      D_u_dot << -af * a.rate * Mat3::Identity(), -point_velocity_by_turn(a, s.z_a),
          af * b.rate * Mat3::Identity(), point_velocity_by_turn(b, s.z_b);
      const Row12 D_rate =
          (s.u_dot.transpose() * D_u + s.u_alpha.transpose() * D_u_dot - s.rate * D_l) / s.l_alpha;
      D_N += (damper.slope + given.by_rate) * D_rate;
      const Vec6 by_rate = damper_.put_rows(v, step.lambda, t);
      for (int k = 0; k < rows(); ++k) {
        t.B_b.col(k) << n, s.z_b.at_alpha.cross(n);
        t.B_a.col(k) << -n, -s.z_a.at_alpha.cross(n);
        if (!step.context.tangents) continue;
        t.G_a.row(k) = by_rate[k] * D_rate.head<6>();
        t.G_b.row(k) = by_rate[k] * D_rate.tail<6>();
      }
    }
    F = -N * n;
    D_F = -N / s.l_alpha * D_u - n * (D_N - N / s.l_alpha * D_l);
  } else {
    if (l_0_ == 0.0) {
      const double k = spring_.at(0.0).slope;
      F = -k * s.u_alpha;
      D_F = -k * D_u;
    }
    for (int k = 0; k < rows(); ++k) {  // without a direction no force of the damper
      t.compliance[k] = 1.0;
      t.B_a.col(k).setZero();
      t.B_b.col(k).setZero();
      if (!step.context.tangents) continue;
      t.G_a.row(k).setZero();
      t.G_b.row(k).setZero();
    }
  }

  t.wrench_b << F, s.z_b.at_alpha.cross(F);
  t.wrench_a << -F, -s.z_a.at_alpha.cross(F);
  // Force and lever arm: @eq{ga-wrench-r-tangent} @eq{ga-moment-tangent}
  const Mat3x12 D_m_b = hat(s.z_b.at_alpha) * D_F, D_m_a = -hat(s.z_a.at_alpha) * D_F;
  t.D_ba << D_F.leftCols<6>(), D_m_b.leftCols<6>();
  t.D_bb << D_F.rightCols<6>(), D_m_b.rightCols<6>();
  t.D_aa << -D_F.leftCols<6>(), D_m_a.leftCols<6>();
  t.D_ab << -D_F.rightCols<6>(), D_m_a.rightCols<6>();
  t.D_bb.bottomRightCorner<3, 3>() += af * hat_hat(F, s.z_b.at_n1);
  t.D_aa.bottomRightCorner<3, 3>() -= af * hat_hat(F, s.z_a.at_n1);
  clear_ground_sides(step, t);
}

void SpringDamper::pieces(const PairStep& step, ForcePieces& pieces) const {
  const Stretch s = stretch(step);
  spring_.piece(s.l_n1 - l_0_, pieces);
  damper_.piece(s.rate, step.history, pieces);
}

Work SpringDamper::work(const PairStep& step) const {
  const Stretch s = stretch(step);
  return {.stored = spring_.energy(s.l_n1 - l_0_),
          .dissipated = damper_.is_zero() || !s.has_direction
                            ? 0.0
                            : damper_.force(rates(step, s), step.lambda, step.history) * s.rate *
                                  step.context.dt,
          .put_in = pull_ || of_motion_ ? -pull(step, s, false).value * (s.l_n1 - s.l_n) : 0.0};
}

StepRates SpringDamper::rates(const PairStep& step, const Stretch& s) const {
  double now = 0.0;
  if (damper_.jumps() && step.context.dt != 0.0) {
    const BodyStep a = body_at_start(step.a), b = body_at_start(step.b);
    now = stretch({a, b, step.context, step.lambda, step.history}).rate;
  }
  return damper_.rates(step, now, s.rate, step.history);
}

void SpringDamper::initialize(const PairStep& step, double* history) const {
  damper_.initialize(rate_now(step), history);
}

void SpringDamper::commit(const PairStep& step, double* history) const {
  if (rows() > 0) damper_.commit(rates(step, stretch(step)), rate_now(step), step.lambda, history);
}

double SpringDamper::rate_now(const PairStep& step) const {
  const BodyStep a = BodyStep::at_instant(step.a.r_n1, step.a.Lambda_n1, step.a.v_n1, step.a.W_n1);
  const BodyStep b = BodyStep::at_instant(step.b.r_n1, step.b.Lambda_n1, step.b.v_n1, step.b.W_n1);
  return stretch({a, b, step.context, step.lambda, step.history}).rate;
}

CoordinateValue SpringDamper::pull(const PairStep& step, const Stretch& s, bool tangents) const {
  const StepContext& c = step.context;
  CoordinateValue f;
  if (of_motion_) f = coordinate_value(*of_motion_, {c.t_alpha(), s.l_alpha, s.rate}, tangents);
  if (pull_) f.value += (*pull_)(c.t_alpha());
  return {c.load_factor * f.value, c.load_factor * f.by_value, c.load_factor * f.by_rate};
}

LawValue SpringDamper::tension(const PairStep& step, const Stretch& s) const {
  return step.context.conserving ? spring_.over_step(s.l_n - l_0_, s.l_n1 - l_0_, step.a.alpha_f)
                                 : spring_.at(s.l_alpha - l_0_);
}

std::vector<double> SpringDamper::report(const PairStep& step) const {
  const Stretch s = stretch(step);
  Vec3 force = Vec3::Zero();
  if (s.has_direction)
    force = -(tension(step, s).value + damper_.force(rates(step, s), step.lambda, step.history) +
              pull(step, s, false).value) /
            s.l_alpha * s.u_alpha;
  else if (l_0_ == 0.0)
    force = -spring_.at(0.0).slope * s.u_alpha;
  return numbers(force, {s.l_n1, s.rate, work(step).stored});
}

double SpringDamper::length(const PairStep& step) const { return stretch(step).l_n1; }

void add_spring_damper(System& system, const LoadDescription& load) {
  system.group<SpringDamper>().add(load);
}

Attraction::Attraction(const LoadDescription& load)
    : SpringDamper([&] {
        LoadDescription d = load;
        d.values["free_length"] = 0.0;
        d.values["inverse_square"] =
            load.value("strength", kGravitation * load.mass_a * load.mass_b);
        return d;
      }()) {}

PotentialForce::PotentialForce(const LoadDescription& load)
    : SpringDamper([&] {
        LoadDescription d = load;
        d.values["free_length"] = 0.0;
        return d;
      }()) {}

void add_potential_force(System& system, const LoadDescription& load) {
  system.group<PotentialForce>().add(load);
}

void add_axial_force(System& system, const LoadDescription& load) {
  system.group<AxialForce>().add(load);
}

void add_attraction(System& system, const LoadDescription& load) {
  system.group<Attraction>().add(load);
}

}  // namespace polhode
