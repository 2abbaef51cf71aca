// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include <polhode/impulses/row_problem.hpp>

namespace polhode::row_problem_tests {
namespace {

using Eigen::Index;
using Kind = ImpulseRows::Kind;

/// Contact points with a normal and two tangents each, on free bodies.
struct Points {
  Mat J;      ///< 3m x 6n
  Vec mass;   ///< By velocity.
  Vec v;      ///< Velocities without impulses.
  double mu;  ///< Of all points.

  [[nodiscard]] RowProblem problem() const {
    RowProblem q(J.rows());
    q.A = J * mass.cwiseInverse().asDiagonal() * J.transpose();
    q.b = J * v;
    for (Index i = 0; i < J.rows(); i += 3) {
      q.blocks.push_back({.kind = Kind::normal, .first = i});
      q.blocks.push_back({.kind = Kind::friction,
                          .first = i + 1,
                          .size = 2,
                          .normal = i,
                          .half_axes = Vec3::Constant(mu)});
    }
    return q;
  }
};

/// Random points between random pairs of bodies and the ground.
Points random_points(int points, int bodies, double mu, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  Points s{Mat::Zero(3 * points, 6 * bodies), Vec(6 * bodies), Vec(6 * bodies), mu};
  for (int b = 0; b < bodies; ++b) {
    const double m = std::pow(10.0, uniform(random));
    s.mass.segment<3>(6 * b).setConstant(m);
    s.mass.segment<3>(6 * b + 3).setConstant(0.1 * m);
    s.v.segment<3>(6 * b) = vector();
    s.v.segment<3>(6 * b + 3) = vector();
  }
  for (int k = 0; k < points; ++k) {
    const int a = k % bodies, b = static_cast<int>(random() % static_cast<unsigned>(bodies + 1));
    const Vec3 n = vector().normalized(), t = n.unitOrthogonal();
    const auto act = [&](int body, double sign) {
      const Vec3 arm = 0.5 * vector();
      int row = 3 * k;
      for (const Vec3& e : {n, t, Vec3(n.cross(t))}) {
        s.J.block<1, 3>(row, 6 * body) += sign * e.transpose();
        s.J.block<1, 3>(row++, 6 * body + 3) += sign * arm.cross(e).transpose();
      }
    };
    act(a, 1.0);
    if (b < bodies && b != a) act(b, -1.0);
  }
  return s;
}

/// Signorini's and Coulomb's conditions of every row, written out.
void expect_solved(const RowProblem& q, const Vec& p) {
  const Vec y = q.A * p + q.b;
  const double scale = 1e-11 * (q.b.lpNorm<Eigen::Infinity>() +
                                (q.A.cwiseAbs() * p.cwiseAbs()).lpNorm<Eigen::Infinity>());
  const double impulse = scale / q.A.diagonal().minCoeff();
  for (const ImpulseRows& block : q.blocks) {
    const Index i = block.first;
    if (block.kind == Kind::equality) {
      EXPECT_NEAR(y[i], 0.0, scale);
    } else if (block.kind == Kind::normal) {
      EXPECT_GE(p[i], -impulse);
      EXPECT_GE(y[i], -scale);
      EXPECT_TRUE(p[i] <= impulse || y[i] <= scale) << p[i] << ' ' << y[i];
    } else {
      const double bound = std::max(0.0, block.carried + p[block.normal]);
      const Vec t = p.segment(i, block.size), slip = y.segment(i, block.size);
      const double used = t.cwiseQuotient(block.half_axes.head(block.size)).norm();
      EXPECT_LE(used, bound + impulse / block.half_axes.head(block.size).minCoeff());
      if (slip.norm() <= scale) continue;
      EXPECT_NEAR(used, bound, 1e-9 * (1.0 + bound));
      if (t.norm() > impulse) {
        EXPECT_NEAR(t.dot(slip), -t.norm() * slip.norm(), 1e-9 * t.norm());
      }
    }
  }
}

// @tests{row-problem}
TEST(RowProblem, MeetsSignorinisAndCoulombsConditionsOfRandomPoints) {
  int iterations = 0, count = 0;
  for (const int points : {1, 4, 10, 30})
    for (unsigned seed = 0; seed < 20; ++seed)
      for (const double mu : {0.1, 0.3, 1.0}) {
        const RowProblem q = random_points(points, std::max(1, points / 2), mu, seed).problem();
        Vec p = Vec::Zero(q.b.size());
        const RowReport report = q.solve(p, 0.0);
        EXPECT_TRUE(report.converged) << points << ' ' << seed << ' ' << mu;
        expect_solved(q, p);
        iterations += report.iterations;
        ++count;
      }
  EXPECT_LT(iterations, 15 * count);
}

/// A guess changes the number of iterations, not the solution: unique impulses, and shares of a
/// load, whatever the guess.
TEST(RowProblem, AGuessDoesNotChangeTheSolution) {
  int alone = 0, guessed = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const RowProblem q = random_points(4, 4, 0.3, seed).problem();
    Vec p = Vec::Zero(q.b.size());
    alone += q.solve(p, 0.0).iterations;
    for (const double wrong : {1e-3, 1.0}) {
      Vec again = Vec::Zero(q.b.size());
      const Vec guess = (1.0 + wrong) * p;
      const RowReport report = q.solve(again, 0.0, &guess);
      EXPECT_TRUE(report.converged);
      expect_solved(q, again);
      EXPECT_LT((again - p).lpNorm<Eigen::Infinity>(), 1e-9 * (1.0 + p.lpNorm<Eigen::Infinity>()));
      if (wrong < 1.0) guessed += report.iterations;
    }
  }
  EXPECT_LT(guessed, alone);

