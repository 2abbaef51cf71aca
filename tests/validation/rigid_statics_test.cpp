// SPDX-License-Identifier: Apache-2.0
// Equilibria with contacts and stops that are rows (law: rigid) against closed forms, in few and
// many load steps, and against the end of damped motions.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/contact/contact_reports.hpp>
#include <polhode/core/format.hpp>
#include <support/run_text.hpp>

namespace polhode::test::rigid_statics_tests {
namespace {

using ::testing::HasSubstr;

constexpr double kG = 9.81;

/// A model in statics, or with `analysis` in another analysis.
std::string model(const std::string& bodies, const std::string& law, const std::string& more = "",
                  const std::string& gravity = "[0, 0, -9.81]",
                  const std::string& analysis = "type: statics", const std::string& pairs = "") {
  return format(R"yaml(
format: 1
gravity: {}
bodies:
  floor: {{fixed: true, shape: {{plane: z}}}}
{}
{}
contacts: {{default: {{law: rigid{}}}{}}}
analysis: {{{}}}
output: {{hdf5: false}}
)yaml",
                gravity, bodies, more, law, pairs, analysis);
}

const std::string kLoadSteps[] = {"type: statics", "type: statics, load_steps: 3",
                                  "type: statics, load_steps: 20"};

/// Message of a run that must not end.
std::string refusal(Simulation& s) {
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::not_converged);
  return r.message;
}

ContactReport contact(const Simulation& s, int a, int b) {
  return s.contact(s.contact_pair(Side{a}, Side{b}));
}

constexpr const char* kBox =
    "  box: {shape: {box: [0.2, 0.2, 0.1]}, mass: 2, position: [0, 0, "
    "0.05]}";

std::string inclined(double angle) {
  return format("[{}, 0, {}]", kG * std::sin(angle), -kG * std::cos(angle));
}

}  // namespace

// @tests{statics-rows}
TEST(RigidStatics, ABoxOnAnInclineStaysBelowTheFrictionAngle) {
  const double mu = 0.5;
  for (const double part : {0.0, 0.5, 0.999})
    for (const std::string& steps : kLoadSteps) {
      const double angle = std::atan(part * mu);
      Simulation s = made(model(kBox, ", friction: 0.5", "", inclined(angle), steps));
      const RunSummary r = finished(s);
      EXPECT_LT((s.body(1).r - Vec3(0, 0, 0.05)).norm(), 1e-11) << part;
      const ContactReport c = contact(s, 1, 0);
      EXPECT_NEAR(c.normal_force, 2 * kG * std::cos(angle), 1e-9);
      EXPECT_NEAR(std::abs(c.friction.x()), 2 * kG * std::sin(angle), 1e-9);
      EXPECT_EQ(c.points, 4);
      EXPECT_EQ(r.statics->unstable, 0);
    }
}

TEST(RigidStatics, ABoxBeyondTheFrictionAngleIsSaidToSlide) {
  for (const std::string& steps : {kLoadSteps[0], kLoadSteps[1]}) {
    Simulation s =
        made(model(kBox, ", friction: 0.5", "", inclined(std::atan(1.001 * 0.5)), steps));
    const std::string message = refusal(s);
    EXPECT_THAT(message, HasSubstr("nothing holds the model: body 'box' moves along x"));
    EXPECT_THAT(message, HasSubstr("slides, at the contact of body 'box' and the ground"));
    EXPECT_THAT(message, HasSubstr("Hold it by a joint, a spring or more friction"));
    EXPECT_LT(s.summary().statics->iterations, 250);  // of eight load steps
  }
  Simulation smooth = made(model(kBox, "", "", inclined(0.01)));
  EXPECT_THAT(refusal(smooth), HasSubstr("nothing holds the model: body 'box'"));
  Simulation static_one =
      made(model(kBox, ", friction: 0.4, static_friction: 0.5", "", inclined(std::atan(0.499))));
  finished(static_one);
  EXPECT_LT((static_one.body(1).r - Vec3(0, 0, 0.05)).norm(), 1e-11);
}

