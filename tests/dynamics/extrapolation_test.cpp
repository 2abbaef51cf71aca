// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/dynamics/extrapolation.hpp>

namespace polhode::extrapolation_weights_tests {
namespace {

// @tests{extrapolation-weights}
TEST(ExtrapolationWeights, RemoveTheEvenPowersOfTheStepLength) {
  for (const int order : {4, 6, 8, 10, 12}) {
    const std::vector<int> n = extrapolation_substeps(order);
    const std::vector<double> w = member_weights(n);
    ASSERT_EQ(n.size(), static_cast<std::size_t>(order / 2));
    for (std::size_t power = 0; power < n.size(); ++power) {
      double sum = 0.0, size = 0.0;
      for (std::size_t j = 0; j < n.size(); ++j) {
        const double term = w[j] * std::pow(n[j], -2.0 * static_cast<double>(power));
        sum += term;
        size += std::abs(term);
      }
      EXPECT_NEAR(sum, power == 0 ? 1.0 : 0.0, 1e-14 * size) << order << ", " << power;
    }
  }
}

TEST(ExtrapolationWeights, ExistForEvenOrdersFromFourToTwelve) {
  for (const int order : {2, 5, 14}) EXPECT_THROW((void)extrapolation_substeps(order), InputError);
}

}  // namespace
}  // namespace polhode::extrapolation_weights_tests
