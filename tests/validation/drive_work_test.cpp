// SPDX-License-Identifier: Apache-2.0
// Work and impulses of drives in impacts, against the balance of momentum of a body that strikes or
// is struck by one whose velocity w is prescribed: a mass m at rest leaves with (1 + e) w, so the
// drive gives the impulse (1 + e) m w and the work (1 + e) m w², of which (1 - e²) m w²/2 is lost.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <support/run_text.hpp>

namespace polhode::drive_work_tests {

using test::finished;
using test::made;

/// Lengths of steps: coarse, of use, and a hundredth of that [ms].
constexpr double kSteps[] = {7.0, 1.0, 0.01};

struct Outcome {
  Vec3 impulse = Vec3::Zero();  ///< Of the driven joint since the start [N s].
  double drive = 0.0;           ///< Work of the drive itself [J].
  Balance balance;
  Vec3 v = Vec3::Zero();  ///< Of the struck body at the end.
};

Outcome run(const std::string& text, double step, const std::string& driven,
            const std::string& struck) {
  Simulation s = made(text, {format("analysis.step={} ms", step)});
  const RunSummary r = finished(s);
  EXPECT_LT(r.energy_drift, 1e-9) << step;
  EXPECT_LT(r.linear_momentum_drift, 1e-9) << step;
  Outcome o;
  const JointReport joint = s.joint(driven);
  o.impulse = joint.impulses.at(0);
  if (!joint.work.empty()) o.drive = joint.work[0];
  o.balance = s.balance();
  o.v = s.body(s.model().body_index(struck)).v;
  return o;
}

/// A wall that moves at 1 m/s strikes a ball of 1 kg at rest.
std::string wall(const std::string& law, double restitution, double duration = 0.1) {
  return format(R"(
format: 1
bodies:
  wall: {{shape: {{box: [0.1, 1, 1]}}, mass: 10, velocity: [1, 0, 0], motion: {{x: t, y: 0, z: 0, rotation_vector: [0, 0, 0]}}}}
  ball: {{shape: {{sphere: 0.2}}, mass: 1, position: [0.17, 0, 0]}}
contacts: {{default: {{restitution: {}{}}}}}
analysis: {{type: dynamics, duration: {}, step: 1 ms}}
output: {{hdf5: false}}
)",
                restitution, law, duration);
}

// The law of nearly rigid contact is exact at any step. @tests{jump-work}
TEST(DriveWork, OfAWallIsItsImpulseTimesItsSpeed) {
  for (const double e : {0.0, 0.5, 1.0})
    for (const double h : kSteps) {
      const Outcome o = run(wall("", e), h, "wall.motion", "ball");
      const std::string at = format("e {} h {} ms", e, h);
      const double p = o.v.x();
      // The wall's reaction has the rounding of second differences, a random sum over the steps.
      const double close = h < 0.1 ? 1e-8 : 1e-9;
      EXPECT_NEAR(p, 1.0 + e, 1e-9) << at;
      EXPECT_NEAR(o.impulse.x(), p, close) << at;
      EXPECT_NEAR(o.drive, p, close) << at;
      EXPECT_NEAR(o.balance.put_in, p, close) << at;
      EXPECT_NEAR(o.balance.dissipated, 0.5 * (1.0 - e * e), close) << at;
    }
}

// Whatever speed a law gives the ball, the drive has done the work of the momentum, and the rest of
// it is lost. (The non-smooth law has no drives.)
TEST(DriveWork, FollowsFromTheMomentumForEveryLaw) {
  for (const char* law :
       {", law: linear, stiffness: 1e6", ", law: linear, stiffness: 1e6, rebound: damped",
        ", law: hertz, hertz_stiffness: 1e8"})
    for (const double e : {0.0, 0.5, 1.0})
      for (const double h : kSteps) {
        if (e == 0.0 && std::string(law).ends_with("damped")) continue;  // is refused
        if (h < 0.1 && e != 0.5) continue;
        const std::string at = format("{} e {} h {} ms", law, e, h);
        const Outcome o = run(wall(law, e), h, "wall.motion", "ball");
        const double p = o.v.x();
        EXPECT_GT(p, 0.9) << at;
        // Newton's tolerance of 1e-9 with contact, of the 12,000 finest steps, as a random sum.
        constexpr double kClose = 1e-8;
        EXPECT_NEAR(o.impulse.x(), p, kClose) << at;
        EXPECT_NEAR(o.drive, p, kClose) << at;
        EXPECT_NEAR(o.balance.put_in, p, kClose) << at;
        EXPECT_NEAR(
            o.balance.kinetic + o.balance.potential + o.balance.dissipated - o.balance.put_in, 5.0,
            kClose)
            << at;
      }
}