// Without friction, and level, it is free to move: this is said, and it stays.
TEST(RigidStatics, WhatFrictionDoesNotHoldIsNamedAsFree) {
  Simulation s = made(model(kBox, ""));
  const RunSummary r = finished(s);
  EXPECT_EQ(r.statics->free_motions.size(), 3u);
  EXPECT_LT((s.body(1).r - Vec3(0, 0, 0.05)).norm(), 1e-11);
}

// @tests{statics-friction-jump}
// A ladder, a rod with round ends, between a smooth wall and a rough floor: with the centres of its
// ends L apart at an angle θ, H (L sin θ + r) = m g L/2 cos θ.
TEST(RigidStatics, ALadderStandsIfFrictionIsEnough) {
  const double L = 2.0, r = 0.05, theta = 1.0, m = 3.0;
  const double H = m * kG * 0.5 * L * std::cos(theta) / (L * std::sin(theta) + r);
  const auto ladder = [&](double mu, const std::string& steps) {
    return model(format("  wall: {{fixed: true, shape: {{plane: x}}}}\n"
                        "  ladder: {{shape: {{capsule: [{}, {}]}}, mass: {}, position: [{}, 0, "
                        "{}], orientation: {{axis: y, angle: {} rad}}}}",
                        2 * r, L + 2 * r, m, r + 0.5 * L * std::cos(theta),
                        r + 0.5 * L * std::sin(theta), theta - 0.5 * std::numbers::pi),
                 format(", friction: {}", mu), "", "[0, 0, -9.81]", steps,
                 ", pairs: {smooth: {between: [ladder, wall], friction: 0}}");
  };
  for (const std::string& steps : kLoadSteps) {
    Simulation s = made(ladder(1.001 * H / (m * kG), steps));
    const Vec3 start = s.body(2).r;
    finished(s);
    EXPECT_LT((s.body(2).r - start).norm(), 1e-11);
    EXPECT_NEAR(contact(s, 2, 1).normal_force, H, 1e-8);
    EXPECT_NEAR(contact(s, 2, 0).normal_force, m * kG, 1e-8);
    EXPECT_NEAR(contact(s, 2, 0).friction.norm(), H, 1e-8);
  }
  for (const std::string& steps : kLoadSteps)
    for (const double part : {0.3, 0.999}) {
      Simulation slides = made(ladder(part * H / (m * kG), steps));
      EXPECT_THAT(refusal(slides), HasSubstr("body 'ladder' and the ground"));
    }
}

// @tests{statics-row-problem}
// A rigid bar on three supports, loaded beyond the last of them. The smallest forces are a + b x;
// the first support is left where it would have to pull, and two carry the bar. Forces balance to
// 1e-9 of the largest, at arms of 1.5.
TEST(RigidStatics, ABarLiftsOffTheSupportThatWouldPull) {
  const double W = 10.0 * kG;
  for (const double P : {40.0, 78.0, 79.0, 120.0})
    for (const std::string& steps : kLoadSteps) {
      std::string supports;
      for (int i = -1; i < 2; ++i)
        supports += format(
            "  s{}: {{fixed: true, shape: {{sphere: 0.2}}, position: [{}, 0, "
            "-0.15]}}\n",
            i + 1, i);
      Simulation s = made(model(
          supports + "  bar: {shape: {box: [4, 0.1, 0.1]}, mass: 10, position: [0, 0, 0]}", "",
          format("joints: {{guide: {{type: planar, bodies: [ground, bar], at: [0, 0, 0], "
                 "axis: y}}}}\nloads: {{P: {{type: force, body: bar, at: [1.5, 0, 0], "
                 "force: [0, 0, -{}]}}}}",
                 P),
          "[0, 0, -9.81]", steps, ", exclude: [[bar, floor]]"));
      finished(s);
      const bool lifts = (W + P) / 3 < 0.75 * P;
      const double first = lifts ? 0.0 : (W + P) / 3 - 0.75 * P;
      const double last = lifts ? 1.5 * P : (W + P) / 3 + 0.75 * P;
      EXPECT_NEAR(contact(s, 4, 1).normal_force, first, 1e-6) << P;
      EXPECT_NEAR(contact(s, 4, 3).normal_force, last, 1e-6) << P;
      EXPECT_NEAR(contact(s, 4, 2).normal_force, W + P - first - last, 1e-6) << P;
      EXPECT_NEAR(s.body(4).r.z(), 0.0, 1e-11);
      EXPECT_EQ(contact(s, 4, 1).points > 0, !lifts);
    }
}

