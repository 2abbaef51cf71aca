// SPDX-License-Identifier: Apache-2.0
// Stops of joints that are rows of the step (law: rigid) against closed forms and conserved
// quantities, at coarse and fine steps.
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/results/checkpoint.hpp>
#include <support/run_text.hpp>

namespace polhode::test::rigid_stops_tests {
namespace {

/// A model whose stops are rows.
std::string model(const std::string& bodies, const std::string& joints, double T, double h,
                  const std::string& more = "", const std::string& gravity = "[0, 0, 0]",
                  const std::string& rest = "") {
  return format(R"yaml(
format: 1
gravity: {}
bodies:
{}
joints:
{}
{}
contacts: {{default: {{law: rigid{}}}}}
analysis: {{type: dynamics, duration: {}, step: {}}}
output: {{hdf5: false}}
)yaml",
                gravity, bodies, joints, more, rest, T, h);
}

/// Runs to the end; the balances of energy and of linear momentum must close.
RunSummary closed(Simulation& s) {
  const RunSummary r = finished(s);
  EXPECT_EQ(r.rejected_steps, 0);
  EXPECT_LT(r.energy_drift, 1e-11);
  EXPECT_LT(r.linear_momentum_drift, 1e-10);
  return r;
}

/// Velocities of a closed row are increments of positions of about 1 m over a step.
double speed_noise(double h) { return 1e-12 + 8.0 * 2.2e-16 / h; }
/// Forces in a step are second differences of such positions; the mass is 2 kg.
double force_noise(double h) { return 1e-10 + 2.0 * 16.0 * 2.2e-16 / (h * h); }

constexpr const char* kBlock =
    "  block: {shape: {box: [0.2, 0.1, 0.1]}, mass: 2, velocity: [2, 0, 0]}";

/// A bar of 1 m that turns about its end in the origin by an angle, with a rate.
std::string bar(const std::string& name, double x, double y, double angle, double vx, double vy,
                double rate) {
  return format(
      "  {}: {{shape: {{box: [1, 0.05, 0.05]}}, mass: 1, position: [{}, {}, 0], orientation: "
      "{{axis: z, angle: {} rad}}, velocity: [{}, {}, 0], angular_velocity: [0, 0, {}]}}\n",
      name, x + 0.5 * std::cos(angle), y + 0.5 * std::sin(angle), angle,
      vx - 0.5 * rate * std::sin(angle), vy + 0.5 * rate * std::cos(angle), rate);
}

/// Two bars, the first on the ground, with a stop between them that both reach after about 9 ms.
std::string elbow(double e, double h, const std::string& base, double T = 0.03) {
  const double w1 = 1.0, w2 = 4.0, a1 = 0.3, bend = -0.03, a2 = a1 + bend;
  return model(
      bar("upper", 0.0, 0.0, a1, 0.0, 0.0, w1) +
          bar("fore", std::cos(a1), std::sin(a1), a2, -w1 * std::sin(a1), w1 * std::cos(a1), w2),
      base + format("  elbow: {{type: revolute, bodies: [upper, fore], at: [{}, {}, 0], "
                    "axis: z, limits: {{upper: {} rad, restitution: {}}}}}",
                    std::cos(a1), std::sin(a1), 0.7 * -bend, e),
      T, h);
}

constexpr const char* kShoulder =
    "  shoulder: {type: revolute, bodies: [ground, upper], at: [0, 0, 0], axis: z}\n";

}  // namespace

// e times the speed before, whatever part of the step has passed when the stop is reached.
TEST(RigidStops, ASliderAndAHingeReturnTheirRestitution) {
  for (const double e : {0.0, 0.5, 1.0})
    for (const double h : {1e-2, 1e-3, 1e-4, 1e-5}) {
      const double T = h < 1e-4 ? 2e-3 : 0.02, gap = 1.3 * T / 2.0;
      Simulation slides = made(model(kBlock,
                                     format("  slide: {{type: prismatic, bodies: [ground, block], "
                                            "at: [0, 0, 0], axis: x, limits: {{upper: {}, "
                                            "restitution: {}}}}}",
                                            gap, e),
                                     T, h));
      closed(slides);
      EXPECT_NEAR(slides.body(0).v[0], -2.0 * e, 1e-12) << h << " e " << e;
      Simulation turns = made(model(bar("bar", 0.0, 0.0, 0.0, 0.0, 0.0, 2.0),
                                    format("  hinge: {{type: revolute, bodies: [ground, bar], at: "
                                           "[0, 0, 0], axis: z, limits: {{upper: {} rad, "
                                           "restitution: {}}}}}",
                                           gap, e),
                                    T, h));
      closed(turns);
      EXPECT_NEAR(turns.joint(0).rates[0], -2.0 * e, speed_noise(h)) << h << " e " << e;
      EXPECT_NEAR(turns.balance().kinetic, e * e * 0.5 * (1.0 / 3.0 + 0.05 * 0.05 / 12.0) * 4.0,
                  5e-12)
          << h << " e " << e;
    }
}

