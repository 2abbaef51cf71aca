// SPDX-License-Identifier: Apache-2.0
// PID controllers of FEBio files.
#include <cmath>

#include "feb_fixture.hpp"

namespace polhode::feb_pid_tests {
namespace {

using namespace feb_tests;
using testing::HasSubstr;

class FebPid : public FebFixture {};

std::string pid(const std::string& parameter, const std::string& gains) {
  return tag("LoadData",
             tag("load_controller", tag("var", parameter) + tag("target", "0.5") + gains,
                 "id='3' type='PID'"));
}
std::string push(double value) {
  return typed("rigid_load", "rigid_force",
               tag("rb", "bar") + tag("dof", "Rz") + tag("value", format("{}", value), "lc='3'"));
}

// m z'' = f (K (0.5 - z) - D z'), from rest at 0: the value's factor multiplies all gains.
TEST_F(FebPid, ForcesFollowTheError) {
  const double K = 2 * kMass, D = 0.5 * kMass;
  for (const std::string parameter :
       {"fem.rigidbody('bar').position.z", "fem.rigidbody[1].position.z"}) {
    const Model m =
        read(two_bodies(control(), push(3),
                        pid(parameter, tag("Kp", format("{}", K)) + tag("Kd", format("{}", D)))));
    const double a = 0.75, w = std::sqrt(6.0 - a * a);
    for (const double step : kSteps) {
      const double z = 0.5 - 0.5 * std::exp(-a) * (std::cos(w) + a / w * std::sin(w));
      EXPECT_NEAR(run(m, 1.0, step).body("bar").r.z(), z, error_at(step)) << step;
    }
  }
}

// The integral alone: m z''' = I (0.5 - z); the series of its solution from rest.
TEST_F(FebPid, IntegralsAdd) {
  const Model m = read(
      two_bodies(control(), push(1),
                 pid("fem.rigidbody(\"bar\").position.z", tag("Ki", format("{}", 6 * kMass)))));
  for (const double step : kSteps) {
    double z = 0.0, term = -0.5;  // 0.5 - z is the sum of 0.5 (-6 t^3)^k / (3 k)! at t = 1.
    for (int k = 1; k < 8; ++k) {
      term *= -6.0 / ((3.0 * k) * (3.0 * k - 1) * (3.0 * k - 2));
      z += term;
    }
    EXPECT_NEAR(run(m, 1.0, step).body("bar").r.z(), z, error_at(step)) << step;
  }
}

TEST_F(FebPid, EachFactorHasAControllerOfItsOwn) {
  const Model m = read(two_bodies(control(), push(3) + push(3) + push(-2),
                                  pid("fem.rigidbody('bar').position.z", tag("Kp", "4"))));
  ASSERT_EQ(m.controllers.size(), 2U);
  EXPECT_EQ(m.controllers[0].name, "pid3");
  EXPECT_EQ(m.controllers[1].name, "pid3_2");
  EXPECT_THAT(
      notes(two_bodies(control(), push(3), pid("fem.rigidbody('bar').position.z", tag("Kp", "4")))),
      HasSubstr("the PID controller 'pid3' is continuous, where FEBio evaluates it once a "
                "step"));
}

TEST_F(FebPid, WhatCannotBeControlledIsNamed) {
  const auto reading = [&](const std::string& parameter) {
    return fault(two_bodies(control(), push(1), pid(parameter, tag("Kp", "1"))));
  };
  for (const std::string parameter :
       {"fem.time", "fem.rigidbody('bar').Fx", "fem.rigidbody('bar.position.z",
        "fem.rigidbody[x].position.z", "fem.rigidbody().position.z", "fem.rigidbody"})
    EXPECT_THAT(reading(parameter), HasSubstr("a PID controller of '")) << parameter;
  EXPECT_THAT(reading("fem.rigidbody('leg').position.z"),
              HasSubstr("there is no rigid body as in"));
  EXPECT_THAT(reading("fem.rigidbody[2].position.z"), HasSubstr("there is no rigid body as in"));
  EXPECT_THAT(
      fault(two_bodies(
          "", "",
          tag("Step", tag("step", control() + tag("Loads", "")) +
                          tag("step", control() + tag("Loads", typed("body_load", "const",
                                                                     tag("z", "1", "lc='3'"))))) +
              pid("fem.rigidbody('bar').position.z", tag("Kp", "1")))),
      HasSubstr("a PID controller in one of several steps is not read"));
  EXPECT_THAT(fault(two_bodies(control("STATIC"), push(1),
                               pid("fem.rigidbody('bar').position.z", tag("Kp", "1")))),
              HasSubstr("a PID controller in statics is not read"));
}

}  // namespace
}  // namespace polhode::feb_pid_tests
