// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <polhode/loads/gear.hpp>
#include <polhode/system/angle_quotient.hpp>

namespace polhode {

namespace {

using Kind = GearCoordinate::Kind;

/// Components of the line of centres in the wheel's axes: C along E, S along F.
FreeDisplacement along(const GearCoordinate& c, const Vec3& direction) {
  return {c.displacement.Z_a, c.displacement.Z_b, direction};
}

/// Angle of the wheel (the first body) relative to the line of centres, −atan2(S, C), of constant
/// length ρ: with x = ½Δ, μ = −(x/sin x)(cos φ ∇S − sin φ ∇C)/ρ is its discrete gradient. Not
/// conserving, as in statics, it is the gradient at t_{n+αf}. @eq{gear-angle}
CoordinateMotion centres_step(const GearCoordinate& c, const BodyStep& a, const BodyStep& b,
                              double at_n, double radius, bool conserving) {
  const CoordinateMotion C = coordinate_motion(along(c, c.angle.E), a, b, 0.0, conserving);
  const CoordinateMotion S = coordinate_motion(along(c, c.angle.F), a, b, 0.0, conserving);
  CoordinateMotion q;
  const double af = a.alpha_f;
  const double psi_n = -at_n, psi_n1 = nearest_turn(std::atan2(S.at_n1, C.at_n1), psi_n);
  const double psi = (1.0 - af) * psi_n + af * psi_n1, cos = std::cos(psi), sin = std::sin(psi);
  const double size = C.at_n1 * C.at_n1 + S.at_n1 * S.at_n1;
  const double rho = radius > 0.0 ? radius : std::sqrt(size);
  const auto [w, w_x] = conserving ? over_sine(0.5 * (psi_n1 - psi_n)) : std::pair(1.0, 0.0);
  q.at_n = at_n;
  q.at_n1 = -psi_n1;
  q.at_alpha = -psi;
  q.at_n1_a = -(C.at_n1 * S.at_n1_a - S.at_n1 * C.at_n1_a) / size;
  q.at_n1_b = -(C.at_n1 * S.at_n1_b - S.at_n1 * C.at_n1_b) / size;
  q.alpha_a = af * q.at_n1_a;
  q.alpha_b = af * q.at_n1_b;
  const auto gradient = [&](const Vec6& of_S, const Vec6& of_C) -> Vec6 {
    return -(cos * of_S - sin * of_C) / rho;
  };
  const auto turned = [&](const Vec6& of_S, const Vec6& of_C) -> Vec6 {
    return (sin * of_S + cos * of_C) / rho;
  };
  const Vec6 n_a = gradient(S.mu_a, C.mu_a), n_b = gradient(S.mu_b, C.mu_b);
  q.mu_a = w * n_a;
  q.mu_b = w * n_b;
  // By ψ: that of w through ½ψ_{n+1}, that of sine and cosine through ψ_α; ψ = −q.
  const Vec6 by_a = -0.5 * w_x * n_a - af * w * turned(S.mu_a, C.mu_a);
  const Vec6 by_b = -0.5 * w_x * n_b - af * w * turned(S.mu_b, C.mu_b);
  const auto tangent = [&, w = w](const Mat6& of_S, const Mat6& of_C, const Vec6& by,
                                  const Vec6& change) -> Mat6 {
    return -w / rho * (cos * of_S - sin * of_C) + by * change.transpose();
  };
  q.D_aa = tangent(S.D_aa, C.D_aa, by_a, q.at_n1_a);
  q.D_ab = tangent(S.D_ab, C.D_ab, by_a, q.at_n1_b);
  q.D_ba = tangent(S.D_ba, C.D_ba, by_b, q.at_n1_a);
  q.D_bb = tangent(S.D_bb, C.D_bb, by_b, q.at_n1_b);
  return q;
}

/// Angle relative to a direction outside the wheel's plane: its projection on the plane has length
/// ρ.
CoordinateMotion axes_step(const GearCoordinate& c, const BodyStep& a, const BodyStep& b,
                           double at_n, double rho, bool conserving) {
  CoordinateMotion q = coordinate_motion(c.angle, a, b, at_n, conserving);
  if (!conserving) return q;
  for (Vec6* mu : {&q.mu_a, &q.mu_b}) *mu /= rho;
  for (Mat6* D : {&q.D_aa, &q.D_ab, &q.D_ba, &q.D_bb}) *D /= rho;
  return q;
}

CoordinateMotion negative(CoordinateMotion q) {
  q.at_n = -q.at_n;
  q.at_alpha = -q.at_alpha;
  q.at_n1 = -q.at_n1;
  for (Vec6* v : {&q.mu_a, &q.mu_b, &q.alpha_a, &q.alpha_b, &q.at_n1_a, &q.at_n1_b}) *v = -*v;
  for (Mat6* D : {&q.D_aa, &q.D_ab, &q.D_ba, &q.D_bb}) *D = -*D;
  return q;
}

}  // namespace

Gear::Gear(const LoadDescription& load)
    : pair_(load.gear.value_or(GearPair{})),
      ratio_(load.values.contains("radius") ? load.value("radius", 1.0)
                                            : load.value("ratio", 1.0)) {
  name = load.name;
  bodies = load.bodies;
}

Screw::Screw(const LoadDescription& load)
    : Gear([&] {
        LoadDescription d = load;
        d.values["ratio"] = load.value("pitch", 1.0) / (2.0 * std::numbers::pi);
        return d;
      }()) {}

namespace {

/// The bodies of a coordinate among ground, a and b.
struct Ends {
  Ends(const GearCoordinate& c, const PairStep& step)
      : ground(BodyStep::ground(step.a.alpha_f)),
        from(c.from == 0   ? ground
             : c.from == 1 ? step.a
                           : step.b),
        to(c.to == 0   ? ground
           : c.to == 1 ? step.a
                       : step.b) {}
  BodyStep ground;
  const BodyStep &from, &to;
};

/// Coordinate with its sides assigned to bodies; the ground's side is dropped.
CoordinateMotion placed(const GearCoordinate& c, const CoordinateMotion& q) {
  if (c.from == 1 && c.to == 2) return q;
  if (c.from == 2 && c.to == 1) return q.exchanged();
  const bool from_moves = c.from != 0;
  const int side = from_moves ? c.from : c.to;
  CoordinateMotion p;
  p.at_n = q.at_n;
  p.at_alpha = q.at_alpha;
  p.at_n1 = q.at_n1;
  for (Vec6* v : {&p.mu_a, &p.mu_b, &p.alpha_a, &p.alpha_b, &p.at_n1_a, &p.at_n1_b}) v->setZero();
  for (Mat6* D : {&p.D_aa, &p.D_ab, &p.D_ba, &p.D_bb}) D->setZero();
  (side == 1 ? p.mu_a : p.mu_b) = from_moves ? q.mu_a : q.mu_b;
  (side == 1 ? p.alpha_a : p.alpha_b) = from_moves ? q.alpha_a : q.alpha_b;
  (side == 1 ? p.at_n1_a : p.at_n1_b) = from_moves ? q.at_n1_a : q.at_n1_b;
  (side == 1 ? p.D_aa : p.D_bb) = from_moves ? q.D_aa : q.D_bb;
  return p;
}

}  // namespace

CoordinateMotion Gear::coordinate(int i, const PairStep& step) const {
  const GearCoordinate& c = pair_.coordinate[static_cast<std::size_t>(i)];
  const Ends e(c, step);
  const double at_n = step.history[kNow + i], rho = step.history[kRadius + i];
  const bool conserving = step.context.conserving;
  switch (c.kind) {
    case Kind::displacement:
      return placed(c, coordinate_motion(c.displacement, e.from, e.to, 0.0, conserving));
    case Kind::centres:
      return placed(c, centres_step(c, e.from, e.to, at_n, rho, conserving));
    // the angle of the other's axis relative to the wheel decreases as the wheel turns
    case Kind::axes:
      return negative(
          placed(c, axes_step(c, e.from, e.to, -at_n, rho > 0.0 ? rho : 1.0, conserving)));
    case Kind::angle:
      break;
  }
  return placed(c, coordinate_motion(c.angle, e.from, e.to, at_n, conserving));
}

bool Gear::holds_ground() const {
  if (bodies.a == kGround || bodies.b == kGround) return false;
  return std::any_of(pair_.coordinate.begin(), pair_.coordinate.end(),
                     [](const GearCoordinate& c) { return c.from == 0 || c.to == 0; });
}

double Gear::rate(int i, const PairStep& step) const {
  const CoordinateMotion q = coordinate(i, step);
  Vec6 v_a, v_b;
  v_a << step.a.v_n1, step.a.Lambda_n1 * step.a.W_n1;
  v_b << step.b.v_n1, step.b.Lambda_n1 * step.b.W_n1;
  return q.at_n1_a.dot(v_a) + q.at_n1_b.dot(v_b);
}

/// Part of the second derivative due to the velocities.
double Gear::acceleration(int i, const PairStep& step) const {
  const GearCoordinate& c = pair_.coordinate[static_cast<std::size_t>(i)];
  const Ends e(c, step);
  switch (c.kind) {
    case Kind::displacement:
      return c.displacement.acceleration_at_n1(e.from, e.to);
    case Kind::angle:
      return c.angle.acceleration_at_n1(e.from, e.to);
    case Kind::axes:
      return -c.angle.acceleration_at_n1(e.from, e.to);
    case Kind::centres:
      break;
  }
  const FreeDisplacement along_E = along(c, c.angle.E), along_F = along(c, c.angle.F);
  const double C = along_E.at_n1(e.from, e.to), S = along_F.at_n1(e.from, e.to);
  const double C_1 = along_E.rate_at_n1(e.from, e.to), S_1 = along_F.rate_at_n1(e.from, e.to);
  const double C_2 = along_E.acceleration_at_n1(e.from, e.to);
  const double S_2 = along_F.acceleration_at_n1(e.from, e.to);
  const double size = C * C + S * S, psi_1 = (C * S_1 - S * C_1) / size;
  return -((C * S_2 - S * C_2) / size - 2.0 * psi_1 * (C * C_1 + S * S_1) / size);
}

void Gear::evaluate(const PairStep& step, PairTerms& t) const {
  const CoordinateMotion x = coordinate(0, step), y = coordinate(1, step);
  const double lambda = step.lambda[0];
  add_force(x, lambda, step, t);
  add_force(y, -ratio_ * lambda, step, t);
  const double* first = step.history + kFirst;
  t.g[0] = step.history[kStarted] == 0.0
               ? 0.0  // before assembly of the start the constant is not known
               : (x.at_n1 - first[0]) - ratio_ * (y.at_n1 - first[1]);
  t.B_a.col(0) = x.mu_a - ratio_ * y.mu_a;
  t.B_b.col(0) = x.mu_b - ratio_ * y.mu_b;
  if (step.context.tangents) {
    t.G_a.row(0) = x.at_n1_a - ratio_ * y.at_n1_a;
    t.G_b.row(0) = x.at_n1_b - ratio_ * y.at_n1_b;
  }
  clear_ground_sides(step, t);
}

void Gear::acceleration_terms(const PairStep& step, Vec6& gamma) const {
  gamma[0] = acceleration(0, step) - ratio_ * acceleration(1, step);
}

std::vector<double> Gear::report(const PairStep& step) const {
  const double lambda = step.lambda[0];
  const CoordinateMotion x = coordinate(0, step), y = coordinate(1, step);
  return {lambda, -ratio_ * lambda, x.at_n1 - step.history[kFirst],
          y.at_n1 - step.history[kFirst + 1], -lambda * rate(0, step)};
}

void Gear::initialize(const PairStep& step, double* history) const {
  for (int i = 0; i < 2; ++i) {
    const GearCoordinate& c = pair_.coordinate[static_cast<std::size_t>(i)];
    const Ends e(c, step);
    double C = 1.0, S = 0.0;
    if (c.kind == Kind::centres) {
      C = along(c, c.angle.E).at_n1(e.from, e.to);
      S = along(c, c.angle.F).at_n1(e.from, e.to);
    } else if (c.kind == Kind::axes) {
      const Vec3 d = e.to.Lambda_n1 * c.angle.D;
      C = (e.from.Lambda_n1 * c.angle.E).dot(d);
      S = (e.from.Lambda_n1 * c.angle.F).dot(d);
    }
    history[kRadius + i] = std::hypot(C, S);
    history[kNow + i] = c.kind == Kind::displacement ? c.displacement.at_n1(e.from, e.to)
                        : c.kind == Kind::angle      ? c.angle.at_n1(e.from, e.to, 0.0)
                                                     : -std::atan2(S, C);
    history[kFirst + i] = history[kNow + i];
  }
  history[kStarted] = 1.0;
}

void Gear::commit(const PairStep& step, double* history) const {
  const double now[2] = {coordinate(0, step).at_n1, coordinate(1, step).at_n1};
  history[kNow] = now[0];
  history[kNow + 1] = now[1];
}

void add_gear(System& system, const LoadDescription& load) { system.group<Gear>().add(load); }

void add_screw(System& system, const LoadDescription& load) { system.group<Screw>().add(load); }

}  // namespace polhode
