// SPDX-License-Identifier: Apache-2.0
// Springs, bushings, servos and drag in complete models: closed forms at coarse, usual and fine
// steps.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <validation/connector_runs.hpp>

namespace polhode::connectors_tests {

using namespace connectors;

// 2 ẍ = −50 x − 60 x³ from 0.8 m returns after 4 K(m)/ω, ω² = 25 + 30·0.64, m = 30·0.64/2ω²
// (Duffing; e.g. Kovacic and Brennan, The Duffing Equation, 2011, 4.1). @tests{law-mean}
TEST(Connectors, ADuffingOscillatorHasThePeriodOfItsEllipticIntegral) {
  const double omega = std::sqrt(25.0 + 30.0 * 0.64), m = 30.0 * 0.64 / (2.0 * omega * omega);
  const double T = 4.0 * std::comp_ellint_1(std::sqrt(m)) / omega;
  for (const Step& step : kSteps)
    for (const char* law :
         {"type: translational_spring, spring_force: \"50*x + 60*x^3\"",
          "type: translational_spring, stiffness: 50, spring_force: \"60*x^3\""}) {
      const Outcome o = run(slider(law, std::to_string(T)), {step_of(step)});
      EXPECT_NEAR(o.body(0).r.x(), 0.8, 200.0 * std::pow(step.h, 2)) << law << ' ' << step.text;
      EXPECT_NEAR(o.body(0).v.x(), 0.0, 500.0 * step.h * step.h + 1e-4) << law << ' ' << step.text;
      EXPECT_LT(o.summary.energy_drift, 1e-12) << law << ' ' << step.text;
    }
}

// 2 ẍ = −40 |x| x from A = 0.8: a quarter lasts √(3·2/(2·40 A)) B(1/3, 1/2)/3.
TEST(Connectors, AQuadraticSpringHasThePeriodOfItsBetaFunction) {
  const double beta = std::tgamma(1.0 / 3.0) * std::tgamma(0.5) / std::tgamma(5.0 / 6.0);
  const double T = 4.0 * std::sqrt(6.0 / (80.0 * 0.8)) * beta / 3.0;
  for (const Step& step : kSteps) {
    const Outcome o = run(slider("type: translational_spring, quadratic: 40", std::to_string(T)),
                          {step_of(step)});
    EXPECT_NEAR(o.body(0).r.x(), 0.8, 200.0 * step.h * step.h) << step.text;
    EXPECT_LT(o.summary.energy_drift, 1e-12) << step.text;
  }
}

// A spring in tension only releases the slider at x = 0: from a quarter of the period on it has the
// speed A ω.
TEST(Connectors, AOneSidedSpringReleasesItsBody) {
  const double omega = 5.0, T = 0.5 * kPi / omega + 0.4;
  for (const Step& step : kSteps) {
    const Outcome o =
        run(slider("type: translational_spring, stiffness: 50, acts: tension", std::to_string(T)),
            {step_of(step)});
    EXPECT_NEAR(o.body(0).v.x(), -0.8 * omega, 1e-12) << step.text;
    EXPECT_NEAR(o.body(0).r.x(), -0.8 * omega * 0.4, 10.0 * step.h * step.h + 1e-6) << step.text;
    EXPECT_LT(o.summary.energy_drift, 1e-12) << step.text;
  }
}

// A table as a piecewise linear function: energy at any step.
TEST(Connectors, ATableKeepsItsEnergy) {
  for (const Step& step : kSteps) {
    const Outcome o = run(slider("type: translational_spring, spring_force: {table: [[-1, -90], "
                                 "[-0.2, -5], [0.1, 0], [0.5, 30], [1, 200]]}",
                                 "5"),
                          {step_of(step)});
    EXPECT_LT(o.summary.energy_drift, 1e-12) << step.text;
  }
}

// Dampers: v = v_0 exp(−c t/m), and v_0/(1 + c v_0 t/m) where the force goes with v².
// @tests{drag-law}
TEST(Connectors, DampersAndDragSlowDownAsTheirClosedForms) {
  const std::string moves = ", velocity: [3, 0, 0]";
  for (const Step& step : kSteps) {
    const double tolerance = 20.0 * step.h * step.h;
    Outcome o = run(slider("type: translational_spring, damping: 4", "1", moves), {step_of(step)});
    EXPECT_NEAR(o.body(0).v.x(), 3.0 * std::exp(-2.0), tolerance) << step.text;
    EXPECT_LT(o.summary.energy_drift, 1e-12);
    o = run(slider("type: translational_spring, damper_force: \"4*abs(v)*v\"", "1", moves),
            {step_of(step)});
    EXPECT_NEAR(o.body(0).v.x(), 3.0 / 7.0, tolerance) << step.text;
    for (const auto& [load, v] :
         {std::pair("linear: 4", 3.0 * std::exp(-2.0)), std::pair("quadratic: 4", 3.0 / 7.0),
          std::pair("per_mass: 2", 3.0 * std::exp(-2.0))}) {
      o = run(std::string(R"(
format: 1
variables: {h: 2 ms}
bodies: {ball: {mass: 2, inertia: [0.1, 0.2, 0.25], velocity: [3, 0, 0], angular_velocity: [1, 2, 3]}}
loads: {it: {type: drag, body: ball, )") +
                  load + R"(}}
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)",
              {step_of(step)});
      EXPECT_NEAR(o.body(0).v.x(), v, tolerance) << load << ' ' << step.text;
      EXPECT_LT(o.summary.energy_drift, 1e-12) << load << ' ' << step.text;
      if (load[0] != 'p') continue;
      // ḣ = −α h keeps its direction.
      const Vec3 h0(0.1, 0.4, 0.75);  // of the start
      const Vec3 h = o.body(0).Lambda() * Vec3(0.1, 0.2, 0.25).asDiagonal() * o.body(0).W;
      EXPECT_NEAR((h - h0 * std::exp(-2.0)).norm(), 0.0, 2.0 * tolerance) << step.text;
    }
  }
}

// Two bodies about their common centre: half axis 1.5 of the relative orbit, eccentricity 0.4,
// period 2π √(a³ m₁m₂/(m₁+m₂)/K). @tests{attraction-gradient}
TEST(Connectors, TwoBodiesFollowKeplersEllipse) {
  const double K = 7.0, m_1 = 2.0, m_2 = 3.0, reduced = m_1 * m_2 / (m_1 + m_2), a = 1.5, e = 0.4;
  const double T = 2.0 * kPi * std::sqrt(a * a * a * reduced / K);
  const double l = a * (1.0 - e), v = std::sqrt(K / reduced * (2.0 / l - 1.0 / a));
  std::string load = "type: attraction, bodies: [one, two], strength: 7";
  const auto model = [&](int order) {
    return format(R"(
format: 1
variables: {{h: 2 ms}}
bodies:
  one: {{mass: 2, inertia: [1, 1, 1], position: [{}, 0, 0], velocity: [0, {}, 0]}}
  two: {{mass: 3, inertia: [1, 1, 1], position: [{}, 0, 0], velocity: [0, {}, 0]}}
loads: {{it: {{{}}}}}
analysis: {{type: dynamics, duration: {:.15g} s, step: h, order: {}}}
output: {{hdf5: false}}
)",
                  -0.6 * l, -0.6 * v, 0.4 * l, 0.4 * v, load, T, order);
  };
  for (const Step& step : kSteps) {
    const Outcome o = run(model(2), {step_of(step)});
    EXPECT_NEAR(o.body(1).r.x(), 0.4 * l, 100.0 * step.h * step.h) << step.text;
    EXPECT_NEAR(o.body(1).r.y(), 0.0, 100.0 * step.h * step.h) << step.text;
    EXPECT_LT(o.summary.energy_drift, 1e-12) << step.text;
    EXPECT_LT(o.summary.linear_momentum_drift, 1e-12) << step.text;
    EXPECT_LT(o.summary.angular_momentum_drift, 1e-12) << step.text;
  }
  for (const int order : {4, 6}) {
    const double coarse = std::abs(run(model(order), {"variables.h=80 ms"}).body(1).r.y());
    const double fine = std::abs(run(model(order), {"variables.h=40 ms"}).body(1).r.y());
    EXPECT_GT(std::log2(coarse / fine), order - 0.7) << order << ' ' << coarse << ' ' << fine;
  }
  // The same potential as an expression: the same motion.
  const Outcome attracted = run(model(2), {"variables.h=2 ms"});
  load = "type: potential, bodies: [one, two], at_body: [[0, 0, 0], [0, 0, 0]], energy: -7/l";
  for (const Step& step : kSteps) {
    const Outcome o = run(model(2), {step_of(step)});
    EXPECT_NEAR(o.body(1).r.x(), 0.4 * l, 100.0 * step.h * step.h) << step.text;
    EXPECT_LT(o.summary.energy_drift, 1e-12) << step.text;
    EXPECT_LT(o.summary.angular_momentum_drift, 1e-12) << step.text;
  }
  const Outcome given = run(model(2), {"variables.h=2 ms"});
  EXPECT_LT((given.body(1).r - attracted.body(1).r).norm(), 1e-9);
  const double coarse = std::abs(run(model(4), {"variables.h=80 ms"}).body(1).r.y());
  const double fine = std::abs(run(model(4), {"variables.h=40 ms"}).body(1).r.y());
  EXPECT_GT(std::log2(coarse / fine), 3.3);
}

namespace {

// Body of 2 kg in a bushing off its centre.
std::string bushed(const std::string& analysis, const std::string& more = "") {
  return R"(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 2 ms}
bodies: {block: {mass: 2, inertia: [0.02, 0.03, 0.04], position: [0.2, 0.1, 0], velocity: [0.3, 0, 0.4], angular_velocity: [1, 4, -3]}}
loads:
  it: {type: bushing, bodies: [ground, block], at: [0, 0, 0], stiffness: [4000, 3000, 5000], turning_stiffness: [60, 80, 50])" +
         more + R"(}
analysis: {)" +
         analysis + R"(}
output: {hdf5: false}
)";
}

}  // namespace