// Energy and angular momentum about the shoulder give both rates at the stop before the impact;
// after it the relative rate is -e times that, and angular momentum is the same.
TEST(RigidStops, AnElbowReturnsItsRestitutionAndKeepsAngularMomentum) {
  for (const double e : {0.0, 0.5, 1.0})
    for (const double h : {1e-2, 1e-3, 1e-4, 1e-5}) {
      Simulation s = made(elbow(e, h, kShoulder, h < 1e-4 ? 0.014 : 0.02));
      const double E = s.balance().kinetic, L = s.balance().angular_momentum[2];
      closed(s);
      // T = ½ (A a² + 2 B a d + C d²), L = A a + B d with a the rate of the first bar and d that of
      // the elbow, at the elbow's angle of the stop.
      const double J = 1.0 / 3.0 + 0.05 * 0.05 / 12.0, c = std::cos(0.7 * 0.03 - 0.03);
      const double A = 2.0 * J + 1.0 + c, B = J + 0.5 * c, C = J;
      const double d2 = (2.0 * E - L * L / A) / (C - B * B / A);
      EXPECT_NEAR(s.balance().angular_momentum[2], L, 1e-12) << h;
      EXPECT_NEAR(s.balance().kinetic, 0.5 * (L * L / A + (C - B * B / A) * d2 * e * e), 1e-11)
          << h << " e " << e;
    }
}

// Two bars that float freely: both momenta are those of the start, and with e = 1 so is the energy.
TEST(RigidStops, AFreeElbowKeepsItsMomenta) {
  for (const double e : {0.0, 0.5, 1.0})
    for (const double h : {1e-2, 1e-3, 1e-4}) {
      Simulation s = made(elbow(e, h, ""));
      const double E = s.balance().kinetic;
      closed(s);
      EXPECT_LE(s.balance().kinetic, E * (1.0 + 2e-12)) << h;
      if (e == 1.0) {
        EXPECT_NEAR(s.balance().kinetic, E, 2e-12 * E) << h;
      }
      if (e < 1.0) {
        EXPECT_LT(s.balance().kinetic, 0.99 * E) << h;
      }
    }
}

// A loop has one freedom: its kinetic energy at the stop is e² of that before the impact.
TEST(RigidStops, AStopInAFourBarReturnsItsRestitution) {
  struct Point {
    double x, y;
  };
  const Point A{0.0, 0.0}, B{0.1, 0.3}, C{0.8, 0.5}, D{0.9, 0.0};
  const auto rod = [](const std::string& name, Point p, Point q, const std::string& moves) {
    return format(
        "  {}: {{shape: {{box: [{}, 0.03, 0.03]}}, mass: 1, position: [{}, {}, 0], orientation: "
        "{{axis: z, angle: {} rad}}{}}}\n",
        name, std::hypot(q.x - p.x, q.y - p.y), 0.5 * (p.x + q.x), 0.5 * (p.y + q.y),
        std::atan2(q.y - p.y, q.x - p.x), moves);
  };
  const auto hinge = [](const std::string& name, const std::string& pair, Point p,
                        const std::string& more) {
    return format("  {}: {{type: revolute, bodies: {}, at: [{}, {}, 0], axis: z{}}}\n", name, pair,
                  p.x, p.y, more);
  };
  for (const double e : {0.0, 0.5, 1.0})
    for (const double h : {1e-2, 1e-3, 1e-4}) {
      Simulation s = made(model(
          rod("crank", A, B, ", angular_velocity: [0, 0, 15], velocity: [-2.25, 0.75, 0]") +
              rod("coupler", B, C, "") + rod("rocker", D, C, ""),
          hinge("a", "[ground, crank]", A, "") + hinge("b", "[crank, coupler]", B, "") +
              hinge("c", "[coupler, rocker]", C,
                    format(", limits: {{lower: -0.03 rad, upper: 0.03 rad, restitution: {}}}", e)) +
              hinge("d", "[rocker, ground]", D, ""),
          0.04, h));
      const double E = s.balance().kinetic;
      closed(s);
      EXPECT_NEAR(s.balance().kinetic, e * e * E, 2e-11 * E) << h << " e " << e;
      EXPECT_LE(std::abs(s.joint("c").coordinates[0]), 0.03 + 1e-12);
    }
}

