// SPDX-License-Identifier: Apache-2.0
// Gears, racks and screws in complete models: ratios, reduced inertia, reactions.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <validation/connector_runs.hpp>

namespace polhode::gears_tests {

using namespace connectors;

// Willis: with the ring held, ω_c = ω_s z_s/(z_s + z_r) = ω_s/4. The sun is driven relative to the
// carrier, with the speed ω_s − ω_c = 3 ω_c. The moment M between sun and carrier accelerates the
// inertia reduced to the carrier, J = J_c + m_p R² + 16 J_s + (1−3)² J_p. @tests{gear-row}
// @tests{gear-angle}
TEST(Connectors, APlanetaryTrainHasWillisRatioAndItsInertia) {
  const double J = 0.08 + 0.04 + 16.0 * 0.02 + 4.0 * 0.008, M = 0.6;
  for (const Step& step : kSteps) {
    const Outcome o = run(planetary("  drive: {type: rotary_motor, joint: shaft, moment: 0.6}",
                                    "type: dynamics, duration: 2 s, step: h"),
                          {step_of(step)});
    const double omega_c = o.body(0).W.z();
    EXPECT_NEAR(o.body(1).W.z(), 4.0 * omega_c, 1e-9) << step.text;
    EXPECT_NEAR(o.body(2).W.z(), -2.0 * omega_c, 1e-9) << step.text;
    EXPECT_NEAR(omega_c, 3.0 * M / J * 2.0, 200.0 * step.h * step.h) << step.text;
    EXPECT_LT(o.summary.energy_drift, 1e-11) << step.text;
    // Moment of the teeth on the sun: M − J_s ω̇_s.
    EXPECT_NEAR(o.load[0], -(M - 0.02 * 12.0 * M / J), 30.0 * step.h * step.h + 1e-8) << step.text;
    EXPECT_NEAR(o.load[1], o.load[0], 1e-12) << step.text;  // ratio −1: the same on the planet
  }
}

TEST(Connectors, APlanetaryTrainDrivenAtConstantSpeedKeepsItsRatioOverManyTurns) {
  for (const int order : {2, 4, 6}) {
    const Outcome o = run(
        planetary("  drive: {type: rotary_motor, joint: main, speed: 20 rad/s}",
                  "type: dynamics, duration: 10 s, step: 20 ms, order: " + std::to_string(order)));
    // Turns counted: the sun by 600 rad relative to the carrier.
    EXPECT_NEAR(o.load[2], 600.0, 1e-8) << order;
    EXPECT_NEAR(o.load[3], -600.0, 1e-8) << order;
    EXPECT_LT(o.summary.energy_drift, 1e-10) << order;
  }
}

// A car's differential: bevel wheels on a carrier that turns; ω_left + ω_right = 2 ω_carrier, and
// the response to a moment on one side.
TEST(Connectors, ADifferentialSharesTheSpeedOfItsCarrier) {
  const std::string text = R"(
format: 1
variables: {h: 2 ms}
bodies:
  cage: {mass: 5, inertia: [0.1, 0.1, 0.1]}
  left: {mass: 1, inertia: [0.02, 0.02, 0.02], position: [0, 0.1, 0]}
  right: {mass: 1, inertia: [0.02, 0.02, 0.02], position: [0, -0.1, 0]}
  spider: {mass: 0.3, inertia: [0.001, 0.001, 0.001], position: [0.08, 0, 0]}
joints:
  cage: {type: revolute, bodies: [ground, cage], at: [0, 0, 0], axis: y}
  left: {type: revolute, bodies: [cage, left], at: [0, 0.1, 0], axis: y}
  right: {type: revolute, bodies: [cage, right], at: [0, -0.1, 0], axis: y}
  spider: {type: revolute, bodies: [cage, spider], at: [0.08, 0, 0], axis: x}
loads:
  it: {type: gear, joints: [left, spider], ratio: 0.5}
  other: {type: gear, joints: [right, spider], ratio: -0.5}
  engine: {type: rotary_motor, joint: cage, speed: 10 rad/s}
  brake: {type: moment, body: left, moment: [0, -0.3, 0]}
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)";
  for (const Step& step : kSteps) {
    const Outcome o = run(text, {step_of(step)});
    const double left = o.body(1).W.y(), right = o.body(2).W.y();
    EXPECT_NEAR(left + right, 20.0, 1e-9) << step.text;
    // −0.3 on one side: J_left, J_right and the spider (twice as fast) are accelerated together.
    const double J = 0.02 + 0.02 + 4.0 * 0.001;
    EXPECT_NEAR(left, 10.0 - 0.3 / J, 60.0 * step.h * step.h) << step.text;
    EXPECT_LT(o.summary.energy_drift, 1e-11) << step.text;
  }
}

