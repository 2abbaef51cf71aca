// SPDX-License-Identifier: Apache-2.0
// Motors in joints: closed forms of driven mechanisms, balance of energy, orders, kinks.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::motor_tests {
namespace {

constexpr double kG = 9.81;

/// What the load reports at each step: force or moment (3), coordinate, rate, power, work.
struct Driven {
  RunSummary summary;
  std::vector<double> t;
  std::vector<std::vector<double>> report;
};

Driven run(const std::string& text, const io::Overrides& overrides = {}) {
  Simulation s(io::read_model_text(text, "driven.yaml", overrides));
  Driven d;
  const auto look = [&](Simulation& now) {
    d.t.push_back(now.time());
    d.report.push_back(now.load(now.model().load_index("motor")));
  };
  d.summary = s.run(look);
  EXPECT_EQ(d.summary.end, RunEnd::finished) << d.summary.message;
  return d;
}

// 2 kg at 0.5 m from a horizontal hinge along y, released horizontally; positive angles are
// downward.
std::string arm(const std::string& motor, const std::string& step = "h") {
  return R"(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 2 ms}
bodies: {arm: {mass: 2, inertia: [0.01, 0.02, 0.02], position: [0.5, 0, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: y}}
loads: {motor: {type: rotary_motor, joint: hinge, )" +
         motor + R"(}}
analysis: {type: dynamics, duration: 1 s, step: )" +
         step + R"(}
output: {hdf5: false}
)";
}

// J φ̈ = M + m g l cos φ about the hinge, J = 0.02 + 2·0.25. @tests{drive-row}
TEST(Motor, TurnsAnArmWithTheMomentOfTheClosedForm) {
  const double J = 0.52, mgl = 2.0 * kG * 0.5;
  struct Case {
    const char* motor;
    double (*angle)(double);
    double (*second)(double);
  };
  const Case cases[] = {
      {"angle: \"3*t^2\"", [](double t) { return 3.0 * t * t; }, [](double) { return 6.0; }},
      {"angle: \"sin(4*t)\"", [](double t) { return std::sin(4.0 * t); },
       [](double t) { return -16.0 * std::sin(4.0 * t); }},
      {"speed: \"6*t\"", [](double t) { return 3.0 * t * t; }, [](double) { return 6.0; }}};
  for (const Case& c : cases)
    for (const char* h : {"50 ms", "2 ms", "0.5 ms"}) {
      const Driven d = run(arm(c.motor), {std::string("variables.h=") + h});
      for (std::size_t k = 0; k < d.t.size(); ++k) {
        const double phi = c.angle(d.t[k]);
        EXPECT_NEAR(d.report[k][3], phi, 1e-11) << c.motor << ' ' << h << ' ' << d.t[k];
        EXPECT_NEAR(d.report[k][1], J * c.second(d.t[k]) - mgl * std::cos(phi), 1e-8)
            << c.motor << ' ' << h << ' ' << d.t[k];
      }
      EXPECT_LT(d.summary.energy_drift, 1e-12) << c.motor << ' ' << h;
      EXPECT_LT(d.summary.linear_momentum_drift, 1e-11) << c.motor << ' ' << h;
      EXPECT_LT(d.summary.angular_momentum_drift, 1e-11) << c.motor << ' ' << h;
    }
}

// Work of the motor: the energy of the arm, ½ J φ̇² − m g l sin φ, up to the difference between the
// velocities of step and drive.
TEST(Motor, SuppliesTheEnergyOfTheArm) {
  for (const char* h : {"10 ms", "1 ms"}) {
    const Driven d = run(arm("angle: \"3*t^2\""), {std::string("variables.h=") + h});
    const double step = h[1] == '0' ? 0.01 : 0.001;
    EXPECT_NEAR(d.report.back()[6], 0.5 * 0.52 * 36.0 - 2.0 * kG * 0.5 * std::sin(3.0),
                100.0 * step * step)
        << h;
  }
}

// A constant moment on a free turn: φ = M t²/2J. A force on a slider likewise.
TEST(Motor, WithAGivenForceAccelerates) {
  for (const char* h : {"50 ms", "0.5 ms"}) {
    const Driven d =
        run(arm("moment: 0.26"), {std::string("variables.h=") + h, "gravity=[0, 0, 0]"});
    const double step = h[0] == '5' ? 0.05 : 0.0005;  // the Cayley transform turns too little
    EXPECT_NEAR(d.report.back()[3], 0.25, 0.004 * step * step) << h;
    EXPECT_NEAR(d.report.back()[6], 0.26 * d.report.back()[3], 1e-12) << h;
    EXPECT_LT(d.summary.energy_drift, 1e-12) << h;
  }
}

// A cart of 1 kg driven along its rail, with a pendulum of two links.
constexpr const char* kCart = R"yaml(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 2 ms, T: 1 s}
bodies:
  cart: {mass: 1, inertia: [0.01, 0.01, 0.01], position: [0, 0, 0]}
  upper: {mass: 0.5, inertia: [0.01, 0.01, 0.001], position: [0, 0, -0.25]}
  lower: {mass: 0.3, inertia: [0.005, 0.005, 0.0005], position: [0, 0, -0.7]}
joints:
  rail: {type: prismatic, bodies: [ground, cart], at: [0, 0, 0], axis: x}
  ball: {type: spherical, bodies: [cart, upper], at: [0, 0, 0]}
  elbow: {type: revolute, bodies: [upper, lower], at: [0, 0, -0.5], axis: y}
loads: {motor: {type: linear_motor, joint: rail, displacement: "0.1*sin(5*t)"
}
}
analysis: {type: dynamics, duration: T, step: h, order: 2}
output: {hdf5: false}
)yaml";

TEST(Motor, DrivesACartWithTheOrderOfTheMethodAndItsWork) {
  for (const int order : {2, 4, 6}) {
    std::vector<double> x;
    for (const char* h : {"20 ms", "10 ms", "5 ms"}) {
      Simulation s(io::read_model_text(
          kCart, "cart.yaml",
          {std::string("variables.h=") + h, "analysis.order=" + std::to_string(order)}));
      const RunSummary r = s.run();
      EXPECT_LT(r.energy_drift, 1e-11) << order << ' ' << h;
      EXPECT_LT(r.constraint_residual_max, 1e-12) << order << ' ' << h;
      x.push_back(s.body(s.model().body_index("lower")).r.x());
    }
    const double rate = std::log2(std::abs((x[1] - x[0]) / (x[2] - x[1])));
    EXPECT_GT(rate, order - 0.5) << order << ": " << x[0] - x[1] << ' ' << x[1] - x[2];
  }
}

// Order 8 at steps that are long enough to show it: errors decrease by more than 2^7 as the step
// halves, down to round-off.
TEST(Motor, DrivesACartWithOrderEight) {
  const auto x_of = [](const char* h, int order) {
    Simulation s(io::read_model_text(
        kCart, "cart.yaml",
        {std::string("variables.h=") + h, "analysis.order=" + std::to_string(order)}));
    const RunSummary r = s.run();
    EXPECT_EQ(r.end, RunEnd::finished) << r.message;
    EXPECT_LT(r.energy_drift, 1e-11) << order << ' ' << h;
    return s.body(s.model().body_index("lower")).r.x();
  };
  const double reference = x_of("5 ms", 8);
  const double coarse = std::abs(x_of("50 ms", 8) - reference);
  const double fine = std::abs(x_of("25 ms", 8) - reference);
  EXPECT_GT(std::log2(coarse / std::max(fine, 1e-14)), 7.0) << coarse << ' ' << fine;
  EXPECT_NEAR(x_of("5 ms", 6), reference, 1e-10);
}

// A ramp that begins and ends: after its kinks the force is that of the pendulum alone, without
// oscillations. @tests{drive-kink}
TEST(Motor, DoesNotRingAfterAKink) {
  const std::string table =
      "loads.motor.displacement={table: [[0, 0], [0.2, 0], [0.6, 0.2]], interpolation: linear}";
  std::vector<double> last;
  for (const char* h : {"4 ms", "2 ms", "1 ms"}) {
    const Driven d = run(kCart, {std::string("variables.h=") + h, table});
    double jumps = 0.0, largest = 0.0;
    for (std::size_t k = 2; k < d.t.size(); ++k) {
      if (d.t[k] < 0.21 || (d.t[k] > 0.59 && d.t[k] < 0.62)) continue;
      jumps =
          std::max(jumps, std::abs(d.report[k][0] - 2.0 * d.report[k - 1][0] + d.report[k - 2][0]));
      largest = std::max(largest, std::abs(d.report[k][0]));
    }
    EXPECT_LT(jumps, 0.02 * largest) << h;
    EXPECT_LT(d.summary.energy_drift, 1e-10) << h;
    // The drive's rate after the last kink is zero, and so is the cart's speed.
    EXPECT_NEAR(d.report.back()[4], 0.0, 1e-9) << h;
    last.push_back(d.report.back()[0]);
  }
  EXPECT_NEAR(last[1] - last[0], 4.0 * (last[2] - last[1]), 0.5 * std::abs(last[1] - last[0]));
}

// Slider-crank at 10 rad/s: x = r cos φ + sqrt(l² − r² sin² φ), a loop with redundant rows.
TEST(Motor, TurnsASliderCrankThroughItsDeadPoints) {
  constexpr const char* kText = R"(
format: 1
variables: {h: 2 ms}
bodies:
  crank: {mass: 1, inertia: [0.01, 0.01, 0.01], position: [0.1, 0, 0]}
  rod: {mass: 1, inertia: [0.01, 0.02, 0.02], position: [0.5, 0, 0]}
  slider: {mass: 2, inertia: [0.01, 0.01, 0.01], position: [0.8, 0, 0]}
joints:
  shaft: {type: revolute, bodies: [ground, crank], at: [0, 0, 0], axis: z}
  pin: {type: revolute, bodies: [crank, rod], at: [0.2, 0, 0], axis: z}
  wrist: {type: revolute, bodies: [rod, slider], at: [0.8, 0, 0], axis: z}
  guide: {type: prismatic, bodies: [ground, slider], at: [0.8, 0, 0], axis: x}
loads: {motor: {type: rotary_motor, joint: shaft, speed: 10 rad/s}}
analysis: {type: dynamics, duration: 2 s, step: h}
output: {hdf5: false}
)";
  for (const char* h : {"10 ms", "1 ms"}) {
    Simulation s(io::read_model_text(kText, "slider.yaml", {std::string("variables.h=") + h}));
    const int slider = s.model().body_index("slider");
    const auto look = [&](Simulation& now) {
      const double phi = 10.0 * now.time(), r = 0.2 * std::sin(phi);
      EXPECT_NEAR(now.body(slider).r.x(), 0.2 * std::cos(phi) + std::sqrt(0.36 - r * r), 1e-10)
          << h << ' ' << now.time();
    };
    const RunSummary summary = s.run(look);
    EXPECT_EQ(summary.end, RunEnd::finished) << summary.message;
    EXPECT_LT(summary.energy_drift, 1e-11) << h;
  }
}