// Two rails with a stop each: which of them acts is not determined, and both carry the same.
TEST(RigidStops, TwoStopsOfOneMotionShareTheirLoad) {
  for (const double h : {1e-2, 1e-3, 1e-4}) {
    const auto rail = [](const std::string& name, double y, double e) {
      return format(
          "  {}: {{type: prismatic, bodies: [ground, block], at: [0, {}, 0], axis: x, limits: "
          "{{upper: 0.0123, restitution: {}}}}}\n",
          name, y, e);
    };
    const auto rails = [&](double e) { return rail("left", 0.1, e) + rail("right", -0.1, e); };
    Simulation bounces = made(model(kBlock, rails(0.5), 0.03, h));
    closed(bounces);
    EXPECT_NEAR(bounces.body(0).v[0], -1.0, 2e-12) << h;
    Simulation rests = made(model(kBlock, rails(0.0), 0.05, h, "", "[7, 0, 0]"));
    closed(rests);
    // Shares have a rounding of their own, see kProximalOfGuess; their sum has none.
    const double first = rests.joint(0).stops[0], second = rests.joint(1).stops[0];
    EXPECT_NEAR(first + second, -14.0, 2.0 * force_noise(h)) << h;
    EXPECT_NEAR(first - second, 0.0, 1e-8) << h;
  }
}

// A load that presses a joint against its stop moves it by nothing, and the stop carries it.
TEST(RigidStops, APressedJointRestsExactlyAtItsLimit) {
  for (const double h : {1e-2, 1e-3, 1e-4, 1e-5}) {
    const double T = h < 1e-4 ? 2e-3 : 0.1;
    Simulation s = made(
        model("  block: {shape: {box: [0.2, 0.1, 0.1]}, mass: 2}\n" +
                  bar("rod", 0.0, 1.0, 0.0, 0.0, 0.0, 0.0),
              "  slide: {type: prismatic, bodies: [ground, block], at: [0, 0, 0], axis: x, limits: "
              "{upper: 0}}\n"
              "  hinge: {type: revolute, bodies: [ground, rod], at: [0, 1, 0], axis: z, limits: "
              "{lower: 0 rad}}",
              T, h, "", "[3, -9.81, 0]"));
    EXPECT_EQ(finished(s).rejected_steps, 0);
    EXPECT_NEAR(s.joint("slide").coordinates[0], 0.0, 1e-15) << h;
    EXPECT_NEAR(s.joint("hinge").coordinates[0], 0.0, 1e-15) << h;
    EXPECT_NEAR(s.joint("slide").rates[0], 0.0, speed_noise(h)) << h;
    EXPECT_NEAR(s.joint("slide").stops[0], -6.0, force_noise(h)) << h;
    EXPECT_NEAR(s.joint("hinge").stops[0], 0.5 * 9.81, force_noise(h)) << h;
    EXPECT_NEAR(s.joint("hinge").force[1], 9.81, force_noise(h)) << h;
  }
}

// Bounces of e = 0.5 become shorter than any step; the block ends at rest at its stop.
TEST(RigidStops, ABouncingSliderComesToRest) {
  for (const double h : {1e-2, 1e-3, 1e-4}) {
    Simulation s = made(model("  block: {shape: {box: [0.2, 0.1, 0.1]}, mass: 2}",
                              "  slide: {type: prismatic, bodies: [ground, block], at: [0, 0, 0], "
                              "axis: x, limits: {upper: "
                              "0.01, restitution: 0.5}}",
                              0.8, h, "", "[9, 0, 0]"));
    const RunSummary r = closed(s);
    EXPECT_NEAR(s.joint(0).coordinates[0], 0.01, 1e-15) << h;
    EXPECT_NEAR(s.joint(0).rates[0], 0.0, speed_noise(h)) << h;
    EXPECT_NEAR(s.joint(0).stops[0], -18.0, force_noise(h)) << h;
    EXPECT_LE(static_cast<double>(r.newton_iterations), 3.5 * static_cast<double>(r.steps)) << h;
  }
}

