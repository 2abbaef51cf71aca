// SPDX-License-Identifier: Apache-2.0
// Joints and loads switched by events: release, clutch, breaking, against closed forms.
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <polhode/system/state_archive.hpp>
#include <support/run_text.hpp>

namespace polhode::test::events_tests {
namespace {

constexpr double kG = 9.81, kDegree = std::numbers::pi / 180.0;

/// A ball of 2 kg on a rod of 0.8 m, from 60 degrees at rest; the zero of the joint's angle is
/// there.
struct Pendulum {
  static constexpr double m = 2.0, l = 0.8, J_c = 0.05, start = 60.0 * kDegree;
  static constexpr double J = J_c + m * l * l;
  /// Angle from straight down after which it flies: 20 degrees beyond.
  static constexpr double release = -20.0 * kDegree;

  static std::string text(const std::string& events, const std::string& T = "1.2") {
    return R"(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 5 ms, order: 2, rho: 1}
bodies:
  ball: {mass: 2, inertia: [0.05, 0.05, 0.05], position: [)" +
           format("{:.17g}, 0, {:.17g}", l * std::sin(start), -l * std::cos(start)) +
           R"(]}
joints:
  pivot: {type: revolute, bodies: [ground, ball], at: [0, 0, 0], axis: y}
)" + events +
           R"(
analysis: {type: dynamics, duration: )" +
           T + R"( s, step: h, rho_inf: rho}
output: {hdf5: false}
)";
  }
  /// ω² from energy at an angle from straight down [1/s²].
  static double omega_at(double angle) {
    return std::sqrt(2.0 * m * kG * l / J * (std::cos(angle) - std::cos(start)));
  }
  /// Time until it swings through an angle beyond the lowest point.
  static double time_at(double angle) {
    const double k = std::sin(0.5 * start), omega_0 = std::sqrt(m * kG * l / J);
    const double beyond = std::asin(std::sin(0.5 * std::abs(angle)) / k);
    return (std::comp_ellint_1(k) + std::ellint_1(k, beyond)) / omega_0;
  }
};

// After the release at the angle: a parabola with the velocity there, and a uniform rotation.
// @tests{event-time} @tests{switch-rows}
TEST(Events, ReleaseAPendulumAtAnAngle) {
  const std::string text = Pendulum::text(
      "events: {release: {when: {joint: pivot, channel: rz, above: 80 deg}, off: [pivot]}}");
  const double angle = Pendulum::release, T = 1.2, t_e = Pendulum::time_at(angle);
  const double omega = Pendulum::omega_at(angle), l = Pendulum::l;
  // From +x to −x: the velocity along −(cos, sin).
  const Vec3 at(l * std::sin(angle), 0.0, -l * std::cos(angle));
  const Vec3 v = -omega * l * Vec3(std::cos(angle), 0.0, std::sin(angle));
  const double free = T - t_e;
  const Vec3 end = at + free * v - 0.5 * kG * free * free * Vec3::UnitZ();
  double coarse = 0.0;
  for (const double h : {0.02, 0.01, 0.005, 0.0002}) {
    Simulation s = made(text, {"h=" + std::to_string(h)});
    const RunSummary r = finished(s);
    ASSERT_EQ(r.events.size(), 1U);
    EXPECT_EQ(r.events[0].count, 1);
    const double off = (s.body(0).r - end).norm();
    EXPECT_LT(std::abs(r.events[0].time - t_e), 3.0 * h * h) << h;
    EXPECT_LT(off, 10.0 * h * h) << h;
    EXPECT_LT(std::abs(s.body(0).omega().norm() - omega), 10.0 * h * h) << h;
    EXPECT_LT(r.energy_drift, h < 1e-3 ? 1e-9 : 1e-11) << h;
    EXPECT_LT(r.angular_momentum_drift, 1e-9) << h;
    // From step to step the error depends on where in its step the event falls.
    if (h == 0.02) coarse = off;
    if (h == 0.0002) {
      EXPECT_NEAR(std::log(coarse / off) / std::log(100.0), 2.0, 0.1);
    }
  }
}

// Location of the event: the angle to round-off, with the same positions and velocities before and
// after it.
TEST(Events, AreLocatedToRoundOff) {
  for (const char* more : {"", "analysis.rho_inf=0.6", "analysis.order=4", "analysis.step=auto"}) {
    io::Overrides overrides;
    if (*more != '\0') overrides.emplace_back(more);
    Simulation s = made(
        Pendulum::text("events: {release: {when: {joint: pivot, channel: rz, above: 80 deg}, off: "
                       "[pivot], stop: true}}"),
        overrides);
    const RunSummary r = finished(s);
    EXPECT_TRUE(r.message.starts_with("stopped by event 'release' at t = ")) << r.message << more;
    EXPECT_NEAR(s.joint(0).coordinates[0], 80.0 * kDegree, 2e-12) << more;
    EXPECT_EQ(s.joint(0).force.norm(), 0.0) << more;
    EXPECT_NEAR(s.body(0).r.norm(), Pendulum::l, 1e-7) << more;
    EXPECT_LT(std::abs(s.body(0).omega().norm() - Pendulum::omega_at(Pendulum::release)), 2e-3);
  }
}

// At order 4 the error of the flight is of the fourth power of the step.
TEST(Events, KeepOrderFour) {
  const double angle = Pendulum::release, T = 1.2, free = T - Pendulum::time_at(angle);
  const double omega = Pendulum::omega_at(angle), l = Pendulum::l;
  const Vec3 end = Vec3(l * std::sin(angle), 0.0, -l * std::cos(angle)) -
                   free * omega * l * Vec3(std::cos(angle), 0.0, std::sin(angle)) -
                   0.5 * kG * free * free * Vec3::UnitZ();
  double last = 0.0;
  for (const double h : {0.04, 0.02}) {
    Simulation s = made(
        Pendulum::text(
            "events: {release: {when: {joint: pivot, channel: rz, above: 80 deg}, off: [pivot]}}"),
        {"h=" + std::to_string(h), "analysis.order=4"});
    (void)finished(s);
    const double off = (s.body(0).r - end).norm();
    EXPECT_LT(off, 300.0 * std::pow(h, 4)) << h;
    if (last > 0.0) {
      EXPECT_GT(last / off, 9.0);
    }
    last = off;
  }
}

// A hook holds the ball at rest until 0.3 s, at any step; then it swings as a pendulum.
TEST(Events, ReleaseALatchAtItsTime) {
  const std::string text = Pendulum::text(R"(
  hook: {type: fixed, bodies: [ground, ball], at: [0, 0, 0]}
events:
  let_go: {at: 0.3 s, off: [hook]}
  bottom: {when: {joint: pivot, channel: rz, above: 60 deg}, stop: true}
)",
                                          "2");
  for (const double h : {0.007, 0.001}) {
    Simulation s = made(text, {"h=" + std::to_string(h)});
    const RunSummary r = finished(s);
    EXPECT_DOUBLE_EQ(r.events[0].time, 0.3);
    EXPECT_NEAR(r.events[1].time, 0.3 + Pendulum::time_at(0.0), 3.0 * h * h);
    EXPECT_LT(r.energy_drift, 1e-11);
  }
}

