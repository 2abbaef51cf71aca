// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>
#include <polhode/statics/clarke_combination.hpp>

namespace polhode::clarke_combination_tests {
namespace {

Vec vec(std::initializer_list<double> numbers) {
  Vec v(static_cast<Eigen::Index>(numbers.size()));
  Eigen::Index i = 0;
  for (const double x : numbers) v[i++] = x;
  return v;
}

/// Residuals on two sides of a roof: components across the ridge cancel, those along it remain.
/// @tests{statics-kink}
TEST(ClarkeCombination, CancelsOppositeComponentsAtAKink) {
  ClarkeCombination kinks;
  kinks.add(vec({0.0, 2.0, 0.5}));
  EXPECT_EQ(kinks.shortest(), vec({0.0, 2.0, 0.5}));
  kinks.add(vec({0.0, -1.0, 0.5}));
  EXPECT_LT((kinks.shortest() - vec({0.0, 0.0, 0.5})).norm(), 1e-15);
}

/// Forces of one sign do not cancel: the shorter one is the minimum.
TEST(ClarkeCombination, DoesNotCancelResidualsOfOneSign) {
  ClarkeCombination kinks;
  kinks.add(vec({3.0, 0.0}));
  kinks.add(vec({1.0, 0.0}));
  EXPECT_LT((kinks.shortest() - vec({1.0, 0.0})).norm(), 1e-15);
  kinks.clear();
  kinks.add(vec({3.0, 0.0}));
  EXPECT_EQ(kinks.shortest(), vec({3.0, 0.0}));
}

/// Against a fine grid of all convex combinations of four residuals; the oldest of five is dropped.
TEST(ClarkeCombination, IsTheShortestConvexCombination) {
  for (int seed = 0; seed < 20; ++seed) {
    std::vector<Vec> all;
    ClarkeCombination kinks;
    for (int k = 0; k < 5; ++k) {
      Vec r(3);
      for (int i = 0; i < 3; ++i) r[i] = std::sin(12.3 * seed + 3.1 * k * k + 7.7 * i) + 0.2 * i;
      if (k > 0) all.push_back(r);
      kinks.add(k > 0 ? r : Vec(Vec::Zero(3)));
    }
    constexpr int kParts = 60;
    double least = 1e30;
    for (int a = 0; a <= kParts; ++a)
      for (int b = 0; a + b <= kParts; ++b)
        for (int c = 0; a + b + c <= kParts; ++c) {
          const Vec sum =
              (a * all[0] + b * all[1] + c * all[2] + (kParts - a - b - c) * all[3]) / kParts;
          least = std::min(least, sum.norm());
        }
    EXPECT_LT(kinks.shortest().norm(), least + 1e-12) << seed;
    EXPECT_GT(kinks.shortest().norm(), least - 0.1) << seed;
  }
}

/// Equal residuals, given twice.
TEST(ClarkeCombination, HandlesEqualResiduals) {
  ClarkeCombination kinks;
  for (int k = 0; k < 4; ++k) kinks.add(vec({k % 2 == 0 ? 1e-9 : -3e-9, 0.0}));
  EXPECT_LT(kinks.shortest().norm(), 1e-20);
}

}  // namespace
}  // namespace polhode::clarke_combination_tests
