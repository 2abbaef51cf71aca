// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numbers>

#include <polhode/io/text/units.hpp>

namespace polhode::units_tests {
namespace {

constexpr double kPi = std::numbers::pi;

/// Relative rounding of a few multiplications.
constexpr double kRounding = 1e-14;

void expect_unit(const char* text, double factor, const io::Dimension& dimension) {
  const io::UnitReading reading = io::read_unit(text);
  ASSERT_TRUE(reading.unit) << text << ": " << reading.what;
  EXPECT_NEAR(reading.unit->factor / factor, 1.0, kRounding) << text;
  EXPECT_TRUE(reading.unit->dimension.matches(dimension)) << text;
  EXPECT_EQ(reading.unit->dimension.angle, dimension.angle) << text;
}

TEST(Units, HaveTheirFactorsToSi) {
  using namespace io::dimensions;
  expect_unit("mm", 1e-3, kLength);
  expect_unit("kg", 1.0, kMass);
  expect_unit("t", 1e3, kMass);
  expect_unit("ms", 1e-3, kTime);
  expect_unit("min", 60.0, kTime);
  expect_unit("deg", kPi / 180.0, kAngle);
  expect_unit("°", kPi / 180.0, kAngle);
  expect_unit("rpm", 2.0 * kPi / 60.0, kAngularVelocity);
  expect_unit("kN", 1e3, kForce);
  expect_unit("g0", 9.80665, kAcceleration);
  expect_unit("MPa", 1e6, {-1, 1, -2, 0});
}

TEST(Units, AreComposedOfFactorsAndPowers) {
  using namespace io::dimensions;
  expect_unit("N/mm", 1e3, kStiffness);
  expect_unit("kg m^2", 1.0, kInertia);
  expect_unit("kg*mm^2", 1e-6, kInertia);
  expect_unit("kg/m^3", 1.0, kDensity);
  expect_unit("g/cm³", 1e3, kDensity);
  expect_unit("N m/rad", 1.0, kAngularStiffness);
  expect_unit("N s/(km m)", 1e-3, {-1, 1, -1, 0});
  expect_unit("1/s", 1.0, {0, 0, -1, 0});
  expect_unit("m s^-2", 1.0, kAcceleration);
}

TEST(Units, AreRefusedWhenTheyAreAmbiguousOrMalformed) {
  EXPECT_FALSE(io::read_unit("kg/m s").unit);
  EXPECT_FALSE(io::read_unit("").unit);
  EXPECT_FALSE(io::read_unit("m^").unit);
  EXPECT_FALSE(io::read_unit("(m").unit);
  EXPECT_FALSE(io::read_unit("m)").unit);
  EXPECT_FALSE(io::read_unit("m^99").unit);
  EXPECT_EQ(io::read_unit("((((((((((m))))))))))").what,
            "the unit '((((((((((m))))))))))' cannot be read: too many brackets");
}

TEST(UnitSystem, DerivesFactorsFromItsBaseUnits) {
  const io::UnitSystem mm_kg_ms{.length = 1e-3, .mass = 1.0, .time = 1e-3, .angle = kPi / 180.0};
  EXPECT_NEAR(mm_kg_ms.factor(io::dimensions::kForce), 1e3, 1e-11);     // kg mm/ms².
  EXPECT_NEAR(mm_kg_ms.factor(io::dimensions::kStiffness), 1e6, 1e-8);  // kg/ms².
  EXPECT_NEAR(mm_kg_ms.factor(io::dimensions::kAngularVelocity), 1e3 * kPi / 180.0, 1e-12);
  EXPECT_EQ(io::UnitSystem{}.factor(io::dimensions::kDensity), 1.0);
}

TEST(Dimension, IsNamedForMessages) {
  EXPECT_EQ(io::dimensions::kMass.name(), "a mass");
  EXPECT_EQ((io::Dimension{4, 1, 0, 0}).name(), "a quantity in kg m^4");
  EXPECT_EQ(io::dimensions::kAngularStiffness.si_unit(), "N m/rad");
}

}  // namespace
}  // namespace polhode::units_tests
