// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/contact_laws/normal_law.hpp>

namespace polhode::contact::normal_law_tests {
namespace {

/// A band that is given another stiffness and the reach for it stores what it is to store, to the
/// last digits; without energy it begins at the gap.
/// @tests{contact-same-energy}
TEST(NormalLaw, StoresWhatItIsToStoreWithAnotherStiffness) {
  for (const NormalPotential potential :
       {NormalPotential::barrier, NormalPotential::linear, NormalPotential::hertz})
    for (const double gap : {-0.9e-4, -0.3e-4, -1e-7})
      for (const double part : {0.25, 1.0, 30.0}) {
        NormalLaw law;
        law.potential = potential;
        law.stiffness = 3e5;
        law.tolerance = 1e-4;
        law.upper = 0.0;
        const double energy = 0.7 * law.energy(gap);
        law.stiffness *= part;
        law.upper = law.reach_for(gap, energy);
        EXPECT_NEAR(law.energy(gap), energy, 1e-9 * energy) << gap << ' ' << part;
        EXPECT_EQ(law.reach_for(gap, 0.0), gap);
      }
}

}  // namespace
}  // namespace polhode::contact::normal_law_tests