// @tests{bushing-cayley}
TEST(Connectors, ABushingKeepsItsEnergyAndTheOrderOfTheMethod) {
  for (const Step& step : kSteps) {
    Outcome o = run(bushed("type: dynamics, duration: 1 s, step: h"), {step_of(step)});
    EXPECT_LT(o.summary.energy_drift, 1e-12) << step.text;
    EXPECT_LT(o.summary.angular_momentum_drift, 1e-10) << step.text;
    o = run(bushed("type: dynamics, duration: 1 s, step: h",
                   ", damping: [5, 5, 5], turning_damping: [0.1, 0.1, 0.1]"),
            {step_of(step)});
    EXPECT_LT(o.summary.energy_drift, 1e-12) << step.text;
  }
  for (const int order : {2, 4, 6}) {
    std::vector<double> z;
    for (const char* h : {"8 ms", "4 ms", "2 ms"})
      z.push_back(
          run(bushed("type: dynamics, duration: 0.2 s, step: h, order: " + std::to_string(order)),
              {std::string("variables.h=") + h})
              .body(0)
              .r.z());
    const double rate = std::log2(std::abs((z[1] - z[0]) / (z[2] - z[1])));
    EXPECT_GT(rate, order - 0.6) << order;
  }
}

// In statics a weight at the bushing's point is displaced by m g/k_z, and a moment causes a
// rotation with 2 tan(θ/2) = M/k.
TEST(Connectors, ABushingAtRestHasTheDeflectionOfItsStiffness) {
  const std::string text = R"(
format: 1
gravity: [0, 0, -9.81]
bodies: {block: {mass: 2, inertia: [0.02, 0.03, 0.04]}}
loads:
  it: {type: bushing, bodies: [ground, block], at: [0, 0, 0], stiffness: [4000, 3000, 5000], turning_stiffness: [60, 80, 50]}
  twist: {type: moment, body: block, moment: [0, 0, 20]}
analysis: {type: statics}
output: {hdf5: false}
)";
  const Outcome o = run(text);
  EXPECT_NEAR(o.body(0).r.z(), -2.0 * 9.81 / 5000.0, 1e-9);
  ASSERT_EQ(o.load.size(), 13U);
  EXPECT_NEAR(o.load[2], 2.0 * 9.81, 1e-6);
  EXPECT_NEAR(o.load[5], -20.0, 1e-6);
  const double theta = 2.0 * std::acos(std::min(1.0, std::abs(o.body(0).q.w())));
  // The moment of a rotation about z alone is M = k c (1 + c²/4) by the gradient of c.
  const double c = 2.0 * std::tan(0.5 * theta);
  EXPECT_NEAR(50.0 * c * (1.0 + 0.25 * c * c), 20.0, 1e-6);
}

