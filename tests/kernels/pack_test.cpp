// SPDX-License-Identifier: Apache-2.0
// Rows and small inverses of the SIMD kernels, compiled here for registers of two numbers. The
// kernels of every instruction set are compared in tests/engines/tree_engine_test.cpp.
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include <polhode/core/types.hpp>

#include "support/random_steps.hpp"

#define POLHODE_ISA pack_tests_width_2
#define POLHODE_WIDTH 2
#include <polhode/kernels/pack.hpp>
#include <polhode/kernels/small_inverse.hpp>

namespace polhode::pack_tests {
namespace {

namespace simd = POLHODE_ISA;

struct alignas(64) Numbers {
  double at[8];
};

Numbers numbers(double first) {
  Numbers n{};
  for (int i = 0; i < 8; ++i) n.at[i] = first + 0.5 * i;
  return n;
}

TEST(Pack, SumsRows) {
  simd::Row rows[6];
  for (int k = 0; k < 6; ++k) rows[k] = simd::row_load(numbers(k).at);
  const simd::Row sums = simd::row_sums(rows);
  for (int k = 0; k < 6; ++k) {
    EXPECT_EQ(sums[k], 8.0 * k + 14.0) << k;
    EXPECT_EQ(simd::row_sum(rows[k]), 8.0 * k + 14.0) << k;
  }
  EXPECT_EQ(sums[6], 0.0);
  EXPECT_EQ(sums[7], 0.0);
}

TEST(Pack, SpreadsANumberOfARow) {
  const simd::Row row = simd::row_load(numbers(1.0).at);
  const simd::Row third = simd::spread<3>(row), last = simd::spread<7>(row);
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(third[i], 2.5);
    EXPECT_EQ(last[i], 4.5);
  }
}

TEST(Pack, TurnsRowsIntoColumnsAndBack) {
  std::array<Numbers, simd::kWidth> bodies{}, back{};
  for (int b = 0; b < simd::kWidth; ++b) bodies[b] = numbers(10.0 * b);
  simd::Pack columns[8];
  simd::to_columns(bodies[0].at, columns);
  for (int i = 0; i < 8; ++i)
    for (int b = 0; b < simd::kWidth; ++b) EXPECT_EQ(columns[i][b], 10.0 * b + 0.5 * i);
  simd::to_rows(columns, back[0].at);
  for (int b = 0; b < simd::kWidth; ++b)
    for (int i = 0; i < 8; ++i) EXPECT_EQ(back[b].at[i], bodies[b].at[i]);
}

TEST(Pack, KeepsWhatIsNotANumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const simd::Pack x = {1.0, nan}, y = {2.0, 0.0};
  EXPECT_TRUE(std::isnan(simd::max_keeping_nan(y, x)[1]));
  EXPECT_TRUE(std::isnan(simd::max_keeping_nan(x, y)[1]));
  EXPECT_TRUE(std::isnan(simd::largest(x)));
  EXPECT_EQ(simd::largest(y), 2.0);
}

template <int n>
void expect_inverse() {
  test::Random random(n);
  for (int repeat = 0; repeat < 20; ++repeat) {
    double D[n][8] = {}, inverse[n][8] = {};
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) D[i][j] = random.number() + (i == j ? 3.0 : 0.0);
    ASSERT_TRUE(simd::invert<n>(D, inverse)) << n;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        double product = 0.0;
        for (int k = 0; k < n; ++k) product += D[i][k] * inverse[k][j];
        EXPECT_NEAR(product, i == j, 1e-13) << n;
      }
    // Equal rows: singular.
    for (int j = 0; n > 1 && j < n; ++j) D[n - 1][j] = D[0][j];
    if (n == 1) D[0][0] = 0.0;
    EXPECT_FALSE(simd::invert<n>(D, inverse)) << n;
  }
}

TEST(SmallInverse, IsTheInverseOfEverySizeAndFindsSingularOnes) {
  [&]<int... n>(std::integer_sequence<int, n...>) { (expect_inverse<n + 1>(), ...); }
  (std::make_integer_sequence<int, 6>{});
}

}  // namespace
}  // namespace polhode::pack_tests

#undef POLHODE_ISA
#undef POLHODE_WIDTH
