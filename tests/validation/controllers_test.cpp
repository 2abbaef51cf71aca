// SPDX-License-Identifier: Apache-2.0
// Controllers on channels: closed forms, recurrences of sampled loops, order, restart.
#include <cmath>
#include <complex>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/system/state_archive.hpp>
#include <support/run_text.hpp>

namespace polhode::test::controllers_tests {
namespace {

/// A cart of 2 kg on a rail with the force of a controller.
std::string cart(const std::string& controller, const std::string& more = "") {
  return R"(
format: 1
variables: {h: 2 ms, rho: 1}
bodies: {cart: {mass: 2, inertia: [1, 1, 1]}}
joints: {rail: {type: prismatic, bodies: [ground, cart], at: [0, 0, 0], axis: x}}
loads: {push: {type: linear_motor, joint: rail, force: {controller: c}}}
controllers: {c: {joint: rail, channel: z, )" +
         controller + R"(}}
analysis: {type: dynamics, duration: 1 s, step: h, rho_inf: rho}
output: {hdf5: false}
)" + more;
}

/// A disc of 0.2 kg m² with bearings of 0.3 N m s, driven to a speed.
std::string disc(const std::string& controller) {
  return R"(
format: 1
variables: {h: 2 ms, rho: 1}
bodies: {disc: {mass: 1, inertia: [0.1, 0.1, 0.2]}}
joints: {axle: {type: revolute, bodies: [ground, disc], at: [0, 0, 0], axis: z}}
loads:
  bearing: {type: torsional_spring, joint: axle, damping: 0.3}
  motor: {type: rotary_motor, joint: axle, moment: {controller: c}}
controllers: {c: {joint: axle, channel: rate rz, )" +
         controller + R"(}}
analysis: {type: dynamics, duration: 1 s, step: h, rho_inf: rho}
output: {hdf5: false}
)";
}

/// Checks that the value of `end` converges to the exact one with order 2, at h, h/2 and h/100.
template <class End>
void expect_second_order(End&& end, double truth, double h) {
  for (const char* rho : {"1", "0.7"}) {
    const double first = std::abs(end(h, rho) - truth),
                 second = std::abs(end(0.5 * h, rho) - truth);
    const double finest = std::abs(end(0.01 * h, rho) - truth);
    EXPECT_NEAR(std::log2(first / second), 2.0, 0.35) << rho << ' ' << first;
    EXPECT_LT(finest, 4e-4 * first + 1e-10) << rho;
  }
}

}  // namespace

// 2 ẍ + 6 ẋ + 50 x = 50·0.1 from rest: 0.1 (1 − e^{−δt}(cos ωt + δ/ω sin ωt)).
// @tests{controller} @tests{controller-steps}
TEST(Controllers, HaveTheStepResponseOfPd) {
  const double d = 1.5, w = std::sqrt(25.0 - d * d);
  const double x = 0.1 * (1.0 - std::exp(-d) * (std::cos(w) + d / w * std::sin(w)));
  expect_second_order(
      [](double h, const char* rho) {
        Simulation s = made(cart("setpoint: 0.1, proportional: 50, derivative: 6"),
                            {format("h={:.17g}", h), format("rho={}", rho)});
        const RunSummary r = finished(s);
        // Its work is supplied energy.
        if (std::string(rho) == "1") {
          EXPECT_LT(r.energy_drift, 1e-11);
        }
        return s.body(0).r[0];
      },
      x, 0.02);
}

// A setpoint that jumps at 0.3 s and has a kink at 0.6 s, which are ends of steps: order 2
// nevertheless. By superposition of step and ramp responses.
TEST(Controllers, FollowASetpointThatJumps) {
  const double d = 1.5, w = std::sqrt(25.0 - d * d);
  const auto step = [&](double t) {
    return 1.0 - std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t));
  };
  // The rate of a setpoint acts, its jumps do not: 50 r + 6 ṙ = 50·0.1 after the jump, and behind
  // the kink (50·0.4 t + 6·0.4) in addition: a ramp of ∫ step, and a step of 2.4/50.
  double ramp = 0.0;
  const int n = 4000;
  for (int k = 0; k < n; ++k) ramp += step(0.4 * (k + 0.5) / n) * 0.4 / n;
  const double x = 0.1 * step(0.7) + 0.4 * ramp + 2.4 / 50.0 * step(0.4);
  expect_second_order(
      [](double h, const char* rho) {
        Simulation s = made(
            cart("setpoint: \"t < 0.3 ? 0 : t < 0.6 ? 0.1 : 0.1 + 0.4*(t - 0.6)\", proportional: "
                 "50, derivative: 6"),
            {format("h={:.17g}", h), format("rho={}", rho)});
        (void)finished(s);
        return s.body(0).r[0];
      },
      x, 0.02);
}