// Lower and upper end are two rows: between them nothing acts, and e = 1 keeps the speed.
TEST(RigidStops, ARattlingSliderKeepsItsSpeed) {
  for (const double h : {1e-2, 1e-3, 1e-4}) {
    Simulation s = made(model(kBlock,
                              "  slide: {type: prismatic, bodies: [ground, block], at: [0, 0, 0], "
                              "axis: x, limits: {lower: -0.031, upper: 0.023, restitution: 1}}",
                              0.2, h));
    closed(s);
    EXPECT_NEAR(std::abs(s.body(0).v[0]), 2.0, 1e-11) << h;
    EXPECT_GE(s.body(0).r[0], -0.031 - 1e-14);
    EXPECT_LE(s.body(0).r[0], 0.023 + 1e-14);
  }
}

// A ball hits a block that rests at its stop: the stop's row takes part, and the ball returns as
// from a wall.
TEST(RigidStops, AStopTakesPartInTheImpactOfAContact) {
  for (const double e : {0.0, 0.5, 1.0})
    for (const double h : {1e-2, 1e-3, 1e-4}) {
      Simulation s = made(model(
          "  block: {shape: {box: [0.2, 0.1, 0.1]}, mass: 2}\n"
          "  ball: {shape: {sphere: 0.1}, mass: 1, position: [-0.162, 0, 0], velocity: [1, "
          "0, 0]}",
          "  slide: {type: prismatic, bodies: [ground, block], at: [0, 0, 0], axis: x, limits: "
          "{upper: 0, restitution: 0.7}}",
          0.03, h, "", "[0, 0, 0]", format(", restitution: {}", e)));
      closed(s);
      EXPECT_NEAR(s.body("ball").v[0], -e, speed_noise(h)) << h << " e " << e;
      EXPECT_NEAR(s.body("block").r[0], 0.0, 1e-13) << h;
      EXPECT_NEAR(s.joint(0).impulses.at(0)[0], -(1.0 + e), 1e-11) << h;
    }
}

// A taut link is a stop of a distance.
TEST(RigidStops, ASlackLinkReturnsItsRestitution) {
  for (const double e : {0.0, 0.5, 1.0})
    for (const double h : {1e-2, 1e-3, 1e-4}) {
      Simulation s = made(model(
          "  ball: {shape: {sphere: 0.1}, mass: 1.5, position: [0.2, 0, 0], velocity: [1, 0.3, "
          "0]}",
          format("  leash: {{type: slack_link, bodies: [ground, ball], at: [[0, 0, 0], [0.2, "
                 "0, 0]], limits: {{upper: 0.213, restitution: {}}}}}",
                 e),
          0.02, h));
      closed(s);
      // The speed across the link stays, as angular momentum says, with the link's length.
      const double across = 0.2 * 0.3 / 0.213, along2 = 1.09 - across * across;
      const double after = s.balance().kinetic / 0.75;
      EXPECT_NEAR(after, across * across + e * e * along2, 1e-11) << h << " e " << e;
    }
}

// A cart rolls freely on a driven carriage until its stop carries it along.
TEST(RigidStops, WorkOfADriveIsThatOfTheStopsImpulse) {
  for (const double e : {0.0, 0.5, 1.0})
    for (const double h : {1e-2, 1e-3, 1e-4}) {
      Simulation s = made(model(
          "  carriage: {mass: 10, inertia: [1, 1, 1], velocity: [1, 0, 0], motion: {x: t, y: 0, "
          "z: 0, rotation_vector: [0, 0, 0]}}\n"
          "  cart: {mass: 2, inertia: [1, 1, 1]}",
          format("  track: {{type: prismatic, bodies: [carriage, cart], at: [0, 0, 0], axis: "
                 "x, limits: {{lower: -53 mm, upper: 1, restitution: {}}}}}",
                 e),
          0.1, h));
      closed(s);
      EXPECT_NEAR(s.body("cart").v[0], 1.0 + e, 1e-12) << h << " e " << e;
      EXPECT_NEAR(s.joint("track").impulses.at(0)[0], 2.0 * (1.0 + e), 1e-11) << h;
      EXPECT_NEAR(s.joint("carriage.motion").work.at(0), 2.0 * (1.0 + e), 1e-10) << h;
      EXPECT_NEAR(s.balance().dissipated, 1.0 - e * e, 1e-11) << h;
    }
}

