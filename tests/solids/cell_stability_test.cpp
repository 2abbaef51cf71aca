// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/solids/cell_stability.hpp>
#include <polhode/solids/materials/registry.hpp>

namespace polhode::cell_stability_tests {
namespace {

std::shared_ptr<const solids::Material> saint_venants(double poisson = 0.0) {
  return solids::make_material(
      "materials.m",
      {.kind = "elastic", .values = {{"youngs_modulus", 1e6}, {"poisson_ratio", poisson}}});
}

/// Bricks of length a and height c = 1 of St. Venant-Kirchhoff's material with ν = 0. The motion
/// u_x = ξζ with all its shear taken up by enhanced strains has the bending stiffness (2/a)² times
/// the modulus and the geometric stiffness S (2/c)², S = E (λ² − 1)/2. Compressed along a, the
/// modulus is E (3λ² − 1)/2: zero at 1 − λ² = 2/(a²/c² + 3). Compressed along c it is E to the
/// first order: zero at 1 − λ² = 2 c²/a², with an error of c²/a² as a part.
/// @tests{hourglass-stability}
TEST(CellStability, AFlatBrickWithEnhancedStrainsLosesItAtItsClosedForm) {
  for (const double a : {2.0, 3.0, 4.0, 10.0}) {
    const double along = solids::stable_stretch("hex8_eas9", saint_venants(), {a, 1.0, 1.0}, 0);
    EXPECT_NEAR(along, std::sqrt(1.0 - 2.0 / (a * a + 3.0)), 1e-3) << a;
    // Bisection resolves 2e-4 of the stretch.
    const double across = solids::stable_stretch("hex8_eas9", saint_venants(), {a, 1.0, 1.0}, 2);
    EXPECT_NEAR(0.5 * a * a * (1.0 - across * across), 1.0, 1.0 / (a * a) + 2e-4 * a * a) << a;
  }
}

// Free of lateral stress, St. Venant-Kirchhoff's brick has the stress of ν = 0 along its axis, and
// the closed form does not depend on ν. Below a range of stretches without resistance it may resist
// again: the largest of them counts.
// @tests{hourglass-stability}
TEST(CellStability, HasTheClosedFormAtEveryPoissonsRatio) {
  for (const double poisson : {0.1, 0.2, 0.3, 0.4, 0.45})
    for (const double a : {1.0, 4.0})
      EXPECT_NEAR(solids::stable_stretch("hex8_eas9", saint_venants(poisson), {a, 1.0, 1.0}, 0),
                  std::sqrt(1.0 - 2.0 / (a * a + 3.0)), 1e-3)
          << poisson << ' ' << a;
}

TEST(CellStability, DoesNotDependOnSizeOrAxes) {
  const double one = solids::stable_stretch("hex8_eas9", saint_venants(), {4.0, 1.0, 2.0}, 1);
  EXPECT_NEAR(solids::stable_stretch("hex8_eas9", saint_venants(), {0.001, 0.004, 0.002}, 0), one,
              1e-3);
}

}  // namespace
}  // namespace polhode::cell_stability_tests
