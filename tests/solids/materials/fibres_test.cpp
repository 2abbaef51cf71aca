// SPDX-License-Identifier: Apache-2.0
// Laws of fibres, their families and their dispersion, against closed forms.
#include <cmath>

#include <gtest/gtest.h>

#include <solids/materials/homogeneous.hpp>
#include <support/derivative.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::fibres_tests {
namespace {

using solids::FibreDescription;

std::unique_ptr<const solids::Material> with(const std::vector<FibreDescription>& fibres,
                                             const std::string& kind = "neo_hookean") {
  solids::ParameterValues values = {{"lame", 2e3}, {"shear_modulus", 1e3}};
  if (kind == "holzapfel_gasser_ogden") values = {{"bulk_modulus", 1e6}, {"shear_modulus", 8e3}};
  return solids::make_material("m", {.kind = kind, .values = values, .fibres = fibres});
}

/// Energy and stress S₁₁ of the fibres alone, stretched along their direction.
struct Alone {
  double energy, stress;
};
Alone alone(const FibreDescription& fibre, double stretch) {
  const auto a = with({fibre}), b = with({});
  Vec6 E = Vec6::Zero();
  E[0] = 0.5 * (stretch * stretch - 1.0);
  return {solids::strain_energy(*a, E) - solids::strain_energy(*b, E),
          solids::discrete_stress(*a, E, E).S[0] - solids::discrete_stress(*b, E, E).S[0]};
}

// The law "fiber-exp-pow" of FEBio's user manual: dF/dI = ξ (I − 1)^(β − 1) exp(α (I − 1)^β).
TEST(ExponentialFibre, HasTheForceOfItsLaw) {
  const double xi = 5e6;
  for (const double beta : {2.0, 2.5, 3.0, 7.0})
    for (const double alpha : {0.0, 1e-25, 0.3, 20.0})
      for (const double stretch : {0.9, 1.0, 1.001, 1.05, 1.3}) {
        const double y = std::max(stretch * stretch - 1.0, 0.0), h = std::pow(y, beta);
        const Alone f =
            alone({.law = "exponential", .values = {{"xi", xi}, {"alpha", alpha}, {"beta", beta}}},
                  stretch);
        const double force = 2.0 * xi * std::pow(y, beta - 1.0) * std::exp(alpha * h);
        const double energy = xi / beta * (alpha > 1e-20 ? std::expm1(alpha * h) / alpha : h);
        EXPECT_NEAR(f.stress, force, 1e-12 * force + 1e-9) << beta << ' ' << alpha;
        EXPECT_NEAR(f.energy, energy, 1e-12 * energy + 1e-10) << beta << ' ' << alpha;
      }
}

// The law "fiber-pow-linear" of FEBio's user manual: the Cauchy stress of the fibre is linear in
// its stretch beyond the toe, where neither it nor its slope jumps.
TEST(PowerLinearFibre, HasTheForceOfItsLaw) {
  const double E = 4e7, bend = 1.06, y_0 = bend * bend - 1.0;
  for (const double beta : {2.0, 2.4, 4.0}) {
    const FibreDescription fibre{
        .law = "power_linear",
        .values = {{"modulus", E}, {"beta", beta}, {"straight_stretch", bend}}};
    const double xi = E / 4.0 / (beta - 1.0) * std::pow(bend, -3.0) * std::pow(y_0, 2.0 - beta);
    const double b = xi * std::pow(y_0, beta - 1.0) + E / 2.0 / bend;
    for (const double stretch : {0.8, 1.0, 1.01, 1.05, 1.06, 1.07, 1.5}) {
      const double I = stretch * stretch, y = std::max(I - 1.0, 0.0);
      const double force = 2.0 * (y < y_0 ? xi * std::pow(y, beta - 1.0) : b - E / (2.0 * stretch));
      const double energy =
          y < y_0 ? xi / beta * std::pow(y, beta)
                  : b * (y - y_0) - E * (stretch - bend) + xi / beta * std::pow(y_0, beta);
      const Alone f = alone(fibre, stretch);
      EXPECT_NEAR(f.stress, force, 1e-11 * force + 1e-8) << beta << ' ' << stretch;
      EXPECT_NEAR(f.energy, energy, 1e-11 * energy + 1e-9) << beta << ' ' << stretch;
    }
    const double h = 1e-6;
    const auto at = [&](double stretch) { return alone(fibre, stretch).stress; };
    EXPECT_NEAR((at(bend + h) - at(bend)) / (at(bend) - at(bend - h)), 1.0, 1e-3);
    EXPECT_NEAR((at(bend + h) - at(bend - h)) / (2.0 * h), E / (bend * bend), 1e-3 * E);
  }
}

// Steps that begin or end where fibres are slack, or cross the end of the toe, of any size.
TEST(EveryFibre, DoesTheWorkOfItsEnergyAcrossItsSwitches) {
  const std::vector<FibreDescription> laws = {
      {.law = "exponential", .values = {{"xi", 1e6}, {"alpha", 2.0}, {"beta", 2.7}}},
      {.law = "exponential", .values = {{"xi", 1e6}, {"alpha", 0.0}, {"beta", 4.0}}},
      {.law = "power_linear",
       .values = {{"modulus", 1e6}, {"beta", 3.2}, {"straight_stretch", 1.04}}}};
  for (const FibreDescription& law : laws) {
    const auto a = with({law}), b = with({});
    for (const double at : {-0.02, 0.0, 1e-9, 0.0408, 0.1})
      for (const double step : {1e-9, 1e-5, 1e-3, 0.05, 0.3})
        for (const double side : {-0.3, 0.3, 1.0}) {
          Vec6 E_0 = Vec6::Zero(), E_1 = Vec6::Zero();
          E_0[0] = at - side * step;
          E_1[0] = at + (1.0 - side) * step;
          const double work = (solids::discrete_stress(*a, E_0, E_1).S[0] -
                               solids::discrete_stress(*b, E_0, E_1).S[0]) *
                              (E_1[0] - E_0[0]);
          const double W_0 = solids::strain_energy(*a, E_0) - solids::strain_energy(*b, E_0);
          const double W_1 = solids::strain_energy(*a, E_1) - solids::strain_energy(*b, E_1);
          EXPECT_NEAR(work, W_1 - W_0, 2e-14 * (W_0 + W_1) + 1e-13 * step) << law.law;
        }
  }
}

TEST(EveryFibre, HasItsTangentInSmallAndLargeSteps) {
  const auto material =
      with({{.law = "exponential", .values = {{"xi", 1e4}, {"alpha", 2.0}, {"beta", 3.7}}},
            {.law = "power_linear",
             .values = {{"modulus", 1e4}, {"beta", 3.2}, {"straight_stretch", 1.2}}}});
  const std::vector<Vec3> A = {Vec3::UnitX(), Vec3(0.6, 0.8, 0.0)};
  for (const double start : {-0.1, 0.05, 0.2})
    for (const double step : {0.0, 1e-12, 1e-8, 1e-5, 1e-3, 0.03, 0.4}) {
      Vec6 E_0, E_1;
      E_0 << start, start, 0.01, 0.02, 0.0, 0.01;
      E_1 = E_0 + step * (Vec6() << 1.0, 0.8, 0.1, 0.2, 0.3, 0.1).finished();
      Mat6 D = solids::discrete_stress(*material, E_0, E_1, A).D / 1e4;
      D.rightCols<3>() *= 2.0;
      expect_derivative(
          D,
          [&](const Vec& d) -> Vec {
            return solids::discrete_stress(*material, E_0, E_1 + d, A).S / 1e4;
          },
          "D", 2e-8);
    }
}

// A sum of energies: each family by itself, in its own direction.
TEST(FamiliesOfFibres, AddUp) {
  const FibreDescription one{.law = "exponential", .values = {{"xi", 1e4}, {"alpha", 3.0}}},
      two{.law = "toe", .values = {{"c3", 1e4}, {"c4", 5.0}}};
  const auto none = with({}), a = with({one}), b = with({two}), both = with({one, two});
  const Vec3 A = Vec3(1, 2, 3).normalized(), B = Vec3(1, -0.2, 0.3).normalized();
  Random random(3);
  for (int i = 0; i < 10; ++i) {
    Mat3 F_0 = Mat3::Identity(), F_1 = F_0;
    for (int k = 0; k < 9; ++k)
      F_0.data()[k] += random.number(0.2), F_1.data()[k] += random.number(0.2);
    const Vec6 E_0 = green_strain_of(F_0), E_1 = green_strain_of(F_1);
    const std::vector<Vec3> AB = {A, B};
    const Vec6 sum = solids::discrete_stress(*a, E_0, E_1, A).S +
                     solids::discrete_stress(*b, E_0, E_1, B).S -
                     solids::discrete_stress(*none, E_0, E_1).S;
    const Vec6 S = solids::discrete_stress(*both, E_0, E_1, AB).S;
    EXPECT_LT((S - sum).norm(), 1e-13 * sum.norm());
    EXPECT_NEAR(solids::strain_energy(*both, E_1, AB),
                solids::strain_energy(*a, E_1, A) + solids::strain_energy(*b, E_1, B) -
                    solids::strain_energy(*none, E_1),
                1e-12 * std::abs(solids::strain_energy(*both, E_1, AB)) + 1e-10);
  }
}

// T. C. Gasser, R. W. Ogden, G. A. Holzapfel, Journal of the Royal Society Interface 3 (2006):
// two families at ±γ in a wall, with the dispersion κ. The derivative of the energy by the stretch
// at constant volume; fibres in compression carry nothing.
// @tests{solid-fibre-dispersion}
TEST(HolzapfelGasserOgden, HasTheStressesOfItsEnergy) {
  const double mu = 8e3, k1 = 2.4e3, k2 = 0.8, gamma = 0.7;
  for (const double kappa : {0.0, 0.226, 1.0 / 3.0}) {
    const FibreDescription fibre{.law = "exponential",
                                 .values = {{"xi", k1}, {"alpha", k2}, {"dispersion", kappa}}};
    const auto m = with({fibre, fibre}, "holzapfel_gasser_ogden");
    const std::vector<Vec3> A = {Vec3(std::cos(gamma), std::sin(gamma), 0.0),
                                 Vec3(std::cos(gamma), -std::sin(gamma), 0.0)};
    const auto energy = [&](const Mat3& F) {
      const Mat3 C = F.transpose() * F;
      double W = mu / 2.0 * (C.trace() - 3.0);
      for (const Vec3& a : A) {
        const double e = kappa * (C.trace() - 3.0) + (1.0 - 3.0 * kappa) * (a.dot(C * a) - 1.0);
        if (e > 0.0) W += k1 / (2.0 * k2) * std::expm1(k2 * e * e);
      }
      return W;
    };
    const auto stress = [&](const Mat3& F) {
      const Vec6 E = green_strain_of(F);
      return Mat3(F * tensor_of(solids::discrete_stress(*m, E, E, A).S) * F.transpose());
    };
    const double h = 1e-5;
    const auto slope = [&](const auto& path, double x) {
      return (energy(path(x + h)) - energy(path(x - h))) / (2.0 * h);
    };
    for (const double x : {0.8, 1.1, 1.4}) {
      const Mat3 pulled = stress(uniaxial(x)), spread = stress(equibiaxial(x)),
                 sheared = stress(simple_shear(x - 1.0));
      // The power of isochoric motions: the lateral rate is −1/2 and −2 of the longitudinal one.
      const double lateral = 0.5 * (pulled(1, 1) + pulled(2, 2));
      EXPECT_NEAR((pulled(0, 0) - lateral) / x, slope(uniaxial, x), 1e-3);
      EXPECT_NEAR((spread(0, 0) + spread(1, 1) - 2.0 * spread(2, 2)) / x, slope(equibiaxial, x),
                  1e-3);
      EXPECT_NEAR(sheared(0, 1), slope(simple_shear, x - 1.0), 1e-3);
    }
  }
  // The pressure of ½ K ((J² − 1)/2 − ln J).
  const auto plain = with({}, "holzapfel_gasser_ogden");
  for (const double x : {0.8, 1.0 + 1e-8, 1.2}) {
    const double J = x * x * x, p = 0.5e6 * (J - 1.0 / J);
    EXPECT_NEAR(cauchy(*plain, x * Mat3::Identity())(0, 0), p, 1e-12 * std::abs(p) + 1e-8);
  }
}

// A dispersion of 1/3 is isotropic.
TEST(HolzapfelGasserOgden, HasNoDirectionAtFullDispersion) {
  const auto m = with(
      {{.law = "exponential", .values = {{"xi", 1e4}, {"alpha", 1.0}, {"dispersion", 1.0 / 3.0}}}},
      "holzapfel_gasser_ogden");
  const Mat3 F = simple_shear(0.4);
  EXPECT_LT((cauchy(*m, F, Vec3::UnitX()) - cauchy(*m, F, Vec3(0, 0.6, 0.8))).norm(), 1e-9);
}

}  // namespace
}  // namespace polhode::test::fibres_tests
