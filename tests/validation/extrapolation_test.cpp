// SPDX-License-Identifier: Apache-2.0
// Orders of extrapolated steps on models that dissipate or are driven, and what is refused.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/published_cases.hpp>

namespace polhode::test::extrapolation_tests {
namespace {

Simulation run_to(Model model, double t_end, int n, int order) {
  model.analysis.method = "extrapolation";
  model.analysis.step = t_end / n;
  model.analysis.duration = t_end;
  model.analysis.order = order;
  Simulation simulation(std::move(model));
  while (simulation.time() < t_end * (1.0 - 1e-9)) {
    const StepReport report = simulation.step(t_end);
    if (!report.accepted) throw std::runtime_error("refused: " + report.newton.text());
  }
  return simulation;
}

/// Positions of bodies and nodes, and velocities of bodies.
Vec observed(const Simulation& s) {
  std::vector<double> x(s.state().node_x);
  for (int b = 0; b < s.system().body_count(); ++b) {
    const BodyMotion m = s.system().motion(s.state(), b);
    for (const Vec3& v : {m.r, m.v, Vec3(m.q * Vec3(1.0, 2.0, 3.0)), m.W})
      x.insert(x.end(), v.data(), v.data() + 3);
  }
  return Eigen::Map<Vec>(x.data(), static_cast<Eigen::Index>(x.size()));
}

/// Positions of bodies and nodes.
Vec positions(const Simulation& s) {
  std::vector<double> x(s.state().node_x);
  for (int b = 0; b < s.system().body_count(); ++b) {
    const Vec3 r = s.system().motion(s.state(), b).r;
    x.insert(x.end(), r.data(), r.data() + 3);
  }
  return Eigen::Map<Vec>(x.data(), static_cast<Eigen::Index>(x.size()));
}

/// Least order in positions between two numbers of steps.
double order_between(const std::function<double(int)>& error, int coarse, int fine) {
  return std::log(error(coarse) / error(fine)) / std::log(double(fine) / coarse);
}

constexpr const char* kSlider = R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies:
  crank: {mass: 0.12, inertia: [1e-4, 1e-4, 1e-5], position: [0, 0.1, 0.16], angular_velocity: [6, 0, 0], velocity: [0, -0.24, 0]}
  rod:
    mass: 0.5
    inertia: [4e-4, 4e-3, 4e-3]
    position: [0.1, 0.05, 0.1]
    orientation: {axis: [0, 2, -1], angle: acos(2/3)}
    angular_velocity: [1.92, -0.96, 0.48]
    velocity: [0.12, -0.24, 0]
  slider: {mass: 2, inertia: [1e-4, 1e-4, 1e-4], position: [0.2, 0, 0], velocity: [0.24, 0, 0]}
joints:
  A: {type: revolute, bodies: [ground, crank], at: [0, 0.1, 0.12], axis: x}
  B: {type: spherical, bodies: [crank, rod], at: [0, 0.1, 0.2]}
  C: {type: universal, bodies: [slider, rod], at: [0.2, 0, 0], axes: [x, [0, 2, -1]]}
  guide: {type: prismatic, bodies: [ground, slider], at: [0.2, 0, 0], axis: x}
loads:
  damper: {type: spring_damper, bodies: [ground, slider], at: [[0, 0, 0], [0.2, 0, 0]], stiffness: 30, free_length: 0.25, damping: 8}
analysis: {duration: 0.5 s, step: 1 ms}
)yaml";

constexpr const char* kNet = R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies:
  a: {mass: 1, inertia: [0.01, 0.02, 0.03], position: [0.5, 0, 0], angular_velocity: [1, 2, 0.5]}
  b: {mass: 1.5, inertia: [0.02, 0.01, 0.03], position: [1, 0.1, 0], velocity: [0, 1, 0]}
  c: {mass: 0.7, inertia: [0.01, 0.01, 0.02], position: [0.9, 0.6, 0.1]}
loads:
  s1: {type: spring_damper, bodies: [ground, a], at: [[0, 0, 0], [0.45, 0.05, 0]], stiffness: 100, damping: 2}
  s2: {type: spring_damper, bodies: [a, b], at: [[0.55, -0.05, 0], [0.95, 0.1, 0.05]], stiffness: 200, damping: 2}
  s3: {type: spring_damper, bodies: [b, c], at: [[1, 0.15, 0], [0.9, 0.55, 0.1]], stiffness: 150, damping: 2}
  s4: {type: spring_damper, bodies: [ground, c], at: [[0, 1, 0], [0.85, 0.6, 0.1]], stiffness: 120, damping: 2}
  s5: {type: spring_damper, bodies: [a, c], at: [[0.5, 0.05, 0.02], [0.9, 0.6, 0.05]], stiffness: 80, damping: 2}
analysis: {duration: 1 s, step: 1 ms}
)yaml";

