// SPDX-License-Identifier: Apache-2.0
#include <complex>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <polhode/core/error.hpp>
#include <polhode/core/types.hpp>
#include <polhode/dynamics/generalized_alpha.hpp>

namespace polhode::generalized_alpha_tests {
namespace {

class Alpha : public testing::TestWithParam<double> {
 protected:
  double rho_ = GetParam();
  GeneralizedAlpha ga_ = GeneralizedAlpha::from_spectral_radius(rho_);
};
INSTANTIATE_TEST_SUITE_P(SpectralRadius, Alpha, testing::Values(0.0, 0.3, 0.5, 0.9, 1.0));

// @tests{eq:ga-alphas-2nd} @tests{eq:ga-Newmark-params}
TEST_P(Alpha, HasTheParametersOfItsSpectralRadius) {
  EXPECT_DOUBLE_EQ(ga_.alpha_f, 1.0 / (1.0 + rho_));
  EXPECT_DOUBLE_EQ(ga_.alpha_m, (2.0 - rho_) / (1.0 + rho_));
  EXPECT_NEAR(ga_.beta, 0.25 * std::pow(1.0 + ga_.alpha_m - ga_.alpha_f, 2), 4e-16);
  EXPECT_NEAR(ga_.gamma, 0.5 + ga_.alpha_m - ga_.alpha_f, 4e-16);
}

TEST_P(Alpha, HasFactorsThatAgreeWithItsParameters) {
  EXPECT_NEAR(ga_.kappa, ga_.alpha_m / ga_.gamma, 4e-16);
  EXPECT_NEAR(ga_.c, ga_.gamma / ga_.beta, 4e-16);
  EXPECT_NEAR(ga_.c_A, 1.0 - 0.5 * ga_.gamma / ga_.beta, 4e-16);
  EXPECT_NEAR(ga_.delta, ga_.alpha_f - ga_.alpha_m, 4e-16);
}

TEST_P(Alpha, DampsAnInfinitelyStiffOscillatorByItsSpectralRadius) {
  // d̈ + ω²d = 0 with ωΔt = 1e4, in (d, Δt ḋ, Δt² d̈): the amplification matrix of one step.
  const double w2 = 1e8;
  const double af = ga_.alpha_f;
  const double am = ga_.alpha_m;
  Mat3 at_n1;
  Mat3 at_n;
  at_n1 << 1.0, 0.0, -ga_.beta,      // Newmark for d
      0.0, 1.0, -ga_.gamma,          // Newmark for Δt ḋ
      af * w2, 0.0, am;              // equation of motion
  at_n << 1.0, 1.0, 0.5 - ga_.beta,  //
      0.0, 1.0, 1.0 - ga_.gamma,     //
      -(1.0 - af) * w2, 0.0, am - 1.0;
  const Eigen::EigenSolver<Mat3> amplification(at_n1.inverse() * at_n);
  // Three roots meet in the limit, so a perturbation of 1/w2 moves them by its cube root.
  EXPECT_NEAR(amplification.eigenvalues().cwiseAbs().maxCoeff(), rho_, 1e-2);
}

TEST(GeneralizedAlpha, DoesNotUseStoredAccelerationsWithoutDamping) {
  // The weights are exactly zero, since accelerations are undamped noise there.
  const GeneralizedAlpha ga = GeneralizedAlpha::from_spectral_radius(1.0);
  EXPECT_EQ(ga.c_A, 0.0);
  EXPECT_EQ(ga.kappa, 1.0);
  EXPECT_EQ(ga.c, 2.0);
  EXPECT_EQ(ga.alpha_f, 0.5);
  EXPECT_EQ(ga.delta, 0.0);
}

TEST(GeneralizedAlpha, RefusesASpectralRadiusOutsideOfZeroToOne) {
  for (const double rho : {-0.1, 1.2, std::nan("")})
    EXPECT_THROW((void)GeneralizedAlpha::from_spectral_radius(rho), InputError);
  try {
    (void)GeneralizedAlpha::from_spectral_radius(1.2);
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "analysis.rho_inf: must lie in [0, 1], but is 1.2. 1 conserves energy, 0 damps "
                 "the highest frequencies in one step.");
  }
}

}  // namespace
}  // namespace polhode::generalized_alpha_tests
