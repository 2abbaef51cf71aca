// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/math/hat.hpp>

namespace polhode::hat_tests {
namespace {

const Vec3 kChi(0.3, -0.7, 0.5);
const Vec3 kV(1.2, 0.4, -0.9);

/// ε_ijk for indices 0, 1, 2.
double permutation(int i, int j, int k) { return 0.5 * (i - j) * (j - k) * (k - i); }

// @tests{eq:rbr-antisymmetric-tensor}
TEST(Hat, IsMinusThePermutationTensorTimesTheVector) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      double sum = 0.0;
      for (int k = 0; k < 3; ++k) sum += permutation(i, j, k) * kChi[k];
      EXPECT_DOUBLE_EQ(hat(kChi)(i, j), -sum);
    }
}

TEST(Hat, GivesTheCrossProduct) {
  // Compilers that fuse a product and a sum round the two differently.
  EXPECT_LT((hat(kChi) * kV - kChi.cross(kV)).norm(), 1e-15);
  EXPECT_LT((hat(kChi) * kChi).norm(), 1e-16);
  EXPECT_EQ(hat(kChi).transpose(), -hat(kChi));
}

TEST(Hat, OfACrossProductIsTheCommutator) {
  const Mat3 commutator = hat(kChi) * hat(kV) - hat(kV) * hat(kChi);
  EXPECT_LT((hat(kChi.cross(kV)) - commutator).norm(), 1e-15);
}

TEST(Vee, InvertsHatAndIgnoresTheSymmetricPart) {
  EXPECT_EQ(vee(hat(kChi)), kChi);
  const Mat3 symmetric = kV * kV.transpose();
  EXPECT_LT((vee(hat(kChi) + symmetric) - kChi).norm(), 1e-15);
}

TEST(HatHat, IsTheProductOfTwoHats) {
  EXPECT_LT((hat_hat(kChi, kV) - hat(kChi) * hat(kV)).norm(), 1e-15);
}

}  // namespace
}  // namespace polhode::hat_tests
