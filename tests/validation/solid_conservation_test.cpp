// SPDX-License-Identifier: Apache-2.0
// Conservation of energy and momenta of deformable solids on rigid bodies over long runs, for every
// element, and the order of the method.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include <polhode/core/format.hpp>
#include <support/flexible_scene.hpp>

namespace polhode::solid_conservation_tests {
namespace {

using test::FlexibleScene;

struct Kind {
  const char *element, *cell, *material;
  std::map<std::string, double> moduli;
  std::vector<double> cells;
};

const std::map<std::string, double> kCompressible{{"youngs_modulus", 2000.0},
                                                  {"poisson_ratio", 0.3}};
const std::map<std::string, double> kUncoupled{{"c1", 350.0}, {"c2", 20.0}, {"bulk_modulus", 2e4}};

std::vector<Kind> kinds() {
  return {{"hex8_eas9", "hex8", "neo_hookean", kCompressible, {4, 1, 1}},
          {"hex8_q1p0", "hex8", "mooney_rivlin_uncoupled", kUncoupled, {4, 1, 1}},
          {"hex20", "hex20", "neo_hookean", kCompressible, {2, 1, 1}},
          {"tet10", "tet10", "neo_hookean", kCompressible, {2, 1, 1}},
          {"hex27", "hex27", "neo_hookean", kCompressible, {2, 1, 1}},
          {"wedge6", "wedge6", "neo_hookean", kCompressible, {3, 1, 1}},
          {"tet15", "tet15", "neo_hookean", kCompressible, {2, 1, 1}},
          {"wedge15", "wedge15", "neo_hookean", kCompressible, {2, 1, 1}}};
}

class EveryElement : public testing::TestWithParam<Kind> {};

/// A bar on a tumbling body: within the round-off of four iterations a step.
void run_a_spinning_bar(const Kind& k, int steps) {
  FlexibleScene s({.element = k.element,
                   .cell = k.cell,
                   .material = k.material,
                   .moduli = k.moduli,
                   .cells = k.cells});
  s.run(steps);
  testing::Test::RecordProperty("energy_drift", format("{:.2e}", s.energy_drift()));
  testing::Test::RecordProperty("angular_momentum_drift", format("{:.2e}", s.momentum_drift()));
  EXPECT_LE(s.energy_drift(), 1e-16 * steps);
  EXPECT_LE(s.momentum_drift(), 1e-16 * steps);
  EXPECT_EQ(s.state.ledger.rejected, 0);
}

TEST_P(EveryElement, KeepsEnergyAndMomentaOfASpinningBar) { run_a_spinning_bar(GetParam(), 2000); }

/// Two bodies, two joints, gravity.
void run_between_two_bodies(const Kind& k, int steps, double stiffer = 1.0) {
  std::map<std::string, double> moduli = k.moduli;
  for (auto& [name, value] : moduli)
    if (name != "poisson_ratio") value *= stiffer;
  FlexibleScene s({.element = k.element,
                   .cell = k.cell,
                   .material = k.material,
                   .moduli = moduli,
                   .cells = k.cells,
                   .two_bodies = true,
                   .hinge = true,
                   .gravity = Vec3(0.3, -9.0, -2.0),
                   .omega = Vec3(0.0, 0.0, 1.5),
                   .step = 0.01});
  s.run(steps);
  testing::Test::RecordProperty("energy_drift", format("{:.2e}", s.energy_drift()));
  testing::Test::RecordProperty("angular_momentum_drift", format("{:.2e}", s.momentum_drift()));
  EXPECT_LE(s.energy_drift(), 1e-11);
  EXPECT_LE(s.momentum_drift(), 1e-11);
}

TEST_P(EveryElement, KeepsEnergyBetweenTwoBodiesOnJointsUnderGravity) {
  run_between_two_bodies(GetParam(), 2000);
}

// Long runs take minutes, and are there when POLHODE_SLOW_TESTS is set.
class EveryElementForLong : public testing::TestWithParam<Kind> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EveryElementForLong);

TEST_P(EveryElementForLong, KeepsEnergyAndMomentaOfASpinningBarOverTenThousandSteps) {
  run_a_spinning_bar(GetParam(), 10'000);
}

// In such a long motion two heavy bodies would crush a bar as soft as the others, so this one is
// stiffer.
TEST_P(EveryElementForLong, KeepsEnergyBetweenTwoBodiesOnJointsOverTenThousandSteps) {
  run_between_two_bodies(GetParam(), 10'000, 10.0);
}

std::string element_of(const testing::TestParamInfo<Kind>& info) { return info.param.element; }

INSTANTIATE_TEST_SUITE_P(Solids, EveryElement, testing::ValuesIn(kinds()), element_of);
INSTANTIATE_TEST_SUITE_P(Solids, EveryElementForLong,
                         testing::ValuesIn(std::getenv("POLHODE_SLOW_TESTS") != nullptr
                                               ? kinds()
                                               : std::vector<Kind>()),
                         element_of);

// Materials of principal stretches and of several families of fibres, at a coarse, the usual and a
// fine step; the fibres are slack at times.
TEST(SolidConservation, OgdenAndFamiliesOfFibresKeepEnergyAndMomenta) {
  std::vector<FlexibleScene::Options> all(3);
  all[0].material = "ogden";
  all[0].moduli = {{"c1", 1200.0}, {"m1", 3.5}, {"c2", 300.0}, {"m2", -4.0}, {"lame", 1000.0}};
  all[1].material = "ogden_uncoupled";
  all[1].element = "hex8_q1p0";
  all[1].moduli = {{"c1", 1400.0}, {"m1", 1.3}, {"c2", 40.0}, {"m2", 9.0}, {"bulk_modulus", 2e4}};
  all[2].material = "holzapfel_gasser_ogden";
  all[2].element = "hex8_q1p0";
  all[2].moduli = {{"shear_modulus", 700.0}, {"bulk_modulus", 2e4}};
  all[2].fibres = {
      {.law = "exponential", .values = {{"xi", 400.0}, {"alpha", 2.0}, {"dispersion", 0.1}}},
      {.law = "power_linear",
       .values = {{"modulus", 900.0}, {"beta", 2.8}, {"straight_stretch", 1.05}}}};
  all[2].directions = {Vec3(0.9, 0.4, 0.1), Vec3(0.9, -0.4, 0.1)};
  for (FlexibleScene::Options& o : all)
    for (const double step : {0.05, 0.02, 0.002}) {
      o.cells = {4, 1, 1};
      o.step = step;
      FlexibleScene s(o);
      const int steps = static_cast<int>(std::lround(4.0 / step));
      s.run(steps);
      EXPECT_LE(s.energy_drift(), 1e-12) << o.material << ' ' << step;
      EXPECT_LE(s.momentum_drift(), 1e-12) << o.material << ' ' << step;
      if (step < 0.05) {
        EXPECT_EQ(s.state.ledger.rejected, 0) << o.material << ' ' << step;
      }
    }
}

TEST(SolidConservation, MidpointStressDoesNotKeepEnergy) {
  FlexibleScene exact({.conserving = true}), plain({.conserving = false});
  exact.run(500);
  plain.run(500);
  EXPECT_LE(exact.energy_drift(), 1e-12);
  EXPECT_GE(plain.energy_drift(), 1e-4);
  EXPECT_LE(plain.momentum_drift(), 1e-11);  // any symmetric stress conserves momenta
}

TEST(SolidConservation, ViscosityDissipatesTheEnergyInTheLedger) {
  FlexibleScene s({.relaxation_time = 2e-3});
  double before = s.stepper->balance(s.state).kinetic + s.stepper->balance(s.state).potential;
  const double start = before;
  for (int i = 0; i < 2000; ++i) {
    s.run(1);
    const Balance b = s.stepper->balance(s.state);
    const double now = b.kinetic + b.potential;
    ASSERT_LE(now, before + 1e-13 * start) << i;
    before = now;
  }
  EXPECT_LT(before, (1.0 - 1e-3) * start);
  EXPECT_LE(s.energy_drift(), 1e-11);
  EXPECT_LE(s.momentum_drift(), 1e-11);
}

/// Position of the far end's nodes after 0.4 s.
std::vector<double> end_of(FlexibleScene::Options o, int steps) {
  o.step = 0.4 / steps;
  FlexibleScene s(o);
  s.run(steps);
  return s.state.node_x;
}

double distance(const std::vector<double>& x, const std::vector<double>& y) {
  double most = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) most = std::max(most, std::abs(x[k] - y[k]));
  return most;
}

/// Order in time with viscosity: without it the highest vibrations of the mesh stay unresolved.
TEST(SolidConservation, IsOfSecondOrderWithViscosity) {
  for (const double rho_inf : {1.0, 0.9, 0.8, 0.5}) {
    const FlexibleScene::Options o{.relaxation_time = 2e-2, .cells = {3, 1, 1}, .rho_inf = rho_inf};
    const auto reference = end_of(o, 640);
    const double e40 = distance(end_of(o, 40), reference), e80 = distance(end_of(o, 80), reference);
    EXPECT_NEAR(std::log2(e40 / e80), 2.0, 0.1) << rho_inf;
  }
}

TEST(SolidConservation, CompositionsRaiseTheOrder) {
  for (const int order : {4, 6}) {
    FlexibleScene::Options o{.cells = {1, 1, 1}, .omega = Vec3(0.3, -0.5, 1.0), .order = order};
    o.moduli = {{"youngs_modulus", 40.0}, {"poisson_ratio", 0.3}};
    const int n = 32;  // the highest vibrations of the element must be resolved
    const auto reference = end_of(o, 4 * n);
    const double coarse = distance(end_of(o, n), reference),
                 fine = distance(end_of(o, 2 * n), reference);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.3) << order;
  }
}

}  // namespace
}  // namespace polhode::solid_conservation_tests
