// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <polhode/impulses/velocity_problem.hpp>

namespace polhode::velocity_problem_test {
namespace {

using Eigen::Index;

/// Rows of bodies with masses M: v holds their velocities, J the rows.
struct Bodies {
  Mat J;
  Vec mass, v;

  [[nodiscard]] VelocityProblem problem(std::vector<ContactRows> contacts) const {
    VelocityProblem p;
    p.A = J * mass.cwiseInverse().asDiagonal() * J.transpose();
    p.w = J * v;
    p.contacts = std::move(contacts);
    p.rounding = 1e-14 * v.lpNorm<Eigen::Infinity>();
    return p;
  }
  [[nodiscard]] Vec after(const Vec& impulses) const {
    return v + mass.cwiseInverse().asDiagonal() * (J.transpose() * impulses);
  }
};

/// A body of mass m approaches the ground with speed w, part φ of the step before it touches; the
/// step of the midpoint rule ends at the surface with the mean velocity φ w.
ContactRows closing(double m, double w, double phi, double e) {
  const double end = 2.0 * phi * w - w, p = m * (w - end);
  // Velocities: start −w, end −(2φ − 1)w; D = −p Δg/h with Δg/h = −φ w.
  return {.normal = 0, .restitution = e, .impulse = p, .absorbed = p * phi * w};
}

TEST(VelocityProblem, ABodyLeavesWithItsRestitutionWhereverItTouchesInTheStep) {
  for (const double phi : {0.01, 0.1, 0.5, 0.9, 0.999})
    for (const double e : {0.0, 0.3, 0.7, 1.0}) {
      const double w = 2.0, m = 3.0;
      Bodies one{Mat::Ones(1, 1), Vec::Constant(1, m), Vec::Constant(1, w - 2.0 * phi * w)};
      ContactRows row = closing(m, w, phi, e);
      row.normal = 0;
      const auto result = one.problem({row}).impact();
      EXPECT_TRUE(result.report.converged);
      EXPECT_NEAR(one.after(result.impulses)[0], e * w, 1e-13) << phi << " " << e;
      EXPECT_EQ(result.closed[0], e == 0.0 ? 1 : 0);
    }
}

/// The energy before the impact, with that which the projection onto joints removed from the
/// velocities of the step.
TEST(VelocityProblem, AnImpactHasTheEnergyThatTheProjectionOntoJointsTook) {
  for (const double phi : {0.1, 0.5, 0.9})
    for (const double e : {0.0, 0.5, 1.0}) {
      const double w = 2.0, m = 3.0, lost = 1e-3;
      Bodies one{Mat::Ones(1, 1), Vec::Constant(1, m), Vec::Constant(1, w - 2.0 * phi * w)};
      VelocityProblem problem = one.problem({closing(m, w, phi, e)});
      problem.projected = lost;
      EXPECT_NEAR(one.after(problem.impact().impulses)[0], e * std::sqrt(w * w + 2.0 * lost / m),
                  1e-13)
          << phi << " " << e;
    }
}

/// A wall driven at 1 m/s hits a body at rest: 1 + e. The driven wall adds its speed to the row.
TEST(VelocityProblem, AMovingWallReturnsTheRelativeSpeed) {
  for (const double phi : {0.2, 0.7})
    for (const double e : {0.0, 0.5, 1.0}) {
      const double m = 2.0, wall = 1.0, mean = wall * (1.0 - phi), v1 = 2.0 * mean;
      VelocityProblem p;
      p.A = Mat::Constant(1, 1, 1.0 / m);
      p.w = Vec::Constant(1, v1 - wall);
      const double impulse = m * v1;
      p.contacts = {
          {.normal = 0, .restitution = e, .impulse = impulse, .absorbed = impulse * (wall - mean)}};
      const auto result = p.impact();
      EXPECT_NEAR(v1 + result.impulses[0] / m, (1.0 + e) * wall, 1e-13);
    }
}

/// A body on the floor is pulled off it by others and meets a free body in the same step: the floor
/// takes nothing of the momentum.
TEST(VelocityProblem, ARowThatLiftsOffByItselfTakesNoImpulse) {
  for (const double e : {0.0, 1.0}) {
    // Lower body leaves with 10 m/s; the upper one at rest stops half way through the step.
    Bodies two{(Mat(2, 2) << 1.0, 0.0, -1.0, 1.0).finished(), Vec::Ones(2), Vec(2)};
    const double before = 10.0, phi = 0.5, p = before * phi;  // impulse that keeps them touching
    two.v << before - p, p;
    std::vector<ContactRows> rows(2);
    rows[0] = {.normal = 0, .was_closed = true, .touches = false};
    // The row absorbs what the midpoint rule has taken from the energy.
    rows[1] = {.normal = 1,
               .restitution = e,
               .impulse = p,
               .absorbed = 0.5 * before * before - 0.5 * two.v.squaredNorm()};
    const auto result = two.problem(rows).impact();
    const Vec v = two.after(result.impulses);
    EXPECT_NEAR(v.sum(), 10.0, 1e-12);
    EXPECT_NEAR(v[1] - v[0], e * before, 1e-11);
  }
}

/// A plate on the floor; a heavy body lands softly on it, and a light one with 1 m/s in the same
/// step. The heavy body's load is no impact. Value of Jacobi's method converged: contact_rows
/// review, 1.3.
TEST(VelocityProblem, ALoadAndAnImpactInOneStepKeepApart) {
  const double h = 0.01, g = 9.81;
  for (const double phi : {0.3, 0.8}) {
    // Rows: plate on floor, heavy on plate, ball on plate.
    Bodies b{(Mat(3, 3) << 1, 0, 0, -1, 1, 0, -1, 0, 1).finished(), Vec(3), Vec(3)};
    b.mass << 10.0, 1000.0, 1.0;
    const double w = 1.0, p_ball = 2.0 * w * (1.0 - phi) + g * h;
    // Without contact velocities would be -g h and -w - g h; rows stop positions.
    b.v << 0.0, 0.0, -w - g * h + p_ball;
    std::vector<ContactRows> rows(3);
    rows[0] = {.normal = 0, .was_closed = true, .impulse = 1010.0 * g * h + p_ball};
    rows[1] = {.normal = 1, .impulse = 1000.0 * g * h};
    rows[2] = {.normal = 2, .restitution = 1.0, .impulse = p_ball};
    // Energy of the fall to the surface: ½ w² + m g φ-way, absorbed by the row.
    const double mean = 0.5 * (-w + b.v[2]);
    rows[2].absorbed = -p_ball * mean;
    const auto result = b.problem(rows).impact();
    const double at_surface = std::sqrt(b.v[2] * b.v[2] + 2.0 * rows[2].absorbed);
    EXPECT_NEAR(b.after(result.impulses)[2], at_surface, 2e-2 * at_surface);
    EXPECT_NEAR(b.after(result.impulses)[1], 0.0, 1e-9);
  }
}

/// Two points of one body in one place give what one gives, also with friction.
TEST(VelocityProblem, TwoEqualPointsAreOne) {
  const Mat J1 = (Mat(3, 3) << 0, 1, 0.4, 1, 0, -0.7, 0, 0, 0).finished();  // normal, tangent, none
  for (const double mu : {0.0, 0.3, 0.6}) {
    Bodies one{J1, (Vec(3) << 1.0, 1.0, 0.08).finished(), (Vec(3) << 1.5, -0.6, 0.2).finished()};
    ContactRows c{.normal = 0,
                  .tangents = mu > 0.0 ? 1 : -1,
                  .half_axes = {mu, mu, 0.0},
                  .restitution = 0.6,
                  .impulse = 0.8,
                  .absorbed = 0.4};
    const auto single = one.problem({c}).impact();
    Bodies two = one;
    two.J.resize(6, 3);
    two.J << J1, J1;
    ContactRows half = c, other = c;
    half.impulse = other.impulse = 0.4;
    half.absorbed = other.absorbed = 0.2;
    other.normal = 3;
    if (mu > 0.0) other.tangents = 4;
    const auto both = two.problem({half, other}).impact();
    EXPECT_LT((one.after(single.impulses) - two.after(both.impulses)).norm(), 1e-9) << mu;
  }
}

/// Energy never rises above that at the start of the step, whatever rows, loads and coefficients.
TEST(VelocityProblem, EnergyNeverRises) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int k = 0; k < 300; ++k) {
    const int bodies = 12, count = 1 + k % 6;
    Bodies b{Mat(3 * count, bodies), Vec(bodies), Vec(bodies)};
    b.J = Mat::NullaryExpr(3 * count, bodies, [&] { return u(random); });
    b.mass = Vec::NullaryExpr(bodies, [&] { return std::exp(3.0 * u(random)); });
    b.v = Vec::NullaryExpr(bodies, [&] { return u(random); });
    std::vector<ContactRows> rows;
    double absorbed = 0.0;
    for (int i = 0; i < count; ++i) {
      ContactRows c{.normal = 3 * i, .tangents = 3 * i + 1};
      c.half_axes.setConstant(0.2 + 0.2 * u(random));
      c.was_closed = i > 0 && u(random) > 0.3;
      c.stuck = u(random) > 0.0;
      c.restitution = 0.5 + 0.5 * u(random);
      c.impulse = std::abs(u(random));
      c.absorbed = c.was_closed ? 0.0 : 0.3 * std::abs(u(random));
      absorbed += c.absorbed;
      rows.push_back(c);
    }
    const auto result = b.problem(rows).impact();
    EXPECT_TRUE(result.report.converged) << k;
    const Vec v = b.after(result.impulses);
    const double before = 0.5 * b.v.dot(b.mass.cwiseProduct(b.v)) + absorbed;
    EXPECT_LE(0.5 * v.dot(b.mass.cwiseProduct(v)), before * (1.0 + 1e-11)) << k;
  }
}

}  // namespace
}  // namespace polhode::velocity_problem_test