TEST(Motor, HoldsAnArmInStatics) {
  Simulation s(io::read_model_text(R"(
format: 1
gravity: [0, 0, -9.81]
bodies: {arm: {mass: 2, inertia: [0.01, 0.02, 0.02], position: [0.5, 0, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: y}}
loads: {motor: {type: rotary_motor, joint: hinge, angle: 60 deg}}
analysis: {type: statics}
output: {hdf5: false}
)",
                                   "statics.yaml"));
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  const std::vector<double> report = s.load(0);
  EXPECT_NEAR(report[3], std::numbers::pi / 3.0, 1e-12);
  EXPECT_NEAR(report[1], -2.0 * kG * 0.5 * std::cos(std::numbers::pi / 3.0), 1e-8);
}

std::string fault(const std::string& text, const io::Overrides& overrides = {}) {
  try {
    Simulation s(io::read_model_text(text, "driven.yaml", overrides));
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

TEST(Motor, RefusesInvalidDrives) {
  EXPECT_NE(fault(arm("angle: 1, speed: 2")).find("cannot be combined with 'angle'"),
            std::string::npos);
  EXPECT_NE(fault(arm("coordinate: ry")).find("has no function of time"), std::string::npos);
  EXPECT_NE(fault(arm("coordinate: rx, angle: 0")).find("'rx' is not free"), std::string::npos);
  EXPECT_NE(
      fault(kCart, {"loads.motor.joint=elbow"}).find("does not have exactly one free displacement"),
      std::string::npos);
  EXPECT_NE(fault(arm("angle: \"t > 0.5 ? 1 : 0\"")).find("jumps by 1 rad at t = 0.5 s"),
            std::string::npos);
  EXPECT_NE(fault(arm("speed: 1"), {"analysis={type: statics}"}).find("is a rate"),
            std::string::npos);
}

}  // namespace
}  // namespace polhode::motor_tests
