// SPDX-License-Identifier: Apache-2.0
// Freedoms of rigid bodies that each of several steps of an FEBio file fixes or prescribes.
#include "feb_fixture.hpp"

namespace polhode::feb_phases_tests {
namespace {

using namespace feb_tests;
using testing::HasSubstr;

class FebPhases : public FebFixture {
 protected:
  /// The bar at a time of a history of equilibria.
  static BodyMotion settled(const Model& model, double until) {
    Simulation simulation(model);
    while (simulation.time() < until * (1.0 - 1e-9)) simulation.step(until);
    return simulation.body("bar");
  }
};

std::string phase(const std::string& rigid_section, const std::string& analysis = "DYNAMIC") {
  return tag("step", control(analysis, 100, 0.01) + tag("Rigid", rigid_section));
}
std::string steps(const std::vector<std::string>& list, const std::string& rigid_section = "",
                  const std::string& more = "") {
  std::string all;
  for (const std::string& s : list) all += s;
  return two_bodies("", rigid_section, tag("Step", all) + more);
}
std::string moved(const std::string& dof, int lc, bool relative = false) {
  const bool turn = dof == "Ru" || dof == "Rv" || dof == "Rw";
  return typed("rigid_bc", turn ? "rigid_rotation" : "rigid_displacement",
               tag("rb", "bar") + tag("dof", dof) +
                   tag("value", "1", "lc='" + std::to_string(lc) + "'") +
                   tag("relative", relative ? "1" : "0"));
}
std::string force(const std::string& value) {
  return typed("rigid_load", "rigid_force",
               tag("rb", "bar") + tag("dof", "Rx") + tag("value", value));
}
const std::string kCurves =
    tag("LoadData", curve(1, "0,0;1,0.1") + curve(2, "2,0;3,0.2") + curve(3, "0,0;1,1"));

// Driven to 0.1 m, held, and driven on by 0.2 m relative to that.
TEST_F(FebPhases, EachStepPrescribesAPlaceInItsOwnWay) {
  for (const std::string analysis : {"DYNAMIC", "STATIC"}) {
    const std::string rest = fixed("bar", "011111");
    const std::string text =
        steps({phase(moved("Rx", 1) + rest, analysis), phase(fixed("bar", "111111"), analysis),
               phase(moved("Rx", 2, true) + rest, analysis)},
              "", kCurves);
    const Model m = read(text);
    EXPECT_EQ(freedoms(m), 0);
    const auto place = [&](double t) {
      return (m.analysis.type == "statics" ? settled(m, t) : run(m, t).body("bar")).r.x();
    };
    EXPECT_NEAR(place(0.5), 0.05, 1e-9) << analysis;
    EXPECT_NEAR(place(1.0), 0.1, 1e-9) << analysis;
    EXPECT_NEAR(place(1.7), 0.1, 1e-9) << analysis;
    EXPECT_NEAR(place(2.5), 0.2, 1e-9) << analysis;
    EXPECT_NEAR(place(3.0), 0.3, 1e-9) << analysis;
  }
}

// Held for a second, then pushed with 2 m/s^2 along x, which alone is free.
TEST_F(FebPhases, AStepReleasesFreedoms) {
  const std::string text =
      steps({phase(fixed("bar", "110000")), phase(force(format("{}", 2 * kMass)))},
            fixed("bar", "011111"));
  for (const double step : kSteps) {
    EXPECT_NEAR(run(read(text), 1.0, step).body("bar").r.x(), 0.0, 1e-12) << step;
    const BodyMotion bar = run(read(text), 2.0, step).body("bar");
    EXPECT_NEAR(bar.r.x(), 1.0, 1e-9) << step;
    EXPECT_NEAR(bar.r.tail<2>().norm(), 0.0, 1e-12) << step;
  }
}

// Freedoms that a step releases keep their velocity: 1 m/s, and 1 rad/s about z.
TEST_F(FebPhases, WhatWasDrivenFliesOn) {
  const std::string all = moved("Rx", 3) + moved("Rw", 3) + fixed("bar", "011110");
  const std::string text = steps({phase(all), phase("")}, "", kCurves);
  for (const double step : kSteps) {
    const BodyMotion bar = run(read(text), 2.0, step).body("bar");
    EXPECT_NEAR((bar.r - Vec3(2, 0, 0)).norm(), 0.0, error_at(step) + 1e-8) << step;
    EXPECT_NEAR((bar.omega() - Vec3(0, 0, 1)).norm(), 0.0, error_at(step) + 1e-8) << step;
  }
}

// Statics: driven against a spring, then pulled by a force instead.
TEST_F(FebPhases, EquilibriaFollowTheSteps) {
  const std::string spring = tag("rigid_connector",
                                 tag("body_a", "base") + tag("body_b", "bar") + tag("k", "100") +
                                     tag("insertion_a", "-2,0,0") + tag("insertion_b", "-1,0,0"),
                                 "name='pull' type='rigid spring'");
  const std::string text = steps({phase(moved("Rx", 1), "STATIC"), phase(force("30"), "STATIC"),
                                  phase(fixed("bar", "111111"), "STATIC")},
                                 fixed("bar", "011111") + spring, kCurves);
  const Model m = read(text);
  EXPECT_NEAR(settled(m, 1.0).r.x(), 0.1, 1e-9);
  EXPECT_NEAR(settled(m, 2.0).r.x(), 0.3, 1e-9);
  // Held by the last step, where it is no longer pulled.
  EXPECT_NEAR(settled(m, 3.0).r.x(), 0.3, 1e-9);
}

TEST_F(FebPhases, WhatCannotBeIsNamed) {
  EXPECT_THAT(fault(steps({phase(""), phase(fixed("bar", "100000"))})),
              HasSubstr("x of 'bar' is free in one step and fixed or prescribed in a later one"));
  EXPECT_THAT(fault(steps({phase(moved("Rx", 1)), phase(""), phase(moved("Rx", 1))}, "", kCurves)),
              HasSubstr("x of 'bar' is free in one step"));
  EXPECT_THAT(fault(steps({phase(moved("Ru", 1)), phase("")}, "", kCurves)),
              HasSubstr("a rotation is prescribed while another one is free"));
  const std::string math =
      tag("LoadData", typed("load_controller", "math", tag("math", "t")).replace(16, 0, " id='1'"));
  EXPECT_THAT(fault(steps({phase(moved("Rx", 1)), phase(fixed("bar", "100000"))}, "", math)),
              HasSubstr("the load controller 1 of a value that changes from step to step"));
  EXPECT_EQ(fault(steps({phase(moved("Rx", 1)), phase(moved("Rx", 1))}, "", math)), "none");
}

}  // namespace
}  // namespace polhode::feb_phases_tests