// A plate that accelerates has the velocity of the instant at the end of the step, not of its
// start: 3 kg at 0.5 m/s.
TEST(DriveWork, TakesTheSpeedOfTheInstant) {
  for (const double h : kSteps) {
    const Outcome o = run(R"(
format: 1
bodies:
  wall: {shape: {box: [0.1, 1, 1]}, mass: 10, motion: {x: "4*t^2", y: 0, z: 0, rotation_vector: [0, 0, 0]}}
  ball: {shape: {sphere: 0.2}, mass: 3, position: [0.19, 0, 0]}
contacts: {default: {restitution: 0.5}}
analysis: {type: dynamics, duration: 0.12, step: 1 ms}
output: {hdf5: false}
)",
                          h, "wall.motion", "ball");
    // It strikes at 4 t² = 0.04, where w = 0.8 m/s; later the wall is slower than the ball.
    // The step of the impact is a part of the motion: error w' h.
    const double w = 0.8, p = 3.0 * o.v.x(), V = 8.0 * 0.12;
    EXPECT_NEAR(o.v.x(), 1.5 * w, 12.0 * 1e-3 * h + 1e-6) << h;
    EXPECT_NEAR(o.impulse.x() - 10.0 * V, p, 1e-9 + 1e-3 * h) << h;
    EXPECT_NEAR(o.balance.put_in - o.balance.dissipated, o.balance.kinetic + o.balance.potential,
                1e-9)
        << h;
    EXPECT_NEAR(o.drive, o.balance.put_in, 1e-9) << h;
    EXPECT_NEAR(o.balance.dissipated, 0.5 * 3.0 * w * w * 0.75, 40.0 * 1e-3 * h + 1e-5) << h;
  }
}

// A box of 2 kg falls by 20 mm on a belt at 1 m/s: at the end it moves with it, so the belt has
// given 2 N s and 2 J, of which friction has taken 1 J; the rest of the loss is that of the fall.
TEST(DriveWork, OfABeltIsThatOfItsFriction) {
  for (const double e : {0.0, 1.0})
    for (const double h : {2.0, 1.0, 0.1}) {
      const Outcome o = run(format(R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  belt: {{shape: {{box: [20, 2, 0.1]}}, mass: 10, position: [0, 0, -0.05], velocity: [1, 0, 0], motion: {{x: t, y: 0, z: 0, rotation_vector: [0, 0, 0]}}}}
  box: {{shape: {{box: [0.4, 0.4, 0.1]}}, mass: 2, position: [0, 0, 0.07]}}
contacts: {{default: {{friction: 0.4, restitution: {}}}}}
analysis: {{type: dynamics, duration: 0.75, step: 1 ms}}
output: {{hdf5: false}}
)",
                                   e),
                            h, "belt.motion", "box");
      const std::string at = format("e {} h {} ms", e, h);
      // A box that bounces on its corners may leave the belt with another speed, by the law of
      // contact; the work is that of its momentum all the same.
      const bool corners = e == 1.0 && h < 1.0;
      const double p = 2.0 * o.v.x();
      EXPECT_NEAR(p, 2.0, corners ? 0.02 : 2e-6) << at;
      EXPECT_NEAR(o.impulse.x(), p, 1e-5) << at;
      EXPECT_NEAR(o.drive, p, 1e-5) << at;
      EXPECT_NEAR(o.balance.put_in, p, 1e-5) << at;
      const double fall = e == 0.0 ? 2.0 * 9.81 * 0.02 : 0.0;
      EXPECT_NEAR(o.balance.dissipated, 1.0 + fall, corners ? 0.07 : 2e-3) << at;
    }
}

