// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include <polhode/contact_laws/normal_law.hpp>

namespace polhode::contact::normal_law_tests {
namespace {

/// Stored energy of a band with another stiffness and the range for it: the given energy, to the
/// last digits. Without energy the band begins at the gap.
/// @tests{contact-same-energy}
TEST(NormalLaw, KeepsTheStoredEnergyWithAnotherStiffness) {
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

/// A barrier that begins at a smaller gap: its force is that of the whole barrier less the force at
/// its beginning, its energy the integral of the force, its difference quotient that of the energy.
/// @tests{contact-later}
TEST(NormalLaw, CanBeginAtASmallerGapWithinItsBand) {
  NormalLaw law;
  law.stiffness = 3e5;
  law.tolerance = 1e-4;
  for (const double begin : {0.99e-4, 0.2e-4, -0.9e-4}) {
    NormalLaw later = law;
    later.later = begin;
    EXPECT_EQ(later.reach(), begin);
    EXPECT_EQ(later.band(), law.band());
    EXPECT_EQ(later.energy(begin), 0.0);
    EXPECT_EQ(later.force(begin), 0.0);
    EXPECT_EQ(later.quotient(begin + 1e-5, begin), 0.0);
    const double less = law.force(begin);
    for (const double part : {1e-9, 0.1, 0.7, 0.95}) {
      const double gap = begin - part * (begin - law.floor());
      EXPECT_NEAR(later.force(gap), law.force(gap) - less, 1e-10 * law.force(gap)) << part;
      const double energy = law.energy(gap) - law.energy(begin) - less * (begin - gap);
      EXPECT_NEAR(later.energy(gap), energy, 1e-12 * law.energy(gap)) << part;
      for (const double from : {begin + 2e-5, begin - 1e-3 * (begin - law.floor())}) {
        const NormalLaw::WithSlope q = later.quotient_and_slope(from, gap);
        const double h = 1e-6 * (gap - law.floor());
        EXPECT_NEAR(q.value * (from - gap), later.energy(gap) - later.energy(from),
                    1e-11 * law.energy(gap));
        if (part < 0.1) continue;  // differences would cross its beginning
        EXPECT_NEAR(q.slope,
                    (later.quotient(from, gap + h) - later.quotient(from, gap - h)) / (2.0 * h),
                    1e-5 * std::abs(q.slope) + 1e-9 * law.stiffness);
      }
    }
  }
}

/// Stiffness, depth and duration of every law of model files, against the integral of its force.
/// Those of the barrier hold for small depths.
TEST(NormalLaw, StatesStiffnessDepthAndDurationOfItsOwnForce) {
  for (const PotentialWord& known : kPotentialWords) {
    EXPECT_EQ(potential_of(known.word), known.potential);
    const double load = 40.0, mass = 3.0, speed = 0.7;
    NormalLaw law;
    law.potential = known.potential;
    law.tolerance = 2e-3;
    law.upper = 0.0;
    const bool spring = law.is_spring();
    EXPECT_EQ(std::isinf(law.floor()), spring) << known.word;

    const auto [k, bristle] = law.stiffness_under(load, 0.0);
    law.stiffness = k;
    const double depth = law.depth_under(load), close = spring ? 1e-12 : 0.1;
    EXPECT_NEAR(law.force(-depth), load, close * load) << known.word;
    EXPECT_NEAR(-law.force_and_slope(-depth).slope, law.slope_under(load),
                2.0 * close * law.slope_under(load))
        << known.word;
    EXPECT_LT(depth, spring ? 1.4 * law.tolerance : 0.06 * law.tolerance) << known.word;
    EXPECT_GT(bristle, 0.1 * load / law.tolerance) << known.word;
    if (spring) {
      EXPECT_NEAR(law.bristle_stiffness(), bristle, 1e-12 * bristle) << known.word;
    }
    EXPECT_GE(law.stiffness_under(load, 1e9).bristle, 1e9) << known.word;

    law.stiffness = law.stiffness_in_impact(mass, speed);
    const double energy = 0.5 * mass * speed * speed;
    EXPECT_LE(-law.gap_of(energy), (1.0 + 1e-9) * law.tolerance) << known.word;
    const double stated = law.impact_duration(mass, speed), dt = 1e-5 * stated;
    double gap = -0.5 * dt * speed, v = -speed, t = 0.0;
    for (; gap < 0.0; t += dt) {
      v += dt / mass * law.force(gap);
      gap += dt * v;
    }
    EXPECT_NEAR(v, speed, 1e-3 * speed) << known.word;
    EXPECT_NEAR(t, stated, (spring ? 1e-3 : 0.05) * stated) << known.word;
  }
}

/// A spring with a floor: alone above three quarters of the way to it, infinite there. Force and
/// quotient are those of its energy, also where an impact has moved its activation distance.
/// @tests{spring-floor}
TEST(NormalLaw, StiffensASpringNearItsFloor) {
  for (const NormalPotential potential : {NormalPotential::linear, NormalPotential::hertz})
    for (const double reach : {0.0, -0.3e-4, -0.8e-4, -0.95e-4}) {
      SCOPED_TRACE(reach);
      NormalLaw alone;
      alone.potential = potential;
      alone.stiffness = 3e5;
      alone.tolerance = 1e-4;
      alone.upper = reach;
      NormalLaw law = alone;
      law.lower = -1e-4;
      EXPECT_EQ(law.floor(), -1e-4);
      EXPECT_TRUE(std::isinf(alone.floor()));
      for (const double gap : {1e-5, 0.0, -0.2e-4, -0.75e-4}) {
        EXPECT_EQ(law.energy(gap), alone.energy(gap));
        EXPECT_EQ(law.force(gap), alone.force(gap));
        EXPECT_FALSE(law.is_near_floor(gap));
      }
      EXPECT_TRUE(std::isinf(law.energy(-1e-4)));
      EXPECT_GT(law.force(-0.999e-4),
                100.0 * law.stiffness * 1e-4 * (potential == NormalPotential::hertz ? 1e-2 : 1.0));
      for (const double gap : {-0.7500001e-4, -0.8e-4, -0.9e-4, -0.97e-4, -0.999e-4}) {
        EXPECT_TRUE(law.is_near_floor(gap));
        const double h = 1e-4 * (gap - law.floor()), energy = law.energy(gap);
        if (std::abs(gap - reach) > 2.0 * h && std::abs(gap + 0.75e-4) > 2.0 * h) {
          EXPECT_NEAR(law.force(gap), -(law.energy(gap + h) - law.energy(gap - h)) / (2.0 * h),
                      1e-6 * law.force(gap));
          EXPECT_NEAR(law.force_and_slope(gap).slope,
                      (law.force(gap + h) - law.force(gap - h)) / (2.0 * h),
                      1e-6 * std::abs(law.force_and_slope(gap).slope));
        }
        for (const double from : {2e-5, -0.5e-4, -0.85e-4, -0.99e-4}) {
          const NormalLaw::WithSlope q = law.quotient_and_slope(from, gap);
          EXPECT_NEAR(q.value * (from - gap), energy - law.energy(from),
                      1e-12 * (energy + law.energy(from)));
          EXPECT_GE(q.value, 0.0);
        }
        if (!(energy > 0.0)) continue;
        EXPECT_NEAR(law.gap_of(energy), gap, 1e-12 * std::abs(gap));
        for (const double part : {1e-3, 0.5, 1.0}) {
          NormalLaw again = law.with_stiffness(0.4 * law.stiffness);
          again.upper = again.reach_for(gap, part * energy);
          EXPECT_NEAR(again.energy(gap), part * energy, 1e-9 * energy) << gap << ' ' << part;
        }
      }
    }
}

}  // namespace
}  // namespace polhode::contact::normal_law_tests