namespace {

std::string wheel(const std::string& load, const std::string& more = "") {
  return R"(
format: 1
variables: {h: 2 ms}
bodies: {wheel: {mass: 1, inertia: [0.1, 0.1, 0.2]}}
joints: {axle: {type: revolute, bodies: [ground, wheel], at: [0, 0, 0], axis: z}}
loads:
  it: {type: rotary_servo, joint: axle, )" +
         load + "}\n" + more + R"(
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)";
}

}  // namespace

// J φ̈ + d φ̇ + k (φ − c) = 0: the step response of the damped oscillator. @tests{servo-law}
TEST(Connectors, APDServoHasTheStepResponseOfASecondOrderSystem) {
  const double k = 20.0, d = 0.8, J = 0.2, c = 1.0;
  const double omega = std::sqrt(k / J), zeta = d / (2.0 * std::sqrt(k * J));
  const double damped = omega * std::sqrt(1.0 - zeta * zeta);
  const double phi = c * (1.0 - std::exp(-zeta * omega) *
                                    (std::cos(damped) + zeta * omega / damped * std::sin(damped)));
  std::vector<double> error;
  for (const Step& step : kSteps) {
    const Outcome o = run(wheel("stiffness: 20, damping: 0.8, angle: 1"), {step_of(step)});
    error.push_back(std::abs(o.load[3] - phi));
    EXPECT_LT(o.summary.energy_drift, 1e-12) << step.text;
  }
  EXPECT_LT(error[1], 1e-3);
  EXPECT_NEAR(error[1] / error[2], 16.0, 2.0);
}