// A table on four legs with a load off its centre: the smallest forces are those of a plane.
TEST(RigidStatics, FourLegsShareALoadByThePlane) {
  const double W = 20 * kG, P = 30, e = 0.2, f = -0.1;
  for (const char* law : {"", ", friction: 0.3"})
    for (const std::string& steps : kLoadSteps) {
      Simulation s = made(
          model("  table: {shape: {box: [1, 0.8, 0.1]}, mass: 20, position: [0, 0, 0.05]}", law,
                format("loads: {{P: {{type: force, body: table, at: [{}, {}, 0.1], force: [0, "
                       "0, -{}]}}}}",
                       e, f, P),
                "[0, 0, -9.81]", steps));
      finished(s);
      int legs = 0;
      for (const contact::TouchingPoint& p : s.contact_points()) {
        ++legs;
        // The plane through the four places, whose corners are rounded.
        const double x = p.point.x(), y = p.point.y();
        EXPECT_NEAR(p.force.z(), 0.25 * (W + P * (1 + e / x + f / y)), 1e-7) << x << " " << y;
      }
      EXPECT_EQ(legs, 4);
    }
}

// A pendulum that gravity presses on its stop, from the stop and from above it.
TEST(RigidStatics, APendulumRestsOnItsStop) {
  const double L = 0.7, m = 2.0, stop = 0.5;
  for (const double start : {0.5, 0.9, 1.4})
    for (const std::string& steps : kLoadSteps) {
      Simulation s = made(
          model(format("  bob: {{shape: {{sphere: 0.1}}, mass: {}, position: [{}, 0, {}], "
                       "orientation: {{axis: y, angle: {} rad}}}}",
                       m, -L * std::sin(start), 2 - L * std::cos(start), start),
                "",
                format("joints: {{hinge: {{type: revolute, bodies: [ground, bob], at: [0, 0, 2], "
                       "axis: y, limits: {{lower: {} rad, upper: 1 rad}}}}}}",
                       stop - start),
                "[0, 0, -9.81]", steps));
      const RunSummary r = finished(s);
      const JointReport j = s.joint(0);
      EXPECT_NEAR(j.coordinates[0], stop - start, 1e-11);
      EXPECT_NEAR(s.body(1).r.x(), -L * std::sin(stop), 1e-11);
      EXPECT_NEAR(j.stops.at(0), m * kG * L * std::sin(stop), 1e-8);
      EXPECT_EQ(r.statics->unstable, 0);
    }
}

// A wedge of angle α under the tip of a weight: without friction the spring carries W tan α.
TEST(RigidStatics, ASpringPressesAWedgeUnderAWeight) {
  const double alpha = 0.3, k = 400, W = 5 * kG;
  for (const double apart : {0.0, 0.03})
    for (const std::string& steps : kLoadSteps) {
      Simulation s = made(model(
          format("  wedge: {{shape: {{box: [0.6, 0.2, 0.1]}}, mass: 1, position: [0, 0, 0.5], "
                 "orientation: {{axis: y, angle: {} rad}}}}\n"
                 "  weight: {{shape: {{sphere: 0.1}}, mass: 5, position: [0, 0, {}]}}",
                 alpha, 0.5 + (0.05 + 0.05) / std::cos(alpha) + apart),
          "",
          "joints:\n  x: {type: prismatic, bodies: [ground, wedge], at: [0, 0, 0.5], axis: x}\n"
          "  z: {type: prismatic, bodies: [ground, weight], at: [0, 0, 0.5], axis: z}\n" +
              format("loads: {{k: {{type: translational_spring, joint: x, stiffness: {}}}}}", k),
          "[0, 0, -9.81]", steps));
      finished(s);
      // The wedge falls towards +x: the weight drives it back, against +x of its slope.
      const double x = W * std::tan(alpha) / k;
      EXPECT_NEAR(std::abs(s.body(1).r.x()), x, 1e-10);
      EXPECT_NEAR(s.body(2).r.z(), 0.5 + 0.1 / std::cos(alpha) - x * std::tan(alpha), 1e-10);
      EXPECT_NEAR(contact(s, 2, 1).normal_force, W / std::cos(alpha), 1e-8);
    }
}

