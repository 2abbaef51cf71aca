// SPDX-License-Identifier: Apache-2.0
// Gradients of runs with rho_inf below 1 against differences of runs without any derivative.
#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <gradient/gradient_models.hpp>

namespace polhode::test::damped_gradient_tests {
namespace {

constexpr std::array<double, 4> kRadii = {0.0, 0.5, 0.8, 0.95};

/// The gradient's difference from differences of runs. Over many short steps tangent and adjoint
/// round differently.
double difference(GradientCase c, double rho_inf) {
  c.rho_inf = rho_inf;
  return difference_from_runs(c, 3e-3, 1e-10);
}

/// @tests{damped-step-derivative}
TEST(DampedGradient, OfADoublePendulumIsThatOfDifferencesOfRunsAtAnyStep) {
  for (const double rho : kRadii) {
    EXPECT_LT(difference(double_pendulum(0.05, 10), rho), 1e-9) << rho;
    EXPECT_LT(difference(double_pendulum(0.01, 50), rho), 1e-9) << rho;
    EXPECT_LT(difference(double_pendulum(1e-4, 500), rho), 1e-9) << rho;
  }
}

/// @tests{damped-step-derivative}
TEST(DampedGradient, OfALoopWithSpringDamperAndDriveIsExactAtAnyStep) {
  for (const double rho : kRadii)
    for (const auto& [step, steps] :
         {std::pair(0.02, 12), std::pair(0.004, 60), std::pair(4e-5, 300)})
      EXPECT_LT(
          difference({example_text("spatial_slider_crank", kSliderCrankLoads),
                      step,
                      steps,
                      {"loads.spring.stiffness", "loads.spring.damping", "loads.spring.free_length",
                       "loads.twist.stiffness", "bodies.rod.mass", "variables.speed"},
                      {"bodies.slider.position.x@end"}},
                     rho),
          1e-9)
          << rho << ", " << step;
}

/// @tests{damped-step-derivative}
TEST(DampedGradient, OfAShorterLastStepIsExact) {
  // Stored accelerations are adapted to its length.
  GradientCase c{R"yaml(
format: 1
gravity: [0, 0, -9.81]
variables: {push: 3}
bodies:
  rod: {mass: 1, inertia: [1.5e-2, 2e-2, 1.2e-2], position: [0.5, 0, 0], angular_velocity: [0, 1, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, rod], at: [0, 0, 0], axis: y}
loads:
  push: {type: moment, body: rod, moment: [0, push*sin(3*t), 0]}
  damper: {type: torsional_spring, joint: hinge, damping: 0.3}
analysis: {duration: 1 s, step: 10 ms}
)yaml",
                 0.01,
                 20,
                 {"push", "bodies.rod.mass", "bodies.rod.inertia.1", "loads.damper.damping"},
                 {"bodies.rod.velocity.z@end"}};
  c.rest = 0.004;
  EXPECT_GT(differentiate(c.model(), c.request()).steps, 20);
  for (const double rho : kRadii) EXPECT_LT(difference(c, rho), 1e-9) << rho;
}

TEST(DampedGradient, OfManyLoadsIsExact) {
  const std::string loads = R"yaml(
format: 1
gravity: [0, 0, -9.81]
variables: {s: 1.0}
bodies:
  base: {mass: 4, inertia: [0.2, 0.25, 0.3], position: [0.1, 0.02, 0.5], velocity: [0.1, 0.3, 0.2], angular_velocity: [0.5, 0.3, 1]}
  arm: {mass: 1.2, inertia: [2e-2, 3e-2, 1e-2], position: [0.5, 0.02, 0.5]}
  cart: {mass: 0.7, inertia: [1e-2, 2e-2, 1.5e-2], position: [0.1, 0.4, 0.6], velocity: [0.2, 0.3, 0.1]}
  rod: {mass: 0.5, inertia: [1e-2, 2e-2, 1.5e-2], position: [0.1, 0.02, 1.0]}
  free: {mass: 0.9, inertia: [1e-2, 2e-2, 1.5e-2], position: [1, 1, 1], velocity: [0.2, 0.1, 0], angular_velocity: [1, 2, 3]}
joints:
  hinge: {type: revolute, bodies: [base, arm], at: [0.3, 0.02, 0.5], axis: [0, 0.1, 1]}
  slide: {type: prismatic, bodies: [base, cart], at: [0.1, 0.4, 0.6], axis: [1, 0.2, 0]}
  cyl: {type: cylindrical, bodies: [base, rod], at: [0.1, 0.02, 0.8], axis: z}
loads:
  force: {type: force, body: free, at: [1.02, 1, 1], body_fixed: true, force: [s*2*sin(3*t), 1, -s]}
  spring: {type: spring_damper, bodies: [base, free], at: [[0.1, 0.1, 0.5], [1, 1, 0.9]], stiffness: 40*s, damping: 1.5, quadratic: 10*s}
  potential: {type: potential, bodies: [cart, free], at: [[0.1, 0.4, 0.6], [1, 1, 1.1]], energy: 3*s*l^2}
  axial: {type: axial_force, bodies: [ground, free], at: [[0, 0, 3], [1.1, 1, 1]], pull: 2*s*cos(t), damping: 0.3}
  short: {type: spring_damper, bodies: [arm, free], at: [[0.999, 0.999, 1], [1, 1, 1]], stiffness: 20*s, free_length: 0.0014}
  damper: {type: vector_damper, bodies: [arm, free], at: [[0.5, 0.02, 0.5], [1, 1, 1]], damping: 0.5*s, turning_damping: 0.02}
  bushing: {type: bushing, bodies: [ground, base], at: [0.1, 0.02, 0.5], stiffness: [500*s, 600, 700], turning_stiffness: [20, 30*s, 25], damping: [3, 4*s, 5], turning_damping: [0.2, 0.2, 0.2]}
  attraction: {type: attraction, bodies: [arm, free], strength: 2*s}
  drag: {type: drag, body: free, linear: 0.2*s, turning: 0.01, quadratic: 0.1*s}
  twist: {type: torsional_spring, joint: hinge, stiffness: 0.8*s, damping: 0.05, free_angle: 0.3}
  pull: {type: translational_spring, joint: slide, stiffness: 30*s, damping: 0.5, free_displacement: 0.05}
  screw: {type: screw, joint: cyl, pitch: 0.08*s}
analysis: {duration: 1 s, step: 10 ms}
)yaml";
  const std::vector<std::string> by{"s", "bodies.free.mass", "loads.drag.turning"};
  for (const double rho : {0.0, 0.8})
    EXPECT_LT(difference({loads, 0.01, 40, by, {"bodies.free.position.z@end"}}, rho), 1e-9) << rho;
}

