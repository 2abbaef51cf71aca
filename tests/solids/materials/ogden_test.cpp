// SPDX-License-Identifier: Apache-2.0
// Ogden's materials: closed forms, and stretches that are equal or nearly so.
#include <cmath>

#include <gtest/gtest.h>

#include <solids/materials/homogeneous.hpp>
#include <support/derivative.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::ogden_tests {
namespace {

constexpr double kC[] = {6e5, 1.2e3, -1e4}, kM[] = {1.3, 5.0, -2.0};  // as of rubber
constexpr double kBulk = 1e8, kLame = 2e6;

std::unique_ptr<const solids::Material> ogden(bool uncoupled) {
  solids::ParameterValues values;
  for (int k = 0; k < 3; ++k) {
    values["c" + std::to_string(k + 1)] = kC[k];
    values["m" + std::to_string(k + 1)] = kM[k];
  }
  values[uncoupled ? "bulk_modulus" : "lame"] = uncoupled ? kBulk : kLame;
  return solids::make_material("m",
                               {.kind = uncoupled ? "ogden_uncoupled" : "ogden", .values = values});
}
std::unique_ptr<const solids::Material> one_term(const char* kind, double m, const char* volume) {
  return solids::make_material("m",
                               {.kind = kind, .values = {{"c1", 1e6}, {"m1", m}, {volume, 3e7}}});
}

class BothOgdens : public testing::TestWithParam<bool> {
 protected:
  std::unique_ptr<const solids::Material> material_ = ogden(GetParam());
};

// R. W. Ogden, Large deformation isotropic elasticity, 1972: principal stresses at constant volume,
// up to a pressure.
TEST_P(BothOgdens, HasThePrincipalStressesOfItsEnergy) {
  const auto slope = [](double stretch) {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) sum += kC[k] / kM[k] * std::pow(stretch, kM[k]);
    return sum;
  };
  for (const double stretch : {0.3, 0.9, 1.0 + 1e-6, 1.5, 4.0}) {
    const Mat3 pulled = cauchy(*material_, uniaxial(stretch));
    const double pull = slope(stretch) - slope(1.0 / std::sqrt(stretch));
    EXPECT_NEAR(pulled(0, 0) - pulled(1, 1), pull, 1e-12 * std::abs(pull) + 1e-9);
    EXPECT_NEAR(pulled(1, 1) - pulled(2, 2), 0.0, 1e-12 * std::abs(pull) + 1e-9);
    const Mat3 spread = cauchy(*material_, equibiaxial(stretch));
    const double both = slope(stretch) - slope(1.0 / (stretch * stretch));
    EXPECT_NEAR(spread(0, 0) - spread(2, 2), both, 1e-12 * std::abs(both) + 1e-9);
    // Stretches λ and 1/λ of a simple shear by λ − 1/λ.
    const Mat3 sheared = cauchy(*material_, simple_shear(stretch - 1.0 / stretch));
    const double shear = (slope(stretch) - slope(1.0 / stretch)) / (stretch + 1.0 / stretch);
    EXPECT_NEAR(sheared(0, 1), shear, 1e-12 * sheared.norm() + 1e-9);
  }
}

TEST_P(BothOgdens, HasThePressureOfItsVolume) {
  const bool uncoupled = GetParam();
  for (const double stretch : {0.7, 1.0 + 1e-7, 1.3}) {
    const double J = stretch * stretch * stretch;
    double mean = uncoupled ? kBulk * std::log(J) / J : kLame * (J - 1.0);
    if (!uncoupled)
      for (int k = 0; k < 3; ++k) mean += kC[k] / kM[k] * (std::pow(stretch, kM[k]) - 1.0) / J;
    const Mat3 sigma = cauchy(*material_, stretch * Mat3::Identity());
    EXPECT_LT((sigma - mean * Mat3::Identity()).norm(), 1e-12 * std::abs(mean) + 1e-7);
  }
}

// The tangent has no division by differences of stretches.
// @tests{solid-principal-derivative}
TEST_P(BothOgdens, HasItsTangentAtNearlyEqualStretches) {
  Random random(7);
  const double modulus = material_->linear().shear;
  for (const double gap : {0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 1e-2})
    for (const double step : {0.0, 1e-12, 1e-6, 1e-3, 0.1})
      for (const double stretch : {0.6, 1.0, 1.8})
        for (const bool all : {false, true}) {
          const Vec3 stretches(stretch, stretch + gap, all ? stretch - 0.3 * gap : 0.8);
          const Mat3 Q = random.frame();
          const Vec6 E_0 = green_strain_of(stretches.asDiagonal() * Q);
          const Vec6 E_1 = E_0 + step * six_of(Mat3::Identity() + 0.3 * (Q + Q.transpose()));
          Mat6 D = solids::discrete_stress(*material_, E_0, E_1).D / modulus;
          D.rightCols<3>() *= 2.0;
          expect_derivative(
              D,
              [&](const Vec& d) -> Vec {
                return solids::discrete_stress(*material_, E_0, E_1 + d).S / modulus;
              },
              "D", 3e-8);
        }
}

