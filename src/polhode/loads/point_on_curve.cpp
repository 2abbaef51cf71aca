// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/pair_duals.hpp>
#include <polhode/loads/point_on_curve.hpp>

namespace polhode {

namespace {

using contact::Dual;
using Vec2 = PlanarCurve::Vec2;

/// Length of steps, as a part of the curve, below which the gradient is that of the middle: the
/// error of the work is below round-off, and quotients would lose digits.
constexpr double kShortStep = 1e-5;

/// Two numbers with their derivatives.
struct Dual2 {
  Dual x, y;
};

/// Distance of P and its gradient with their derivatives.
struct DualDistance {
  DualDistance(const PlanarCurve::Distance& d, const Dual2& P) {
    const Dual dx = P.x - P.x.v, dy = P.y - P.y.v;  // no value, only derivatives
    const Dual along = d.tangent.x() * dx + d.tangent.y() * dy;
    value = Dual(d.value) + (d.normal.x() * dx + d.normal.y() * dy);
    x = Dual(d.normal.x()) + (d.curvature * d.tangent.x()) * along;
    y = Dual(d.normal.y()) + (d.curvature * d.tangent.y()) * along;
  }
  Dual value, x, y;
};

}  // namespace

PointOnCurve::PointOnCurve(const LoadDescription& load)
    : Z_a_(load.Z_a),
      Z_b_(load.Z_b),
      R_a_(load.R_a),
      roller_(load.value("roller_radius", 0.0)),
      in_plane_(load.word("holds") == "point") {
  name = load.name;
  bodies = load.bodies;
  curve_ = planar_curve(load, "", load.word("side") == "left" ? -1.0 : 1.0);
}

Vec2 PointOnCurve::place(const PairStep& step) const {
  return {along(0).at_n1(step.a, step.b), along(1).at_n1(step.a, step.b)};
}

PlanarCurve::Distance PointOnCurve::foot(const PairStep& step) const {
  return curve_.distance(place(step), step.history[0]);
}

/// @eq{curve-gradient}
void PointOnCurve::evaluate(const PairStep& step, PairTerms& t) const {
  const PairDuals pair(step);
  const auto e_x = pair.vector_a(R_a_.col(0)), e_y = pair.vector_a(R_a_.col(1));
  const auto e_z = pair.vector_a(R_a_.col(2));
  const auto x_a = pair.point_a(Z_a_), x_b = pair.point_b(Z_b_);
  const auto r_a = pair.point_a(Vec3::Zero()), r_b = pair.point_b(Vec3::Zero());
  const auto u_n1 = x_b.at_n1 - x_a.at_n1;
  const Vec3 u_n = x_b.at_n - x_a.at_n;
  const Vec2 P_n(e_x.at_n.dot(u_n), e_y.at_n.dot(u_n));
  const Dual2 P{dot(e_x.at_n1, u_n1), dot(e_y.at_n1, u_n1)};
  const Dual2 moved{P.x - P_n.x(), P.y - P_n.y()};
  const double alpha = step.a.alpha_f, near = step.history[0];
  const Dual2 between{P_n.x() + alpha * moved.x, P_n.y() + alpha * moved.y};
  const Vec2 middle(between.x.v, between.y.v);
  const auto d_n = curve_.distance(P_n, near), d_middle = curve_.distance(middle, near);
  const DualDistance at_end(curve_.distance({P.x.v, P.y.v}, near), P);
  const DualDistance at_middle(d_middle, between);
  Dual2 gradient{at_middle.x, at_middle.y};
  const Dual square = moved.x * moved.x + moved.y * moved.y;
  const double least = kShortStep * curve_.size();
  if (step.context.conserving && alpha == 0.5 && square.v > least * least) {
    const Dual left = at_end.value - d_n.value - (at_middle.x * moved.x + at_middle.y * moved.y);
    const Dual part = left / square;
    gradient = {gradient.x + part * moved.x, gradient.y + part * moved.y};
  }
  const auto direction = gradient.x * e_x.mean(alpha) + gradient.y * e_y.mean(alpha);
  const auto touch = x_b.mean(alpha);
  const auto arm_a = touch - r_a.mean(alpha), arm_b = touch - r_b.mean(alpha);
  pair.add(Dual(step.lambda[0]) * direction, arm_a, arm_b, t);
  pair.set_row(0, at_end.value - roller_, direction, arm_a, arm_b, t);
  if (in_plane_) {
    const auto normal = e_z.mean(alpha);
    pair.add(Dual(step.lambda[1]) * normal, arm_a, arm_b, t);
    pair.set_row(1, dot(e_z.at_n1, u_n1), normal, arm_a, arm_b, t);
  }
  clear_ground_sides(step, t);
}

void PointOnCurve::acceleration_terms(const PairStep& step, Vec6& gamma) const {
  const PlanarCurve::Distance d = foot(step);
  const auto rate = [&](int i) { return along(i).rate_at_n1(step.a, step.b); };
  const auto second = [&](int i) { return along(i).acceleration_at_n1(step.a, step.b); };
  const double along_curve = d.tangent.dot(Vec2(rate(0), rate(1)));
  gamma[0] = d.normal.dot(Vec2(second(0), second(1))) + d.curvature * along_curve * along_curve;
  if (in_plane_) gamma[1] = second(2);
}

std::vector<double> PointOnCurve::report(const PairStep& step) const {
  const PlanarCurve::Distance d = foot(step);
  const Vec3 in_frame(step.lambda[0] * d.normal.x(), step.lambda[0] * d.normal.y(),
                      in_plane_ ? step.lambda[1] : 0.0);
  const Vec2 P = place(step);
  return numbers(step.a.Lambda_n1 * (R_a_ * in_frame),
                 {d.foot, step.lambda[0], P.x(), P.y(), along(2).at_n1(step.a, step.b)});
}

void PointOnCurve::initialize(const PairStep& step, double* history) const {
  history[0] = curve_.known() ? curve_.nearest(place(step)) : 0.0;
}

void PointOnCurve::commit(const PairStep& step, double* history) const {
  history[0] = foot(step).foot;
}

bool PointOnCurve::acceptable(const PairStep& step) const {
  const PlanarCurve::Distance d = foot(step);
  return curve_.contains(d.foot) && d.room > 0.0;
}

void add_point_on_curve(System& system, const LoadDescription& load) {
  system.group<PointOnCurve>().add(load);
}

}  // namespace polhode
