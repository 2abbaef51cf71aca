// SPDX-License-Identifier: Apache-2.0
// Modes about a steady spin by the command line.
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "command_line.hpp"

namespace polhode::spin_cli_tests {
namespace {

using test::CommandLine;
using testing::AllOf;
using testing::HasSubstr;

// A body on isotropic springs of 20 rad/s = 3.1831 Hz.
constexpr const char* kRotor = R"(format: 1
bodies: {disc: {mass: 2, inertia: [0.01, 0.01, 0.015], position: [0, 0, 0]}}
loads: {bearing: {type: bushing, bodies: [ground, disc], at: [0, 0, 0], axis: z, stiffness: [800, 800, 5000]}}
)";

TEST_F(CommandLine, PrintsAndWritesACampbellDiagram) {
  write("rotor.yaml", kRotor);
  const auto result =
      run({"modes", "rotor.yaml", "--spin", "0:600:300 rpm", "--axis", "z", "-o", "out"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(
      result.out,
      AllOf(HasSubstr("spin rad/s"), HasSubstr("Hz turning"), HasSubstr("Hz in world"),
            HasSubstr("31.4159"), HasSubstr("62.8319"), HasSubstr("forward"), HasSubstr("backward"),
            HasSubstr("3.1831"), HasSubstr("free: body 'disc' rotates about z")));
  for (const char* file : {"out/campbell.csv", "out/campbell.svg", "out/speed_3/modes.h5"})
    EXPECT_TRUE(exists(file)) << file;
  EXPECT_THAT(read("out/campbell.csv"),
              HasSubstr("spin [rad/s],mode,frequency [Hz],world_frequency [Hz],whirl"));
  const std::string picture = read("out/campbell.svg");
  EXPECT_THAT(picture,
              AllOf(HasSubstr("frequency in the turning frame [Hz]"), HasSubstr("once a turn")));
  // Each whirl of the pair that the springs hold, in both diagrams, from rest on.
  for (const char* colour : {"#1f77b4", "#d62728"}) {
    std::size_t curves = 0;
    for (std::size_t at = 0; (at = picture.find("<path d=\"M60.0 ", at)) != std::string::npos; ++at)
      if (picture.find(colour, at) < picture.find("/>", at)) ++curves;
    EXPECT_GE(curves, 2U) << colour;
  }
  const auto json = run({"modes", "rotor.yaml", "--spin", "7", "--axis", "[0, 0, 2]", "--json"});
  ASSERT_EQ(json.code, 0) << json.err;
  EXPECT_EQ(value(json.out, "spin"), "7.0");
  EXPECT_THAT(json.out, AllOf(HasSubstr("\"whirl\": \"forward\""), HasSubstr("world_frequency")));
  EXPECT_TRUE(exists("rotor.results/modes.h5"));
}

TEST_F(CommandLine, RefusesASpinThatIsNotSteadyOrNotWritten) {
  write("rotor.yaml", kRotor);
  const auto clamped = run({"modes", "rotor.yaml", "--spin", "7", "--axis", "x"});
  EXPECT_EQ(clamped.code, 3);
  EXPECT_THAT(clamped.err,
              HasSubstr("loads.bearing: exerts another force as the model turns on the ground"));
  EXPECT_EQ(run({"modes", "rotor.yaml", "--spin", "7", "--axis", "x", "--ground", "turns"}).code,
            0);
  const auto wrong = run({"modes", "rotor.yaml", "--spin", "0:5 rad/s", "--axis", "z"});
  EXPECT_EQ(wrong.code, 3);
  EXPECT_THAT(wrong.err, HasSubstr("expects three parts between colons"));
  const auto unit = run({"modes", "rotor.yaml", "--spin", "5 Hz", "--axis", "z"});
  EXPECT_EQ(unit.code, 3);
  EXPECT_THAT(unit.err, HasSubstr("Write rad/s, deg/s, rpm or rev/s"));
  const auto none = run({"modes", "rotor.yaml", "--axis", "z"});
  EXPECT_EQ(none.code, 3);
  EXPECT_THAT(none.err, HasSubstr("analysis.spin: is missing, but its axis, point or ground"));
  const auto still = run({"modes", "rotor.yaml", "--spin", "5"});
  EXPECT_THAT(still.err, HasSubstr("analysis.spin_axis: is missing, and no body turns"));
}

// Pulled apart: a mass on a radial spring of 10 rad/s on a turntable has no equilibrium at 10
// rad/s.
TEST_F(CommandLine, EndsWith4AtASpeedWithoutEquilibrium) {
  write("slide.yaml", R"(format: 1
bodies: {mass: {mass: 1, inertia: [1, 1, 1], position: [1, 0, 0]}}
joints: {slide: {type: prismatic, bodies: [ground, mass], at: [1, 0, 0], axis: x}}
loads: {spring: {type: spring_damper, bodies: [ground, mass], at: [[0, 0, 0], [1, 0, 0]], stiffness: 100}}
)");
  const auto result = run({"modes", "slide.yaml", "--spin", "[6, 10, 12]", "--axis", "z",
                           "--ground", "turns", "--json"});
  EXPECT_EQ(result.code, 4) << result.out;
  // √(100 − 36) = 8 rad/s.
  EXPECT_NEAR(std::stod(value(result.out, "frequency")), 8.0 / (2.0 * std::numbers::pi), 1e-9);
  EXPECT_THAT(result.err, HasSubstr("At 10 rad/s: No equilibrium was found"));
}

}  // namespace
}  // namespace polhode::spin_cli_tests
