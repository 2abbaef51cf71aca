// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/beams/cable.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/system/mass_coupling.hpp>

namespace polhode {

namespace {

using Row12 = Eigen::Matrix<double, 1, 12>;  ///< Derivative by (Δr_a, Δθ_a, Δr_b, Δθ_b).
using Mat3x12 = Eigen::Matrix<double, 3, 12>;

/// Part of the free length below which the points coincide and define no direction.
constexpr double kNoLength = 1e-14;

Vec3 point_velocity(const BodyStep& body, const Carried& z) {
  return body.velocity_alpha() + body.omega_alpha().cross(z.at_alpha);
}

Mat3 point_velocity_by_turn(const BodyStep& body, const Carried& z) {
  return -hat(z.at_alpha) * body.omega_alpha_tangent() -
         body.alpha_f * hat_hat(body.omega_alpha(), z.at_n1);
}

}  // namespace

/// The bar over the step.
struct Cable::Stretch {
  Carried z_a, z_b;
  Vec3 u_alpha, u_n1, u_dot;
  double l_alpha = 0.0, l_n1 = 0.0;
  double taut = 0.0;     ///< y_α − s_0.
  double ratio = 1.0;    ///< r = Δy/Δs.
  double D_ratio = 0.0;  ///< Of r by s_{n+1}.
  double D_taut = 0.0;   ///< Of y_α by s_{n+1}, or by s_{n+αf} in plain form.
  double rate = 0.0;     ///< ṡ_α.
  double per_rho = 0.0;  ///< 1/ϱ; 0: no direction.
};

Cable::Cable(const CableSpec& spec) : spec_(spec) {
  name = spec.name;
  bodies = spec.bodies;
  const std::string where = format("cable '{}'", name);
  if (!(spec.stiffness > 0.0))
    throw InputError(where, format("has the stiffness {:g}", spec.stiffness),
                     "Give EA above zero, in N");
  if (!(spec.free_length > 0.0))
    throw InputError(where, "has no length", "Give a free length above zero, or distinct points");
  if (!(spec.damping >= 0.0))
    throw InputError(where, format("has the damping {:g}", spec.damping),
                     "Give a damping that is not negative");
  if (spec.coupled_mass != 0.0 && (!spec.Z_a.isZero(0.0) || !spec.Z_b.isZero(0.0)))
    throw InputError(where, "has a consistent mass, but its ends are not at the centres of mass",
                     "Put its ends at the centres of mass, or lump its mass");
  k_ = spec.stiffness / spec.free_length;
  s_0_ = measure(spec.free_length);
}

double Cable::measure(double l) const {
  return spec_.strain == BarStrain::green ? 0.5 * l * l / spec_.free_length : l;
}

double Cable::taut(double s) const { return is_taut(s) ? s - s_0_ : 0.0; }

Cable::Stretch Cable::stretch(const PairStep& step) const {
  const BodyStep &a = step.a, &b = step.b;
  const double af = a.alpha_f;
  Stretch x;
  x.z_a = a.vector(spec_.Z_a);
  x.z_b = b.vector(spec_.Z_b);
  const Vec3 u_n = (b.r_n - a.r_n) + (x.z_b.at_n - x.z_a.at_n);
  x.u_n1 = (b.r_n1 - a.r_n1) + (x.z_b.at_n1 - x.z_a.at_n1);
  x.u_alpha = (1.0 - af) * u_n + af * x.u_n1;
  x.l_n1 = x.u_n1.norm();
  if (step.context.conserving) {
    const double l_n = u_n.norm(), s_n = measure(l_n), s_n1 = measure(x.l_n1);
    x.l_alpha = (1.0 - af) * l_n + af * x.l_n1;
    x.taut = (1.0 - af) * taut(s_n) + af * taut(s_n1);
    x.D_taut = is_taut(s_n1) ? af : 0.0;
    if (is_taut(s_n) != is_taut(s_n1)) {  // the transition lies within the step
      x.ratio = (taut(s_n1) - taut(s_n)) / (s_n1 - s_n);
      x.D_ratio = ((is_taut(s_n1) ? 1.0 : 0.0) - x.ratio) / (s_n1 - s_n);
    } else {
      x.ratio = is_taut(s_n1) ? 1.0 : 0.0;
    }
  } else {
    x.l_alpha = x.u_alpha.norm();
    const double s = measure(x.l_alpha);
    x.taut = taut(s);
    x.D_taut = x.ratio = is_taut(s) ? 1.0 : 0.0;
  }
  const double rho = spec_.strain == BarStrain::green ? spec_.free_length : x.l_alpha;
  if (rho > kNoLength * spec_.free_length) x.per_rho = 1.0 / rho;
  x.u_dot = point_velocity(b, x.z_b) - point_velocity(a, x.z_a);
  x.rate = x.per_rho * x.u_alpha.dot(x.u_dot);
  return x;
}

void Cable::evaluate(const PairStep& step, PairTerms& t) const {
  const BodyStep &a = step.a, &b = step.b;
  const double af = a.alpha_f, c = spec_.damping;
  const bool green = spec_.strain == BarStrain::green, conserving = step.context.conserving;
  const Stretch x = stretch(step);
  add_mass_coupling(step, spec_.coupled_mass, t);
  const double force = k_ * x.taut + damper(x), N = x.ratio * force;
  const Vec3 n = x.per_rho * x.u_alpha, F = -N * n;
  const Vec3 &z_a = x.z_a.at_alpha, &z_b = x.z_b.at_alpha;
  const auto add = [](Vec6& wrench, const Vec3& f, const Vec3& m) {
    wrench.head<3>() += f;
    wrench.tail<3>() += m;
  };
  add(t.wrench_b, F, z_b.cross(F));
  add(t.wrench_a, -F, -z_a.cross(F));
  const bool limp = force == 0.0 && is_limp(x);
  if (step.context.tangents && !limp && (x.ratio != 0.0 || x.D_taut != 0.0)) {
    Mat3x12 D_u_n1;
    D_u_n1 << -Mat3::Identity(), hat(x.z_a.at_n1), Mat3::Identity(), -hat(x.z_b.at_n1);
    const Mat3x12 D_u = af * D_u_n1;
    const auto per = [&](double length) { return length > 0.0 ? 1.0 / length : 0.0; };
    // The length of which s, and with the engineering strain also ϱ, is a function.
    const Row12 D_l = conserving ? Row12(per(x.l_n1) * x.u_n1.transpose() * D_u_n1)
                                 : Row12(per(x.l_alpha) * x.u_alpha.transpose() * D_u);
    const double l = conserving ? x.l_n1 : x.l_alpha;
    const Row12 D_s = (green ? l / spec_.free_length : 1.0) * D_l;
    Row12 D_rho = Row12::Zero();
    if (!green) D_rho = (conserving ? af : 1.0) * D_l;
    Row12 D_N = (x.ratio * k_ * x.D_taut + (force + c * x.ratio * x.rate) * x.D_ratio) * D_s;
    if (c != 0.0) {
      Mat3x12 D_u_dot;
      D_u_dot << -af * a.rate * Mat3::Identity(), -point_velocity_by_turn(a, x.z_a),
          af * b.rate * Mat3::Identity(), point_velocity_by_turn(b, x.z_b);
      D_N += c * x.ratio * x.ratio * x.per_rho *
             (x.u_dot.transpose() * D_u + x.u_alpha.transpose() * D_u_dot - x.rate * D_rho);
    }
    const Mat3x12 D_F = -N * x.per_rho * D_u - n * (D_N - N * x.per_rho * D_rho);
    const Mat3x12 D_m_b = hat(z_b) * D_F, D_m_a = -hat(z_a) * D_F;
    const auto add_block = [](Mat6& D, const auto& f, const auto& m) {
      D.topRows<3>() += f;
      D.bottomRows<3>() += m;
    };
    add_block(t.D_ba, D_F.leftCols<6>(), D_m_b.leftCols<6>());
    add_block(t.D_bb, D_F.rightCols<6>(), D_m_b.rightCols<6>());
    add_block(t.D_aa, -D_F.leftCols<6>(), D_m_a.leftCols<6>());
    add_block(t.D_ab, -D_F.rightCols<6>(), D_m_a.rightCols<6>());
    t.D_bb.bottomRightCorner<3, 3>() += af * hat_hat(F, x.z_b.at_n1);
    t.D_aa.bottomRightCorner<3, 3>() -= af * hat_hat(F, x.z_a.at_n1);
  }
  clear_ground_sides(step, t);
}

bool Cable::is_limp(const Stretch& x) const {
  return spec_.tension_only && k_ * x.taut + spec_.damping * x.ratio * x.rate <= 0.0;
}

double Cable::damper(const Stretch& x) const {
  return is_limp(x) ? -k_ * x.taut : spec_.damping * x.ratio * x.rate;
}

/// Slack, taut, or let go faster than the cable shortens by itself. A damper acts at once.
void Cable::pieces(const PairStep& step, ForcePieces& pieces) const {
  if (!spec_.tension_only) return;
  const Stretch x = stretch(step);
  const bool taut_now = is_taut(measure(x.l_n1));
  pieces.add(!taut_now ? 0.0 : is_limp(x) ? 2.0 : 1.0, spec_.damping > 0.0);
}

Work Cable::work(const PairStep& step) const {
  const Stretch x = stretch(step);
  const double y = taut(measure(x.l_n1));
  return {.stored = 0.5 * k_ * y * y, .dissipated = damper(x) * x.ratio * x.rate * step.context.dt};
}

double Cable::length(const PairStep& step) const { return stretch(step).l_n1; }

double Cable::tension(const PairStep& step) const {
  const Stretch x = stretch(step);
  if (!is_taut(measure(x.l_n1))) return 0.0;
  return (k_ * taut(measure(x.l_n1)) + damper(x)) *
         (spec_.strain == BarStrain::green ? x.l_n1 / spec_.free_length : 1.0);
}

}  // namespace polhode