std::string discs(const std::string& clutch, const std::string& type) {
  return R"(
format: 1
variables: {h: 5 ms}
bodies:
  one: {mass: 3, inertia: [0.1, 0.1, 0.2], position: [0, 0, 0], angular_velocity: [0, 0, 20]}
  two: {mass: 2, inertia: [0.4, 0.4, 0.6], position: [0, 0, 0.1], angular_velocity: [0, 0, -4]}
joints:
  first: {type: revolute, bodies: [ground, one], at: [0, 0, 0], axis: z}
  second: {type: revolute, bodies: [)" +
         type + R"(, two], at: [0, 0, 0.1], axis: z}
)" + clutch +
         R"(
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)";
}

// Angular momentum is conserved, J1 J2/(J1 + J2) Δω²/2 is lost; on which side the load acts does
// not matter. @tests{switch-impulse} @tests{switch-loss}
TEST(Events, CloseAClutch) {
  const double common = (0.2 * 20.0 - 0.6 * 4.0) / 0.8;
  const double lost = 0.5 * 0.2 * 0.6 / 0.8 * 24.0 * 24.0;
  const std::string plates = R"(
  clutch: {type: fixed, bodies: [one, two], at: [0, 0, 0.05]}
events:
  open: {at: 0, off: [clutch]}
  close: {at: 0.37 s, on: [clutch]}
)";
  const std::string drive = R"(
