// SPDX-License-Identifier: Apache-2.0
// Gradients of runs against closed forms, and against differences of runs without any derivative.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <gradient/gradient_models.hpp>
#include <polhode/core/error.hpp>

namespace polhode::test::gradient_tests {
namespace {

/// @tests{step-derivative} @tests{parameter-difference}
TEST(RunGradient, OfADoublePendulumIsThatOfDifferencesOfRunsAtAnyStep) {
  EXPECT_LT(difference_from_runs(double_pendulum(0.05, 10)), 1e-9);
  EXPECT_LT(difference_from_runs(double_pendulum(0.01, 50)), 1e-9);
  EXPECT_LT(difference_from_runs(double_pendulum(1e-4, 500), 3e-3, 5e-11), 1e-9);
}

TEST(RunGradient, IsExactAtEveryOrderOfComposition) {
  for (const int order : {4, 6, 8})
    EXPECT_LT(difference_from_runs(double_pendulum(0.05, 10, order)), 1e-9) << order;
}

TEST(RunGradient, IsExactForVelocitiesAnglesAndProbes) {
  for (const char* outcome : {"bodies.two.velocity.z", "bodies.two.angular_velocity.x",
                              "joints.B.rz", "probes.tip.y", "probes.tip.vx"}) {
    GradientCase c = double_pendulum(0.01, 40);
    c.parameters = {"a", "speed", "bodies.one.mass"};
    c.outcomes = {outcome};
    EXPECT_LT(difference_from_runs(c), 1e-9) << outcome;
  }
}

TEST(RunGradient, OfASpatialSliderCrankWithSpringDamperAndDriveIsExact) {
  for (const auto& [step, steps] :
       {std::pair(0.02, 12), std::pair(0.004, 60), std::pair(4e-5, 300)})
    EXPECT_LT(difference_from_runs(
                  {example_text("spatial_slider_crank", kSliderCrankLoads),
                   step,
                   steps,
                   {"loads.spring.stiffness", "loads.spring.damping", "loads.spring.free_length",
                    "loads.twist.stiffness", "bodies.rod.mass", "variables.speed"},
                   {"bodies.slider.position.x@end"}}),
              1e-9)
        << step;
}

TEST(RunGradient, OfRedundantLoopsIsExact) {
  EXPECT_LT(difference_from_runs({example_text("bricard"),
                                  0.01,
                                  40,
                                  {"variables.L", "variables.w", "bodies.rod_1.mass"},
                                  {"bodies.rod_3.position.x@end"}}),
            1e-9);
}

TEST(RunGradient, OfAFastGyroscopeIsExact) {
  EXPECT_LT(difference_from_runs({example_text("gyroscope"),
                                  0.001,
                                  60,
                                  {"variables.spin", "variables.arm", "variables.steel"},
                                  {"bodies.weight.position.y@end"}}),
            1e-9);
}

TEST(RunGradient, OfAGovernorWithStiffSpringsIsExact) {
  // Its derivatives by stiffness and damping are 1e-11 and 1e-10, where differences end.
  EXPECT_LT(difference_from_runs({example_text("flyball_governor"),
                                  0.002,
                                  40,
                                  {"variables.m_ball", "variables.turn", "loads.spring_a.stiffness",
                                   "loads.spring_a.damping"},
                                  {"bodies.slider.position.z@end"}}),
            1e-8);
}

TEST(RunGradient, OfWheelsThatRollIsExact) {
  EXPECT_LT(difference_from_runs({example_text("bicycle"),
                                  0.005,
                                  60,
                                  {"variables.v", "variables.push", "bodies.frame.mass"},
                                  {"bodies.frame.position.y@end"}}),
            1e-9);
}

TEST(RunGradient, OfBeamsIsExact) {
  // The beams' rounding limits differences of runs.
  EXPECT_LT(difference_from_runs({example_text("flexible_four_bar"),
                                  0.001,
                                  15,
                                  {"materials.polyamide.youngs_modulus",
                                   "materials.polyamide.density", "variables.speed"},
                                  {"bodies.rocker.position.x@end"}}),
            1e-8);
}

TEST(RunGradient, OfEveryOtherLoadIsExact) {
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
  moment: {type: moment, body: free, moment: [0.1*s, 0.05*cos(4*t), 0]}
  spring: {type: spring_damper, bodies: [base, free], at: [[0.1, 0.1, 0.5], [1, 1, 0.9]], stiffness: 40*s, damping: 1.5, quadratic: 10*s}
  potential: {type: potential, bodies: [cart, free], at: [[0.1, 0.4, 0.6], [1, 1, 1.1]], energy: 3*s*l^2}
  axial: {type: axial_force, bodies: [ground, free], at: [[0, 0, 3], [1.1, 1, 1]], pull: 2*s*cos(t), damping: 0.3}
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
  EXPECT_LT(difference_from_runs({loads, 0.01, 40, by, {"bodies.free.position.z@end"}}), 1e-9);
  EXPECT_LT(difference_from_runs({loads, 0.01, 40, by, {"joints.cyl.rz@end"}}), 1e-9);
}

TEST(RunGradient, OfEveryJointIsExact) {
  // Joints by type, with the keys of their frames.
  const std::vector<std::pair<std::string, std::string>> joints{
      {"spherical", "at: [c, 0.01, 0]"},
      {"revolute", "at: [c, 0.01, 0], axis: [0.3, 0.1, 1]"},
      {"prismatic", "at: [c, 0.01, 0], axis: [0.3, 1, 0.2]"},
      {"cylindrical", "at: [c, 0.01, 0], axis: [0.3, 1, 0.2]"},
      {"universal", "at: [c, 0.01, 0], axes: [x, y]"},
      {"constant_velocity", "at: [c, 0.01, 0], axis: x"},
      {"planar", "at: [c, 0.01, 0], axis: [0.3, 0.1, 1]"},
      {"fixed", "at: [c, 0.01, 0]"},
      {"distance", "at: [[c, 0.01, 0], [0.6, 0.4, 0.1]]"},
      {"revolute_spherical", "at: [[c, 0.01, 0], [c, 0.4, 0.1]], axis: x"},
      {"universal_spherical", "at: [[c, 0.01, 0], [0.6, 0.4, 0.1]], x_axis: z"},
      {"point_in_plane", "at: [c, 0.01, 0], axis: [0.3, 0.1, 1]"},
      {"point_on_line", "at: [c, 0.01, 0], axis: [0.3, 1, 0.2]"},
      {"parallel_axes", "axis: [0.3, 1, 0.2]"},
      {"generic", "at: [c, 0.01, 0], free: [x, ry]"}};
  for (const auto& [type, keys] : joints) {
    const std::string text = R"yaml(
format: 1
gravity: [0, 0, -9.81]
variables: {c: 0.6, speed: 2 rad/s}
bodies:
  one: {mass: 1.2, inertia: [2.2e-2, 3e-2, 1e-2], position: [0.3, 0, 0], angular_velocity: [0, speed, 0.5]}
  two: {mass: 0.7, inertia: [1e-2, 2e-2, 1.5e-2], position: [0.6, 0.2, 0.05]}
joints:
  A: {type: spherical, bodies: [ground, one], at: [0, 0, 0]}
  B: {type: )yaml" + type + ", bodies: [one, two], " +
                             keys +
                             "}\nanalysis: {duration: 1 s, step: 10 ms}\noutput: {probes: {tip: "
                             "{body: two, point: [0.1, 0.2, 0.3]}}}\n";
    std::vector<std::string> by{"speed", "bodies.two.mass", "bodies.one.inertia.1"};
    // The place of the others along their axis has no effect.
    if (type != "prismatic" && type != "parallel_axes") by.emplace_back("c");
    EXPECT_LT(difference_from_runs({text, 0.01, 30, by, {"probes.tip.z@end"}}), 3e-9)
        << type;  // small effects are where the differences end
  }
}

TEST(RunGradient, OfMotorsServosAndGearsIsExact) {
  const std::vector<std::string> by{"w", "amp", "k", "bodies.three.mass"};
  EXPECT_LT(difference_from_runs({kDrives, 0.01, 60, by, {"bodies.three.position.x@end"}}), 1e-9);
  EXPECT_LT(difference_from_runs({kDrives, 0.01, 60, by, {"bodies.three.velocity.y@end"}}), 1e-9);
  EXPECT_LT(difference_from_runs({kDrives, 0.01, 60, {"amp", "ratio"}, {"joints.D.rz@end"}}), 1e-9);
}

constexpr const char* kThrown = R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies:
  ball: {mass: 2, inertia: [0.1, 0.1, 0.1], position: [0, 0, 1], velocity: [3, 0, 4]}
analysis: {duration: 1 s, step: 10 ms}
)yaml";

TEST(RunGradient, OfAThrowIsItsClosedForm) {
  // z(T) = z_0 + v T + g T²/2 and x(T) = v_x T; the step is exact for constant forces.
  for (const double step : {0.1, 0.01, 1e-4}) {
    const int steps = static_cast<int>(std::lround(0.5 / step));
    GradientCase c{kThrown,
                   step,
                   steps,
                   {"bodies.ball.velocity.2", "bodies.ball.velocity.0", "bodies.ball.position.2",
                    "gravity.2", "bodies.ball.mass"},
                   {"bodies.ball.position.z@end", "bodies.ball.position.x@end"}};
    const RunGradient run = differentiate(c.model(), c.request());
    const std::vector<double>&z = run.outcomes[0].by, &x = run.outcomes[1].by;
    const double expected[2][5] = {{0.5, 0.0, 1.0, 0.125, 0.0}, {0.0, 0.5, 0.0, 0.0, 0.0}};
    for (std::size_t j = 0; j < 5; ++j) {
      EXPECT_NEAR(z[j], expected[0][j], 1e-11) << step << " " << j;
      EXPECT_NEAR(x[j], expected[1][j], 1e-11) << step << " " << j;
    }
  }
}

TEST(RunGradient, OfASmallSwingConvergesToItsClosedFormWithinTheErrorBar) {
  // x(T) = x_0 cos(√(k/m) T): by k it is −x_0 T sin(√(k/m) T)/(2 √(k m)).
  const std::string spring = R"yaml(
format: 1
bodies:
  cart: {mass: 2, inertia: [1, 1, 1], position: [0.1, 0, 0]}
joints:
  guide: {type: prismatic, bodies: [ground, cart], at: [0, 0, 0], axis: x}
loads:
  spring: {type: translational_spring, joint: guide, stiffness: 50, free_displacement: -0.1}
analysis: {duration: 1 s, step: 10 ms}
)yaml";
  const double k = 50.0, m = 2.0, x_0 = 0.1, T = 1.2, w = std::sqrt(k / m);
  const double by_k = -x_0 * T * std::sin(w * T) / (2.0 * std::sqrt(k * m));
  for (const double step : {0.02, 0.01, 1e-4}) {
    const auto of = [&](double h) {
      const GradientCase c{spring,
                           h,
                           static_cast<int>(std::lround(T / h)),
                           {"loads.spring.stiffness"},
                           {"bodies.cart.position.x@end"}};
      return differentiate(c.model(), c.request());
    };
    const RunGradient own = of(step), half = of(0.5 * step);
    const double bar = error_bars(own, half)[0][0];
    EXPECT_NEAR(own.outcomes[0].by[0], by_k, 1.1 * bar + 1e-13) << step;
    EXPECT_LT(bar, 10.0 * step * step) << step;
  }
}