TEST(DampedGradient, OfMotorsServosAndGearsIsExact) {
  const std::vector<std::string> by{"w", "amp", "k", "bodies.three.mass"};
  for (const double rho : {0.0, 0.8}) {
    EXPECT_LT(difference({kDrives, 0.01, 60, by, {"bodies.three.position.x@end"}}, rho), 1e-9);
    EXPECT_LT(difference({kDrives, 0.01, 60, {"amp", "ratio"}, {"joints.D.rz@end"}}, rho), 1e-9);
  }
}

TEST(DampedGradient, OfSpinsWheelsGovernorAndBeamsIsExact) {
  for (const double rho : {0.0, 0.8}) {
    EXPECT_LT(difference({example_text("gyroscope"),
                          0.001,
                          60,
                          {"variables.spin", "variables.arm", "variables.steel"},
                          {"bodies.weight.position.y@end"}},
                         rho),
              1e-9);
    EXPECT_LT(difference({example_text("bicycle"),
                          0.005,
                          60,
                          {"variables.v", "variables.push", "bodies.frame.mass"},
                          {"bodies.frame.position.y@end"}},
                         rho),
              1e-9);
    // Differences end at 1e-11 of a length, and at the beams' rounding.
    EXPECT_LT(difference({example_text("flyball_governor"),
                          0.002,
                          40,
                          {"variables.m_ball", "variables.turn", "loads.spring_a.stiffness",
                           "loads.spring_a.damping"},
                          {"bodies.slider.position.z@end"}},
                         rho),
              1e-8);
    EXPECT_LT(difference({example_text("flexible_four_bar"),
                          0.001,
                          15,
                          {"materials.polyamide.youngs_modulus", "materials.polyamide.density",
                           "variables.speed"},
                          {"bodies.rocker.position.x@end"}},
                         rho),
              1e-8);
  }
}

TEST(DampedGradient, OfRedundantLoopsHasFewerDigitsAndSaysSo) {
  for (const auto& [step, steps] : {std::pair(0.05, 8), std::pair(0.01, 40), std::pair(1e-3, 50)}) {
    GradientCase c{example_text("bricard"),
                   step,
                   steps,
                   {"variables.L", "variables.w", "bodies.rod_1.mass"},
                   {"bodies.rod_3.position.x@end"}};
    c.rho_inf = 0.8;
    EXPECT_LT(difference_from_runs(c, 3e-3, 1e-6), 3e-5) << step;
    const GradientRequest request = c.request();
    EXPECT_THAT(gradient_doubts(differentiate(c.model(), request), 0, request, {}),
                testing::Contains(testing::HasSubstr("rows, which are not unique")))
        << step;
  }
}

TEST(DampedGradient, OfTangentsIsThatOfTheAdjoint) {
  GradientCase c = double_pendulum(0.01, 100);
  c.rho_inf = 0.6;
  c.outcomes = {"bodies.two.position.z@end", "bodies.one.velocity.x@0.5"};
  GradientRequest request = c.request();
  const RunGradient adjoint = differentiate(c.model(), request);
  request.forward = true;
  const RunGradient tangents = differentiate(c.model(), request);
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t j = 0; j < request.parameters.size(); ++j)
      EXPECT_NEAR(tangents.outcomes[k].by[j] / adjoint.outcomes[k].by[j], 1.0, 1e-10);
}

}  // namespace
}  // namespace polhode::test::damped_gradient_tests