/// A bar of a motor at 2 rad/s strikes a ball of 0.5 kg at 1 m: w = 2 m/s.
std::string bar(const std::string& drive, double e) {
  return format(R"(
format: 1
bodies:
  bar: {{shape: {{box: [1.2, 0.1, 0.1]}}, mass: 3, position: [0.6, 0, 0], angular_velocity: [0, 0, 2], velocity: [0, 1.2, 0]}}
  ball: {{shape: {{sphere: 0.05}}, mass: 0.5, position: [1, 0.16, 0]}}
joints: {{hinge: {{type: revolute, bodies: [ground, bar], at: [0, 0, 0], axis: z}}}}
loads: {{motor: {{type: rotary_motor, joint: hinge, {}}}}}
contacts: {{default: {{restitution: {}}}}}
analysis: {{type: dynamics, duration: 0.06, step: 1 ms}}
output: {{hdf5: false}}
)",
                drive, e);
}

TEST(DriveWork, OfAMotorIsItsImpulseTimesItsRate) {
  for (const char* drive : {"speed: 2 rad/s", "angle: 2*t"})
    for (const double e : {0.0, 0.5})
      for (const double h : kSteps) {
        Simulation s = made(bar(drive, e), {format("analysis.step={} ms", h)});
        const RunSummary r = finished(s);
        const std::string at = format("{} e {} h {} ms", drive, e, h);
        EXPECT_LT(r.energy_drift, 1e-10) << at;
        EXPECT_LT(r.angular_momentum_drift, 1e-10) << at;
        const BodyMotion ball = s.body(1);
        const double L = 0.5 * ball.r.cross(ball.v).z();  // given to the ball about the hinge
        EXPECT_GT(L, 0.9 * (1.0 + e)) << at;
        const std::vector<double> motor = s.load(0);
        // The bar's velocity on its circle has an error normal to the drive's row.
        const double near = 4e-6 * h * h + 1e-9;
        const double work = motor[6], impulse = motor[7];
        EXPECT_NEAR(impulse, L, near) << at;
        EXPECT_NEAR(work, 2.0 * L, near) << at;
        EXPECT_NEAR(s.balance().put_in, 2.0 * L, near) << at;
        const double T = 0.25 * ball.v.squaredNorm();
        EXPECT_NEAR(s.balance().dissipated, 2.0 * L - T, near) << at;
        // The hinge holds the bar on its circle against the ball: forces along y add up.
        EXPECT_NEAR(s.joint(0).impulses.at(1).z(), 0.0, 1e-9) << at;
      }
}

// A linear motor, and a joint with prescribed motion, push a slider into another body.
TEST(DriveWork, OfSlidesIsThatOfTheirImpulses) {
  const auto text = [](bool motion, double e) {
    return format(
        R"(
format: 1
bodies:
  ram: {{shape: {{box: [0.1, 1, 1]}}, mass: 4, velocity: [1, 0, 0]}}
  ball: {{shape: {{sphere: 0.2}}, mass: 1, position: [0.17, 0, 0]}}
joints: {{guide: {{type: {}, bodies: [ground, ram], at: [0, 0, 0]{}}}}}
{}
contacts: {{default: {{restitution: {}}}}}
analysis: {{type: dynamics, duration: 0.1, step: 1 ms}}
output: {{hdf5: false}}
)",
        motion ? "fixed" : "prismatic", motion ? ", motion: {x: t}" : ", axis: x",
        motion ? "" : "loads: {motor: {type: linear_motor, joint: guide, displacement: t}}", e);
  };
  for (const bool motion : {true, false})
    for (const double e : {0.0, 0.5})
      for (const double h : kSteps) {
        const std::string at = format("motion {} e {} h {} ms", motion, e, h);
        Simulation s = made(text(motion, e), {format("analysis.step={} ms", h)});
        const RunSummary r = finished(s);
        EXPECT_LT(r.energy_drift, 1e-10) << at;
        const double p = 1.0 + e;
        EXPECT_NEAR(motion ? s.joint(0).work.at(0) : s.load(0)[6], p, 1e-9) << at;
        EXPECT_NEAR(motion ? s.joint(0).impulses.at(0).x() : s.load(0)[7], p, 1e-9) << at;
        EXPECT_NEAR(s.balance().put_in, p, 1e-9) << at;
        EXPECT_NEAR(s.balance().dissipated, 0.5 * (1.0 - e * e), 1e-9) << at;
      }
}

