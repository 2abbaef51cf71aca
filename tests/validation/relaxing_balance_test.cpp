// SPDX-License-Identifier: Apache-2.0
// Balance of energy and momenta of moving solids whose stress relaxes.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <support/flexible_scene.hpp>

namespace polhode::relaxing_balance_tests {

using test::FlexibleScene;

// Tumbling bars at large strains, all elements: the balance of energy closes and momenta are kept
// to round-off, and no step supplies energy, from steps much longer than a relaxation time to
// hundredfold finer ones.
// @tests{solid-relaxation-loss}
TEST(RelaxingSolids, ATumblingBarBalancesItsEnergyAndOnlyLosesIt) {
  struct Kind {
    const char *element, *cell, *material;
    std::map<std::string, double> moduli;
  };
  const Kind kinds[] = {
      {"hex8_eas9", "hex8", "elastic", {{"youngs_modulus", 2000.0}, {"poisson_ratio", 0.3}}},
      {"hex8_standard",
       "hex8",
       "neo_hookean",
       {{"youngs_modulus", 2000.0}, {"poisson_ratio", 0.3}}},
      {"tet10", "tet10", "neo_hookean", {{"youngs_modulus", 2000.0}, {"poisson_ratio", 0.3}}},
      {"hex8_q1p0",
       "hex8",
       "mooney_rivlin_uncoupled",
       {{"c1", 350.0}, {"c2", 20.0}, {"bulk_modulus", 2e4}}}};
  for (const Kind& k : kinds)
    for (const double step : {0.05, 0.02, 0.0005}) {
      FlexibleScene::Options o;
      o.element = k.element;
      o.cell = k.cell;
      o.material = k.material;
      o.moduli = k.moduli;
      o.relaxation = {{0.8, 0.01}, {0.5, 0.4}, {0.2, 20.0}};
      o.cells = {3, 1, 1};
      o.step = step;
      FlexibleScene s(o);
      const int steps = static_cast<int>(std::lround((step < 0.01 ? 0.5 : 4.0) / step));
      double before = 0.0, least = 0.0;
      for (int n = 0; n < steps; ++n) {
        s.run(1);
        const double now = s.state.ledger.dissipated.value();
        least = std::min(least, now - before);
        before = now;
      }
      const double energy = s.state.ledger.energy_scale;
      EXPECT_GE(least, -1e-15 * energy) << k.element << ' ' << k.material << ' ' << step;
      EXPECT_GT(before, 1e-3 * energy) << k.element << ' ' << k.material << ' ' << step;
      EXPECT_LE(s.energy_drift(), 2e-16 * steps + 1e-14) << k.element << ' ' << step;
      EXPECT_LE(s.momentum_drift(), 1e-16 * steps + 1e-14) << k.element << ' ' << step;
    }
}

}  // namespace polhode::relaxing_balance_tests
