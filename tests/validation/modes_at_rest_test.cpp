// SPDX-License-Identifier: Apache-2.0
// Modes and statics of what has a state of its own or none: prescribed nodes, integrals of servos,
// loads that follow their body, rotors in any direction.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/modal.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::modes_at_rest_tests {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

ModesReport modes_of(const std::string& text, const io::Overrides& overrides = {}) {
  const ModalAnalysis analysis(io::read_model_text(text, "model.yaml", overrides));
  EXPECT_TRUE(analysis.converged()) << analysis.message();
  return analysis.report();
}

/// A bar clamped at one end and held at the other by prescribed nodes; without stretch, as
/// Poisson's ratio is zero. Timoshenko's beam with these ends has 1.604 Hz, in two planes.
TEST(ModesAtRest, PrescribedNodesClampTheEndOfABar) {
  const std::string bar = R"(
format: 1
materials: {s: {type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0.0, density: 1000}}
solids:
  b:
    mesh: {block: {size: [1, 0.05, 0.05], cells: [10, 1, 1]}}
    element: hex20
    material: s
    bonded: {ground: xmin}
    prescribed: {e: {nodes: xmax, x: 0, y: 0, z: 0}}
analysis: {type: modes, count: 4, about: ABOUT}
)";
  for (const char* about : {"equilibrium", "start"}) {
    std::string text = bar;
    text.replace(text.find("ABOUT"), 5, about);
    const ModesReport r = modes_of(text);
    ASSERT_EQ(r.modes.size(), 4u);
    EXPECT_TRUE(r.complete);
    for (int i = 0; i < 2; ++i)  // ten elements of one order are stiffer by less than a hundredth
      EXPECT_NEAR(r.modes[i].frequency, 1.604, 0.01 * 1.604) << about;
  }
}

/// The frequencies of a rotor do not depend on the axis along which it lies, nor does the silence.
TEST(ModesAtRest, ARotorIsSteadyAlongAnyAxis) {
  const std::string rotor = R"(
format: 1
materials: {s: {type: elastic, youngs_modulus: 200 GPa, poisson_ratio: 0.3, density: 7800}}
sections: {c: {type: circle, diameter: 30 mm, material: s}}
beams: {b: {points: [[0, 0, 0], END], elements: 10, section: c, angular_velocity: SPIN}}
joints:
  l: {type: spherical, bodies: [ground, b.start], at: [0, 0, 0]}
  r: {type: point_on_line, bodies: [ground, b.end], at: END, axis: AXIS}
analysis: {type: modes, count: 5}
)";
  const auto along = [&](const Vec3& axis) {
    const auto list = [](const Vec3& v) { return format("[{}, {}, {}]", v[0], v[1], v[2]); };
    std::string text = rotor;
    for (const auto& [key, value] : {std::pair<std::string, std::string>{"END", list(0.5 * axis)},
                                     {"END", list(0.5 * axis)},
                                     {"SPIN", list(100.0 * axis)},
                                     {"AXIS", list(axis)}})
      text.replace(text.find(key), key.size(), value);
    return modes_of(text);
  };
  const ModesReport x = along(Vec3::UnitX());
  for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ()),
                           Vec3(0.6, 0.0, 0.8), Vec3(2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0)}) {
    const ModesReport r = along(axis);
    for (const std::string& warning : r.warnings) ADD_FAILURE() << warning;
    ASSERT_EQ(r.modes.size(), 5u);
    for (int i = 0; i < 5; ++i)
      EXPECT_NEAR(r.modes[i].frequency, x.modes[i].frequency, 1e-6 * x.modes[4].frequency);
  }
}

TEST(ModesAtRest, ASolidThatRotatesWithItsBodyIsRefusedByName) {
  const char* disc = R"(
format: 1
materials: {s: {type: elastic, youngs_modulus: 200 GPa, poisson_ratio: 0.3, density: 7800}}
bodies: {hub: {mass: 1, inertia: [1, 1, 1], angular_velocity: [0, 0, 300]}}
joints: {j: {type: revolute, bodies: [ground, hub], at: [0, 0, 0], axis: z}}
solids: {disc: {mesh: {cylinder: {diameter: 0.4, length: 0.04, cells: [1, 8, 1]}}, element: hex20, material: s, bonded: {hub: start}}}
analysis: {type: modes}
)";
  try {
    (void)modes_of(disc);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("solids.disc: rotates with body 'hub'"));
  }
}

/// A thruster on a free body has no potential; a force fixed in the world has one.
TEST(ModesAtRest, ALoadThatFollowsItsBodyIsNamed) {
  const auto thrust = [](const char* fixed) {
    return modes_of(format(R"(
format: 1
bodies: {{craft: {{mass: 2, inertia: [1, 2, 3]}}}}
loads: {{main: {{type: force, body: craft, at: [0, 0, -1], force: [0, 0, 40], body_fixed: {}}}}}
analysis: {{type: modes, about: start}}
)",
                           fixed));
  };
  EXPECT_THAT(thrust("true").warnings.at(0), HasSubstr("force 'main' acts here with 40 N"));
  for (const std::string& warning : thrust("false").warnings)
    EXPECT_THAT(warning, Not(HasSubstr("main")));
}