TEST(RunGradient, OfMeanAndMaximumAreThoseOfASwing) {
  // Mean and maximum over the steps, against differences of the same figures.
  GradientCase c = double_pendulum(0.01, 60);
  c.parameters = {"a", "bodies.one.mass"};
  c.outcomes = {"bodies.two.position.y@mean", "probes.tip.x@max", "bodies.two.position.z@0.3"};
  const RunGradient run = differentiate(c.model(), c.request());
  const GradientRequest request = c.request();
  for (std::size_t j = 0; j < 2; ++j) {
    const GradientParameter& p = request.parameters[j];
    const auto figures = [&](double value) {
      const Model model = p.at(value);
      Simulation simulation(model);
      SystemMap map;
      const System system = build_system(model, &map);
      const OutcomeReader y(model, map, "bodies.two.position.y"), x(model, map, "probes.tip.x"),
          z(model, map, "bodies.two.position.z");
      std::vector<double> of_y, of_x, of_z;
      const auto look = [&] {
        of_y.push_back(y.value(simulation.system(), simulation.state()));
        of_x.push_back(x.value(simulation.system(), simulation.state()));
        of_z.push_back(z.value(simulation.system(), simulation.state()));
      };
      look();
      for (int n = 0; n < 60; ++n) {
        EXPECT_TRUE(simulation.step(0.6).accepted);
        look();
      }
      double mean = 0.0;
      for (std::size_t n = 0; n < 60; ++n) mean += 0.5 * (of_y[n] + of_y[n + 1]) / 60.0;
      const auto peak = static_cast<std::size_t>(
          std::lround(run.outcomes[1].time / 0.01));  // at the time of the run itself
      return std::array{mean, of_x[peak], of_z[30]};
    };
    const double d = 3e-3 * p.value;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto pair = [&](double n) {
        return figures(p.value + n * d)[k] - figures(p.value - n * d)[k];
      };
      const double of_runs = (45.0 * pair(1.0) - 9.0 * pair(2.0) + pair(3.0)) / (60.0 * d);
      EXPECT_NEAR(run.outcomes[k].by[j], of_runs, 1e-9 * std::max(1e-2, std::abs(of_runs)))
          << run.outcomes[k].outcome << " " << p.path;
    }
  }
}

