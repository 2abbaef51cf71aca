// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include <Eigen/LU>
#include <polhode/linear/block_cg.hpp>
#include <polhode/math/hat.hpp>

#include "linear/random_kkt.hpp"

namespace polhode::block_cg_tests {
namespace {

using test::Numbers;

/// Bodies with contact points between them and the ground.
struct ManyBodies {
  std::vector<Mat6> blocks;
  std::vector<ContactSpring> springs;
};

ManyBodies many_bodies(int bodies, double stiffness, unsigned seed) {
  ManyBodies c;
  Numbers number(seed);
  const auto vector = [&] {
    Vec3 x;
    for (int i = 0; i < 3; ++i) x[i] = number();
    return x;
  };
  c.blocks.assign(static_cast<std::size_t>(bodies), Mat6::Identity());
  const auto push = [&](int a, int b) {
    const Vec3 n = vector().normalized();
    c.springs.push_back(
        {a, b, vector(), vector(), stiffness * (n * n.transpose() + 0.3 * Mat3::Identity())});
  };
  for (int b = 0; b < bodies; ++b) {
    push(b, kGround);
    if (b > 0) push(b - 1, b);
    if (b > 4) push(b, b - 5);
  }
  return c;
}

std::vector<ActingPoint> acting(const ManyBodies& c) {
  std::vector<ActingPoint> points;
  for (const ContactSpring& s : c.springs) points.emplace_back().spring = s;
  return points;
}

void set(linear::BlockCg& cg, const ManyBodies& c) {
  ASSERT_TRUE(cg.set_bodies(c.blocks));
  std::vector<int> all(c.blocks.size());
  std::iota(all.begin(), all.end(), 0);
  cg.set_springs(acting(c), all);
}

/// The matrix that BlockCg never assembles.
Eigen::MatrixXd assembled(const ManyBodies& c) {
  const auto n = 6 * static_cast<Eigen::Index>(c.blocks.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t b = 0; b < c.blocks.size(); ++b)
    A.block<6, 6>(6 * static_cast<Eigen::Index>(b), 6 * static_cast<Eigen::Index>(b)) = c.blocks[b];
  for (const ContactSpring& s : c.springs) {
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(3, n);  // displacement of a's point from b's
    if (s.a != kGround) P.middleCols<6>(6 * s.a) << Mat3::Identity(), -hat(s.arm_a);
    if (s.b != kGround) P.middleCols<6>(6 * s.b) << -Mat3::Identity(), hat(s.arm_b);
    A += P.transpose() * (s.C - s.friction_slope * s.normal.transpose()) * P;
  }
  return A;
}

std::vector<Vec6> numbers(int bodies, unsigned seed) {
  Numbers number(seed);
  std::vector<Vec6> x(static_cast<std::size_t>(bodies));
  for (Vec6& v : x)
    for (int i = 0; i < 6; ++i) v[i] = number();
  return x;
}

Vec flat(const std::vector<Vec6>& x) {
  return Eigen::Map<const Vec>(x.data()->data(), 6 * static_cast<Eigen::Index>(x.size()));
}

/// Solution of A x − Gᵀ λ = f, G x = −g.
struct Constrained {
  Eigen::MatrixXd G;
  Vec g, x, force;  ///< The last is Gᵀ λ.
};

Constrained solve_directly(const Eigen::MatrixXd& A, const std::vector<linear::BlockCg::Row>& rows,
                           const Vec& f) {
  const Eigen::Index n = A.rows(), m = static_cast<Eigen::Index>(rows.size());
  Constrained found{Eigen::MatrixXd::Zero(m, n), Vec(m), {}, {}};
  for (Eigen::Index i = 0; i < m; ++i) {
    const linear::BlockCg::Row& row = rows[static_cast<std::size_t>(i)];
    if (row.a != kGround) found.G.block<1, 6>(i, 6 * row.a) = row.G_a.transpose();
    if (row.b != kGround) found.G.block<1, 6>(i, 6 * row.b) = row.G_b.transpose();
    found.g[i] = row.g;
  }
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + m, n + m);
  K.topLeftCorner(n, n) = A;
  K.topRightCorner(n, m) = -found.G.transpose();
  K.bottomLeftCorner(m, n) = found.G;
  Vec right(n + m);
  right << f, -found.g;
  const Vec all = K.completeOrthogonalDecomposition().solve(right);
  found.x = all.head(n);
  found.force = found.G.transpose() * all.tail(m);
  return found;
}

/// Single precision: some seven digits, less the loss by the condition of the matrix.
TEST(BlockCg, AgreesWithADirectSolver) {
  for (const double stiffness : {0.0, 1.0, 100.0}) {
    const ManyBodies c = many_bodies(40, stiffness, 3);
    linear::BlockCg cg;
    set(cg, c);
    const std::vector<Vec6> rhs = numbers(40, 5);
    std::vector<Vec6> x;
    cg.solve(rhs, x, 1e-14, 2000, 0);
    const Vec reference = assembled(c).partialPivLu().solve(flat(rhs));
    EXPECT_LT((flat(x) - reference).norm(), 2e-5 * reference.norm()) << stiffness;
  }
}

/// Bodies in a chain, between stiff springs: elimination without fill is exact, so one iteration
/// solves the system to single precision. A spring that closes a loop needs more.
/// @tests{cg-sweeps}
TEST(BlockCg, NeedsOneIterationWhereNoContactsFormALoop) {
  ManyBodies c = many_bodies(40, 1e3, 3);
  const auto solve = [&](const ManyBodies& bodies, double part, int most) {
    linear::BlockCg cg;
    set(cg, bodies);
    const std::vector<Vec6> rhs = numbers(40, 5);
    std::vector<Vec6> x;
    const int iterations = cg.solve(rhs, x, part, most, 0);
    const Vec reference = assembled(bodies).partialPivLu().solve(flat(rhs));
    return std::pair(iterations, (flat(x) - reference).norm() / reference.norm());
  };
  ManyBodies chain = c;
  std::erase_if(chain.springs,
                [](const ContactSpring& s) { return s.b != kGround && s.b != s.a + 1; });
  ASSERT_LT(chain.springs.size(), c.springs.size());
  EXPECT_LT(solve(chain, 0.0, 1).second, 1e-4);
  EXPECT_GT(solve(c, 0.0, 1).second, 1e-3);
  // Springs far stiffer than inertia hardly matter then.
  EXPECT_LE(solve(chain, 1e-8, 100).first, 2);
}

/// Sliding points whose friction follows their normal forces: every direction of GMRES reduces the
/// residual of the unsymmetric system; without them it is not solved.
TEST(BlockCg, SolvesWithFrictionThatFollowsNormalForces) {
  ManyBodies c = many_bodies(40, 100.0, 3);
  Numbers number(8);
  for (ContactSpring& s : c.springs) {
    s.normal = Vec3(number(), number(), number()).normalized();
    const Vec3 along = s.normal.cross(Vec3(number(), number(), number())).normalized();
    s.C = 100.0 * (s.normal * s.normal.transpose() + 0.01 * Mat3::Identity());
    s.friction_slope = 0.5 * 100.0 * along;
  }
  linear::BlockCg cg;
  set(cg, c);
  const std::vector<Vec6> rhs = numbers(40, 5);
  const Vec reference = assembled(c).partialPivLu().solve(flat(rhs));
  double before = 1e30;
  for (const int directions : {0, 1, 2, 4}) {
    std::vector<Vec6> x;
    cg.solve(rhs, x, 1e-12, 2000, directions);
    const double error = (assembled(c) * flat(x) - flat(rhs)).norm() / flat(rhs).norm();
    EXPECT_LT(error, directions == 4 ? 0.1 * before : before) << directions;
    if (directions == 0) before = error;
  }
}

/// Ties between bodies and rows between them and the ground, some of them redundant, beside points
/// whose friction follows normal forces. @tests{cg-rows}
TEST(BlockCg, SatisfiesRowsAsADirectSolverDoes) {
  for (const bool with_friction : {false, true}) {
    ManyBodies c = many_bodies(40, 20.0, 3);
    Numbers number(8);
    if (with_friction)
      for (ContactSpring& s : c.springs) {
        s.normal = Vec3(number(), number(), number()).normalized();
        s.friction_slope = 3.0 * s.normal.cross(Vec3(number(), number(), number())).normalized();
        s.C = 20.0 * (s.normal * s.normal.transpose() + 0.01 * Mat3::Identity());
      }
    std::vector<linear::BlockCg::Tie> ties;
    std::vector<linear::BlockCg::Row> rows;
    const std::vector<Vec6> G = numbers(40, 11);
    for (int k = 0; k < 12; ++k) {
      const int a = k % 3 == 0 ? kGround : 2 * k, b = 2 * k + 1;
      rows.push_back({a, b, G[2 * k], G[2 * k + 1], 0.3 * number()});
      if (k % 4 == 0)
        rows.push_back({a, b, 2.0 * G[2 * k], 2.0 * G[2 * k + 1], 2.0 * rows.back().g});
      if (k % 3 == 1) {
        Mat6 K;
        for (int i = 0; i < 36; ++i) K(i / 6, i % 6) = 0.1 * number();
        ties.push_back({a, b, K});
      }
    }
    Eigen::MatrixXd A = assembled(c);
    for (const linear::BlockCg::Tie& t : ties) {
      A.block<6, 6>(6 * t.a, 6 * t.b) += t.K_ab;
      A.block<6, 6>(6 * t.b, 6 * t.a) += t.K_ab.transpose();
    }
    const std::vector<Vec6> rhs = numbers(40, 5);
    const Constrained reference = solve_directly(A, rows, flat(rhs));

    linear::BlockCg cg;
    set(cg, c);
    cg.set_ties(ties);
    ASSERT_TRUE(cg.set_rows(rows));
    std::vector<Vec6> x;
    cg.solve(rhs, x, 1e-13, 2000, with_friction ? 4 : 0);
    const double close = with_friction ? 2e-2 : 1e-4;
    EXPECT_LT((reference.G * flat(x) + reference.g).norm(), 1e-4 * reference.g.norm());
    EXPECT_LT((flat(x) - reference.x).norm(), close * reference.x.norm()) << with_friction;
    const Vec carried = reference.G.transpose() * cg.multipliers();
    EXPECT_LT((carried - reference.force).norm(), close * reference.force.norm()) << with_friction;
  }
}

/// Sets bodies, springs and rows. @returns the solution for the forces numbers(40, 5).
Constrained set_with_rows(linear::BlockCg& cg, const ManyBodies& c,
                          const std::vector<linear::BlockCg::Row>& rows) {
  set(cg, c);
  EXPECT_TRUE(cg.set_rows(rows));
  return solve_directly(assembled(c), rows, flat(numbers(40, 5)));
}

/// Two chains of bodies between stiff springs, each of which ends in bodies connected by rows,
/// which are swept together: one iteration solves the system to single precision. Rows come in no
/// order.
/// @tests{cg-rows}
TEST(BlockCg, NeedsOneIterationWithRowsWhereNoContactsFormALoop) {
  for (const int connected : {1, 2, 3, 4, 12}) {
    ManyBodies c = many_bodies(40, 1e3, 3);
    const auto in_group = [&](int b) { return b % 20 >= 20 - connected; };
    std::erase_if(c.springs, [&](const ContactSpring& s) {
      return s.b != kGround && (s.b != s.a + 1 || s.b == 20 || in_group(s.a));
    });
    std::vector<linear::BlockCg::Row> rows;
    const std::vector<Vec6> G = numbers(320, 11);
    for (int k = 0; k < 8 * connected; ++k) {
      const int b = (k % 2 == 0 ? 40 : 20) - 1 - 7 * k % connected;
      const int a = in_group(b - 1) ? b - 1 : kGround;
      if (a == kGround && k >= 8) continue;
      rows.push_back({a, b, G[2 * k], G[2 * k + 1], 0.1 * G[k][0]});
    }
    linear::BlockCg cg;
    std::vector<Vec6> x;
    const Constrained reference = set_with_rows(cg, c, rows);
    cg.solve(numbers(40, 5), x, 0.0, 1, 0);
    EXPECT_LT((flat(x) - reference.x).norm(), 2e-4 * reference.x.norm()) << connected;
    EXPECT_LT((reference.G * flat(x) + reference.g).norm(), 1e-5 * flat(x).norm()) << connected;
    const Vec carried = reference.G.transpose() * cg.multipliers();
    EXPECT_LT((carried - reference.force).norm(), 2e-4 * reference.force.norm()) << connected;
  }
}

/// Bodies connected by rows in groups of two, which touch each other, beside two bodies without
/// rows. @tests{cg-rows}
TEST(BlockCg, SolvesForGroupsThatTouchEachOther) {
  ManyBodies c = many_bodies(40, 1e3, 3);
  std::vector<linear::BlockCg::Row> rows;
  const std::vector<Vec6> G = numbers(120, 11);
  for (int k = 0; k < 57; ++k) {
    const int a = 2 * (k % 19);
    rows.push_back({a, a + 1, G[2 * k], G[2 * k + 1], 0.0});
  }
  linear::BlockCg cg;
  std::vector<Vec6> x;
  const Constrained reference = set_with_rows(cg, c, rows);
  EXPECT_LT(cg.solve(numbers(40, 5), x, 1e-11, 2000, 0), 200);
  EXPECT_LT((flat(x) - reference.x).norm(), 1e-3 * reference.x.norm());
}

/// A hinged body that another one hits at an arm, with a stiffness far above inertia: rows that
/// nearly oppose the contact hold to the rounding of the displacement.
TEST(BlockCg, SatisfiesTheRowsOfABodyInAStiffContact) {
  for (const double stiffness : {1.0, 1e3, 1e5}) {
    ManyBodies c;
    c.blocks.assign(2, Mat6::Identity());
    for (Mat6& B : c.blocks) B.bottomRightCorner<3, 3>() *= 0.01;
    c.springs.push_back({1,
                         0,
                         {0.0, 0.0, -0.1},
                         {0.25, 0.01, 0.1},
                         stiffness * Vec3::UnitZ() * Vec3::UnitZ().transpose()});
    std::vector<linear::BlockCg::Row> rows;
    for (int k = 0; k < 5; ++k)
      rows.push_back({kGround, 0, Vec6::Zero(), Vec6::Unit(k), 1e-3 * (k + 1)});
    const std::vector<Vec6> rhs = numbers(2, 5);
    linear::BlockCg cg;
    set(cg, c);
    cg.set_ties({});
    ASSERT_TRUE(cg.set_rows(rows));
    std::vector<Vec6> x;
    cg.solve(rhs, x, 1e-10, 100, 0);
    for (int k = 0; k < 5; ++k)
      EXPECT_NEAR(x[0][k], -1e-3 * (k + 1), 2e-6 * flat(x).lpNorm<Eigen::Infinity>())
          << k << " at " << stiffness;
  }
}

/// Repeated solution as in Newton iterations: the residual of one is the right-hand side of the
/// next.
TEST(BlockCg, ReachesDoublePrecisionByRepeatedSolution) {
  for (const double unit : {1e-12, 1.0, 1e12}) {  // of forces and of stiffness
    ManyBodies c = many_bodies(40, 100.0, 3);
    for (Mat6& B : c.blocks) B *= unit;
    for (ContactSpring& s : c.springs) s.C *= unit;
    const Eigen::MatrixXd A = assembled(c);
    linear::BlockCg cg;
    set(cg, c);
    std::vector<Vec6> rhs = numbers(40, 5), x;
    for (Vec6& f : rhs) f *= unit;
    const Vec f = flat(rhs);
    Vec sum = Vec::Zero(f.size());
    for (int k = 0; k < 6; ++k) {
      const Vec rest = f - A * sum;
      for (std::size_t b = 0; b < rhs.size(); ++b)
        rhs[b] = rest.segment<6>(6 * static_cast<int>(b));
      cg.solve(rhs, x, 1e-10, 2000, 0);
      sum += flat(x);
    }
    const Vec reference = A.partialPivLu().solve(f);
    EXPECT_LT((sum - reference).norm(), 1e-12 * reference.norm()) << unit;
  }
}

TEST(BlockCg, TakesMoreIterationsForMorePrecision) {
  const ManyBodies c = many_bodies(60, 50.0, 9);
  linear::BlockCg cg;
  set(cg, c);
  const std::vector<Vec6> rhs = numbers(60, 6);
  const Vec reference = assembled(c).partialPivLu().solve(flat(rhs));
  int before = 0;
  double error = 1e30;
  for (const double part : {1e-1, 1e-4, 1e-8}) {
    std::vector<Vec6> x;
    const int iterations = cg.solve(rhs, x, part, 2000, 0);
    EXPECT_GT(iterations, before);
    const double now = (flat(x) - reference).norm();
    EXPECT_LT(now, error);
    before = iterations;
    error = now;
  }
}

/// Springs so stiff that masses vanish in single precision.
TEST(BlockCg, HandlesSpringsOfAnyStiffness) {
  const ManyBodies c = many_bodies(12, 1e12, 7);
  linear::BlockCg cg;
  set(cg, c);
  std::vector<Vec6> x;
  cg.solve(numbers(12, 5), x, 1e-4, 200, 0);
  EXPECT_TRUE(flat(x).allFinite());
}

/// A x = f with only the rows and columns of the bodies that move.
TEST(BlockCg, DoesNotMoveBodiesThatAreLeftOut) {
  const ManyBodies c = many_bodies(40, 20.0, 3);
  const std::vector<int> moving{1, 2, 3, 7, 8, 20, 39};
  linear::BlockCg cg;
  ASSERT_TRUE(cg.set_bodies(c.blocks));
  cg.set_springs(acting(c), moving);
  const std::vector<Vec6> rhs = numbers(40, 5);
  std::vector<Vec6> x;
  cg.solve(rhs, x, 1e-14, 2000, 0);
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(6 * std::ssize(moving), 6 * 40);
  for (int k = 0; k < std::ssize(moving); ++k)
    P.block<6, 6>(6 * k, 6 * moving[k]) = Mat6::Identity();
  const Eigen::MatrixXd A = P * assembled(c) * P.transpose();
  const Vec f = P * flat(rhs), reference = P.transpose() * A.partialPivLu().solve(f);
  EXPECT_LT((flat(x) - reference).norm(), 2e-5 * reference.norm());
  for (int b = 0; b < 40; ++b) {
    const bool moves = std::find(moving.begin(), moving.end(), b) != moving.end();
    EXPECT_EQ(x[b].isZero(0.0), !moves) << b;
  }
}

TEST(BlockCg, SolvesBodiesWithoutSpringsInOneIteration) {
  ManyBodies c = many_bodies(7, 0.0, 1);
  c.springs.clear();
  c.blocks[3] *= 5.0;
  linear::BlockCg cg;
  set(cg, c);
  const std::vector<Vec6> rhs = numbers(7, 2);
  std::vector<Vec6> x;
  EXPECT_EQ(cg.solve(rhs, x, 1e-10, 100, 0), 1);
  EXPECT_LT((x[3] - rhs[3] / 5.0).norm(), 1e-7);
}

TEST(BlockCg, RefusesABlockThatIsNotPositive) {
  ManyBodies c = many_bodies(3, 1.0, 4);
  c.blocks[1] -= 50.0 * Mat6::Identity();
  linear::BlockCg cg;
  EXPECT_FALSE(cg.set_bodies(c.blocks));
}

}  // namespace
}  // namespace polhode::block_cg_tests
