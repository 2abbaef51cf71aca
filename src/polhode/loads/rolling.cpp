// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/loads/pair_duals.hpp>
#include <polhode/loads/rolling.hpp>

namespace polhode {

namespace {

using contact::Dual;
using Vector = PairDuals::Vector;

/// Angle over Cayley vector of a step, less one, of the square q of half the Cayley vector:
/// atan(√q)/√q − 1.
Dual angle_excess(const Dual& q) {
  if (q.v < 1e-3)  // the next terms: q⁵/11
    return q.chained(q.v * (-1.0 / 3.0 + q.v * (0.2 + q.v * (-1.0 / 7.0 + q.v / 9.0))),
                     -1.0 / 3.0 + q.v * (0.4 + q.v * (-3.0 / 7.0 + q.v * 4.0 / 9.0)));
  const double root = std::sqrt(q.v), value = std::atan(root) / root;
  return q.chained(value - 1.0, 0.5 * (1.0 / (1.0 + q.v) - value) / q.v);
}

}  // namespace

Rolling::Rolling(const LoadDescription& load)
    : Z_a_(load.Z_a),
      Z_b_(load.Z_b),
      R_a_(load.R_a),
      axle_(load.R_b.col(2)),
      circle_(load.value("radius", 1.0) - load.value("edge_radius", 0.0)),
      edge_(load.value("edge_radius", 0.0)) {
  name = load.name;
  bodies = load.bodies;
}

/// @eq{rolling-height} @eq{rolling-slip}
void Rolling::evaluate(const PairStep& step, PairTerms& t) const {
  const PairDuals pair(step);
  const auto e_1 = pair.vector_a(R_a_.col(0)), e_2 = pair.vector_a(R_a_.col(1));
  const auto k = pair.vector_a(R_a_.col(2)), n = pair.vector_b(axle_);
  const auto x_a = pair.point_a(Z_a_), c = pair.point_b(Z_b_);
  const auto r_a = pair.point_a(Vec3::Zero()), r_b = pair.point_b(Vec3::Zero());
  const double cos_n = k.at_n.dot(n.at_n), sin_n = k.at_n.cross(n.at_n).norm();
  Dual cos_n1, sin_n1;
  if (circle_ > 0.0) {
    cos_n1 = dot(k.at_n1, n.at_n1);
    sin_n1 = norm(cross(k.at_n1, n.at_n1));
  }
  const auto mean = [](double at_n, const Dual& at_n1, double weight) {
    return (1.0 - weight) * at_n + weight * at_n1;
  };
  // From the centre to the contact point: −R m − ρ k, with m the direction in the wheel's plane
  // nearest to k. Means of cosine and sine make it the lever arm of the discrete gradient.
  const auto to_edge = [&](double weight) -> Vector {
    const Vector k_mean = k.mean(weight);
    Vector down = Dual(-edge_) * k_mean;
    if (circle_ > 0.0)
      down = down - (circle_ / mean(sin_n, sin_n1, weight)) *
                        (k_mean - mean(cos_n, cos_n1, weight) * n.mean(weight));
    return down;
  };
  const double alpha = step.a.alpha_f;
  const Vector touch = c.mean(alpha) + to_edge(alpha);
  const Vector arm_a = touch - r_a.mean(alpha), arm_b = touch - r_b.mean(alpha);
  const Vector d[3] = {k.mean(alpha), e_1.mean(alpha), e_2.mean(alpha)};
  const double* lambda = step.lambda;
  pair.add(lambda[0] * d[0] + lambda[1] * d[1] + lambda[2] * d[2], arm_a, arm_b, t);
  // Way of the edge: the angle of the step times the arm, not its longer Cayley vector.
  const Vector turn =
      contact::Motion<Dual>(step.b, 6).theta - contact::Motion<Dual>(step.a, 0).theta;
  const Dual excess = angle_excess(Dual(0.25) * dot(turn, turn));
  const bool conserving = step.context.conserving;
  if (conserving)  // the multipliers do no work
    pair.add_couple(excess * cross(arm_b, lambda[1] * d[1] + lambda[2] * d[2]), t);

  const Vector middle = c.mean(0.5) + to_edge(0.5);
  const Vector arm = middle - r_b.mean(0.5);
  const Vector slip = pair.slip(middle - r_a.mean(0.5), arm) + excess * cross(turn, arm);
  const Dual height = dot(k.at_n1, c.at_n1 - x_a.at_n1) - circle_ * sin_n1 - edge_;
  pair.set_row(0, height, d[0], arm_a, arm_b, t);
  for (int row = 1; row < 3; ++row) {
    const Vec3 couple =
        conserving ? contact::value(excess * cross(arm_b, d[row])) : Vec3(Vec3::Zero());
    pair.set_row(row, dot((row == 1 ? e_1 : e_2).mean(0.5), slip), d[row], arm_a, arm_b, t, couple);
  }
  clear_ground_sides(step, t);
}

/// Contact point at an instant, and its motion on both bodies.
struct Rolling::Place {
  Vec3 k, point;          ///< Normal; world [m].
  Vec3 arm_a, arm_b;      ///< From the centres of mass [m].
  Vec3 along_a, along_b;  ///< Their derivatives by time [m/s].
  Vec3 slip;              ///< Of the material points [m/s].
  double sine = 1.0;      ///< Sine of the angle between axle and normal.
};

Rolling::Place Rolling::place(const PairStep& step) const {
  const BodyStep &a = step.a, &b = step.b;
  const Vec3 omega_a = a.Lambda_n1 * a.W_n1, omega_b = b.Lambda_n1 * b.W_n1;
  Place p;
  p.k = a.Lambda_n1 * R_a_.col(2);
  const Vec3 n = b.Lambda_n1 * axle_, z = b.Lambda_n1 * Z_b_;
  const Vec3 k_dot = omega_a.cross(p.k), n_dot = omega_b.cross(n);
  Vec3 down = -edge_ * p.k, down_dot = -edge_ * k_dot;
  if (circle_ > 0.0) {
    const double cosine = p.k.dot(n), cosine_dot = k_dot.dot(n) + p.k.dot(n_dot);
    p.sine = p.k.cross(n).norm();
    const double sine_dot = -cosine * cosine_dot / p.sine;
    const Vec3 m = (p.k - cosine * n) / p.sine;
    down -= circle_ * m;
    down_dot -= circle_ * ((k_dot - cosine_dot * n - cosine * n_dot) - sine_dot * m) / p.sine;
  }
  p.point = b.r_n1 + z + down;
  p.arm_b = z + down;
  p.arm_a = p.point - a.r_n1;
  p.along_b = omega_b.cross(z) + down_dot;
  p.along_a = b.v_n1 + p.along_b - a.v_n1;
  p.slip = b.v_n1 + omega_b.cross(p.arm_b) - a.v_n1 - omega_a.cross(p.arm_a);
  return p;
}

/// Acceleration terms. All three rows forbid the relative velocity of the points in contact, along
/// k, e_1, e_2.
void Rolling::acceleration_terms(const PairStep& step, Vec6& gamma) const {
  const Place p = place(step);
  const Vec3 omega_a = step.a.Lambda_n1 * step.a.W_n1, omega_b = step.b.Lambda_n1 * step.b.W_n1;
  const Vec3 change = omega_b.cross(p.along_b) - omega_a.cross(p.along_a);
  const int axes[3] = {2, 0, 1};
  for (int i = 0; i < 3; ++i) {
    const Vec3 d = step.a.Lambda_n1 * R_a_.col(axes[i]);
    gamma[i] = omega_a.cross(d).dot(p.slip) + d.dot(change);
  }
}

std::vector<double> Rolling::report(const PairStep& step) const {
  const Place p = place(step);
  const Vec3 force =
      step.a.Lambda_n1 *
      (R_a_.col(2) * step.lambda[0] + R_a_.col(0) * step.lambda[1] + R_a_.col(1) * step.lambda[2]);
  return numbers(force, {p.point.x(), p.point.y(), p.point.z(), step.lambda[0]});
}

bool Rolling::acceptable(const PairStep& step) const {
  const Vec3 k = R_a_.col(2);
  const Vec3 at_n = (step.a.Lambda_n * k).cross(step.b.Lambda_n * axle_);
  const Vec3 at_n1 = (step.a.Lambda_n1 * k).cross(step.b.Lambda_n1 * axle_);
  return circle_ == 0.0 || at_n.dot(at_n1) > 0.0;
}

void add_rolling(System& system, const LoadDescription& load) {
  const double radius = load.value("radius", 1.0), edge = load.value("edge_radius", 0.0);
  if (edge > radius)
    throw InputError(format("loads.{}.edge_radius", load.name),
                     format("is {:g} m, larger than the radius of {:g} m", edge, radius),
                     "Give a smaller one; for a sphere both are equal");
  system.group<Rolling>().add(load);
}

}  // namespace polhode