loads: {clutch: {type: rotary_motor, joint: second, speed: 0}}
events:
  open: {at: 0 s, off: [clutch]}
  close: {at: 0.37 s, on: [clutch]}
)";
  for (const double h : {0.02, 0.005, 0.00005})
    for (const bool fixed : {true, false}) {
      if (h < 1e-3 && !fixed) continue;
      Simulation s = made(fixed ? discs(plates, "ground") : discs(drive, "one"),
                          {"h=" + std::to_string(h), "analysis.duration=0.5"});
      const RunSummary r = finished(s);
      EXPECT_NEAR(s.body(0).omega()[2], common, 1e-9) << h << fixed;
      EXPECT_NEAR(s.body(1).omega()[2], common, 1e-9) << h << fixed;
      EXPECT_NEAR(r.events[1].lost, lost, 1e-10 * lost) << h << fixed;
      EXPECT_NEAR(r.events[1].impulse, 0.2 * (20.0 - common), 1e-9) << h << fixed;
      EXPECT_NEAR(s.balance().dissipated, lost, 1e-10 * lost) << h << fixed;
      EXPECT_LT(r.energy_drift, 1e-11) << h << fixed;
      EXPECT_LT(r.angular_momentum_drift, 1e-11) << h << fixed;
      // The relative angle is that of the closure: each turned by its own speed until then.
      const double apart = -24.0 * 0.37;
      const Mat3 turn = s.body(0).Lambda().transpose() * s.body(1).Lambda();
      EXPECT_NEAR(
          std::remainder(std::atan2(turn(1, 0), turn(0, 0)) - apart, 2.0 * std::numbers::pi), 0.0,
          2.0 * h * h * 20.0 * 20.0 * 20.0 / 12.0 * 0.5 + 1e-9);
    }
}

// Closed and opened again: discs that are not locked turn freely.
TEST(Events, CloseAndOpenAgain) {
  Simulation s = made(discs(R"(
  clutch: {type: fixed, bodies: [one, two], at: [0, 0, 0.05]}
loads:
  brake: {type: moment, body: two, moment: [0, 0, 0.3]}
events:
  begin: {at: 0, off: [clutch, brake]}
  close: {at: 0.2 s, on: [clutch]}
  open: {at: 0.4 s, off: [clutch], on: [brake]}
  end: {at: 0.6 s, off: [brake]}
)",
                            "ground"));
  const RunSummary r = finished(s);
  EXPECT_NEAR(s.body(0).omega()[2], 2.0, 1e-9);
  EXPECT_NEAR(s.body(1).omega()[2], 2.0 + 0.3 * 0.2 / 0.6, 1e-9);
  EXPECT_LT(r.energy_drift, 1e-11);
}

// A spring that is switched off removes its energy, and one that is switched on adds it.
TEST(Events, RecordTheEnergyOfSwitchedSprings) {
  Simulation s = made(R"(
format: 1
bodies: {cart: {mass: 2, inertia: [1, 1, 1], position: [1.2, 0, 0]}}
joints: {rail: {type: prismatic, bodies: [ground, cart], at: [1.2, 0, 0], axis: x}}
loads:
  spring: {type: spring_damper, bodies: [ground, cart], at_body: [[0, 0, 0], [0, 0, 0]], stiffness: 50, free_length: 1}
  other: {type: spring_damper, bodies: [ground, cart], at_body: [[0, 0, 0], [0, 0, 0]], stiffness: 80, free_length: 1}
events:
  begin: {at: 0, off: [other]}
  exchange: {when: {joint: rail, channel: z, below: -0.1}, off: [spring], on: [other]}
analysis: {type: dynamics, duration: 0.5 s, step: 1 ms}
output: {hdf5: false}
)");
  const RunSummary r = finished(s);
  EXPECT_LT(r.energy_drift, 1e-12);
  EXPECT_NEAR(s.balance().dissipated, 0.5 * 50.0 * 0.01, 1e-12);
  EXPECT_NEAR(s.balance().put_in, 0.5 * 80.0 * 0.01, 1e-12);
  // x̄ = 0.2 cos 5t until 0.1: t = π/15; then 2 ẍ = −80 x̄ from there.
  const double t_e = std::numbers::pi / 15.0, w = std::sqrt(40.0), tau = 0.5 - t_e;
  const double v = -0.2 * 5.0 * std::sin(5.0 * t_e);
  EXPECT_NEAR(r.events[1].time, t_e, 1e-6);
  EXPECT_NEAR(s.body(0).r[0] - 1.0, 0.1 * std::cos(w * tau) + v / w * std::sin(w * tau), 3e-6);
  EXPECT_EQ(s.load(0)[0], 0.0);
  EXPECT_GT(std::abs(s.load(1)[0]), 0.0);
}

