// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <polhode/loads/curve_on_curve.hpp>
#include <polhode/loads/pair_duals.hpp>

namespace polhode {

namespace {

using contact::Dual;
using Vec4 = CurvePair::Vec4;

/// Length of steps, as a part of the curves, below which the gradient is that of the middle: the
/// error of the work is below round-off, and quotients would lose digits.
constexpr double kShortPart = 1e-5;
/// Smallest c² + s², the squared cosine between the planes' normals if one is tilted.
constexpr double kMinSquare = 0.99;

/// Four numbers with their derivatives.
using Dual4 = std::array<Dual, 4>;

Vec4 values_of(const Dual4& q) { return {q[0].v, q[1].v, q[2].v, q[3].v}; }

/// Gradient with its derivatives at q.
Dual4 gradient_at(const CurvePair::Distance& d, const Dual4& q) {
  Dual4 result;
  for (int i = 0; i < 4; ++i) {
    Dual& g = result[static_cast<std::size_t>(i)];
    g = d.gradient[i];
    for (int j = 0; j < 4; ++j) {
      const Dual& x = q[static_cast<std::size_t>(j)];
      g += d.hessian(i, j) * (x - x.v);
    }
  }
  return result;
}

}  // namespace

CurveOnCurve::CurveOnCurve(const LoadDescription& load)
    : Z_a_(load.Z_a),
      Z_b_(load.Z_b),
      R_a_(load.R_a),
      R_b_(load.R_b),
      curves_(planar_curve(load, "", load.word("side") == "left" ? -1.0 : 1.0),
              planar_curve(load, "other_", 1.0)) {
  name = load.name;
  bodies = load.bodies;
}

CurvePair::Vec4 CurveOnCurve::place(const PairStep& step) const {
  const Vec3 e_b = step.b.Lambda_n1 * R_b_.col(0);
  return {along(0).at_n1(step.a, step.b), along(1).at_n1(step.a, step.b),
          (step.a.Lambda_n1 * R_a_.col(0)).dot(e_b), (step.a.Lambda_n1 * R_a_.col(1)).dot(e_b)};
}

CurvePair::Vec4 CurveOnCurve::place_n(const PairStep& step) const {
  const BodyStep &a = step.a, &b = step.b;
  const Vec3 e_b = b.Lambda_n * R_b_.col(0);
  const Vec3 u = b.r_n + b.Lambda_n * Z_b_ - a.r_n - a.Lambda_n * Z_a_;
  const Vec3 e_x = a.Lambda_n * R_a_.col(0), e_y = a.Lambda_n * R_a_.col(1);
  return {e_x.dot(u), e_y.dot(u), e_x.dot(e_b), e_y.dot(e_b)};
}

CurvePair::Distance CurveOnCurve::touch(const PairStep& step) const {
  return curves_.distance(place(step), {step.history[0], step.history[1]});
}

/// @eq{curves-gradient}
void CurveOnCurve::evaluate(const PairStep& step, PairTerms& t) const {
  const PairDuals pair(step);
  const auto e_x = pair.vector_a(R_a_.col(0)), e_y = pair.vector_a(R_a_.col(1));
  const auto e_b = pair.vector_b(R_b_.col(0));
  const auto x_a = pair.point_a(Z_a_), x_b = pair.point_b(Z_b_);
  const auto r_a = pair.point_a(Vec3::Zero()), r_b = pair.point_b(Vec3::Zero());
  const auto u_n1 = x_b.at_n1 - x_a.at_n1;
  const Vec3 u_n = x_b.at_n - x_a.at_n;
  const Vec4 q_n(e_x.at_n.dot(u_n), e_y.at_n.dot(u_n), e_x.at_n.dot(e_b.at_n),
                 e_y.at_n.dot(e_b.at_n));
  const Dual4 q{dot(e_x.at_n1, u_n1), dot(e_y.at_n1, u_n1), dot(e_x.at_n1, e_b.at_n1),
                dot(e_y.at_n1, e_b.at_n1)};
  const double alpha = step.a.alpha_f, size = curves_.size();
  Dual4 moved, between;
  for (std::size_t i = 0; i < 4; ++i) {
    const double from = q_n[static_cast<int>(i)];
    moved[i] = q[i] - from;
    between[i] = from + alpha * moved[i];
  }
  const CurvePair::Places near{step.history[0], step.history[1]};
  const auto d_n1 = curves_.distance(values_of(q), near);
  Dual at_end = d_n1.value;
  for (std::size_t i = 0; i < 4; ++i)
    at_end += d_n1.gradient[static_cast<int>(i)] * (q[i] - q[i].v);
  Dual4 gradient = gradient_at(curves_.distance(values_of(between), near), between);
  // Cosine and sine count as the displacement of a point at a distance of the curves' size.
  const double weight[4] = {1.0, 1.0, size * size, size * size};
  Dual square, expected;
  for (std::size_t i = 0; i < 4; ++i) {
    square += weight[i] * (moved[i] * moved[i]);
    expected += gradient[i] * moved[i];
  }
  const double least = kShortPart * size;
  if (step.context.conserving && alpha == 0.5 && square.v > least * least) {
    const Dual part = (at_end - curves_.distance(q_n, near).value - expected) / square;
    for (std::size_t i = 0; i < 4; ++i) gradient[i] += weight[i] * (part * moved[i]);
  }
  const auto along_a = e_x.mean(alpha), across_a = e_y.mean(alpha), along_b = e_b.mean(alpha);
  const auto direction = gradient[0] * along_a + gradient[1] * across_a;
  const auto couple = cross(along_b, gradient[2] * along_a + gradient[3] * across_a);
  const auto origin = x_b.mean(alpha);
  const auto arm_a = origin - r_a.mean(alpha), arm_b = origin - r_b.mean(alpha);
  const Dual lambda = step.lambda[0];
  pair.add(lambda * direction, arm_a, arm_b, t);
  pair.add_couple(lambda * couple, t);
  pair.set_row(0, at_end, direction, arm_a, arm_b, t, contact::value(couple));
  clear_ground_sides(step, t);
}

void CurveOnCurve::acceleration_terms(const PairStep& step, Vec6& gamma) const {
  const CurvePair::Distance d = touch(step);
  const BodyStep &a = step.a, &b = step.b;
  const Vec3 omega_a = a.Lambda_n1 * a.W_n1, omega_b = b.Lambda_n1 * b.W_n1;
  const Vec3 e_b = b.Lambda_n1 * R_b_.col(0), e_b_dot = omega_b.cross(e_b);
  Vec4 rate, second;
  for (int i = 0; i < 2; ++i) {
    rate[i] = along(i).rate_at_n1(a, b);
    second[i] = along(i).acceleration_at_n1(a, b);
    const Vec3 e_a = a.Lambda_n1 * R_a_.col(i), e_a_dot = omega_a.cross(e_a);
    rate[2 + i] = e_a_dot.dot(e_b) + e_a.dot(e_b_dot);
    second[2 + i] = omega_a.cross(e_a_dot).dot(e_b) + 2.0 * e_a_dot.dot(e_b_dot) +
                    e_a.dot(omega_b.cross(e_b_dot));
  }
  gamma[0] = d.gradient.dot(second) + rate.dot(d.hessian * rate);
}

std::vector<double> CurveOnCurve::report(const PairStep& step) const {
  const CurvePair::Distance d = touch(step);
  const BodyStep &a = step.a, &b = step.b;
  const auto in_world = [&](const CurvePair::Vec2& X) -> Vec3 {
    return a.Lambda_n1 * (R_a_.leftCols<2>() * X);
  };
  const Vec3 arm_b = b.Lambda_n1 * (Z_b_ + R_b_.leftCols<2>() * d.own);
  const Vec3 where = b.r_n1 + arm_b;
  const Vec3 slip = b.v_n1 + (b.Lambda_n1 * b.W_n1).cross(arm_b) - a.v_n1 -
                    (a.Lambda_n1 * a.W_n1).cross(where - a.r_n1);
  return numbers(step.lambda[0] * in_world(d.normal),
                 {d.at.a, d.at.b, step.lambda[0], slip.dot(in_world(d.tangent)), where.x(),
                  where.y(), where.z()});
}

void CurveOnCurve::initialize(const PairStep& step, double* history) const {
  const auto at = curves_.known() ? curves_.first(place(step)) : CurvePair::Places{};
  history[0] = at.a;
  history[1] = at.b;
}

void CurveOnCurve::commit(const PairStep& step, double* history) const {
  const CurvePair::Places at = touch(step).at;
  history[0] = at.a;
  history[1] = at.b;
}

bool CurveOnCurve::acceptable(const PairStep& step) const {
  const CurvePair::Vec4 q = place(step);
  const CurvePair::Places before{step.history[0], step.history[1]};
  const CurvePair::Distance d = curves_.distance(q, before);
  return d.touches && curves_.contains(d.at) && q.tail<2>().squaredNorm() > kMinSquare &&
         curves_.leads_to(place_n(step), before, d.at);
}

void add_curve_on_curve(System& system, const LoadDescription& load) {
  system.group<CurveOnCurve>().add(load);
}

}  // namespace polhode