  RowProblem table(4);
  const Eigen::Matrix<double, 4, 2> corner =
      (Eigen::Matrix<double, 4, 2>() << 1, 1, 1, -1, -1, 1, -1, -1).finished();
  table.A = Mat::Ones(4, 4) + 6.0 * corner * corner.transpose();
  table.b = Vec::Constant(4, -9.81);
  for (Index i = 0; i < 4; ++i) table.blocks.push_back({.kind = Kind::normal, .first = i});
  for (const Vec& guess : {Vec(Vec::Constant(4, 2.0)), Vec(Vec::Unit(4, 0) + Vec::Unit(4, 3))}) {
    Vec p = Vec::Zero(4);
    EXPECT_TRUE(table.solve(p, 0.0, &guess).converged);
    EXPECT_LT((p.array() - 9.81 / 4.0).abs().maxCoeff(), 1e-6) << p.transpose();
  }
}

/// The kinetic energy of bodies never rises by impulses without targets.
TEST(RowProblem, OnlyDissipates) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    const Points s = random_points(8, 4, 0.5, seed);
    const RowProblem q = s.problem();
    Vec p = Vec::Zero(q.b.size());
    ASSERT_TRUE(q.solve(p, 0.0).converged);
    EXPECT_LE(p.dot(q.b) + 0.5 * p.dot(q.A * p), 1e-12);
  }
}

