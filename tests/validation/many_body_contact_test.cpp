// SPDX-License-Identifier: Apache-2.0
// Many bodies in contact by forces, see also tests/engines/contact_cg_engine_test.cpp.
#include <algorithm>

#include <gtest/gtest.h>

#include "model_scene.hpp"

namespace polhode::test::many_body_contact_tests {
namespace {

/// SPHERES_IN_A_BIN: the first second, in which nearly all of the energy is lost in impacts.
TEST(ManyBodyContact, AThousandSpheresInABinNeverGainEnergyNorPenetrate) {
  ModelScene s;
  const int n = 1000;
  s.add_bin(n, 4.0);
  s.law(0.5, 0.0, 5e-4);
  s.begin(2e-3);
  double energy = s.energy(), rise = 0.0, least = 1.0;
  for (int k = 0; k < 500; ++k) {
    s.step();
    rise = std::max(rise, s.energy() - energy);
    energy = s.energy();
    least = std::min(least, s.least_gap());
  }
  EXPECT_LT(rise, 1e-10);   // J of some thousand; measured 2e-12
  EXPECT_GT(least, -5e-4);  // the tolerance; measured -3.2e-4
  EXPECT_EQ(s.simulation().state().ledger.rejected, 0);
  for (int b = 0; b < n; ++b) EXPECT_GT(s.motion(b).r.z(), 0.1 - 5e-4) << b;
}

}  // namespace
}  // namespace polhode::test::many_body_contact_tests