// A relay: a force of 3 N towards x = 0 from either side. Parabolas, from 0.2 m at rest; the period
// is 4 √(2 m x/F). @tests{event-time}
TEST(Events, RepeatOnRequest) {
  const std::string text = R"(
format: 1
variables: {h: 5 ms}
bodies: {cart: {mass: 2, inertia: [1, 1, 1], position: [0.2, 0, 0]}}
joints: {rail: {type: prismatic, bodies: [ground, cart], at_body: [[0, 0, 0], [0, 0, 0]], axis: x}}
loads:
  back: {type: force, body: cart, force: [-3, 0, 0]}
  forth: {type: force, body: cart, force: [3, 0, 0]}
events:
  start: {at: 0, off: [forth]}
  right: {when: {body: cart, channel: x, above: 0}, off: [forth], on: [back], repeat: true}
  left: {when: {body: cart, channel: x, below: 0}, off: [back], on: [forth], repeat: true}
analysis: {type: dynamics, duration: 5 s, step: h}
output: {hdf5: false}
)";
  const double a = 1.5, quarter = std::sqrt(2.0 * 0.2 / a);
  const double in = std::fmod(5.0, 4.0 * quarter);
  const auto branch = [&](double t) { return 0.2 - 0.5 * a * t * t; };
  const double x = in < quarter         ? branch(in)
                   : in < 3.0 * quarter ? -branch(in - 2.0 * quarter)
                                        : branch(in - 4.0 * quarter);
  for (const double h : {0.05, 0.005, 0.0005}) {
    Simulation s = made(text, {"h=" + std::to_string(h)});
    const RunSummary r = finished(s);
    // Parabolas are exact at any step.
    EXPECT_NEAR(s.body(0).r[0], x, 1e-10) << h;
    EXPECT_EQ(r.events[1].count, 1 + static_cast<int>((5.0 + quarter) / (4.0 * quarter))) << h;
    EXPECT_EQ(r.events[2].count, static_cast<int>((5.0 + 3.0 * quarter) / (4.0 * quarter))) << h;
    EXPECT_LT(r.energy_drift, 1e-11) << h;
  }
}

// m g + f t: at the limit to round-off, and from then on it falls. @tests{event-time}
TEST(Events, BreakAJointAtItsForce) {
  for (const double h : {0.02, 0.001}) {
    Simulation s = made(R"(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 1 ms}
bodies: {lamp: {mass: 2, inertia: [0.1, 0.1, 0.1], position: [0, 0, -1]}}
joints: {hook: {type: spherical, bodies: [ground, lamp], at: [0, 0, 0], breaks: {force: 30 N}}}
loads: {pull: {type: force, body: lamp, force: [0, 0, -25*t]}}
analysis: {type: dynamics, duration: 0.6 s, step: h}
output: {hdf5: false}
)",
                        {"h=" + std::to_string(h)});
    const RunSummary r = finished(s);
    const double t_e = (30.0 - 2.0 * kG) / 25.0, tau = 0.6 - t_e;
    ASSERT_EQ(r.events[0].count, 1);
    EXPECT_EQ(r.events[0].name, "hook breaks by force");
    EXPECT_NEAR(r.events[0].time, t_e, 1e-11) << h;
    // 2 z̈ = −2 g − 25 t
    const double fall = 0.5 * (kG + 12.5 * t_e) * tau * tau + 12.5 * tau * tau * tau / 6.0;
    EXPECT_NEAR(s.body(0).r[2], -1.0 - fall, 3.0 * h * h) << h;
    EXPECT_LT(r.energy_drift, 1e-10) << h;
  }
}

