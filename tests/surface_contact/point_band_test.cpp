// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <polhode/surface_contact/point_band.hpp>

namespace polhode::test::point_band_tests {
namespace {

// @tests{surface-start}
TEST(PointBand, BeginsAtTheInitialGapOfAPoint) {
  surface_contact::SurfaceLaw law;
  law.normal.tolerance = 2e-4;
  law.normal.stiffness = 1e6;
  for (const double start : {1.9e-4, 1e-4, 0.0, -1e-4, -1.79e-4}) {
    const contact::NormalLaw own =
        surface_contact::beginning_later(law, surface_contact::lowered_for(law, start)).normal;
    EXPECT_NEAR(own.reach(), start, 1e-18);
    EXPECT_EQ(own.floor(), -2e-4);
    EXPECT_NEAR(own.energy(start), 0.0, 1e-30);
    const double deeper = 0.9 * -2e-4 + 0.1 * start;
    EXPECT_NEAR(own.force(deeper), law.normal.force(deeper) - law.normal.force(start),
                1e-12 * law.normal.force(deeper));
  }
  EXPECT_NEAR(surface_contact::beginning_later(law, surface_contact::lowered_for(law, -1.99e-4))
                  .normal.reach(),
              -2e-4 + 0.05 * 4e-4, 1e-18)
      << "a twentieth of the gap remains";
}

// @tests{surface-start}
TEST(PointBand, OfAMeshEndsAtTheInitialGap) {
  surface_contact::SurfaceLaw law;
  law.normal.tolerance = 2e-4;
  law.normal.stiffness = 1e6;
  const double middle = law.normal.force(0.0);
  for (const double start : {1.9e-4, 1e-4, 0.0, -1e-4, -1.79e-4}) {
    const contact::NormalLaw own =
        surface_contact::with_band_lowered(law, surface_contact::lowered_for(law, start)).normal;
    EXPECT_NEAR(own.reach(), start, 1e-18);
    EXPECT_EQ(own.floor(), -2e-4);
    EXPECT_NEAR(own.energy(start), 0.0, 1e-30);
    EXPECT_NEAR(own.force(0.5 * (start - 2e-4)), middle, 1e-9 * middle) << "in its middle";
  }
}

TEST(PointBand, IsUnchangedForPointsThatStartOutsideIt) {
  surface_contact::SurfaceLaw law;
  EXPECT_EQ(surface_contact::lowered_for(law, law.normal.reach()), 0.0);
  EXPECT_EQ(surface_contact::lowered_for(law, std::numeric_limits<double>::infinity()), 0.0);
  EXPECT_EQ(surface_contact::lowered_for(law, std::nan("")), 0.0) << "nothing is near";
  EXPECT_EQ(surface_contact::with_band_lowered(law, 0.0).normal.stiffness, law.normal.stiffness);
  EXPECT_FALSE(surface_contact::beginning_later(law, 0.0).normal.later);
  law.normal.potential = contact::NormalPotential::linear;
  EXPECT_EQ(surface_contact::lowered_for(law, -1e-3), 0.0) << "overlaps are allowed";
}

// @tests{surface-turn}
TEST(PointBand, KeepsTheEnergyOfTheRebound) {
  surface_contact::SurfaceLaw law;
  law.normal.tolerance = 2e-4;
  law.normal.stiffness = 1e6;
  for (const double e : {0.0, 0.3, 0.9})
    for (const double gap : {1.5e-4, 0.0, -1.9e-4}) {
      law.end_share = 0.5 * (1.0 - e);
      surface_contact::PointPhase p = surface_contact::PointPhase{}.in_step(law, 3e-4, -1.0);
      EXPECT_TRUE(p.is(contact::ContactPhase::compression));
      EXPECT_EQ(p.law(law).end_share, e == 0.0 ? 1.0 : 0.0);
      p = p.at_end(law, gap);
      const double before = law.normal.energy(gap), released = p.turn(law, gap, 0.0),
                   after = surface_contact::beginning_later(law, p.lowered).normal.energy(gap);
      EXPECT_NEAR(after, e * e * before, 1e-9 * before) << e << ", " << gap;
      EXPECT_NEAR(released + after, before, 1e-12 * before);
      EXPECT_TRUE(p.is(e > 0.0 ? contact::ContactPhase::restitution : contact::ContactPhase::rest));
    }
}

// @tests{surface-held}
TEST(PointBand, BalancesTheLoadOnItAfterCompression) {
  surface_contact::SurfaceLaw law;
  law.normal.tolerance = 2e-4;
  law.normal.stiffness = 1e6;
  law.end_share = 0.5;  // no rebound
  for (const double gap : {1.5e-4, 0.0, -1.9e-4})
    for (const double part : {0.01, 0.5, 0.99, 1.0, 3.0}) {
      surface_contact::PointPhase p = surface_contact::PointPhase{}.in_step(law, 3e-4, -1.0);
      const double force = law.normal.force(gap), before = law.normal.energy(gap),
                   released = p.turn(law, gap, part * force);
      const contact::NormalLaw after = surface_contact::beginning_later(law, p.lowered).normal;
      EXPECT_NEAR(after.force(gap), std::min(1.0, part) * force, 1e-9 * force) << part;
      EXPECT_NEAR(released + after.energy(gap), before, 1e-12 * before);
      EXPECT_GE(released, 0.0);
    }
}

TEST(PointBand, BeginsAnImpactOnlyIfItClosesFromOutside) {
  surface_contact::SurfaceLaw law;
  law.mu = law.end_share = 0.5;  // no rebound
  const double reach = law.normal.reach();
  EXPECT_TRUE(surface_contact::PointPhase{}.in_step(law, reach, -1e-9).in_impact());
  EXPECT_FALSE(surface_contact::PointPhase{}.in_step(law, reach, 0.0).in_impact()) << "no approach";
  EXPECT_FALSE(surface_contact::PointPhase{}.in_step(law, 0.5 * reach, -1.0).in_impact())
      << "it starts within the band";
  surface_contact::PointPhase p =
      surface_contact::PointPhase{}.in_step(law, reach, -1.0).at_end(law, 0.0);
  EXPECT_EQ(p.law(law).mu, 0.0) << "friction is an impulse";
  p.turn(law, 0.0, 0.0);
  EXPECT_EQ(p.law(law).mu, 0.5);
  EXPECT_FALSE(p.in_step(law, 0.0, -1.0).in_impact()) << "it is still loaded";
  EXPECT_TRUE(p.at_end(law, 0.5 * reach).open()) << "of a lowered band";
  EXPECT_GT(p.at_end(law, 0.5 * reach).lowered, 0.0);
  EXPECT_EQ(p.at_end(law, reach).lowered, 0.0);
}

}  // namespace
}  // namespace polhode::test::point_band_tests