// A mass between two walls on a spring: free between them, stopped at them, one of two at play 0.
TEST(RigidStatics, AMassBetweenTwoWallsTouchesTheOneItIsPushedTo) {
  const double k = 200;
  for (const double play : {0.0, 0.02, 0.2})
    for (const double F : {-30.0, -2.0, 10.0})
      for (const std::string& steps : kLoadSteps) {
        Simulation s = made(model(
            format("  left: {{fixed: true, shape: {{box: [0.001, 1, 1]}}, position: [{0}, 0, 2]}}\n"
                   "  right: {{fixed: true, shape: {{box: [0.001, 1, 1]}}, position: [{1}, 0, "
                   "2]}}\n  m: {{shape: {{box: [0.2, 0.2, 0.2]}}, mass: 1, position: [0, 0, 2]}}",
                   -0.1005 - play, 0.1005 + play),
            ", friction: 0.3",
            format("joints: {{x: {{type: prismatic, bodies: [ground, m], at: [0, 0, 2], axis: "
                   "x}}}}\nloads:\n  k: {{type: translational_spring, joint: x, stiffness: {}}}\n"
                   "  F: {{type: force, body: m, force: [{}, 0, 0]}}",
                   k, F),
            "[0, 0, 0]", steps));
        finished(s);
        const double x = std::clamp(F / k, -play, play), N = std::abs(F - k * x);
        EXPECT_NEAR(s.body(3).r.x(), x, 1e-11) << play << " " << F;
        EXPECT_NEAR(contact(s, 3, F < 0 ? 1 : 2).normal_force, N, 1e-8) << play << " " << F;
        EXPECT_NEAR(contact(s, 3, F < 0 ? 2 : 1).normal_force, 0.0, 1e-8);
      }
}

// A block on a rough floor pulled over a spring: it stays up to μ m g, then stretches by the rest.
TEST(RigidStatics, ABlockSlidesUntilItsSpringCarriesTheRest) {
  const double mu = 0.3, m = 2.0, k = 500;
  for (const double F : {3.0, 5.8, 6.5, 20.0})
    for (const std::string& steps : kLoadSteps) {
      Simulation s =
          made(model(kBox, format(", friction: {}", mu),
                     format("loads:\n  k: {{type: spring_damper, bodies: [ground, box], at: [[-3, "
                            "0, 0.05], [0, 0, 0.05]], stiffness: {}}}\n  F: {{type: force, body: "
                            "box, at: [0, 0, 0], force: [{}, 0, 0]}}",
                            k, F),
                     "[0, 0, -9.81]", steps));
      finished(s);
      EXPECT_NEAR(s.body(1).r.x(), std::max(0.0, F - mu * m * kG) / k, 1e-9) << F;
    }
}

// A block on a spring, pulled more and more: it slides from F = μ m g on, and with μ_s above μ it
// would jump at μ_s m g.
TEST(RigidStatics, AJumpFromStaticFrictionIsRefusedWhereItOccurs) {
  const double mu = 0.3, mu_s = 0.4, m = 2.0, k = 500;
  const auto pulled = [&](const std::string& law) {
    return model(kBox, law,
                 format("loads:\n  k: {{type: spring_damper, bodies: [ground, box], at: [[-3, 0, "
                        "0.05], [0, 0, 0.05]], stiffness: {}}}\n  F: {{type: force, body: box, at: "
                        "[0, 0, 0], force: [\"20*t\", 0, 0]}}",
                        k),
                 "[0, 0, -9.81]", "type: statics, history: 1 s, load_steps: 7");
  };
  Simulation slides = made(pulled(", friction: 0.3"));
  finished(slides);
  EXPECT_NEAR(slides.body(1).r.x(), (20 - mu * m * kG) / k, 1e-9);
  Simulation jumps = made(pulled(", friction: 0.3, static_friction: 0.4"));
  EXPECT_THAT(refusal(jumps), HasSubstr("the contact of body 'box' and the ground"));
  EXPECT_NEAR(jumps.time(), mu_s * m * kG / 20, 1e-4);
  EXPECT_LT(std::abs(jumps.body(1).r.x()), 1e-11);
}