// A crank-rocker whose crank follows a speed, with a viscous damper on the rocker.
constexpr const char* kFourBar = R"yaml(
format: 1
gravity: [0, 0, -9.81]
variables: {a: (0.35^2 - 0.25^2 + 0.3^2)/0.6, x_C: 0.1 + a, z_C: sqrt(0.35^2 - a^2)}
bodies:
  crank: {shape: {box: [0.1, 0.02, 0.02]}, density: 7800, position: [0.05, 0, 0]}
  coupler: {shape: {box: [0.35, 0.015, 0.015]}, density: 7800, position: [(0.1 + x_C)/2, 0, z_C/2], orientation: {axis: -y, angle: "atan2(z_C, x_C - 0.1)"}}
  rocker: {shape: {box: [0.25, 0.02, 0.02]}, density: 7800, position: [(0.4 + x_C)/2, 0, z_C/2], orientation: {axis: -y, angle: "atan2(z_C, x_C - 0.4)"}}
joints:
  shaft: {type: revolute, bodies: [ground, crank], at: [0, 0, 0], axis: -y}
  B: {type: revolute, bodies: [crank, coupler], at: [0.1, 0, 0], axis: -y}
  C: {type: revolute, bodies: [coupler, rocker], at: [x_C, 0, z_C], axis: -y}
  bearing: {type: revolute, bodies: [ground, rocker], at: [0.4, 0, 0], axis: -y}
loads:
  motor: {type: rotary_motor, joint: shaft, DRIVE}
  brake: {type: torsional_spring, joint: bearing, damping: 0.5}
analysis: {duration: 1 s, step: 1 ms}
)yaml";

constexpr const char* kBeam = R"yaml(
format: 1
gravity: [0, 0, -9.81]
materials:
  soft: {type: elastic, youngs_modulus: 2e6, poisson_ratio: 0.3, density: 1000, viscosity: {relaxation_time: 1 ms}}
sections:
  bar: {type: rectangle, height: 0.2, width: 0.1, material: soft}
beams:
  arm: {points: [[0, 0, 0], [1, 0, 0]], elements: 2, section: bar, bonded: {ground: start}}
analysis: {duration: 0.2 s, step: 1 ms}
)yaml";

constexpr const char* kSolid = R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies:
  hub: {mass: 1, inertia: [0.01, 0.01, 0.01], position: [0, 0, 0], angular_velocity: [0, 3, 0]}
joints:
  axle: {type: revolute, bodies: [ground, hub], at: [0, 0, 0], axis: y}
materials:
  rubber: {type: mooney_rivlin_uncoupled, c1: 0.35 MPa, c2: 0.05 MPa, bulk_modulus: 4 MPa, density: 1100, viscosity: {relaxation_time: 2 ms}}
solids:
  bar:
    mesh: {block: {size: [0.3, 0.05, 0.05], cells: [3, 1, 1]}, position: [0.15, 0, 0]}
    element: hex8
    material: rubber
    bonded: {hub: xmin}
analysis: {duration: 0.1 s, step: 1 ms}
)yaml";

Model model_of(std::string text, const std::string& drive = "") {
  if (const std::size_t at = text.find("DRIVE"); at != std::string::npos)
    text.replace(at, 5, drive);
  return io::read_model_text(text, "model.yaml");
}

struct Extrapolated {
  std::string name;
  Model model;
  double t_end;
  std::vector<int> steps_4, steps_6, steps_8;
  int finest;  ///< Steps of order 10 of the reference.
};

class ExtrapolatedSteps : public testing::TestWithParam<Extrapolated> {
 protected:
  /// The order may be reached from above: further terms of the error fall faster.
  void expect(int order, const std::vector<int>& steps) const {
    const Extrapolated& c = GetParam();
    const Simulation exact = run_to(c.model, c.t_end, c.finest, 10);
    const auto error = [&](int n) {
      const Simulation s = run_to(c.model, c.t_end, n, order);
      // The balance closes to the order too.
      EXPECT_LE(s.summary().energy_drift,
                10.0 * (observed(s) - observed(exact)).lpNorm<Eigen::Infinity>())
          << n << " steps, order " << order;
      return (positions(s) - positions(exact)).lpNorm<Eigen::Infinity>();
    };
    EXPECT_GE(order_between(error, steps.front(), steps.back()), order - (order == 8 ? 0.7 : 0.3))
        << error(steps.front()) << ", " << error(steps.back());
  }
};

