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

/// Two wheels with hinges on a carrier, which is the ground or welded to it.
std::string pair_on(const std::string& carrier, const std::string& friction = "") {
  const auto hinge = [&](const char* wheel, const char* at) {
    return format("{{type: revolute, bodies: [{}, {}], at: [{}], axis: z{}}}", carrier, wheel, at,
                  friction);
  };
  return format(R"(
format: 1
variables: {{h: 1 ms}}
bodies:
  a: {{mass: 1, inertia: [0.02, 0.02, 0.02]}}
  b: {{mass: 1, inertia: [0.05, 0.05, 0.05], position: [0.3, 0, 0]}}
  frame: {{mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0, -1]}}
joints:
  weld: {{type: fixed, bodies: [ground, frame], at: [0, 0, -1]}}
  ja: {}
  jb: {}
loads:
  it: {{type: gear, joints: [ja, jb], ratio: -2}}
  m: {{type: rotary_motor, joint: ja, moment: 10}}
  k: {{type: torsional_spring, joint: jb, stiffness: 100}}
analysis: {{type: dynamics, duration: 0.1 s, step: h}}
output: {{hdf5: false}}
)",
                hinge("a", "0, 0, 0"), hinge("b", "0.3, 0, 0"));
}

// x of the wheels is φ and -φ/2: 0.0325 φ'' + 25 φ = 10. The teeth give the second wheel its moment
// at 0.2 m, and both hinges carry their force along the pitch line. @tests{gear-angle}
TEST(Connectors, HingesOnTheGroundCarryTheForceOfTeeth) {
  const double J = 0.02 + 0.05 / 4.0, w = std::sqrt(25.0 / J), c = std::cos(0.1 * w);
  const double F = (50.0 * 0.4 * (1.0 - c) + 0.025 * 0.4 * w * w * c) / 0.2;
  EXPECT_NEAR(F, 157.416, 1e-3);
  for (const char* carrier : {"ground", "frame"})
    for (const char* h : {"10 ms", "1 ms", "0.01 ms"}) {
      Simulation s(
          io::read_model_text(pair_on(carrier), "m.yaml", {std::string("variables.h=") + h}));
      const RunSummary r = s.run();
      const double step = std::string(h) == "10 ms" ? 0.01 : std::string(h) == "1 ms" ? 1e-3 : 1e-5;
      for (const char* joint : {"ja", "jb"}) {
        const Vec3 f = s.joint(joint).force;
        EXPECT_NEAR(std::abs(f.y()), F, 6e4 * step * step + 1e-5)
            << carrier << ' ' << joint << ' ' << h;
        EXPECT_NEAR(f.x(), 0.0, 1e-6 + 6e4 * step * step) << carrier << ' ' << joint << ' ' << h;
      }
      EXPECT_LT(r.angular_momentum_drift, 1e-10) << carrier << ' ' << h;
      EXPECT_LT(r.linear_momentum_drift, 1e-10) << carrier << ' ' << h;
      EXPECT_LT(r.energy_drift, 1e-10) << carrier << ' ' << h;
    }
}

// Bearing friction has the force of the teeth.
TEST(Connectors, FrictionOfHingesOnTheGroundIsThatOnACarrier) {
  const auto angle = [](const char* carrier, const char* friction) {
    return run(pair_on(carrier, friction)).load[2];
  };
  const double smooth = angle("ground", "");
  const char* rubs = ", friction: {mu: 0.3, radius: 20 mm}";
  EXPECT_GT(smooth - angle("ground", rubs), 0.01);
  EXPECT_NEAR(angle("ground", rubs), angle("frame", rubs), 1e-9);
}

// Shafts on one axis, and slides, have no teeth: the ground takes the difference of their moments
// and forces, which the balance of momentum contains.
TEST(Connectors, TheGroundTakesWhatAGearboxCannotBalance) {
  for (const char* h : {"20 ms", "2 ms", "0.2 ms"})
    for (const char* kind : {"revolute", "prismatic"}) {
      const Outcome o = run(format(R"(
format: 1
variables: {{h: 2 ms}}
bodies:
  a: {{mass: 1, inertia: [1, 1, 1]}}
  b: {{mass: 1, inertia: [1, 1, 1], position: [0, 0, 0.5]}}
joints:
  ja: {{type: {0}, bodies: [ground, a], at: [0, 0, 0], axis: z}}
  jb: {{type: {0}, bodies: [ground, b], at: [0, 0, 0.5], axis: z}}
loads:
  it: {{type: gear, joints: [ja, jb], ratio: -2}}
  m: {{type: moment, body: a, moment: [0, 0, 1]}}
  f: {{type: force, body: a, at: [0, 0, 0], force: [0, 0, 1]}}
analysis: {{type: dynamics, duration: 1 s, step: h}}
output: {{hdf5: false}}
)",
                                   kind),
                            {std::string("variables.h=") + h});
      EXPECT_NEAR(o.load[2], 0.4, 1e-5) << kind << ' ' << h;  // (1 + 1/4) q'' = 1, to h²
      EXPECT_LT(o.summary.angular_momentum_drift, 1e-10) << kind << ' ' << h;
      EXPECT_LT(o.summary.linear_momentum_drift, 1e-10) << kind << ' ' << h;
    }
}

// A ring on the ground: the balance of momentum of a planetary train, whose pin carries the forces
// of both meshes: twice that of the sun, if the planet is light.
TEST(Connectors, ARingOnTheGroundHoldsItsPlanet) {
  for (const char* h : {"20 ms", "2 ms", "0.2 ms"}) {
    Simulation s(
        io::read_model_text(planetary("  drive: {type: rotary_motor, joint: shaft, moment: 0.6}",
                                      "type: dynamics, duration: 0.5 s, step: h"),
                            "m.yaml", {std::string("variables.h=") + h}));
    const RunSummary r = s.run();
    EXPECT_LT(r.angular_momentum_drift, 1e-10) << h;
    EXPECT_LT(r.linear_momentum_drift, 1e-10) << h;
    // Radii 0.1 m of sun and planet; planet: J ω' = (F_sun - F_ring) 0.1 along the rim.
    const double J = 0.08 + 0.04 + 16.0 * 0.02 + 4.0 * 0.008, a = 3.0 * 0.6 / J;
    const double sun = (0.6 - 0.02 * 4.0 * a) / 0.1, ring = sun - 0.008 * 2.0 * a / 0.1;
    const BodyMotion carrier = s.body(0);
    const Vec3 along = carrier.q * Vec3::UnitY();
    const double mass = 1.0 * 0.2 * a;  // of the planet on its circle
    EXPECT_NEAR(std::abs(s.joint("pin").force.dot(along)), std::abs(sun + ring - mass),
                20.0 * 4e-4 * (h[0] == '2' && h[1] == '0' ? 1.0 : 0.01) + 1e-6)
        << h;
  }
}

}  // namespace polhode::gears_tests
