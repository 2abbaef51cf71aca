// SPDX-License-Identifier: Apache-2.0
// Files of FEBio with several steps, whose loads and connectors act in their step alone.
#include "feb_fixture.hpp"

namespace polhode::feb_steps_tests {
namespace {

using namespace feb_tests;
using testing::HasSubstr;

class FebSteps : public FebFixture {};

/// A step of DYNAMIC analysis.
std::string lasting(double seconds, const std::string& inside, double step = 0.01) {
  return tag("step",
             control("DYNAMIC", static_cast<int>(std::lround(seconds / step)), step) + inside);
}
std::string push(const std::string& force, const std::string& more = "") {
  return tag("Rigid", typed("rigid_load", "rigid_force",
                            tag("rb", "bar") + tag("dof", "Rx") + tag("value", force) + more));
}

// Speed 2 m/s after a second, for one more, and 1 m/s after half a second of twice the force.
TEST_F(FebSteps, LoadsActInTheirStepAlone) {
  const std::string one = format("{}", 2 * kMass), two = format("{}", -2 * kMass);
  const std::string text = two_bodies(
      "", "", tag("Step", lasting(1, push(one)) + lasting(1, "") + lasting(0.5, push(two))));
  Model m = read(text);
  EXPECT_NEAR(m.analysis.duration, 2.5, 1e-12);
  for (const double step : {0.1, 0.01, 1e-4}) {
    const BodyMotion bar = run(m, 2.5, step).body("bar");
    EXPECT_NEAR(bar.v.x(), 1.0, 1e-9) << step;
    EXPECT_NEAR(bar.r.x(), 1.0 + 2.0 + 0.75, 1e-9) << step;
  }
}

// A load up to a target rises over its step.
TEST_F(FebSteps, TargetsAreReachedAtTheEndOfTheStep) {
  const std::string text =
      two_bodies("", "",
                 tag("Step", lasting(1, "") +
                                 lasting(2, push(format("{}", 2 * kMass), tag("load_type", "2")))));
  for (const double step : kSteps)
    EXPECT_NEAR(run(read(text), 3.0, step).body("bar").v.x(), 2.0, error_at(step)) << step;
}

// Held in the first step, it falls in the second.
TEST_F(FebSteps, ConnectorsHoldInTheirStepAlone) {
  const std::string text = two_bodies(
      "", "",
      tag("Loads", typed("body_load", "const", tag("z", "10"))) +
          tag("Step", lasting(0.5, tag("Rigid", connector("rigid lock", ""))) + lasting(1, "")));
  for (const double step : kSteps) {
    EXPECT_NEAR(run(read(text), 0.5, step).body("bar").r.z(), 0.0, 1e-9) << step;
    EXPECT_NEAR(run(read(text), 1.5, step).body("bar").r.z(), -5.0, 1e-8) << step;
  }
  // A weight of one step is a force of that step, and a lock stops what moves.
  const std::string later =
      two_bodies("", "",
                 tag("Step", lasting(1, tag("Loads", typed("body_load", "const", tag("z", "10")))) +
                                 lasting(1, tag("Rigid", connector("rigid lock", "")))));
  const Model m = read(later);
  EXPECT_TRUE(m.gravity.isZero());
  for (const double step : kSteps)
    EXPECT_NEAR(run(m, 2.0, step).body("bar").r.z(), -5.0, 1e-7) << step;
}

// A body that is pushed for a second, then held where it is, and then pushed again.
TEST_F(FebSteps, BodiesAreHeldWhereTheStepFindsThem) {
  const std::string force = format("{}", 2 * kMass);
  const std::string text = two_bodies(
      "", "",
      tag("Step", lasting(1, push(force)) + lasting(0.5, tag("Rigid", fixed("bar", "111111"))) +
                      lasting(1, push(force))));
  for (const double step : kSteps) {
    EXPECT_NEAR(run(read(text), 0.5, step).body("bar").v.x(), 1.0, 1e-9) << step;
    const BodyMotion held = run(read(text), 1.5, step).body("bar");
    EXPECT_NEAR(held.r.x(), 1.0, 1e-8) << step;
    EXPECT_NEAR(held.v.norm(), 0.0, 1e-8) << step;
    EXPECT_NEAR(run(read(text), 2.5, step).body("bar").r.x(), 2.0, 1e-7) << step;
  }
}

// In its step a load has the part of its curve; v = integral of 1 + 4 t - t^2 from 1 to 2.
TEST_F(FebSteps, CurvesAreCutToTheStep) {
  const auto weight = [](const std::string& attributes) {
    return tag("Loads", typed("body_load", "const", tag("z", "-1", attributes)));
  };
  const auto speed = [&](const std::string& controller, double step) {
    const std::string text =
        two_bodies("", "",
                   tag("Step", lasting(1, "") + lasting(1, weight("lc='1'")) + lasting(1, "")) +
                       tag("LoadData", controller));
    return run(read(text), 3.0, step).body("bar").v.z();
  };
  for (const double step : kSteps) {
    const double exact = 1 + 6 - 7.0 / 3;
    EXPECT_NEAR(
        speed(typed("load_controller", "math", tag("math", "1+4*t-t^2")).replace(16, 0, " id='1'"),
              step),
        exact, error_at(step));
    // The parabola through three points.
    EXPECT_NEAR(speed(curve(1, "0,1;1,4;4,1", "SMOOTH"), step), exact, error_at(step));
    EXPECT_NEAR(speed(curve(1, "0,1;4,5"), step), 2.5, error_at(step));
  }
}

/// A block that lies on a plate, with contact of a kind between them in the first of two steps.
std::string on_a_plate(const std::string& type, const std::string& analysis = "DYNAMIC") {
  const std::string touch =
      tag("Contact", tag("contact", "", "name='c' type='" + type + "' surface_pair='pair'"));
  const auto part = [&](int steps, const std::string& inside) {
    return tag("step", control(analysis, steps, 0.01) + inside);
  };
  return feb(
      tag("Material", rigid(1, "plate") + rigid(2, "bar")) +
      tag("Mesh", block(1, "part", Vec3(-0.5, -0.1, -0.2), Vec3(0.5, 0.1, 0.2)) +
                      block(101, "floor", Vec3(-1, -1, -0.4), Vec3(1, 1, -0.2)) +
                      tag("Surface", tag("quad4", "105,106,107,108", "id='1'"), "name='top'") +
                      tag("Surface", tag("quad4", "1,4,3,2", "id='1'"), "name='bottom'") +
                      tag("SurfacePair", tag("primary", "bottom") + tag("secondary", "top"),
                          "name='pair'")) +
      tag("MeshDomains", domain("part", "bar") + domain("floor", "plate")) +
      tag("Rigid", fixed("plate", "111111")) +
      tag("Loads", typed("body_load", "const", tag("z", "10"))) +
      tag("Step", part(100, touch) + part(50, "")));
}

// It rests for a second and falls for another half.
TEST_F(FebSteps, ContactOfRigidBodiesActsInItsStepAlone) {
  const Model m = read(on_a_plate("sliding-elastic"));
  for (const double step : {0.01, 0.001}) {
    const double rest = run(m, 1.0, step).body("bar").r.z();
    EXPECT_NEAR(rest, 0.0, 0.02) << step;
    EXPECT_NEAR(run(m, 1.5, step).body("bar").r.z() - rest, -1.25, 0.02) << step;
  }
  EXPECT_THAT(fault(on_a_plate("tied-elastic")),
              HasSubstr("contact of one step of several is not read, except between rigid bodies"));
  EXPECT_THAT(fault(on_a_plate("sliding-elastic", "STATIC")),
              HasSubstr("contact of one step of several is not read, except between rigid bodies"));
}

TEST_F(FebSteps, SettingsOfStepsAreMerged) {
  const auto steps = [](const std::string& a, const std::string& b) {
    return two_bodies("", "", tag("Step", a + b));
  };
  const std::string text = steps(lasting(1, "", 0.1), lasting(1, "", 0.05));
  EXPECT_EQ(read(text).analysis.step, 0.05);
  EXPECT_THAT(notes(text), HasSubstr("all have the shortest length of a step"));
  EXPECT_THAT(notes(steps(lasting(1, ""), lasting(1, ""))), Not(HasSubstr("shortest length")));
  EXPECT_THAT(fault(steps(lasting(1, ""), tag("step", control("STATIC", 1, 1)))),
              HasSubstr("some steps are STATIC and others DYNAMIC"));
  EXPECT_THAT(fault(steps(lasting(1, ""), tag("step", ""))),
              HasSubstr("the step has no <Control>"));
  EXPECT_THAT(fault(steps(lasting(1, ""), lasting(1, tag("Rigid", fixed("bar", "110000"))))),
              HasSubstr("x of 'bar' is free in one step and fixed or prescribed in a later one"));
  const std::string start = tag("Rigid", typed("rigid_ic", "initial_rigid_velocity",
                                               tag("rb", "bar") + tag("value", "1,0,0")));
  EXPECT_EQ(fault(steps(lasting(1, start), lasting(1, ""))), "none");
  EXPECT_THAT(fault(steps(lasting(1, ""), lasting(1, start))),
              HasSubstr("<rigid_ic> of one step of several is not read"));
}

}  // namespace
}  // namespace polhode::feb_steps_tests
