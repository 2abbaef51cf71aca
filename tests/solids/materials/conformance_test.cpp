// SPDX-License-Identifier: Apache-2.0
// Laws that every material of the registry obeys, with and without fibres.
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <solids/materials/example_materials.hpp>
#include <support/derivative.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::conformance_tests {
namespace {

Vec6 voigt(const Mat3& E) {
  Vec6 v;
  v << E(0, 0), E(1, 1), E(2, 2), E(0, 1), E(1, 2), E(2, 0);
  return v;
}

/// Strain of a deformation gradient near a rotation.
Vec6 strain(Random& random, double size) {
  Mat3 F = Mat3::Identity();
  for (int i = 0; i < 9; ++i) F.data()[i] += random.number(size);
  return voigt(0.5 * (F.transpose() * F - Mat3::Identity()));
}

/// S : ΔE of symmetric tensors.
double contract(const Vec6& S, const Vec6& E) { return S.dot(E) + S.tail<3>().dot(E.tail<3>()); }

class EveryMaterial : public testing::TestWithParam<solids::MaterialDescription> {
 protected:
  std::unique_ptr<const solids::Material> material_ =
      solids::make_material("materials.m", GetParam());
  std::vector<Vec3> A_ = [this] {
    std::vector<Vec3> directions = example_directions(*material_);
    for (Vec3& a : directions) a.normalize();
    return directions;
  }();
  double modulus_ = material_->bulk_modulus();
};

TEST_P(EveryMaterial, IsFreeOfStressAndEnergyAtRest) {
  const solids::MaterialPoint rest =
      solids::discrete_stress(*material_, Vec6::Zero(), Vec6::Zero(), A_);
  EXPECT_EQ(rest.S.norm(), 0.0);
  EXPECT_EQ(solids::strain_energy(*material_, Vec6::Zero(), A_), 0.0);
}

// Fibres resist in tension only, so a material with them has none.
class EveryMaterialWithoutFibres : public EveryMaterial {};

TEST_P(EveryMaterialWithoutFibres, HasTheStatedLinearModuliAtRest) {
  const solids::LinearModuli m = material_->linear();
  Mat6 D = Mat6::Zero();
  D.topLeftCorner<3, 3>().setConstant(m.lame);
  D.diagonal().array() += m.shear;
  D.diagonal().head<3>().array() += m.shear;
  // The derivative by one of two equal ends is half of the derivative.
  const Mat6 half = solids::discrete_stress(*material_, Vec6::Zero(), Vec6::Zero(), A_).D;
  EXPECT_LT((2.0 * half - D).norm(), 1e-14 * D.norm());
}

// @tests{solid-discrete-invariants} @tests{solid-discrete-stress} @tests{solid-fibre-stress}
// @tests{solid-discrete-volume} @tests{solid-log-difference}
TEST_P(EveryMaterial, ReturnsExactlyTheEnergyItStoresInStepsOfAnySize) {
  Random random(1);
  for (const double start : {0.0, 1e-3, 0.3})
    for (const double step : {0.3, 0.05, 1e-3, 1e-6, 1e-9})
      for (int i = 0; i < 20; ++i) {
        const Vec6 E_0 = strain(random, start);
        const Vec6 E_1 = E_0 + step * (strain(random, 0.3));
        const Vec6 S = solids::discrete_stress(*material_, E_0, E_1, A_).S;
        const double work = contract(S, E_1 - E_0);
        const double W_0 = solids::strain_energy(*material_, E_0, A_);
        const double W_1 = solids::strain_energy(*material_, E_1, A_);
        // Rounding of the strains, times the stress, and of the energies themselves.
        const double size = std::max({start, step, 1e-3});
        const double tolerance = 100.0 * 2.2e-16 *
                                 (modulus_ * size * (E_1 - E_0).norm() + std::abs(W_0) +
                                  std::abs(W_1) + S.norm() * 0.3 * start);
        EXPECT_NEAR(work, W_1 - W_0, tolerance) << "start " << start << ", step " << step;
      }
}

TEST_P(EveryMaterial, HasTheStressOfItsEnergyWhenNothingMoves) {
  Random random(2);
  for (int i = 0; i < 10; ++i) {
    const Vec6 E = strain(random, 0.2);
    const Vec6 S = solids::discrete_stress(*material_, E, E, A_).S;
    Vec6 scaled = S / modulus_;
    scaled.tail<3>() *= 2.0;
    expect_derivative(
        scaled.transpose(),
        [&](const Vec& d) -> Vec {
          return Vec::Constant(1, solids::strain_energy(*material_, E + d, A_) / modulus_);
        },
        "stress", 1e-8);
  }
}

TEST_P(EveryMaterial, HasTheTangentOfItsDiscreteStress) {
  Random random(3);
  for (const double step : {0.2, 1e-2, 1e-4}) {
    for (int i = 0; i < 10; ++i) {
      const Vec6 E_0 = strain(random, 0.2);
      const Vec6 E_1 = E_0 + step * strain(random, 1.0);
      Mat6 D = solids::discrete_stress(*material_, E_0, E_1, A_).D / modulus_;
      D.rightCols<3>() *= 2.0;
      // A switch of the fibres within the stencil makes differences less accurate.
      const double tolerance = material_->has_fibres() ? 1e-4 : 1e-8;
      expect_derivative(
          D,
          [&](const Vec& d) -> Vec {
            return solids::discrete_stress(*material_, E_0, E_1 + d, A_).S / modulus_;
          },
          "D", tolerance);
    }
  }
}

TEST_P(EveryMaterial, HasASymmetricTangentWhenNothingMoves) {
  Random random(4);
  const Vec6 E = strain(random, 0.2);
  const Mat6 D = solids::discrete_stress(*material_, E, E, A_).D;
  EXPECT_LT((D - D.transpose()).norm(), 1e-14 * D.norm());
}

TEST_P(EveryMaterial, HasAStressSymmetricInBothEnds) {
  Random random(5);
  const Vec6 E_0 = strain(random, 0.2), E_1 = strain(random, 0.2);
  const Vec6 there = solids::discrete_stress(*material_, E_0, E_1, A_).S;
  const Vec6 back = solids::discrete_stress(*material_, E_1, E_0, A_).S;
  EXPECT_LT((there - back).norm(), 1e-14 * modulus_);
}

// The energy of `elastic` does not depend on the volume.
class EveryMaterialWithVolume : public EveryMaterial {};

TEST_P(EveryMaterialWithVolume, HasNoFiniteEnergyInAnInvertedVolume) {
  Vec6 flat = Vec6::Zero();
  flat[0] = -0.5;
  EXPECT_FALSE(std::isfinite(solids::strain_energy(*material_, flat, A_)));
}

std::vector<solids::MaterialDescription> materials_with(
    bool (*wanted)(const solids::MaterialDescription&)) {
  std::vector<solids::MaterialDescription> all = example_materials();
  std::erase_if(all, [&](const auto& material) { return !wanted(material); });
  return all;
}

std::string label_of(const testing::TestParamInfo<solids::MaterialDescription>& info) {
  return label(info.param);
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryMaterial, testing::ValuesIn(example_materials()), label_of);
INSTANTIATE_TEST_SUITE_P(Registry, EveryMaterialWithoutFibres,
                         testing::ValuesIn(materials_with([](const auto& material) {
                           return material.fibres.empty();
                         })),
                         label_of);
INSTANTIATE_TEST_SUITE_P(Registry, EveryMaterialWithVolume,
                         testing::ValuesIn(materials_with([](const auto& material) {
                           return material.kind != "elastic";
                         })),
                         label_of);

// Closed forms, written with C and its inverse.
TEST(NeoHookean, HasTheStressOfTheTextbook) {
  const auto m = solids::make_material(
      "m", {.kind = "neo_hookean", .values = {{"lame", 3e6}, {"shear_modulus", 1e6}}});
  Mat3 F;
  F << 1.3, 0.2, -0.1, 0.05, 0.9, 0.3, 0.1, -0.2, 1.1;
  const Mat3 C = F.transpose() * F, C_inverse = C.inverse();
  const Mat3 S = 1e6 * (Mat3::Identity() - C_inverse) + 3e6 * std::log(F.determinant()) * C_inverse;
  const Vec6 E = voigt(0.5 * (C - Mat3::Identity()));
  EXPECT_LT((solids::discrete_stress(*m, E, E).S - voigt(S)).norm(), 1e-14 * S.norm());
}

TEST(MooneyRivlinUncoupled, SplitsStressIntoDeviatorAndPressure) {
  const auto m =
      solids::make_material("m", {.kind = "mooney_rivlin_uncoupled",
                                  .values = {{"c1", 3e5}, {"c2", 2e5}, {"bulk_modulus", 1e9}}});
  Mat3 F;
  F << 1.3, 0.2, -0.1, 0.05, 0.9, 0.3, 0.1, -0.2, 1.1;
  const double J = F.determinant();
  const Vec6 E = voigt(0.5 * (F.transpose() * F - Mat3::Identity()));
  const auto pressure = [&](bool whole) {
    const Vec6 s = solids::discrete_stress(*m, E, E, Vec3::UnitX(), whole).S;
    Mat3 S;
    S << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    return (F * S * F.transpose()).trace() / (3.0 * J);
  };
  EXPECT_NEAR(pressure(false), 0.0, 1e-14 * 1e6);
  EXPECT_NEAR(pressure(true), 1e9 * std::log(J) / J, 1e-13 * 1e9);
}

// A fibre that goes from slack to taut in one step: the work is the energy of the taut part only.
TEST(Fibres, AreExactAcrossTheSwitchWithinAStep) {
  const auto with = solids::make_material(
      "m", {.kind = "neo_hookean",
            .values = {{"lame", 1.0}, {"shear_modulus", 1.0}},
            .fibres = {{.law = "exponential", .values = {{"xi", 10.0}, {"alpha", 3.0}}}}});
  const auto without = solids::make_material(
      "m", {.kind = "neo_hookean", .values = {{"lame", 1.0}, {"shear_modulus", 1.0}}});
  for (const double size : {0.2, 1e-2, 1e-5, 1e-9}) {
    Vec6 E_0 = Vec6::Zero(), E_1 = Vec6::Zero();
    E_0[0] = -0.3 * size;
    E_1[0] = 0.7 * size;
    const Vec6 S =
        solids::discrete_stress(*with, E_0, E_1).S - solids::discrete_stress(*without, E_0, E_1).S;
    const double W = solids::strain_energy(*with, E_1) - solids::strain_energy(*without, E_1);
    EXPECT_NEAR(S[0] * size, W, 4e-15 * W + 1e-15 * size * size) << size;
    EXPECT_GT(W, 0.0);
    EXPECT_EQ(solids::discrete_stress(*with, E_0, 0.5 * E_0).S,
              solids::discrete_stress(*without, E_0, 0.5 * E_0).S);
  }
}

// λ dF/dλ = c₃ (exp(c₄ (λ − 1)) − 1): the energy by fine sums of the trapezoidal rule.
TEST(ToeFibre, HasTheForceOfItsLaw) {
  const double c3 = 2.0, c4 = 30.0, c5 = 500.0, m = 1.1;
  const auto material = solids::make_material(
      "m", {.kind = "elastic",
            .values = {{"lame", 1.0}, {"shear_modulus", 1.0}},
            .fibres = {{.law = "toe",
                        .values = {{"c3", c3}, {"c4", c4}, {"c5", c5}, {"straight_stretch", m}}}}});
  const auto plain = solids::make_material(
      "m", {.kind = "elastic", .values = {{"lame", 1.0}, {"shear_modulus", 1.0}}});
  const auto law = [&](double stretch) {
    const double c6 = c3 * std::expm1(c4 * (m - 1.0)) - c5 * m;
    return stretch < m ? c3 * std::expm1(c4 * (stretch - 1.0)) : c5 * stretch + c6;
  };
  for (const double stretch : {1.02, 1.09, 1.2}) {
    Vec6 E = Vec6::Zero();
    E[0] = 0.5 * (stretch * stretch - 1.0);
    const double S =
        solids::discrete_stress(*material, E, E).S[0] - solids::discrete_stress(*plain, E, E).S[0];
    // S = dF/dE = (dF/dλ)/λ.
    EXPECT_NEAR(S, law(stretch) / (stretch * stretch), 1e-12 * S);
    const int n = 20000;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
      const double h = (stretch - 1.0) / n, a = 1.0 + (i + 0.5) * h;
      sum += h * law(a) / a;
    }
    EXPECT_NEAR(solids::strain_energy(*material, E) - solids::strain_energy(*plain, E), sum,
                1e-6 * sum);
  }
}

}  // namespace
}  // namespace polhode::test::conformance_tests