// Without stiffness before it touches, a body falls to the floor at any load.
TEST(RigidStatics, AFallEndsOnTheFloorInFewIterations) {
  for (const char* friction : {"", ", friction: 0.3"}) {
    Simulation s = made(
        model("  box: {shape: {box: [0.2, 0.2, 0.1]}, mass: 2, position: [0, 0, 1.05]}", friction));
    const RunSummary r = finished(s);
    EXPECT_NEAR(s.body(1).r.z(), 0.05, 1e-11);
    EXPECT_NEAR(contact(s, 1, 0).normal_force, 2 * kG, 1e-8);
    EXPECT_LT(r.statics->iterations, 40) << friction;
  }
}

// @tests{statics-closing}
// A thin plate far below: one load step takes the body to it and not through it.
TEST(RigidStatics, NothingIsPassedThrough) {
  const char* const bodies =
      "  plate: {fixed: true, shape: {box: [1, 1, 0.001]}, position: [0, 0, 1]}\n"
      "  pad: {shape: {SHAPE}, mass: 1, position: [0, 0, 3], orientation: {axis: [1, 2, 3], angle: "
      "20 deg}}";
  for (const char* shape : {"sphere: 0.02", "box: [0.02, 0.03, 0.01]", "cylinder: [0.02, 0.05]"}) {
    std::string text = bodies;
    text.replace(text.find("SHAPE"), 5, shape);
    for (const std::string& steps : kLoadSteps) {
      Simulation s = made(
          model(text, ", friction: 0.2",
                "joints: {z: {type: prismatic, bodies: [ground, pad], at: [0, 0, 3], axis: z}}\n"
                "loads: {k: {type: translational_spring, joint: z, stiffness: 10}, F: {type: "
                "force, body: "
                "pad, force: [0, 0, -300]}}",
                "[0, 0, 0]", steps));
      finished(s);
      const ContactReport c = contact(s, 2, 1);
      EXPECT_NEAR(c.normal_force, 300 - 10 * (3 - s.body(2).r.z()), 1e-7) << shape;
      EXPECT_GT(s.body(2).r.z(), 1.0) << shape;
      EXPECT_NEAR(c.gap, 0.0, 1e-10) << shape;
    }
  }
}

// The equilibrium is where a damped motion with the same rows ends.
TEST(RigidStatics, ADampedMotionEndsAtTheEquilibrium) {
  const auto text = [&](const std::string& analysis) {
    return model(
        "  post: {fixed: true, shape: {sphere: 0.2}, position: [0.4, 0, -0.3]}\n"
        "  arm: {shape: {capsule: [0.06, 1]}, mass: 2, position: [0.5, 0, 0], orientation: {axis: "
        "y, angle: 90 deg}}",
        ", friction: 0",
        "joints: {hinge: {type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: y}}\n"
        "loads: {k: {type: torsional_spring, joint: hinge, stiffness: 3, damping: 2}}",
        "[0, 0, -9.81]", analysis, ", exclude: [[arm, floor]]");
  };
  Simulation moves = made(text("type: dynamics, duration: 4, step: 2 ms"));
  finished(moves);
  for (const std::string& steps : kLoadSteps) {
    Simulation s = made(text(steps));
    finished(s);
    EXPECT_LT((s.body(2).r - moves.body(2).r).norm(), 1e-9);
    EXPECT_NEAR(contact(s, 2, 1).normal_force, contact(moves, 2, 1).normal_force, 1e-6);
    // The tangent from the hinge to a ball of both radii: its distance is 0.5, its angle atan 3/4.
    const double angle = std::atan2(0.3, 0.4) - std::asin(0.13 / 0.5);
    EXPECT_NEAR(s.joint(0).coordinates[0], angle, 1e-10);
    const double moment = 2 * kG * 0.5 * std::cos(angle) - 3 * angle;
    EXPECT_NEAR(contact(s, 2, 1).normal_force, moment / std::sqrt(0.25 - 0.13 * 0.13), 1e-7);
  }
}

TEST(RigidStatics, OtherLawsAreRefusedByName) {
  std::string text = model(kBox, "");
  text.replace(text.find("law: rigid"), 10, "law: barrier");
  expect_fault(text, "needs contacts.default law: rigid");
}

}  // namespace polhode::test::rigid_statics_tests