// Five hanging bars swing, with stops at every second hinge: e = 1 keeps the energy whatever stops
// act at once, and others only take from it.
TEST(RigidStops, AChainKeepsItsEnergyAtItsStops) {
  std::string bars, hinges;
  for (int k = 0; k < 5; ++k) {
    bars += bar(format("b{}", k), k, 0.0, 0.0, 0.0, 0.0, 0.0);
    const std::string on = k == 0 ? "ground" : format("b{}", k - 1);
    hinges += format("  h{}: {{type: revolute, bodies: [{}, b{}], at: [{}, 0, 0], axis: z{}}}\n", k,
                     on, k, k,
                     k % 2 == 1 ? ", limits: {lower: -0.2 rad, upper: 0.15 rad, "
                                  "restitution: $e}"
                                : "");
  }
  for (const double e : {0.0, 0.5, 1.0})
    for (const double h : {1e-2, 1e-3, 1e-4}) {
      std::string joints = hinges;
      for (std::size_t at; (at = joints.find("$e")) != std::string::npos;)
        joints.replace(at, 2, format("{}", e));
      Simulation s = made(model(bars, joints, h < 1e-3 ? 0.4 : 1.0, h, "", "[0, -9.81, 0]"));
      const auto energy = [&] { return s.balance().kinetic + s.balance().potential; };
      const double start = energy(), scale = 5.0 * 9.81;
      double least = start;
      while (s.time() < (h < 1e-3 ? 0.4 : 1.0) - 1e-9) {
        ASSERT_TRUE(s.step(2.0).accepted) << h;
        EXPECT_LE(energy(), least + 1e-11 * scale) << h << " e " << e << " t " << s.time();
        least = std::min(least, energy());
        for (int k = 1; k < 5; k += 2) {
          EXPECT_GE(s.joint(k).coordinates[0], -0.2 - 1e-11);
          EXPECT_LE(s.joint(k).coordinates[0], 0.15 + 1e-11);
        }
      }
      if (e == 1.0) {
        EXPECT_NEAR(energy(), start, 1e-11 * scale) << h;
      }
    }
}

// Automatic steps reach the stop in short steps, in which gaps are rounding; the balance closes.
TEST(RigidStops, AutomaticStepsCloseTheirBalance) {
  std::string text = model(
      "  block: {shape: {box: [0.2, 0.1, 0.1]}, mass: 2}",
      "  slide: {type: prismatic, bodies: [ground, block], at: [0, 0, 0], axis: x, limits: {upper: "
      "0.01, restitution: 0.5}}",
      0.8, 1e-3, "", "[9, 0, 0]");
  text.replace(text.find("step: 0.001"), 11, "tolerance: 1e-6");
  Simulation s = made(text);
  const RunSummary r = finished(s);
  EXPECT_LT(r.energy_drift, 1e-11);
  EXPECT_NEAR(s.joint(0).coordinates[0], 0.01, 1e-14);
  EXPECT_LT(r.steps, 1000);
}

// A motor presses an arm against its stop, which takes its moment; friction of the hinge acts
// besides, and the balance closes.
TEST(RigidStops, AMotorPressesItsArmAgainstTheStop) {
  for (const double mu : {0.0, 0.3})
    for (const double h : {1e-2, 1e-3, 1e-4}) {
      Simulation s = made(
          model(bar("arm", 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
                format("  hinge: {{type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: z, "
                       "limits: {{upper: 0.1 rad, restitution: 0.3}}{}}}",
                       mu > 0.0 ? format(", friction: {{mu: {}, radius: 0.02}}", mu) : ""),
                0.6, h, "loads: {motor: {type: rotary_motor, joint: hinge, moment: 3}}"));
      closed(s);
      EXPECT_NEAR(s.joint(0).coordinates[0], 0.1, 1e-14) << h << " mu " << mu;
      if (mu == 0.0) {
        EXPECT_NEAR(s.joint(0).stops[0], -3.0, force_noise(h)) << h;
      }
    }
}

// A drive that goes on beyond a stop cannot: the joint of the stop is named.
TEST(RigidStops, ADriveIntoAStopNamesItsJoint) {
  Simulation s = made(model(
      "  cart: {mass: 2, inertia: [1, 1, 1], velocity: [0.5, 0, 0], motion: {x: 0.5*t, y: 0, z: "
      "0, rotation_vector: [0, 0, 0]}}",
      "  track: {type: prismatic, bodies: [ground, cart], at: [0, 0, 0], axis: x, limits: "
      "{upper: 53 mm}}",
      0.3, 1e-2));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::not_converged);
  EXPECT_NEAR(r.t, 0.106, 1e-6);
  EXPECT_NE(r.message.find("a stop that locks joint 'track'"), std::string::npos) << r.message;
}