/// A box on four corners: equal shares, whatever the order of the rows, and from any one of the
/// admissible distributions the nearest. The proximal part is 1e-5 or more where it ends, so that
/// rounding appears 1e5 times larger in differences of shares.
TEST(RowProblem, SharesALoadAlikeWhateverTheOrderOfRows) {
  const double weight = 9.81;
  std::vector<int> order{0, 1, 2, 3};
  Vec first;
  do {
    RowProblem q(4);
    const Eigen::Matrix<double, 4, 2> corner =
        (Eigen::Matrix<double, 4, 2>() << 1, 1, 1, -1, -1, 1, -1, -1).finished();
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        q.A(i, j) = 1.0 + 6.0 * corner.row(order[static_cast<std::size_t>(i)])
                                    .dot(corner.row(order[static_cast<std::size_t>(j)]));
    q.b.setConstant(-weight);
    for (Index i = 0; i < 4; ++i) q.blocks.push_back({.kind = Kind::normal, .first = i});
    Vec p = Vec::Zero(4);
    ASSERT_TRUE(q.solve(p, 0.0).converged);
    for (Index i = 0; i < 4; ++i) EXPECT_NEAR(p[i], weight / 4.0, 1e-11 * weight);
    // Along the null space (1, −1, −1, 1) in the order of the corners.
    Vec start(4);
    for (int i = 0; i < 4; ++i) {
      const int c = order[static_cast<std::size_t>(i)];
      start[i] = c == 0 || c == 3 ? 2.0 : 0.0;
    }
    ASSERT_TRUE(q.solve(start, 0.0).converged);
    for (int i = 0; i < 4; ++i) {
      const int c = order[static_cast<std::size_t>(i)];
      EXPECT_NEAR(start[i], weight / 4.0 + (c == 0 || c == 3 ? 1.0 : -1.0), 1e-11 * weight);
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

/// A billiard ball of radius 1 that lands sliding: it rolls off at 5/7 of its speed, if friction
/// suffices, otherwise it loses μ times the normal impulse.
TEST(RowProblem, SlidesAndRollsAsABallThatLands) {
  const double m = 2.0, along = 3.0, down = 1.0;
  for (const double mu : {0.1, 0.5, 5.0}) {
    RowProblem q(3);
    q.A.diagonal() << 1.0 / m, 3.5 / m, 3.5 / m;
    q.b << -down, along, 0.0;
    q.blocks = {{.kind = Kind::normal, .first = 0},
                {.kind = Kind::friction,
                 .first = 1,
                 .size = 2,
                 .normal = 0,
                 .half_axes = Vec3::Constant(mu)}};
    Vec p = Vec::Zero(3);
    const RowReport report = q.solve(p, 0.0);
    ASSERT_TRUE(report.converged);
    EXPECT_LE(report.iterations, 5);  // a thousandth of the error remains after each
    EXPECT_NEAR(p[0], m * down, 1e-14);
    EXPECT_NEAR(p[1], -std::min(mu * m * down, m * along / 3.5), 1e-14);
    EXPECT_NEAR(p[2], 0.0, 1e-15);
  }
}

/// Friction that is stronger across than along: its impulse is against the slip, on the ellipse.
TEST(RowProblem, BoundsFrictionByAnEllipse) {
  RowProblem q(3);
  q.A.diagonal().setConstant(0.5);
  q.b << -1.0, 3.0, 4.0;
  q.blocks = {
      {.kind = Kind::normal, .first = 0},
      {.kind = Kind::friction, .first = 1, .size = 2, .normal = 0, .half_axes = {0.2, 0.4, 0}}};
  Vec p = Vec::Zero(3);
  ASSERT_TRUE(q.solve(p, 0.0).converged);
  EXPECT_NEAR(std::hypot(p[1] / 0.2, p[2] / 0.4), p[0], 1e-13);
  const Vec y = q.A * p + q.b;
  // Against the outward normal (p₁/μ₁², p₂/μ₂²).
  EXPECT_NEAR(p[1] / 0.04 * y[2], p[2] / 0.16 * y[1], 1e-12);
  EXPECT_LT(p[1] * y[1] + p[2] * y[2], 0.0);
}

/// Rows of joints, one of them twice, beside a contact that presses on the mechanism.
TEST(RowProblem, HoldsRedundantEqualities) {
  // Velocities (x, z) of a mass of 2 kg: x = 0 twice, z ≥ 0.
  Mat J(3, 2);
  J << 1, 0, 1, 0, 0, 1;
  RowProblem q(3);
  q.A = J * J.transpose() / 2.0;
  q.b = J * Eigen::Vector2d(3.0, -5.0);
  q.blocks = {{.kind = Kind::equality, .first = 0},
              {.kind = Kind::equality, .first = 1},
              {.kind = Kind::normal, .first = 2}};
  Vec p = Vec::Zero(3);
  ASSERT_TRUE(q.solve(p, 0.0).converged);
  EXPECT_NEAR(p[0], -3.0, 1e-11);
  EXPECT_NEAR(p[1], -3.0, 1e-11);
  EXPECT_NEAR(p[2], 10.0, 1e-13);
}

/// Painlevé's paradox: friction turns the effect of the normal impulse round, and no impulse stops
/// the approach. The report says so, and names the row.
TEST(RowProblem, NamesTheRowThatHasNoSolution) {
  RowProblem q(3);
  q.A << 1.0, 0.9, 0.0, 0.9, 1.0, 0.0, 0.0, 0.0, 1.0;
  q.b << -1.0, 1e9, 0.0;  // slips for any impulse that could matter
  q.blocks = {
      {.kind = Kind::normal, .first = 0},
      {.kind = Kind::friction, .first = 1, .size = 2, .normal = 0, .half_axes = {2.0, 2.0, 0}}};
  Vec p = Vec::Zero(3);
  const RowReport report = q.solve(p, 0.0);
  if (report.converged) {  // only by stopping the slip of 1e9 m/s
    expect_solved(q, p);
    EXPECT_GT(p.norm(), 1e8);
    return;
  }
  EXPECT_GE(report.worst, 0);
  EXPECT_GT(report.error, 0.0);
}

/// Rows without any mobility keep their impulses, others are solved.
TEST(RowProblem, LeavesRowsThatNothingMoves) {
  RowProblem q(2);
  q.A(1, 1) = 1.0;
  q.b << -1.0, -1.0;
  q.blocks = {{.kind = Kind::normal, .first = 0}, {.kind = Kind::normal, .first = 1}};
  Vec p(2);
  p << 3.0, 0.0;
  ASSERT_TRUE(q.solve(p, 0.0).converged);
  EXPECT_EQ(p[0], 3.0);
  EXPECT_NEAR(p[1], 1.0, 1e-15);
}

}  // namespace
}  // namespace polhode::row_problem_tests