// Rack of 2 kg and pinion of J = 0.02 and 0.1 m: s̈ = (M/r)/(m + J/r²); on the ground, and on a
// moving carrier.
TEST(Connectors, ARackRunsUnderItsPinion) {
  const auto text = [](const std::string& carrier) {
    return R"(
format: 1
variables: {h: 2 ms}
bodies:
  carrier: {mass: 50, inertia: [9, 9, 9], velocity: [0, 3, 0]}
  rack: {mass: 2, inertia: [0.1, 0.1, 0.1], position: [0, -0.1, 0], velocity: )" +
           std::string(carrier == "ground" ? "[0, 0, 0]" : "[0, 3, 0]") + R"(}
  pinion: {mass: 1, inertia: [0.01, 0.01, 0.02], velocity: )" +
           std::string(carrier == "ground" ? "[0, 0, 0]" : "[0, 3, 0]") + R"(}
joints:
  floor: {type: prismatic, bodies: [ground, carrier], at: [0, 0, 0], axis: y}
  slide: {type: prismatic, bodies: [)" +
           carrier + R"(, rack], at: [0, -0.1, 0], axis: x}
  axle: {type: revolute, bodies: [)" +
           carrier + R"(, pinion], at: [0, 0, 0], axis: z}
loads:
  it: {type: gear, joints: [slide, axle], radius: 0.1}
  drive: {type: rotary_motor, joint: axle, moment: 0.4}
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)";
  };
  const double s_2 = (0.4 / 0.1) / (2.0 + 0.02 / 0.01);
  for (const char* carrier : {"ground", "carrier"})
    for (const Step& step : kSteps) {
      const Outcome o = run(text(carrier), {step_of(step)});
      EXPECT_NEAR(o.body(1).v.x(), s_2, 20.0 * step.h * step.h) << carrier << ' ' << step.text;
      EXPECT_NEAR(o.load[2], 0.1 * o.load[3], 1e-12) << carrier << ' ' << step.text;
      EXPECT_NEAR(o.load[0], 2.0 * s_2, 20.0 * step.h * step.h + 1e-9)
          << carrier << ' ' << step.text;
      EXPECT_LT(o.summary.energy_drift, 1e-11) << carrier << ' ' << step.text;
    }
}

// A nut of 2 kg and J = 0.02 runs down a screw of 50 mm: z̈ = −g/(1 + (2π/p)² J/m); orders. The
// screw carries m (g − |z̈|). @tests{gear-row}
TEST(Connectors, ANutRunsDownItsScrew) {
  const std::string text = R"(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 2 ms}
bodies: {nut: {mass: 2, inertia: [0.01, 0.01, 0.02], position: [0, 0, 0.5]}}
joints: {sleeve: {type: cylindrical, bodies: [ground, nut], at: [0, 0, 0.5], axis: z}}
loads: {it: {type: screw, joint: sleeve, pitch: 50 mm}}
analysis: {type: dynamics, duration: 2 s, step: h, order: 2}
output: {hdf5: false}
)";
  const double p = 0.05, per = 2.0 * kPi / p, a = 9.81 / (1.0 + per * per * 0.02 / 2.0);
  for (const Step& step : kSteps)
    for (const int order : {2, 4, 6}) {
      const Outcome o = run(text, {step_of(step), "analysis.order=" + std::to_string(order)});
      const double h2 = order == 2   ? 2.0 * step.h * step.h
                        : order == 4 ? 3.0 * std::pow(step.h, 4)
                                     : 0.0;
      EXPECT_NEAR(o.body(0).r.z(), 0.5 - 2.0 * a, h2 + 1e-8) << step.text << ' ' << order;
      EXPECT_NEAR(o.load[2], p / (2.0 * kPi) * o.load[3], 1e-13) << step.text << ' ' << order;
      EXPECT_NEAR(o.load[0], 2.0 * (9.81 - a), 10.0 * h2 + 1e-6) << step.text << ' ' << order;
      EXPECT_LT(o.summary.energy_drift, 1e-10) << step.text << ' ' << order;
    }
}

}  // namespace polhode::gears_tests