// Between samples the force is constant, and the cart's parabola exact: the sampled loop is a
// recurrence, satisfied to rounding at any step.
TEST(Controllers, AreSampled) {
  const double T = 0.04, m = 2.0, kp = 50.0, kd = 6.0, ki = 30.0;
  double x = 0.0, v = 0.0, sum = 0.0, last = 0.1, u = 0.0;
  for (int k = 0; k < 25; ++k) {
    const double e = 0.1 - x;
    if (k > 0) sum += 0.5 * T * (e + last);
    last = e;
    u = kp * e + ki * sum - kd * v;
    x += v * T + 0.5 * u / m * T * T;
    v += u / m * T;
  }
  for (const double h : {0.02, 0.01, 0.003, 0.0004}) {
    Simulation s =
        made(cart("sample: 40 ms, setpoint: 0.1, proportional: 50, derivative: 6, integral: 30"),
             {format("h={:.17g}", h)});
    (void)finished(s);
    EXPECT_NEAR(s.body(0).r[0], x, 1e-12) << h;
    EXPECT_NEAR(s.body(0).v[0], v, 1e-11) << h;
  }
  for (const char* order : {"4", "6"}) {
    Simulation s =
        made(cart("sample: 40 ms, setpoint: 0.1, proportional: 50, derivative: 6, integral: 30"),
             {"h=0.01", format("analysis.order={}", order)});
    (void)finished(s);
    EXPECT_NEAR(s.body(0).r[0], x, 1e-12) << order;
  }
}

// PI control of the speed of a disc with viscous bearings: J ω̈ + (b + k_p) ω̇ + k_i ω = k_i ω_r.
TEST(Controllers, ControlASpeed) {
  const double J = 0.2, b = 0.3, kp = 1.1, ki = 8.0, target = 10.0;
  using Complex = std::complex<double>;
  const Complex root = std::sqrt(Complex((b + kp) * (b + kp) - 4.0 * J * ki));
  const Complex p = (-(b + kp) + root) / (2.0 * J), q = (-(b + kp) - root) / (2.0 * J);
  // ω = ω_r + A e^{pt} + B e^{qt}, ω(0) = 0, ω̇(0) = k_p ω_r/J.
  const Complex A = (kp * target / J + target * q) / (p - q), B = -target - A;
  const double w = target + (A * std::exp(p) + B * std::exp(q)).real();
  expect_second_order(
      [](double h, const char* rho) {
        Simulation s = made(disc("setpoint: 10 rad/s, proportional: 1.1, integral: 8"),
                            {format("h={:.17g}", h), format("rho={}", rho)});
        (void)finished(s);
        return s.body(0).omega()[2];
      },
      w, 0.01);
}

// Step responses of a lag, of an oscillator and of a lead, to a constant error of 1.
TEST(Controllers, HaveTheStepResponsesOfTransferFunctions) {
  const std::string text = R"(
format: 1
variables: {h: 5 ms}
bodies: {post: {mass: 1, inertia: [1, 1, 1]}}
controllers:
  lag: {body: post, channel: x, setpoint: 1, numerator: 1, denominator: [0.2, 1]}
  oscillator: {body: post, channel: x, setpoint: 1, numerator: 40, denominator: [1, 3, 40]}
  lead: {body: post, channel: x, setpoint: 1, numerator: [0.5, 1], denominator: [0.1, 1], sample: 20 ms}
analysis: {type: dynamics, duration: 0.6 s, step: h}
output: {hdf5: false, probes: {lag: {controller: lag}}}
)";
  const double t = 0.6, d = 1.5, w = std::sqrt(40.0 - d * d);
  const double lag = 1.0 - std::exp(-t / 0.2);
  const double oscillator = 1.0 - std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t));
  double last = 0.0;
  for (const double h : {0.01, 0.005, 0.0001}) {
    Simulation s = made(text, {format("h={:.17g}", h)});
    (void)finished(s);
    EXPECT_NEAR(s.controller("lag")[2], lag, 3.0 * h * h + 1e-12) << h;
    const double off = std::abs(s.controller("oscillator")[2] - oscillator);
    EXPECT_LT(off, 40.0 * h * h) << h;
    if (h == 0.005) {
      EXPECT_NEAR(last / off, 4.0, 0.3);
    }
    last = off;
    // (0.5 s + 1)/(0.1 s + 1) of a step, by the trapezoidal rule of 20 ms: 1 + 4 ((2τ − T)/(2τ +
    // T))^k.
    EXPECT_NEAR(s.controller("lead")[2], 1.0 + 4.0 * std::pow(0.18 / 0.22, 30), 1e-12) << h;
  }
}

// The limits hold without windup of the integral: the controller leaves its limit when the error
// changes its sign.
TEST(Controllers, KeepTheirLimitsWithoutWindup) {
  Simulation s = made(disc("setpoint: 10, proportional: 0.5, integral: 4, minimum: -3, maximum: 3"),
                      {"analysis.duration=4"});
  double most = 0.0, peak = 0.0;
  const RunSummary r = s.run({}, [&](Simulation& now) {
    most = std::max(most, std::abs(now.controller(0)[2]));
    peak = std::max(peak, now.body(0).omega()[2]);
  });
  EXPECT_EQ(r.end, RunEnd::finished);
  EXPECT_EQ(most, 3.0);
  EXPECT_LT(peak, 10.5);  // 3 N m are just enough for 10 rad/s
  EXPECT_NEAR(s.body(0).omega()[2], 10.0, 0.3);
}

