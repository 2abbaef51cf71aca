// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <solids/materials/homogeneous.hpp>

namespace polhode::test::veronda_westmann_tests {
namespace {

// Rivlin's formulas of isochoric deformations, with the derivatives W₁ and W₂ of the energy by the
// invariants.
TEST(VerondaWestmann, HasTheStressesOfRivlinsFormulas) {
  const double c1 = 3e3, c2 = 8.0;
  const auto m = solids::make_material(
      "m", {.kind = "veronda_westmann", .values = {{"c1", c1}, {"c2", c2}, {"bulk_modulus", 5e7}}});
  const double W_2 = -0.5 * c1 * c2;
  const auto W_1 = [&](double I_1) { return c1 * c2 * std::exp(c2 * (I_1 - 3.0)); };
  for (const double x : {0.7, 0.97, 1.0 + 1e-6, 1.05, 1.6}) {
    const double square = x * x;
    const Mat3 pulled = cauchy(*m, uniaxial(x));
    const double pull = 2.0 * (square - 1.0 / x) * (W_1(square + 2.0 / x) + W_2 / x);
    EXPECT_NEAR(pulled(0, 0) - pulled(1, 1), pull, 1e-12 * std::abs(pull) + 1e-8);
    const Mat3 spread = cauchy(*m, equibiaxial(x));
    const double both = 2.0 * (square - 1.0 / (square * square)) *
                        (W_1(2.0 * square + 1.0 / (square * square)) + square * W_2);
    EXPECT_NEAR(spread(0, 0) - spread(2, 2), both, 1e-12 * std::abs(both) + 1e-8);
    const double gamma = x - 1.0;
    const Mat3 sheared = cauchy(*m, simple_shear(gamma));
    const double shear = 2.0 * gamma * (W_1(3.0 + gamma * gamma) + W_2);
    EXPECT_NEAR(sheared(0, 1), shear, 1e-12 * sheared.norm() + 1e-8);
  }
}

}  // namespace
}  // namespace polhode::test::veronda_westmann_tests
