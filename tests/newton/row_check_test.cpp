// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/newton/row_check.hpp>

#include "engines/mechanisms.hpp"

namespace polhode::row_check_tests {
namespace {

using namespace test;

/// A trial at which a bar of a given size, on a hinge far from the origin, is displaced.
struct Displaced {
  System system;
  State state;
  Trial trial;
  RowCheck rows;

  Displaced(double size, double far, double by) : Displaced(hinged(size, far), by) {}

  [[nodiscard]] bool hold(bool rounded = false) { return rows.hold(state, trial, rounded); }

 private:
  Displaced(System made, double by)
      : system(std::move(made)), state(system.initial_state()), rows(system) {
    trial.context.dt = 1e-3;
    trial.lambda.assign(static_cast<std::size_t>(system.rows()), 0.0);
    size_blocks(state, trial);
    start_trial(system, state, trial);
    move_body(state, trial, system.slot(0), Vec3(0.0, 0.0, by), Vec3::Zero());
  }
  static System hinged(double size, double far) {
    Mechanism m;
    m.body("bar", {far + 0.5 * size, 0.0, 0.0}, 1.0, size * size * Vec3(0.01, 0.08, 0.08));
    m.joint("hinge", "revolute", kGround, 0, {far, 0.0, 0.0}, Vec3::UnitY());
    return m.system();
  }
};

// @tests{row-tolerance}
TEST(RowCheck, MeasuresGapsInSizesOfTheBodies) {
  for (const double size : {1e-3, 1.0, 1e3}) {
    // Half a size is the arm of the hinge.
    EXPECT_TRUE(Displaced(size, 0.0, 0.9 * RowCheck::kTolerance * 0.5 * size).hold()) << size;
    // The arm counts once for the displacement of a row, and once for the rotation of its body.
    Displaced open(size, 0.0, 3.0 * RowCheck::kTolerance * 0.5 * size);
    EXPECT_FALSE(open.hold()) << size;
    EXPECT_EQ(open.rows.open().interaction, 0);
    EXPECT_TRUE(open.rows.open().length);
    EXPECT_NEAR(open.rows.open().gap, 1.5 * RowCheck::kTolerance * size,
                1e-6 * open.rows.open().gap);
  }
}

TEST(RowCheck, AllowsTheRoundingOfCoordinates) {
  // At 1e6 m numbers are 1e-10 m apart.
  EXPECT_TRUE(Displaced(1.0, 1e6, 1e-9).hold());
  EXPECT_TRUE(Displaced(1.0, 1e6, 1e-9).hold(true));
  EXPECT_FALSE(Displaced(1.0, 1e6, 1e-7).hold());
  EXPECT_FALSE(Displaced(1.0, 0.0, 1e-12).hold(true));
  EXPECT_TRUE(Displaced(1.0, 0.0, 1e-15).hold(true));
}

}  // namespace
}  // namespace polhode::row_check_tests
