// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/newton/tangent_check.hpp>

#include "engines/mechanisms.hpp"

namespace polhode::tangent_check_tests {
namespace {

using namespace test;

// @tests{ga-inertia-tangent} @tests{ga-moment-tangent}
TEST(CheckTangents, AgreesWithDifferencesForWholeMechanisms) {
  for (const Mechanism& m : {double_pendulum("universal"), double_pendulum("prismatic"),
                             double_pendulum("fixed"), four_bars(1, 0.8), bricard_system()})
    for (const double rho : {1.0, 0.5, 0.0})
      for (const MomentumRate form : {MomentumRate::momentum, MomentumRate::kinematic_corrected}) {
        const System system = m.system();
        const TangentReport report = check_tangents(system, system.initial_state(), 0.1, rho, form);
        EXPECT_LT(report.error, kTangentTolerance) << report.text();
        EXPECT_EQ(report.bodies_moved, system.body_count());
      }
}

/// A spring to the origin whose tangent has the wrong sign.
struct WrongSpring : InteractionItem {
  static constexpr const char* kKind = "spring";
  void evaluate(const PairStep& step, PairTerms& t) const {
    t.wrench_b.head<3>() = -100.0 * step.b.r_n1;
    t.D_bb.topLeftCorner<3, 3>() = 100.0 * Mat3::Identity();
  }
};

TEST(CheckTangents, NamesAWrongEntry) {
  System system;
  BodyMotion start;
  start.r = {1.0, 2.0, 3.0};
  system.add_body({"ball", 1.0, Mat3::Identity()}, start);
  WrongSpring spring;
  spring.name = "wrong";
  spring.bodies = {kGround, 0};
  system.group<WrongSpring>().add(spring);
  system.finish();
  const TangentReport report = check_tangents(system, system.initial_state(), 0.1, 1.0);
  EXPECT_GT(report.error, 0.1);
  EXPECT_TRUE(report.row.starts_with("force ")) << report.text();
  EXPECT_TRUE(report.column.starts_with("displacement ")) << report.text();
  EXPECT_TRUE(report.row.ends_with(" of body 'ball'")) << report.text();
}

}  // namespace
}  // namespace polhode::tangent_check_tests
