// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>
#include <polhode/core/error.hpp>
#include <polhode/linear/kkt.hpp>
#include <polhode/linear/kkt_matrix.hpp>

#include "linear/random_kkt.hpp"

namespace polhode::linear_solver_tests {
namespace {

using test::add_pair;
using test::Numbers;

struct Case {
  const char* name;
  linear::KktTopology topology;
};

linear::KktTopology bodies(int n) {
  linear::KktTopology t;
  t.bodies = n;
  return t;
}

linear::KktTopology chain(int n, int rows, bool grounded) {
  linear::KktTopology t = bodies(n);
  if (grounded) add_pair(t, kGround, 0, rows);
  for (int i = 1; i < n; ++i) add_pair(t, i - 1, i, rows);
  return t;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  all.push_back({"free bodies", bodies(3)});
  all.push_back({"revolute chain", chain(9, 5, true)});
  all.push_back({"floating fixed chain", chain(7, 6, false)});

  linear::KktTopology t = chain(6, 5, true);
  add_pair(t, 5, kGround, 3);
  add_pair(t, 2, 4, 1);
  all.push_back({"loops", t});

  t = chain(5, 3, true);
  add_pair(t, 0, 4, 0);
  add_pair(t, 3, 1, 0);
  all.push_back({"springs between distant bodies", t});

  t = bodies(4);
  add_pair(t, 0, 1, 2);
  add_pair(t, 1, 0, 2);
  add_pair(t, 0, 1, 0);
  add_pair(t, 2, kGround, 4);
  add_pair(t, kGround, 2, 1);
  all.push_back({"several pairs between the same bodies", t});

  t = bodies(30);
  for (int i = 1; i < 30; ++i) add_pair(t, (i - 1) / 2, i, 1 + i % 5);
  all.push_back({"binary tree with its numbers downwards", t});

  t = bodies(12);
  for (int i = 1; i < 12; ++i) add_pair(t, i, 0, 3);
  all.push_back({"star", t});

  Numbers number(7);
  for (int k = 0; k < 20; ++k) {
    const int n = 2 + number.below(12);
    t = bodies(n);
    // A joint for most bodies, then loops and springs; at most 6 rows per body.
    for (int i = 0; i < n; ++i)
      if (number.below(5) > 0)
        add_pair(t, i == 0 ? kGround : number.below(i), i, 1 + number.below(4));
    for (int i = 0; i < n / 2; ++i) {
      const int a = number.below(n), b = (a + 1 + number.below(n - 1)) % n;
      add_pair(t, a, b, number.below(3));
    }
    all.push_back({"random", t});
  }
  return all;
}

Vec random_vector(Eigen::Index n, Numbers& number) {
  Vec x(n);
  for (double& value : x) value = number();
  return x;
}

class LinearSolvers : public testing::TestWithParam<const char*> {};

TEST_P(LinearSolvers, AgreeWithADenseSolution) {
  Numbers number(3);
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto solver = linear::make_linear_solver(GetParam());
    solver->analyse(c.topology);
    linear::KktMatrix matrix(c.topology);
    for (int repeat = 0; repeat < 3; ++repeat) {  // new values, old symbolic work
      const linear::KktValues values = test::random_values(c.topology, number);
      ASSERT_TRUE(matrix.set(values));
      const Mat A = matrix.dense();
      const Vec b = random_vector(A.rows(), number);
      const Vec dense = A.fullPivLu().solve(b);
      ASSERT_TRUE(solver->factor(values));
      // Pivots are chosen inside nodes only: 1e3 times the rounding of a full choice.
      const double tolerance = 1e-12 * A.norm() * (1.0 + dense.norm());
      Vec x = b;
      solver->solve(x);
      EXPECT_LT((A * x - b).norm(), tolerance);
      x = b;
      solver->solve_transposed(x);
      EXPECT_LT((A.transpose() * x - b).norm(), 1e-12 * A.norm() * (1.0 + x.norm()));
    }
    EXPECT_GT(solver->factor_flops(), 0.0);
  }
}

TEST_P(LinearSolvers, SolveAMechanismWithRedundantExactRows) {
  // The same five rows twice: without ε the matrix is singular, with it the multipliers are equal.
  linear::KktTopology t = bodies(2);
  add_pair(t, kGround, 0, 5);
  add_pair(t, 0, 1, 5);
  add_pair(t, 0, 1, 5);
  Numbers number(11);
  linear::KktValues values = test::random_values(t, number);
  for (Mat6& K : values.diagonal) K = Vec6::LinSpaced(0.5, 2.0).asDiagonal();
  for (auto& v : values.pairs) {
    v.K_ab.setZero();
    v.K_ba.setZero();
    v.B_a = v.G_a.transpose();
    v.B_b = v.G_b.transpose();
  }
  values.pairs[2] = values.pairs[1];
  const auto solver = linear::make_linear_solver(GetParam());
  solver->analyse(t);
  ASSERT_TRUE(solver->factor(values));
  Vec x = Vec::Zero(12 + 15);
  x.head(12) = random_vector(12, number);
  solver->solve(x);
  // Rounding of the twin pivot, ε + O(1e-16), moves the share by 1e-16/ε, not the motion.
  EXPECT_LT((x.segment(17, 5) - x.segment(22, 5)).norm(), 1e-2 * x.norm());
  Vec motion = x.head(12);
  EXPECT_LT((values.pairs[1].G_a.topRows(5) * motion.head(6) +
             values.pairs[1].G_b.topRows(5) * motion.tail(6))
                .norm(),
            1e-10 * x.norm());
}

TEST_P(LinearSolvers, ReportASingularMatrixAndValuesThatAreNotFinite) {
  const linear::KktTopology t = chain(3, 3, true);
  Numbers number(5);
  const auto solver = linear::make_linear_solver(GetParam());
  solver->analyse(t);
  linear::KktValues values = test::random_values(t, number);
  const linear::KktValues good = values;
  values.diagonal[1](2, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(solver->factor(values));
  values = good;
  values.diagonal[1](2, 2) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(solver->factor(values));
  values = good;
  for (auto& v : values.pairs) v.C.setZero();
  values.pairs[1].G_a.setZero();
  values.pairs[1].G_b.setZero();
  EXPECT_FALSE(solver->factor(values));
  EXPECT_TRUE(solver->factor(good));  // and recover
}

TEST_P(LinearSolvers, GiveTheSameBitsEachTime) {
  const linear::KktTopology t = cases()[3].topology;
  Numbers number(5);
  const linear::KktValues values = test::random_values(t, number);
  const Vec b = random_vector(6 * t.bodies + t.rows, number);
  Vec first = b, second = b;
  for (Vec* x : {&first, &second}) {
    const auto solver = linear::make_linear_solver(GetParam());
    solver->analyse(t);
    ASSERT_TRUE(solver->factor(values));
    solver->solve(*x);
  }
  EXPECT_EQ(first, second);
}

TEST_P(LinearSolvers, HaveTheNameTheyAreMadeBy) {
  EXPECT_EQ(linear::make_linear_solver(GetParam())->name(), GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, LinearSolvers, testing::Values("block_lu", "klu", "sparse_lu"),
                         [](const auto& one) { return std::string(one.param); });

TEST(MakeLinearSolver, ListsTheNamesWhenOneIsUnknown) {
  try {
    (void)linear::make_linear_solver("cholesky");
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_STREQ(
        e.what(),
        "analysis.solver: 'cholesky' is not known. Use one of: automatic, tree, block_lu, klu, "
        "sparse_lu.");
  }
}

}  // namespace
}  // namespace polhode::linear_solver_tests