// A cart rolls freely on a driven carriage until its stop carries it along.
TEST(DriveWork, AtStopsIsThatOfTheirImpulse) {
  for (const double e : {0.0, 0.5, 1.0})
    for (const double h : kSteps) {
      Simulation s = made(format(R"(
format: 1
bodies:
  carriage: {{mass: 10, inertia: [1, 1, 1], velocity: [1, 0, 0], motion: {{x: t, y: 0, z: 0, rotation_vector: [0, 0, 0]}}}}
  cart: {{mass: 2, inertia: [1, 1, 1]}}
joints: {{track: {{type: prismatic, bodies: [carriage, cart], at: [0, 0, 0], axis: x, limits: {{lower: -50 mm, upper: 1, restitution: {}}}}}}}
analysis: {{type: dynamics, duration: 0.1, step: 1 ms}}
output: {{hdf5: false}}
)",
                                 e),
                          {format("analysis.step={} ms", h)});
      const RunSummary r = finished(s);
      const std::string at = format("e {} h {} ms", e, h);
      EXPECT_LT(r.energy_drift, 1e-10) << at;
      const double p = 2.0 * (1.0 + e);
      EXPECT_NEAR(s.body(1).v.x(), 1.0 + e, 1e-6) << at;
      EXPECT_NEAR(s.joint("carriage.motion").impulses.at(0).x(), p, 1e-6) << at;
      EXPECT_NEAR(s.joint("track").impulses.at(0).x(), p, 1e-6) << at;  // by its stop
      EXPECT_NEAR(s.joint("carriage.motion").work.at(0), p, 1e-6) << at;
      EXPECT_NEAR(s.balance().put_in, p, 1e-6) << at;
      EXPECT_NEAR(s.balance().dissipated, 1.0 - e * e, 1e-6) << at;
    }
}

// A joint closes between a driven body and one at rest: a plastic impact.
TEST(DriveWork, WhenAJointClosesIsThatOfItsImpulse) {
  for (const double h : kSteps) {
    Simulation s = made(R"(
format: 1
bodies:
  hook: {mass: 10, inertia: [1, 1, 1], velocity: [1, 0, 0], motion: {x: t, y: 0, z: 0, rotation_vector: [0, 0, 0]}}
  load: {mass: 2, inertia: [1, 1, 1], position: [0.05, 0, 0]}
joints: {grip: {type: fixed, bodies: [hook, load], at: [0.05, 0, 0]}}
events: {free: {at: 0, off: [grip]}, take: {at: 50 ms, on: [grip]}}
analysis: {type: dynamics, duration: 0.1, step: 1 ms}
output: {hdf5: false}
)",
                        {format("analysis.step={} ms", h)});
    const RunSummary r = finished(s);
    EXPECT_LT(r.energy_drift, 1e-10) << h;
    EXPECT_NEAR(s.body(1).v.x(), 1.0, 1e-9) << h;
    EXPECT_NEAR(s.joint("grip").impulses.at(0).x(), 2.0, 1e-9) << h;
    EXPECT_NEAR(s.joint("hook.motion").impulses.at(0).x(), 2.0, 1e-9) << h;
    EXPECT_NEAR(s.joint("hook.motion").work.at(0), 2.0, 1e-9) << h;
    EXPECT_NEAR(s.balance().put_in, 2.0, 1e-9) << h;
    EXPECT_NEAR(s.balance().dissipated, 1.0, 1e-9) << h;
  }
}

// A kink of a drive: 4 kg are accelerated to 1 m/s at once, and the motor knows it.
TEST(DriveWork, AtKinksIsThatOfTheirImpulse) {
  for (const double h : kSteps) {
    Simulation s = made(R"(
format: 1
bodies: {cart: {mass: 4, inertia: [1, 1, 1]}}
joints: {guide: {type: prismatic, bodies: [ground, cart], at: [0, 0, 0], axis: x}}
loads: {motor: {type: linear_motor, joint: guide, displacement: "t < 0.05 ? 0 : t - 0.05"}}
analysis: {type: dynamics, duration: 0.1, step: 1 ms}
output: {hdf5: false}
)",
                        {format("analysis.step={} ms", h)});
    (void)finished(s);
    EXPECT_NEAR(s.load(0)[6], 2.0, 1e-9) << h;
    EXPECT_NEAR(s.load(0)[7], 4.0, 1e-9) << h;
    EXPECT_NEAR(s.balance().put_in, 2.0, 1e-9) << h;
  }
}