// A joint that opens loses its stops with it, and has them again when it closes.
TEST(RigidStops, AreSwitchedWithTheirJoint) {
  Simulation s = made(model(
      "  block: {shape: {box: [0.2, 0.1, 0.1]}, mass: 2}",
      "  slide: {type: prismatic, bodies: [ground, block], at: [0, 0, 0], axis: x, limits: {lower: "
      "-10, upper: 0}}",
      0.2, 1e-3, "events: {opens: {at: 0.05, off: [slide]}, closes: {at: 0.1, on: [slide]}}",
      "[-3, 0, 0]"));
  const RunSummary r = finished(s);
  EXPECT_LT(r.energy_drift, 1e-11);
  EXPECT_NEAR(s.body(0).v[0], -0.6, 1e-12);
  Simulation held = made(model(
      "  block: {shape: {box: [0.2, 0.1, 0.1]}, mass: 2}",
      "  slide: {type: prismatic, bodies: [ground, block], at: [0, 0, 0], axis: x, limits: {upper: "
      "0}}",
      0.2, 1e-3, "events: {opens: {at: 0.1, off: [slide]}}", "[3, 0, 0]"));
  EXPECT_LT(finished(held).energy_drift, 1e-11);
  EXPECT_NEAR(held.body(0).v[0], 0.3, 1e-11);
}

// A run that goes on from a checkpoint between two impacts, and while a stop carries load, has the
// same bits.
TEST(RigidStops, ARestartHasTheSameBits) {
  const std::string text = model(
      "  block: {shape: {box: [0.2, 0.1, 0.1]}, mass: 2}\n"
      "  other: {shape: {box: [0.2, 0.1, 0.1]}, mass: 2, position: [0, 1, 0]}",
      "  slide: {type: prismatic, bodies: [ground, block], at: [0, 0, 0], axis: x, limits: {upper: "
      "0.01, restitution: 0.5}}\n"
      "  rest: {type: prismatic, bodies: [ground, other], at: [0, 1, 0], axis: x, limits: {upper: "
      "0, "
      "restitution: 0.5}}",
      0.15, 1e-3, "", "[9, 0, 0]");
  Simulation whole = made(text), first = made(text);
  finished(whole);
  while (first.time() < 0.0599) ASSERT_TRUE(first.step(0.06).accepted);
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / "polhode_rigid_stops.pst";
  io::write_checkpoint(file.string(), first.model(), first.system(), first.state());
  Simulation second(first.model(),
                    io::read_checkpoint(file.string(), first.model(), first.system()));
  std::filesystem::remove(file);
  finished(second);
  EXPECT_EQ(second.state_hash(), whole.state_hash());
}

TEST(RigidStops, RefusesWhatItDoesNotHave) {
  const auto fault = [](const std::string& limits, const std::string& more,
                        const std::string& wanted) {
    return expect_fault(
        model("  block: {shape: {box: [0.2, 0.1, 0.1]}, mass: 2}",
              "  slide: {type: prismatic, bodies: [ground, block], at: [0, 0, 0], axis: x, "
              "limits: {" +
                  limits + "}}",
              0.1, 1e-2, more),
        wanted);
  };
  EXPECT_TRUE(fault("upper: 1, band: 1 mm", "",
                    "joints.slide.limits.band: cannot be combined with the law rigid"));
  EXPECT_TRUE(fault("upper: 1, stiffness: 1e5", "",
                    "joints.slide.limits.stiffness: cannot be combined with the law rigid"));
  const std::string block = "  block: {mass: 2, inertia: [1, 1, 1]}";
  try {
    (void)made(model(block,
                     "  slide: {type: prismatic, bodies: [ground, block], at: [0, 0, 0], axis: x, "
                     "limits: {upper: 1}}",
                     0.1, 1e-2),
               {"analysis.solver=tree"});
    ADD_FAILURE();
  } catch (const std::exception& e) {
    EXPECT_NE(std::string(e.what()).find("'tree' does not support stops with the law rigid"),
              std::string::npos)
        << e.what();
  }
  EXPECT_TRUE(expect_fault(
      model("  block: {shape: {box: [0.2, 0.1, 0.1]}, mass: 2, contact: "
            "{touches: false}}",
            "  hinge: {type: revolute, bodies: [ground, block], at: [0, 0, 0]}", 0.1, 1e-2),
      "no body that moves has a shape that touches"));
}

}  // namespace polhode::test::rigid_stops_tests