/// @tests{step-adjoint}
TEST(RunGradient, OfTangentsIsThatOfTheAdjoint) {
  GradientCase c = double_pendulum(0.01, 100);
  c.outcomes = {"bodies.two.position.z@end", "bodies.one.velocity.x@0.5"};
  GradientRequest request = c.request();
  const RunGradient adjoint = differentiate(c.model(), request);
  request.forward = true;
  const RunGradient tangents = differentiate(c.model(), request);
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t j = 0; j < request.parameters.size(); ++j)
      EXPECT_NEAR(tangents.outcomes[k].by[j] / adjoint.outcomes[k].by[j], 1.0, 1e-11);
  request.only_last_adjoint = true;
  const RunGradient quick = differentiate(c.model(), request);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(quick.outcomes[k].by, tangents.outcomes[k].by);
}

/// @tests{step-adjoint}
TEST(RunGradient, OfAWeightedSumIsTheSumOfGradients) {
  for (const double step : {0.05, 0.01, 1e-3}) {
    GradientCase c = double_pendulum(step, static_cast<int>(std::lround(0.5 / step)));
    c.outcomes = {"bodies.two.position.z@end", "bodies.one.position.x@mean",
                  "bodies.two.velocity.y@0.25", "bodies.two.position.z@0.25"};
    GradientRequest request = c.request();
    const std::vector<OutcomeGradient> each = differentiate(c.model(), request).outcomes;
    request.weights = {0.5, -2.0, 3.0, 0.0};
    const std::vector<OutcomeGradient> sum = differentiate(c.model(), request).outcomes;
    ASSERT_EQ(sum.size(), 1U);
    EXPECT_LT(sum.front().spot_check, 1e-11);
    double value = 0.0;
    for (std::size_t k = 0; k < each.size(); ++k) value += request.weights[k] * each[k].value;
    EXPECT_NEAR(sum.front().value, value, 1e-13 * std::abs(value));
    for (std::size_t j = 0; j < request.parameters.size(); ++j) {
      double by = 0.0, size = 0.0;
      for (std::size_t k = 0; k < each.size(); ++k) {
        by += request.weights[k] * each[k].by[j];
        size += std::abs(request.weights[k] * each[k].by[j]);
      }
      EXPECT_NEAR(sum.front().by[j], by, 1e-11 * size)
          << request.parameters[j].path << ", " << step;
    }
  }
}