/// The work of drives against springs in statics is the energy of the springs, whatever the load
/// steps: forces vary linearly with the way, so that the trapezoidal rule is exact.
/// @tests{statics-work}
TEST(DriveWork, InStaticsIsTheEnergyOfTheSpring) {
  struct Case {
    const char* drive;
    std::size_t channel;
    double work;
  };
  // A servo of 3 N m/rad at 1 rad against 2 N m/rad ends at 0.6 rad.
  for (const Case& c :
       {Case{"m: {type: rotary_motor, joint: j, angle: 1}", 6, 1.0},
        Case{"m: {type: rotary_servo, joint: j, angle: 1, stiffness: 3, damping: 0}", 7, 0.36},
        Case{"m: {type: rotary_motor, joint: j, moment: 2}", 6, 1.0}})
    for (const int steps : {1, 10, 1000})
      for (const bool history : {false, true}) {
        Simulation s(io::read_model_text(format(R"yaml(
format: 1
bodies: {{b: {{mass: 1, inertia: [0.1, 0.1, 0.1]}}}}
joints: {{j: {{type: revolute, bodies: [ground, b], at: [0, 0, 0], axis: z}}}}
loads:
  s: {{type: torsional_spring, joint: j, stiffness: 2}}
  {}
analysis: {{type: statics, load_steps: {}, {}}}
output: {{hdf5: false}}
)yaml",
                                                c.drive, steps, history ? "history: 1" : ""),
                                         "drive.yaml"));
        const RunSummary r = s.run();
        ASSERT_EQ(r.end, RunEnd::finished) << c.drive << r.message;
        EXPECT_NEAR(s.load(1).at(c.channel), c.work, 1e-9) << c.drive << ' ' << steps << history;
      }
  // A body moved by 3 mm against 1 MN/m.
  for (const int steps : {1, 10, 1000}) {
    Simulation s(io::read_model_text(format(R"yaml(
format: 1
bodies: {{b: {{mass: 1, inertia: [0.1, 0.1, 0.1], motion: {{x: 0.003, y: 0, z: 0, rotation_vector: [0, 0, 0]}}}}}}
loads:
  s: {{type: spring_damper, bodies: [ground, b], at: [[-1, 0, 0], [0, 0, 0]], stiffness: 1e6}}
analysis: {{type: statics, load_steps: {}}}
output: {{hdf5: false}}
)yaml",
                                            steps),
                                     "driven.yaml"));
    const RunSummary r = s.run();
    ASSERT_EQ(r.end, RunEnd::finished) << r.message;
    EXPECT_NEAR(s.joint(0).work.at(0), 4.5, 1e-9) << steps;
  }
}

/// A cart that moves at 1 m/s from 0.05 s on, and 1 kg on a spring and a damper behind it: after
/// the kink of the drive the mass lags by e^(−ζωt) sin(ω_d t)/ω_d, at any tolerance of extrapolated
/// steps.
TEST(DriveWork, AtKinksBetweenExtrapolatedSteps) {
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    Simulation s = made(R"(
format: 1
bodies:
  cart: {mass: 4, inertia: [1, 1, 1]}
  load: {mass: 1, inertia: [1, 1, 1], position: [-1, 0, 0]}
joints:
  guide: {type: prismatic, bodies: [ground, cart], at: [0, 0, 0], axis: x}
  slide: {type: prismatic, bodies: [cart, load], at: [-1, 0, 0], axis: x}
loads:
  motor: {type: linear_motor, joint: guide, displacement: "t < 0.05 ? 0 : t - 0.05"}
  spring: {type: translational_spring, joint: slide, stiffness: 100, damping: 2}
analysis: {type: dynamics, duration: 0.4, tolerance: 1e-6}
output: {hdf5: false}
)",
                        {format("analysis.tolerance={}", tolerance)});
    const RunSummary r = finished(s);
    EXPECT_LT(r.steps, 60) << tolerance;
    EXPECT_TRUE(r.trusted()) << tolerance;
    const double w = std::sqrt(99.0), t = 0.35;
    const double lag = std::exp(-t) * std::sin(w * t) / w;
    EXPECT_NEAR(s.body(1).r.x(), -1.0 + t - lag, 5.0 * tolerance) << tolerance;
    EXPECT_LT(r.energy_drift, 10.0 * tolerance + 1e-12) << tolerance;
  }
}

}  // namespace polhode::drive_work_tests