// Speed control with k ∫(s − ω) and a brake of 0.5 N m: the speed returns to its setpoint, as J ω̈
// + d ω̇ + k (ω − s) = 0 with ω(0) = 0, ω̇(0) = (d s − 0.5)/J.
TEST(Connectors, APIServoHoldsItsSpeedUnderLoad) {
  const double k = 12.0, d = 0.6, J = 0.2, s = 3.0;
  const double sigma = d / (2.0 * J), damped = std::sqrt(k / J - sigma * sigma);
  const double start = (d * s - 0.5) / J;
  const double omega = s + std::exp(-sigma) * (-s * std::cos(damped) +
                                               (start - sigma * s) / damped * std::sin(damped));
  std::vector<double> error;
  for (const Step& step : kSteps) {
    const Outcome o = run(wheel("stiffness: 12, damping: 0.6, speed: 3",
                                "  brake: {type: moment, body: wheel, moment: [0, 0, -0.5]}"),
                          {step_of(step)});
    error.push_back(std::abs(o.body(0).W.z() - omega));
    EXPECT_LT(o.summary.energy_drift, 1e-12) << step.text;
  }
  EXPECT_LT(error[1], 1e-3);
  EXPECT_NEAR(error[1] / error[2], 16.0, 2.0);
}

TEST(Connectors, AServoAtItsLimitAcceleratesEvenly) {
  for (const Step& step : kSteps) {
    const Outcome o = run(wheel("stiffness: 1000, angle: 100, max_moment: 0.4"), {step_of(step)});
    EXPECT_NEAR(o.body(0).W.z(), 2.0, 0.02 * step.h) << step.text;
    EXPECT_DOUBLE_EQ(o.load[2], 0.4) << step.text;
    EXPECT_NEAR(o.load[7], 0.4 * o.load[3], 1e-12) << step.text;
  }
}