// One controller sets the speed for another.
TEST(Controllers, CanBeCascaded) {
  const std::string text = R"(
format: 1
bodies: {disc: {mass: 1, inertia: [0.1, 0.1, 0.2]}}
joints: {axle: {type: revolute, bodies: [ground, disc], at: [0, 0, 0], axis: z}}
loads: {motor: {type: rotary_motor, joint: axle, moment: {controller: inner}}}
controllers:
  outer: {joint: axle, channel: rz, setpoint: 1 rad, proportional: 4, sample: 20 ms}
  inner: {joint: axle, channel: rate rz, setpoint: {controller: outer}, proportional: 5, sample: 2 ms}
analysis: {type: dynamics, duration: 4 s, step: 1 ms}
output: {hdf5: false}
)";
  Simulation s = made(text);
  (void)finished(s);
  EXPECT_NEAR(s.joint(0).coordinates[0], 1.0, 1e-5);
}

// Simulations of the same model are independent of each other.
TEST(Controllers, AreIndependentInEachSimulation) {
  const std::string text = cart("sample: 40 ms, setpoint: 0.1, proportional: 50, derivative: 6");
  Simulation alone = made(text);
  (void)finished(alone);
  Simulation one = made(text);
  Simulation two(Model(one.model()));
  while (one.time() < 0.5) ASSERT_TRUE(one.step(1.0).accepted);
  while (two.time() < 0.999999) ASSERT_TRUE(two.step(1.0).accepted);
  (void)finished(one);
  EXPECT_EQ(one.state_hash(), alone.state_hash());
  EXPECT_EQ(two.body(0).r[0], alone.body(0).r[0]);
}

TEST(Controllers, ContinueBitForBitAfterARestart) {
  const std::string events = "events: {let_go: {at: 0.7 s, off: [push]}}\n";
  for (const char* sample : {"", "sample: 30 ms, "})
    for (const bool switched : {false, true}) {
      const std::string text = cart(std::string(sample) +
                                        "setpoint: 0.1*sin(5*t), proportional: 50, derivative: 6, "
                                        "filter: 20 ms, integral: 3",
                                    switched ? events : "");
      Simulation straight = made(text);
      (void)finished(straight);
      for (const double cut : {0.05, 0.5, 0.8}) {
        Simulation first = made(text);
        while (first.time() < cut) ASSERT_TRUE(first.step(1.0).accepted);
        const std::string bytes = state_bytes(first.system(), first.state());
        Simulation second(io::read_model_text(text, "model.yaml", {}),
                          state_from_bytes(first.system(), bytes, "here"));
        (void)finished(second);
        EXPECT_EQ(second.state_hash(), straight.state_hash()) << sample << cut;
      }
    }
}

TEST(Controllers, ReportErrors) {
  expect_fault(cart("proportional: 1, sampl: 3"), "controllers.c: unknown key 'sampl'");
  expect_fault(cart("setpoint: 1"), "controllers.c: has no gains. Give proportional, integral");
  expect_fault(cart("proportional: 1, numerator: 1"), "Give gains or a transfer function.");
  expect_fault(cart("numerator: [1, 2], denominator: 3"),
               "is of higher order than the denominator");
  expect_fault(cart("proportional: 1, minimum: 2, maximum: 1"), "controllers.c.maximum: is below");
  expect_fault(cart("proportional: 1, filter: 1 s"),
               "controllers.c.filter: requires a derivative gain");
  std::string text = cart("proportional: 1");
  text.replace(text.find("channel: z"), 10, "channel: y");
  expect_fault(text, "controllers.c.channel: 'y' is no channel of the joint 'rail'.");
  text = cart("derivative: 1");
  text.replace(text.find("channel: z"), 10, "channel: fx");
  expect_fault(text, "controllers.c.derivative: needs the rate of 'fx', which is not available");
  text = cart("proportional: 1");
  text.replace(text.find("controller: c}"), 14, "controller: d}");
  expect_fault(text, "loads.push.force.controller: unknown controller 'd'. Controllers: c.");
  text = cart("proportional: 1");
  text.replace(text.find("force:"), 6, "displacement:");
  expect_fault(text,
               "loads.push.displacement: is prescribed, but the output of a controller may jump.");
  text = cart("proportional: 1");
  text.replace(text.find("type: dynamics"), 14, "order: 4, type: dynamics");
  expect_fault(text, "controllers.c: is continuous, which requires order 2, not 4.");
  text = cart("proportional: 1");
  text.replace(text.find("type: dynamics, duration: 1 s, step: h, rho_inf: rho"), 52,
               "type: statics");
  expect_fault(text, "controllers: act in time, which statics and modes do not have.");
}

}  // namespace polhode::test::controllers_tests