/// A free body with any forces and moments that follow it moves the same after any rotation: six
/// free motions and no flutter. @tests{modes-turned-loads}
TEST(ModesAtRest, ThrustersTurnWithAFreeBody) {
  for (const char* thrust :
       {"at: [0, 0, -1], force: [0, 0, 40]", "at: [0.3, 0.1, -1], force: [1, 2, 10]"}) {
    const ModesReport r = modes_of(format(R"(
format: 1
bodies: {{craft: {{mass: 2, inertia: [1, 2, 3]}}}}
loads: {{main: {{type: force, body: craft, {}, body_fixed: true}}}}
analysis: {{type: modes, about: start}}
)",
                                          thrust));
    ASSERT_EQ(r.modes.size(), 6u) << thrust;
    std::vector<std::string> motions;
    for (const Mode& mode : r.modes) {
      EXPECT_EQ(mode.kind, ModeKind::free) << thrust;
      EXPECT_LT(mode.residual, 1e-6) << thrust;
      motions.push_back(mode.motion);
    }
    EXPECT_THAT(motions, Contains("body 'craft' moves along y"));
    EXPECT_THAT(motions, Contains("body 'craft' rotates about x; force 'main' turns with it"));
  }
}

/// A craft of two parts on a hinge with a spring: six free motions, and the vibration that it has
/// without thrusters, as these act through the axis of the hinge's vibration.
TEST(ModesAtRest, ThrustersLeaveAVibrationItsFrequency) {
  const auto craft = [](const char* loads) {
    return modes_of(std::string(R"(
format: 1
bodies:
  hull: {mass: 2, inertia: [1, 2, 3]}
  wing: {mass: 1, inertia: [0.1, 0.2, 0.3], position: [1, 0, 0]}
joints: {hinge: {type: revolute, bodies: [hull, wing], at: [0.5, 0, 0], axis: z}}
loads:
  spring: {type: torsional_spring, joint: hinge, stiffness: 100}
)") + loads + "analysis: {type: modes, about: start}\n");
  };
  const ModesReport without = craft("");
  const ModesReport with = craft(R"(
  main: {type: force, body: hull, at: [0, 0, -1], force: [0, 0, 10], body_fixed: true}
  left: {type: force, body: wing, at: [1, 0, 0.2], force: [0, 0, 3], body_fixed: true}
)");
  ASSERT_EQ(with.modes.size(), 7u);
  ASSERT_EQ(without.modes.size(), 7u);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(with.modes[i].kind, ModeKind::free) << i;
  EXPECT_EQ(with.modes[6].kind, ModeKind::oscillation);
  EXPECT_NEAR(with.modes[6].frequency, without.modes[6].frequency, 1e-9);
}

constexpr const char* kServo = R"(
format: 1
variables: {g: 0, c: 0, k_i: 300, hold: 1e9}
gravity: [g, 0, 0]
bodies: {s: {mass: 2, inertia: [0.01, 0.01, 0.01]}}
joints: {rail: {type: prismatic, bodies: [ground, s], at: [0, 0, 0], axis: x}}
loads:
  v: {type: linear_servo, joint: rail, displacement: c, stiffness: 200, damping: 8, integral: k_i, max_force: hold}
)";

/// Roots of 2 λ³ + 8 λ² + 200 λ + k_i: the integral of the error is a state of its own.
/// @tests{servo-at-rest}
TEST(ModesAtRest, TheIntegralOfAServoIsAStateOfItsOwn) {
  using Complex = std::complex<double>;
  for (const double k_i : {1.0, 300.0, 700.0, 5000.0}) {
    const ModesReport r = modes_of(std::string(kServo) + "analysis: {type: modes}\n",
                                   {format("variables.k_i={}", k_i)});
    ASSERT_EQ(r.modes.size(), 2u) << k_i;
    EXPECT_EQ(r.freedoms, 1);
    for (const Mode& mode : r.modes) {
      const Complex x = mode.eigenvalue;
      const Complex left = ((2.0 * x + 8.0) * x + 200.0) * x + k_i;
      EXPECT_LT(std::abs(left), 1e-8 * (k_i + 200.0 * std::abs(x))) << k_i << ' ' << x;
      EXPECT_LT(mode.residual, 1e-7) << k_i;
    }
    // The count of unstable motions of Hurwitz: k_i > 8·200/2.
    EXPECT_EQ(r.modes[0].kind == ModeKind::flutter || r.modes[1].kind == ModeKind::flutter,
              k_i > 800.0);
  }
}

double rest_of(const std::string& loads, const io::Overrides& overrides) {
  Simulation s(
      io::read_model_text(kServo + loads + "analysis: {type: statics}\n", "servo.yaml", overrides));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  return s.system().motion(s.state(), 0).r.x();
}

/// At rest the error is zero, or the force at its limit.
TEST(ModesAtRest, AServoWithAnIntegralRestsAtItsSetpointUpToItsLimit) {
  const io::Overrides weight{"variables.g=9.81", "variables.c=0.1"};
  EXPECT_NEAR(rest_of("", weight), 0.1, 1e-12);
  io::Overrides proportional = weight;
  proportional.push_back("variables.k_i=0");
  EXPECT_NEAR(rest_of("", proportional), 0.1 + 19.62 / 200.0, 1e-12);
  const std::string spring =
      "  k: {type: spring_damper, bodies: [ground, s], at: [[-1, 0, 0], [0, 0, 0]], stiffness: 50, "
      "free_length: 1}\n";
  io::Overrides limited = weight;
  limited.push_back("variables.hold=10");
  EXPECT_NEAR(rest_of(spring, limited), (19.62 - 10.0) / 50.0, 1e-12);
  limited.back() = "variables.hold=100";
  EXPECT_NEAR(rest_of(spring, limited), 0.1, 1e-12);
}

}  // namespace
}  // namespace polhode::modes_at_rest_tests