// A tension of 3 N between a free ball and the ground; a damper of the motion of a point.
TEST(Connectors, ForcesAndDampersBetweenPointsHaveTheirClosedForms) {
  const auto ball = [](const std::string& load) {
    return R"(
format: 1
variables: {h: 2 ms}
bodies: {ball: {mass: 2, inertia: [0.1, 0.1, 0.1], position: [2, 0, 0], velocity: [0, 0, 0]}}
loads: {it: {bodies: [ground, ball], at_body: [[0, 0, 0], [0, 0, 0]], )" +
           load + R"(}}
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)";
  };
  for (const Step& step : kSteps) {
    Outcome o = run(ball("type: axial_force, pull: \"3*t\""), {step_of(step)});
    EXPECT_NEAR(o.body(0).v.x(), -0.75, 1e-11) << step.text;
    EXPECT_LT(o.summary.energy_drift, 1e-12) << step.text;
    o = run(ball("type: vector_damper, damping: 3, turning_damping: 0.2"),
            {step_of(step), "bodies.ball.velocity=[1, 2, 0]",
             "bodies.ball.angular_velocity=[0, 0, 1.5]"});
    EXPECT_NEAR(o.body(0).v.y(), 2.0 * std::exp(-1.5), 5.0 * step.h * step.h) << step.text;
    EXPECT_NEAR(o.body(0).W.z(), 1.5 * std::exp(-2.0), 5.0 * step.h * step.h) << step.text;
    EXPECT_LT(o.summary.energy_drift, 1e-12) << step.text;
  }
}

// Two bodies that turn as one, with a damper between points apart: nothing brakes a common
// rotation, and momenta of bodies on a slide between them stay.
// @tests{drag-law}
TEST(Connectors, AVectorDamperLeavesACommonRotationAlone) {
  const auto pair = [](const std::string& joint) {
    return R"(
format: 1
variables: {h: 2 ms}
bodies:
  a: {mass: 2, inertia: [0.1, 0.2, 0.3], position: [-0.5, 0, 0], velocity: [0, -1, 0], angular_velocity: [0, 0, 2]}
  b: {mass: 2, inertia: [0.1, 0.2, 0.3], position: [0.5, 0, 0], velocity: [0, 1, 0], angular_velocity: [0, 0, 2]}
joints: {j: {type: )" +
           joint + R"(, bodies: [a, b], at: [0, 0, 0]}}
loads: {d: {type: vector_damper, bodies: [a, b], at: [[-0.7, 0.1, 0], [0.6, 0, 0.1]], damping: 3, turning_damping: 0.2}}
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)";
  };
  for (const Step& step : kSteps) {
    const Outcome one = run(pair("fixed"), {step_of(step)});
    EXPECT_NEAR(one.body(1).W.z(), 2.0, 1e-12) << step.text;
    EXPECT_NEAR((one.body(1).v - one.body(0).v).norm(), 2.0, 1e-12) << step.text;
    const Outcome slides =
        run(pair("prismatic, axis: y"), {step_of(step), "bodies.b.velocity=[0, 3, 0]"});
    EXPECT_LT((slides.body(1).v - slides.body(0).v).norm(), 3.5) << step.text;  // from 4 m/s
    EXPECT_LT(slides.summary.angular_momentum_drift, 1e-12) << step.text;
    EXPECT_LT(slides.summary.energy_drift, 1e-12) << step.text;
  }
}