// @tests{extrapolated-step}
TEST_P(ExtrapolatedSteps, FourIsObserved) { expect(4, GetParam().steps_4); }
TEST_P(ExtrapolatedSteps, SixIsObserved) { expect(6, GetParam().steps_6); }
TEST_P(ExtrapolatedSteps, EightIsObserved) { expect(8, GetParam().steps_8); }

INSTANTIATE_TEST_SUITE_P(
    Of, ExtrapolatedSteps,
    testing::Values(
        Extrapolated{
            "damped_slider_crank", model_of(kSlider), 0.5, {40, 60}, {40, 60}, {40, 60}, 120},
        Extrapolated{
            "governor_of_softer_dampers", soft_governor(), 1.0, {20, 80}, {40, 80}, {20, 40}, 100},
        Extrapolated{"spring_net", model_of(kNet), 1.0, {20, 40}, {20, 40}, {20, 40}, 100},
        Extrapolated{"driven_four_bar",
                     model_of(kFourBar, "moment: \"0.6 + 0.3*sin(5*t)\""),
                     1.0,
                     {20, 80},
                     {40, 80},
                     {40, 80},
                     160},
        Extrapolated{"beam_with_damping", model_of(kBeam), 0.2, {10, 80}, {10, 40}, {10, 20}, 160},
        Extrapolated{
            "solid_with_viscosity", model_of(kSolid), 0.1, {80, 160}, {20, 40}, {20, 30}, 100}),
    [](const auto& p) { return p.param.name; });

// Reference: three-degree-of-freedom model by Radau and DOP853, which agree to 4e-11.
TEST(ExtrapolatedGovernor, ReachesOneMillionthIn2500SubstepsAndTenToMinusNineIn6000) {
  const PublishedCase c = flyball_case();
  const Reference r = Reference::read(c.data);
  const auto error = [&](int n, int order) {
    const Simulation s = run_to(c.model, c.duration, n, order);
    return std::abs(c.observe(s)[0] - r.values.back()[0]);
  };
  EXPECT_LE(error(100, 6), 1e-6);  // 1,200 substeps
  EXPECT_LE(error(300, 8), 1e-9);  // 6,000
}

// Positions of the slider against a run of order 8 with steps of 2.5 ms. The estimate is that of
// the column before the last one, so the error is well below the tolerance.
TEST(Extrapolation, AutomaticStepsMeetTheirTolerance) {
  Model model = model_of(kSlider, "");
  const Vec exact = positions(run_to(model, 0.5, 200, 8));
  int steps = 0;
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    Model chosen = model;
    chosen.analysis.method = "extrapolation";
    chosen.analysis.order = 6;
    chosen.analysis.step.reset();
    chosen.analysis.tolerance = tolerance;
    Simulation s(std::move(chosen));
    const RunSummary r = s.run();
    EXPECT_EQ(r.end, RunEnd::finished) << r.message;
    EXPECT_LT((positions(s) - exact).lpNorm<Eigen::Infinity>(), tolerance) << tolerance;
    EXPECT_GT(r.steps, steps);
    steps = static_cast<int>(r.steps);
  }
  EXPECT_LT(steps, 500);
}

constexpr const char* kControlled = R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies:
  cart: {mass: 2, inertia: [1e-3, 1e-3, 1e-3]}
  bob: {mass: 0.5, inertia: [1e-4, 1e-4, 1e-4], position: [0, 0, -0.4]}
joints:
  rail: {type: prismatic, bodies: [ground, cart], at: [0, 0, 0], axis: x}
  pin: {type: revolute, bodies: [cart, bob], at: [0, 0, 0], axis: y}
loads:
  push: {type: linear_motor, joint: rail, force: {controller: place}}
  damper: {type: torsional_spring, joint: pin, damping: 0.05}
controllers:
  place: {joint: rail, channel: z, setpoint: 0.3, proportional: 20, derivative: 4, integral: 5, sample: 50 ms}
events:
  free: {when: {joint: rail, channel: z, above: 0.12}, off: [damper]}
analysis: {duration: 1 s, step: 1 ms}
)yaml";

