// SPDX-License-Identifier: Apache-2.0
// A point that slides along a beam, at an instant.
#include <cmath>

#include <polhode/beams/slide_on_beam.hpp>

namespace polhode {

/// Position, tangent and speed at an instant.
struct SlideOnBeam::Instant {
  double s = 0.0, speed = 0.0;
  Vec3 X, T, bend;  ///< Curve and its derivatives by s.
  Vec3 turning;     ///< Rate of T at constant s [1/s].
  Vec3 v;           ///< Of the point relative to the place on the curve.
};

SlideOnBeam::Instant SlideOnBeam::at_instant(const NodeStep& instant, double near) const {
  Instant i;
  const Vec3 point = NodeStep::at(instant.x_n1, spec_.point);
  const double s = i.s = follow(instant.x_n1, point, near);
  i.X = place(instant.x_n1, s, 0);
  i.T = place(instant.x_n1, s, 1);
  i.bend = place(instant.x_n1, s, 2);
  i.turning = place(instant.v_n1, s, 1);
  i.v = NodeStep::at(instant.v_n1, spec_.point) - place(instant.v_n1, s, 0);
  i.speed = i.T.dot(i.v) / i.T.squaredNorm();
  return i;
}

double SlideOnBeam::present_force(const NodeStep& instant, const Instant& i) const {
  if (spec_.position) return 0.0;
  double Q = -spec_.stiffness * (i.s - spec_.free_position) - spec_.damping * i.speed;
  if (spec_.force) Q += instant.context.load_factor * (*spec_.force)(instant.context.t_n);
  return Q;
}

/// Adds F with F·T = Q along the tangent.
void SlideOnBeam::add_present_force(const NodeStep& instant, double s,
                                    const ElementSink& sink) const {
  const Instant i = at_instant(instant, s);
  const double Q = present_force(instant, i);
  if (Q == 0.0) return;
  for (const auto& [node, n] : row_along(i.s, Q / i.T.squaredNorm() * i.T).on)
    Eigen::Map<Vec3>(sink.force + 3 * static_cast<std::ptrdiff_t>(node)) += n;
}

/// The row n·(x_b − X(s)) at constant n and s.
NodeRow SlideOnBeam::row_along(double s, const Vec3& n) const {
  NodeRow row;
  row.on.emplace_back(spec_.point, n);
  const int e = curve_.element_of(s);
  const BeamCurve::Pair w = curve_.at(e, s, 0);
  for (int k = 0; k < 2; ++k) {
    const auto& four = spec_.nodes[static_cast<std::size_t>(e + k)];
    const double tip = w(k, 1) / spec_.tip;
    row.on.emplace_back(four[0], -(w(k, 0) - tip) * n);
    row.on.emplace_back(four[1], -tip * n);
  }
  return row;
}

/// Rows across the beam, and along it where the position is prescribed:
///
///   n·(v_b − Σ c v) = ṡ n·T,   n·(a_b − Σ c a) = n·(s̈ T + ṡ² X'' + 2 ṡ Ṫ)
void SlideOnBeam::rows(const NodeStep& instant, const double* history,
                       std::vector<NodeRow>& list) const {
  Instant i = at_instant(instant, position(history));
  TimeRates given;
  if (spec_.position) {
    given = spec_.position->rates(instant.context.t_n, TimeSide::kAfter);
    i.speed = given.rate;
  }
  Mat3 axes;
  axes.col(0) = i.T.normalized();
  axes.col(1) = axes.col(0).unitOrthogonal();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  for (int k = spec_.position ? 0 : 1; k < 3; ++k) {
    const Vec3 n = axes.col(k);
    NodeRow row = row_along(i.s, n);
    if (k == 0) {
      row.rate = given.rate * n.dot(i.T);
      row.second = given.second * n.dot(i.T);
    }
    row.second += i.speed * (i.speed * n.dot(i.bend) + 2.0 * n.dot(i.turning));
    list.push_back(std::move(row));
  }
}

SlideReport SlideOnBeam::report(const NodeStep& instant, const double* history) const {
  const Instant i = at_instant(instant, position(history));
  SlideReport r;
  r.tangent = i.T.normalized();
  r.position = i.s;
  r.speed = i.speed;
  r.energy = 0.5 * spec_.stiffness * std::pow(i.s - spec_.free_position, 2);
  return r;
}

}  // namespace polhode