// At rest, along the way of the tangent from equal stretches to different ones, nothing jumps.
TEST_P(BothOgdens, HasATangentThatDoesNotJumpBetweenSeriesAndQuotients) {
  const auto tangent = [&](double gap) {
    const Vec6 E = green_strain_of(Vec3(1.1, 1.1 + gap, 1.1 - 0.5 * gap).asDiagonal());
    return solids::discrete_stress(*material_, E, E).D;
  };
  for (double gap = 1e-4; gap < 0.05; gap *= 1.02) {
    const Mat6 before = tangent(gap), middle = tangent(gap * 1.01), after = tangent(gap * 1.0201);
    // Second differences of a smooth function.
    const double bend = (after - middle - 1.01 * (middle - before)).norm();
    EXPECT_LT(bend, (1e-2 * gap * gap + 1e-11) * middle.norm()) << gap;
  }
}

INSTANTIATE_TEST_SUITE_P(Materials, BothOgdens, testing::Bool(), [](const auto& one) {
  return std::string(one.param ? "uncoupled" : "coupled");
});

// Ī₁ = Σ λ̄² and Ī₂ = Σ λ̄⁻².
TEST(OgdenUncoupled, IsMooneyRivlinWithExponentsOfTwo) {
  const auto both = solids::make_material(
      "m",
      {.kind = "ogden_uncoupled",
       .values = {{"c1", 1.2e6}, {"m1", 2.0}, {"c2", 4e5}, {"m2", -2.0}, {"bulk_modulus", 1e8}}});
  const auto plain =
      solids::make_material("m", {.kind = "mooney_rivlin_uncoupled",
                                  .values = {{"c1", 3e5}, {"c2", 1e5}, {"bulk_modulus", 1e8}}});
  Random random(8);
  for (const double size : {1e-8, 1e-3, 0.3})
    for (int i = 0; i < 20; ++i) {
      Mat3 H;
      for (int k = 0; k < 9; ++k) H.data()[k] = random.number(size);
      const Vec6 E = green_strain_of(Mat3::Identity() + H);
      const auto a = solids::discrete_stress(*both, E, E),
                 b = solids::discrete_stress(*plain, E, E);
      EXPECT_LT((a.S - b.S).norm(), 1e-13 * b.D.norm() * E.norm());
      EXPECT_LT((a.D - b.D).norm(), 1e-12 * b.D.norm());
      const double W = solids::strain_energy(*plain, E);
      EXPECT_NEAR(solids::strain_energy(*both, E), W, 1e-12 * W);
    }
}

// With one exponent of two even the stress over a step is the same.
TEST(Ogden, IsNeoHookeanWithAnExponentOfTwo) {
  const auto one = one_term("ogden", 2.0, "lame");
  Random random(9);
  for (int i = 0; i < 20; ++i) {
    Mat3 F = Mat3::Identity();
    for (int k = 0; k < 9; ++k) F.data()[k] += random.number(0.3);
    const double J = F.determinant();
    const Mat3 C_inverse = (F.transpose() * F).inverse();
    const Mat3 S = 5e5 * (Mat3::Identity() - C_inverse) + 3e7 * (J - 1.0) * J * C_inverse;
    const Vec6 E = green_strain_of(F);
    EXPECT_LT((solids::discrete_stress(*one, E, E).S - six_of(S)).norm(), 1e-13 * S.norm() + 1e-7);
  }
}

TEST(Ogden, IsStiffInBothDirectionsAtLargeExponents) {
  for (const double m : {-25.0, 25.0, 100.0}) {
    const auto stiff = one_term("ogden_uncoupled", m, "bulk_modulus");
    Random random(10);
    for (int i = 0; i < 20; ++i) {
      Mat3 H;
      for (int k = 0; k < 9; ++k) H.data()[k] = random.number(0.05);
      const Vec6 E_0 = green_strain_of(Mat3::Identity() + H);
      const Vec6 E_1 = green_strain_of(Mat3::Identity() + random.number(1.0) * H);
      const Vec6 S = solids::discrete_stress(*stiff, E_0, E_1).S, d = E_1 - E_0;
      const double W_0 = solids::strain_energy(*stiff, E_0),
                   W_1 = solids::strain_energy(*stiff, E_1);
      EXPECT_NEAR(S.dot(d) + S.tail<3>().dot(d.tail<3>()), W_1 - W_0, 1e-13 * (W_0 + W_1));
    }
  }
}

}  // namespace
}  // namespace polhode::test::ogden_tests