// A bead on surfaces: on a vertical cylinder it turns uniformly as it falls; on a horizontal one it
// swings as a pendulum of its radius, from 90 degrees to the bottom in K(1/√2) √(R/g); on an
// ellipsoid it conserves energy.
// @tests{surface-row}
TEST(Connectors, ABeadOnACylinderFallsOrSwings) {
  const auto bead = [](const std::string& axes, const std::string& v, const std::string& T) {
    return R"(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 2 ms}
bodies: {bead: {mass: 0.1, point_mass: true, position: [0.5, 0, 0], velocity: )" +
           v + R"(}}
loads: {it: {type: point_on_surface, bodies: [ground, bead], at: [[0, 0, 0], [0.5, 0, 0]], semi_axes: )" +
           axes + R"(}}
analysis: {type: dynamics, duration: )" +
           T + R"( s, step: h}
output: {hdf5: false}
)";
  };
  for (const Step& step : kSteps) {
    Outcome o = run(bead("[0.5, 0.5, 0]", "[0, 2, 0]", "1"), {step_of(step)});
    EXPECT_NEAR(o.body(0).r.z(), -0.5 * 9.81, 1e-11) << step.text;
    EXPECT_NEAR(o.body(0).r.x(), 0.5 * std::cos(4.0), 3.0 * step.h * step.h) << step.text;
    EXPECT_NEAR(Vec3(o.load[0], o.load[1], 0.0).norm(), 0.1 * 4.0 / 0.5, 1e-6) << step.text;
    EXPECT_LT(o.summary.energy_drift, 1e-12) << step.text;
    const double T = std::comp_ellint_1(std::sqrt(0.5)) * std::sqrt(0.5 / 9.81);
    o = run(bead("[0.5, 0, 0.5]", "[0, 0, 0]", std::to_string(T)), {step_of(step)});
    EXPECT_NEAR(o.body(0).r.x(), 0.0, 20.0 * step.h * step.h + 2e-6) << step.text;
    EXPECT_NEAR(o.load[2], 0.3 * 9.81, 100.0 * step.h * step.h + 1e-5) << step.text;
    o = run(bead("[0.5, 0.4, 0.3]", "[0, 2, 0]", "2"), {step_of(step)});
    EXPECT_LT(o.summary.energy_drift, 1e-12) << step.text;
  }
}

// Statics: 50 x + 60 x³ = 40 N; a moment over a gear on a spring.
TEST(Connectors, HaveEquilibriaInStatics) {
  Outcome o = run(R"(
format: 1
gravity: [20, 0, 0]
bodies: {cart: {mass: 2, inertia: [1, 1, 1]}}
joints: {rail: {type: prismatic, bodies: [ground, cart], at: [0, 0, 0], axis: x}}
loads: {it: {type: translational_spring, joint: rail, spring_force: "50*x + 60*x^3"}}
analysis: {type: statics}
output: {hdf5: false}
)");
  const double x = o.body(0).r.x();
  EXPECT_NEAR(50.0 * x + 60.0 * x * x * x, 40.0, 1e-7);
  o = run(R"(
format: 1
bodies:
  one: {mass: 1, inertia: [1, 1, 1]}
  two: {mass: 1, inertia: [1, 1, 1], position: [0.3, 0, 0]}
joints:
  one: {type: revolute, bodies: [ground, one], at: [0, 0, 0], axis: z}
  two: {type: revolute, bodies: [ground, two], at: [0.3, 0, 0], axis: z}
loads:
  it: {type: gear, joints: [one, two], ratio: -2}
  spring: {type: torsional_spring, joint: one, stiffness: 30}
  turn: {type: moment, body: two, moment: [0, 0, 5]}
analysis: {type: statics}
output: {hdf5: false}
)");
  // 5 N m on the second are −2.5 on the first.
  EXPECT_NEAR(o.load[2], -2.5 / 30.0, 1e-9);
  EXPECT_NEAR(o.load[3], 2.5 / 60.0, 1e-9);
}

// Impossible connectors are refused with their location.
TEST(Connectors, RefuseInvalidInput) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      Simulation s(io::read_model_text(text, "m.yaml"));
    } catch (const std::exception& e) {
      return e.what();
    }
    return "";
  };
  const auto has = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(message(slider("type: translational_spring", "1")), "has neither stiffness nor damping");
  has(message(slider("type: translational_spring, spring_force: \"3*t\"", "1")),
      "'t' (the time) has no meaning here");
  has(message(slider("type: translational_spring, damper_force: \"-v\"", "1")),
      "a damper must not add energy");
  has(message(slider("type: translational_spring, spring_force: \"4*x m\"", "1")), "expects");
  has(message(bushed("type: dynamics, duration: 1 s, step: h",
                     ", stiffness_matrix: [[1, 2, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0], [0, 0, 1, 0, 0, "
                     "0], [0, 0, 0, 1, 0, 0], [0, 0, 0, 0, 1, 0], [0, 0, 0, 0, 0, 1]]")),
      "is not symmetric");
  has(message(planetary("  wrong: {type: gear, joints: [main, shaft], radius: 1}",
                        "type: dynamics, duration: 1 s, step: h")),
      "Give ratio alone");
}

}  // namespace polhode::connectors_tests