TEST(RunGradient, OfACoordinateByNumberIsThatByName) {
  GradientCase c = double_pendulum(0.01, 10);
  c.outcomes = {"joints.B.rz@end", "joints.B.coordinates.0@end"};
  const RunGradient run = differentiate(c.model(), c.request());
  EXPECT_EQ(run.outcomes[0].by, run.outcomes[1].by);
  EXPECT_EQ(run.outcomes[1].unit, "rad");
  c.outcomes = {"joints.B.coordinates.1"};
  EXPECT_THROW((void)differentiate(c.model(), c.request()), InputError);
}

TEST(RunGradient, IsThatOfUnitsInTheFile) {
  std::string grams = kThrown;
  grams.replace(grams.find("mass: 2"), 7, "mass: 2000 g");
  grams += "loads:\n  push: {type: force, body: ball, force: [6, 0, 0]}\n";
  const GradientCase c{grams, 0.01, 50, {"bodies.ball.mass"}, {"bodies.ball.position.x@end"}};
  const GradientRequest request = c.request();
  EXPECT_EQ(request.parameters[0].unit, "kg");
  EXPECT_NEAR(request.parameters[0].value, 2.0, 1e-15);
  // x = v T + F T²/(2 m): by m it is −F T²/(2 m²).
  EXPECT_NEAR(differentiate(c.model(), request).outcomes[0].by[0], -6.0 * 0.25 / 8.0, 1e-11);
}

}  // namespace
}  // namespace polhode::test::gradient_tests
