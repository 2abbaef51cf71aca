// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/base/error.hpp>
#include <polhode/solve/block_lu.hpp>
#include <polhode/solve/conjugate_gradients.hpp>

#include "random_kkt.hpp"

namespace polhode {
namespace {

using test::Numbers;

/// Bodies on a line that push each other and the ground: K is symmetric and definite.
struct Crowd {
  KktTopology topology;
  KktValues values;
};

Crowd crowd(int bodies, double stiffness, unsigned seed) {
  Crowd c;
  Numbers number(seed);
  c.topology.bodies = bodies;
  c.values.diagonal.assign(static_cast<std::size_t>(bodies), Mat6::Identity());
  const auto push = [&](int a, int b) {
    Vec6 g_a, g_b;
    for (int i = 0; i < 6; ++i) g_a[i] = number(), g_b[i] = number();
    if (a != kGround) c.values.diagonal[a] += stiffness * g_a * g_a.transpose();
    if (b != kGround) c.values.diagonal[b] += stiffness * g_b * g_b.transpose();
    test::add_pair(c.topology, a, b, 0);
    KktValues::Pair pair{};
    pair.K_ab = stiffness * g_a * g_b.transpose();
    pair.K_ba = pair.K_ab.transpose();
    c.values.pairs.push_back(pair);
  };
  for (int b = 0; b < bodies; ++b) {
    push(b, kGround);
    if (b > 0) push(b - 1, b);
    if (b > 4) push(b, b - 5);
  }
  return c;
}

Vec numbers(int n, unsigned seed) {
  Numbers number(seed);
  Vec x(n);
  for (int i = 0; i < n; ++i) x[i] = number();
  return x;
}

TEST(ConjugateGradients, AgreesWithTheDirectSolver) {
  for (const double stiffness : {0.0, 1.0, 100.0}) {
    const Crowd c = crowd(40, stiffness, 3);
    BlockLu direct;
    ConjugateGradients iterative(1e-12, 2000);
    direct.analyse(c.topology);
    iterative.analyse(c.topology);
    ASSERT_TRUE(direct.factor(c.values));
    ASSERT_TRUE(iterative.factor(c.values));
    Vec x = numbers(240, 5), y = x;
    direct.solve(x);
    iterative.solve(y);
    EXPECT_LT((x - y).norm(), 1e-9 * x.norm()) << stiffness;
  }
}

TEST(ConjugateGradients, LeavesWhatItsToleranceAllows) {
  const Crowd c = crowd(60, 50.0, 9);
  BlockLu direct;
  direct.analyse(c.topology);
  ASSERT_TRUE(direct.factor(c.values));
  long before = 0;
  for (const double tolerance : {1e-1, 1e-3, 1e-6}) {
    ConjugateGradients iterative(tolerance);
    iterative.analyse(c.topology);
    ASSERT_TRUE(iterative.factor(c.values));
    Vec x = numbers(360, 6), y = x;
    direct.solve(x);
    iterative.solve(y);
    // The matrix' condition, about 1e3, stands between residual and error.
    EXPECT_LT((x - y).norm(), 1e3 * tolerance * x.norm());
    EXPECT_GT(iterative.iterations(), before);
    before = iterative.iterations();
  }
}

TEST(ConjugateGradients, SolvesBodiesOfTheirOwnInOneIteration) {
  const Crowd c = crowd(1, 10.0, 1);
  ConjugateGradients iterative(1e-12);
  iterative.analyse(c.topology);
  ASSERT_TRUE(iterative.factor(c.values));
  Vec x = numbers(6, 2);
  const Vec rhs = x;
  iterative.solve(x);
  EXPECT_EQ(iterative.iterations(), 1);
  EXPECT_LT((c.values.diagonal[0] * x - rhs).norm(), 1e-13);
}

TEST(ConjugateGradients, StopsAtNegativeCurvature) {
  Crowd c = crowd(3, 1.0, 4);
  c.values.diagonal[1] -= 50.0 * Mat6::Identity();
  ConjugateGradients iterative;
  iterative.analyse(c.topology);
  ASSERT_TRUE(iterative.factor(c.values));
  Vec x = numbers(18, 7);
  iterative.solve(x);
  EXPECT_TRUE(x.allFinite());
}

TEST(ConjugateGradients, RefusesJoints) {
  KktTopology t;
  t.bodies = 2;
  test::add_pair(t, 0, 1, 5);
  ConjugateGradients iterative;
  EXPECT_THROW(iterative.analyse(t), InputError);
}

}  // namespace
}  // namespace polhode