// A swinging pendulum: its pivot carries m g (cos φ + ...) and breaks where that is 30 N.
TEST(Events, BreakASwingingPendulum) {
  const double m = Pendulum::m, l = Pendulum::l, J = Pendulum::J, limit = 30.0;
  // Radial m g cos φ + m l ω², across m g sin φ − m l α with α = m g l sin φ/J.
  const auto force = [&](double angle) {
    const double w = Pendulum::omega_at(angle);
    const double along = m * kG * std::cos(angle) + m * l * w * w;
    const double across = m * kG * std::sin(angle) * (1.0 - m * l * l / J);
    return std::hypot(along, across);
  };
  double low = 0.0, high = Pendulum::start;
  for (int k = 0; k < 100; ++k)
    (force(0.5 * (low + high)) > limit ? low : high) = 0.5 * (low + high);
  for (const double h : {0.01, 0.0005}) {
    std::string text = Pendulum::text("");
    text.replace(text.find("axis: y}"), 8, "axis: y, breaks: {force: 30}}");
    Simulation s = made(text, {"h=" + std::to_string(h)});
    const RunSummary r = finished(s);
    ASSERT_EQ(r.events[0].count, 1);
    const double k = std::sin(0.5 * Pendulum::start);
    const double t_e =
        (std::comp_ellint_1(k) - std::ellint_1(k, std::asin(std::sin(0.5 * low) / k))) /
        std::sqrt(m * kG * l / J);
    EXPECT_NEAR(r.events[0].time, t_e, 3.0 * h * h + 1e-9) << h;
  }
}

// A run in two parts, divided in a later phase: the same bits.
TEST(Events, ContinueBitForBitAfterARestart) {
  const std::string text = discs(R"(
  clutch: {type: fixed, bodies: [one, two], at: [0, 0, 0.05]}
events:
  open: {at: 0, off: [clutch]}
  close: {when: {joint: first, channel: rz, above: 5}, on: [clutch]}
  again: {at: 0.7 s, off: [clutch]}
)",
                                 "ground");
  for (const char* more : {"analysis.rho_inf=1", "analysis.rho_inf=0.7", "analysis.order=4"}) {
    Simulation straight = made(text, {more});
    (void)finished(straight);
    for (const double cut : {0.1, 0.5, 0.8}) {
      Simulation first = made(text, {more});
      while (first.time() < cut) ASSERT_TRUE(first.step(1.0).accepted);
      const std::string bytes = state_bytes(first.system(), first.state());
      Model model = first.model();
      Simulation second(std::move(model), state_from_bytes(first.system(), bytes, "here"));
      (void)finished(second);
      EXPECT_EQ(second.state_hash(), straight.state_hash()) << more << ' ' << cut;
      EXPECT_EQ(second.summary().events[1].time, straight.summary().events[1].time);
    }
  }
}

TEST(Events, ReportErrors) {
  const auto with = [](const std::string& events) {
    return Pendulum::text("events:\n  e: " + events);
  };
  expect_fault(with("{at: 1 s, off: [pivott]}"),
               "events.e.off: unknown joint or load 'pivott'. Did you mean 'pivot'?");
  expect_fault(with("{off: [pivot]}"),
               "events.e: never occurs. Give at (a time) or when (a condition).");
  expect_fault(with("{at: 1 s}"), "events.e: does nothing. Give off, on, or stop: true.");
  expect_fault(with("{at: 1 s, off: [pivot], after: f}"), "unknown event 'f'");
  expect_fault(with("{at: 1 s, off: [pivot], repeat: true}"),
               "events.e.repeat: cannot be combined with 'at'");
  expect_fault(with("{when: {joint: pivot, channel: ry, above: 1}, off: [pivot]}"),
               "events.e.when.channel: 'ry' is no channel of the joint 'pivot'");
  expect_fault(with("{when: {joint: pivo, channel: rz, above: 1}, off: [pivot]}"),
               "unknown joint 'pivo'");
  expect_fault(with("{when: {joint: pivot, channel: rz, above: 1 m}, off: [pivot]}"),
               "events.e.when.above");
  expect_fault(with("{when: {joint: pivot, channel: rz}, off: [pivot]}"),
               "events.e.when: has no level. Give above or below.");
  expect_fault(with("{when: {channel: ry, above: 1}, off: [pivot]}"),
               "names no object that reports");
  EXPECT_NE(fault_of(R"(
format: 1
bodies: {a: {mass: 1, inertia: [1, 1, 1]}}
joints: {j: {type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: z, breaks: {}}}
)")
                .find("joints.j.breaks: no limit is given. Give force, moment, or both."),
            std::string::npos);
  // A joint that is not assembled when it is to be switched on.
  Simulation s = made(discs(R"(
  pin: {type: spherical, bodies: [one, two], at_body: [[0.3, 0, 0.05], [0, 0.3, -0.05]]}
events:
  open: {at: 0, off: [pin]}
  close: {at: 0.1 s, on: [pin]}
)",
                            "ground"));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::not_converged);
  EXPECT_NE(r.message.find("joint 'pin' cannot be switched on"), std::string::npos) << r.message;
}

}  // namespace
}  // namespace polhode::test::events_tests