// A controller that is sampled and an event that is located within a step: both end steps.
TEST(Extrapolation, KeepsItsOrderWithASampledControllerAndAnEvent) {
  const Model model = model_of(kControlled);
  const Vec exact = positions(run_to(model, 1.0, 160, 10));
  const auto error = [&](int n) {
    return (positions(run_to(model, 1.0, n, 6)) - exact).lpNorm<Eigen::Infinity>();
  };
  EXPECT_LT(error(20), 1e-8);
  EXPECT_GE(order_between(error, 20, 40), 5.0);
}

TEST(Extrapolation, ContinuesARunFromItsStateWithTheSameBits) {
  Model model = model_of(kFourBar, "speed: \"12 + 3*sin(5*t)\"");
  const Simulation once = run_to(model, 0.4, 20, 6);
  Simulation half = run_to(model, 0.2, 10, 6);
  model.analysis.method = "extrapolation";
  model.analysis.order = 6;
  model.analysis.step = 0.4 / 20;
  model.analysis.duration = 0.4;
  Simulation rest(model, half.state());
  while (rest.time() < 0.4 * (1.0 - 1e-9)) ASSERT_TRUE(rest.step(0.4).accepted);
  EXPECT_EQ(observed(rest), observed(once));
  EXPECT_EQ(rest.state().ledger.dissipated.value(), once.state().ledger.dissipated.value());
}

// Without these step ends the error would be of order 3.
TEST(Extrapolation, EndsAStepAtAKinkOfALoad) {
  const Model model = model_of(kFourBar, "moment: {table: [[0, 0.5], [0.33, 1], [0.61, 0.2]]}");
  const Vec exact = positions(run_to(model, 1.0, 160, 10));
  const auto error = [&](int n) {
    return (positions(run_to(model, 1.0, n, 6)) - exact).lpNorm<Eigen::Infinity>();
  };
  EXPECT_GE(order_between(error, 25, 100), 4.5);
}

TEST(Extrapolation, CountsTurnsInLongSteps) {
  const Model model = model_of(kFourBar, "speed: \"20\"");
  const Simulation s = run_to(model, 2.0, 20, 8);  // two radians a step
  EXPECT_NEAR(s.joint("shaft").coordinates[0], 40.0, 1e-9);
}

void expect_refused(const std::string& text, const std::string& words) {
  Model model = model_of(text, "speed: \"3\"");
  model.analysis.method = "extrapolation";
  model.analysis.order = 6;
  try {
    const Simulation s(std::move(model));
    FAIL() << "not refused: " << words;
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr(words));
  }
}

std::string with(std::string text, const std::string& old, const std::string& now) {
  return text.replace(text.find(old), old.size(), now);
}

TEST(Extrapolation, NamesWhatIsNotSmooth) {
  const std::string four = kFourBar, net = kNet;
  expect_refused(with(four, "at: [0.4, 0, 0], axis: -y}",
                      "at: [0.4, 0, 0], axis: -y, friction: {mu: 0.2, radius: 0.01}}"),
                 "the joint 'bearing' has dry friction");
  expect_refused(with(four, "at: [0.4, 0, 0], axis: -y}",
                      "at: [0.4, 0, 0], axis: -y, limits: {lower: -2, upper: 2}}"),
                 "the joint 'bearing' has stops");
  expect_refused(with(net, "stiffness: 100, damping: 2", "stiffness: 100, acts: tension"),
                 "'s1' acts in tension only");
  expect_refused(with(net, "stiffness: 100, damping: 2", "damper_force: \"3*abs(v)*v + sign(v)\""),
                 "damper_force of 's1' jumps");
  expect_refused(with(four, "type: rotary_motor, joint: shaft, DRIVE",
                      "type: rotary_servo, joint: shaft, speed: 3, damping: 1, max_moment: 2"),
                 "the servo 'motor' has a limit");
  expect_refused(with(net, "stiffness: 100, damping: 2", "quadratic: 5"), "'s1' is quadratic");
  expect_refused(with(four, "analysis:", "contacts: {}\nanalysis:"), "the model has contacts");
  expect_refused(
      with(net, "analysis:", "cables:\n  rope: {through: [[a], [b]], stiffness: 10}\nanalysis:"),
      "the cable 'rope' can go slack");
}

TEST(Extrapolation, NeedsTheSymmetricStep) {
  expect_refused(with(kNet, "step: 1 ms", "step: 1 ms, rho_inf: 0.8"), "rho_inf is 0.8");
  expect_refused(with(kNet, "step: 1 ms", "step: 1 ms, momentum_rate: kinematic"), "momentum_rate");
}

}  // namespace
}  // namespace polhode::test::extrapolation_tests
