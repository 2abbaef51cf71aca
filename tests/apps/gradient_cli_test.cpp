// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "command_line.hpp"

namespace polhode::gradient_cli_tests {
namespace {

using test::CommandLine;
using testing::HasSubstr;

TEST_F(CommandLine, PrintsGradientsWithErrorBars) {
  const auto result = run({"gradient", "model.yaml", "--set", "analysis.duration=0.2", "--of",
                           "probes.tip.z@end", "--with", "bodies.upper.density,gravity.2"});
  EXPECT_EQ(result.code, 0) << result.err;
  for (const char* text :
       {"probes.tip.z@end = ", "parameter", "elasticity", "error bar", "bodies.upper.density",
        "gravity.2", "tangent against adjoint", "20 steps of 10 ms, kept as they are"})
    EXPECT_THAT(result.out, HasSubstr(text));
  EXPECT_EQ(result.err, "");
}

TEST_F(CommandLine, PrintsGradientsAsJson) {
  write("throw.yaml",
        "format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
        "  ball: {mass: 1, inertia: [1, 1, 1], position: [0, 0, 1], velocity: [0, 0, 2]}\n"
        "analysis: {duration: 0.5 s, step: 10 ms}\n");
  for (const char* way : {"--no-bars", "--forward"}) {
    const auto result = run({"gradient", "throw.yaml", way, "--json", "--of",
                             "bodies.ball.position.z", "--with", "bodies.ball.velocity.2"});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_NEAR(std::stod(value(result.out, "gradient")), 0.5, 1e-11) << result.out;
    EXPECT_EQ(value(result.out, "error_bar") == "null", std::string(way) == "--no-bars");
  }
}

TEST_F(CommandLine, PrintsGradientsOfIntegralsAndMisfits) {
  write("throw.yaml",
        "format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
        "  ball: {mass: 1, inertia: [1, 1, 1], position: [0, 0, 1], velocity: [3, 0, 2]}\n"
        "analysis: {duration: 0.5 s, step: 10 ms}\n");
  write("table.csv", "t [s],bodies.ball.position.x [m]\n0.5,1.4\n");
  const auto by_speed = [&](const std::string& of) {
    return run({"gradient", "throw.yaml", "--no-bars", "--json", "--of", of, "--with",
                "bodies.ball.velocity.0"});
  };
  const auto integral = by_speed("bodies.ball.position.x@integral");
  EXPECT_EQ(integral.code, 0) << integral.err;
  EXPECT_NEAR(std::stod(value(integral.out, "gradient")), 0.125, 1e-11);
  const auto misfit = by_speed("misfit:table.csv");
  EXPECT_EQ(misfit.code, 0) << misfit.err;
  EXPECT_NEAR(std::stod(value(misfit.out, "gradient")), 2.0 * 0.1 * 0.5, 1e-11);
  EXPECT_EQ(by_speed("misfit:nothing.csv").code, 5);
}

TEST_F(CommandLine, SaysThatTheSequenceOfAutomaticStepsIsFrozen) {
  write("swing.yaml",
        "format: 1\nbodies:\n"
        "  cart: {mass: 2, inertia: [1, 1, 1], position: [0.1, 0, 0], velocity: [0, 1, 0]}\n"
        "loads:\n  strut: {type: spring_damper, bodies: [ground, cart], at: [[0, 1, 0], [0.1, 0, "
        "0]], stiffness: 50, damping: 2}\n"
        "analysis: {duration: 0.5 s, tolerance: 1e-7}\n");
  const auto result = run({"gradient", "swing.yaml", "--of", "bodies.cart.position.x@0.3", "--with",
                           "loads.strut.stiffness"});
  EXPECT_EQ(result.code, 0) << result.err;
  for (const char* text : {" automatic steps of ", "single ones), order",
                           "the sequence of their lengths and orders is frozen", "at 0.3 s"})
    EXPECT_THAT(result.out, HasSubstr(text));
  const auto json = run({"gradient", "swing.yaml", "--json", "--of", "bodies.cart.position.x",
                         "--with", "loads.strut.stiffness"});
  EXPECT_EQ(value(json.out, "step"), "null");
  EXPECT_GT(std::stod(value(json.out, "longest_step")),
            std::stod(value(json.out, "shortest_step")));
  EXPECT_GE(std::stoi(value(json.out, "highest_order")), std::stoi(value(json.out, "order")));
}

TEST_F(CommandLine, RefusesAGradientByNameWithExitCode3) {
  const auto result = run({"gradient", "model.yaml", "--set", "analysis.momentum_rate=kinematic",
                           "--of", "probes.tip.z", "--with", "gravity.2"});
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.err, HasSubstr("analysis.momentum_rate"));
  EXPECT_THAT(result.err,
              HasSubstr("is kinematic, but gradients exist for the momentum form only"));
  EXPECT_EQ(run({"gradient", "model.yaml", "--of", "probes.tip.z"}).code, 2);
}

}  // namespace
}  // namespace polhode::gradient_cli_tests
