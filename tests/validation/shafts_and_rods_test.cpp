// SPDX-License-Identifier: Apache-2.0
// Constant-velocity joints, rods and links with slack in complete models.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <support/convergence.hpp>
#include <validation/connector_runs.hpp>

namespace polhode::shafts_and_rods_tests {

using namespace connectors;

namespace {

/// A driven shaft along x and one at an angle beta to it in the x, z plane, in a sleeve.
std::string bent_shafts(const std::string& type, double beta, const std::string& drive) {
  const std::string axis =
      "[" + std::to_string(std::cos(beta)) + ", 0, " + std::to_string(std::sin(beta)) + "]";
  const std::string joint = type == "universal"
                                ? "axes: [y, [" + std::to_string(-std::sin(beta)) + ", 0, " +
                                      std::to_string(std::cos(beta)) + "]]"
                                : "axis_body: [x, " + axis + "]";
  return R"(
format: 1
variables: {h: 2 ms}
bodies:
  engine: {mass: 1, inertia: [0.02, 0.05, 0.05], position: [-0.5, 0, 0]}
  wheel: {mass: 2, inertia: [0.2, 0.2, 0.2], position: )" +
         ("[" + std::to_string(0.5 * std::cos(beta)) + ", 0, " +
          std::to_string(0.5 * std::sin(beta)) + "]") +
         R"(}
joints:
  bearing: {type: revolute, bodies: [ground, engine], at: [-0.5, 0, 0], axis: x}
  sleeve: {type: cylindrical, bodies: [ground, wheel], at: [0, 0, 0], axis: )" +
         axis + R"(}
  joint: {type: )" +
         type + R"(, bodies: [engine, wheel], at: [0, 0, 0], )" + joint + R"(}
loads: {it: {type: rotary_motor, joint: bearing, )" +
         drive + R"(}}
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)";
}

double speed_of_wheel(const BodyMotion& wheel) { return wheel.W.norm(); }

}  // namespace

// Driven at 7 rad/s the wheel turns at 7 rad/s, at 40 degrees and at each step; a cardan's at
// 7 cos β/(1 − sin²β sin²φ), as its first pin starts across both shafts. @tests{joint-equal-turns}
TEST(ConstantVelocity, TurnsBothShaftsAtTheSameSpeed) {
  const double beta = 40.0 * kPi / 180.0;
  for (const Step& step : kSteps) {
    const Outcome o =
        run(bent_shafts("constant_velocity", beta, "speed: 7 rad/s"), {step_of(step)});
    EXPECT_NEAR(speed_of_wheel(o.body(1)), 7.0, 1e-8) << step.text;
    EXPECT_LT(o.summary.energy_drift, 1e-11) << step.text;
    EXPECT_LT(o.summary.constraint_residual_max, 1e-12) << step.text;
    EXPECT_NEAR(o.load[0], 0.0, 1e-6) << step.text;  // no moment: nothing accelerates
    const Outcome cardan = run(bent_shafts("universal", beta, "speed: 7 rad/s"), {step_of(step)});
    const double c = std::sin(7.0), s = std::sin(beta);
    EXPECT_NEAR(speed_of_wheel(cardan.body(1)), 7.0 * std::cos(beta) / (1.0 - s * s * c * c),
                200.0 * step.h * step.h)
        << step.text;
  }
}

// A moment of 0.6 N m on the first shaft turns both: (J_1 + J_2) φ̈ = M.
TEST(ConstantVelocity, TransmitsTheWholeMoment) {
  for (const Step& step : kSteps) {
    const Outcome o =
        run(bent_shafts("constant_velocity", 0.6, "moment: 0.6 N*m"), {step_of(step)});
    EXPECT_NEAR(speed_of_wheel(o.body(1)), 0.6 / 0.22, 10.0 * step.h * step.h) << step.text;
    EXPECT_LT(o.summary.energy_drift, 1e-11) << step.text;
  }
}

namespace {

/// Two free rotating bodies with one joint between them.
std::string flying_pair(const std::string& joint, int order) {
  return R"(
format: 1
variables: {h: 10 ms}
bodies:
  a: {mass: 1, inertia: [0.02, 0.05, 0.04], velocity: [0.2, 0, 0], angular_velocity: [2, 1, 0.5]}
  b: {mass: 2, inertia: [0.06, 0.03, 0.08], position: [0.5, 0.1, 0], angular_velocity: [-1, 0.5, 1]}
joints: {it: {bodies: [a, b], )" +
         joint + R"(}}
analysis: {type: dynamics, duration: 1 s, step: h, order: )" +
         std::to_string(order) + R"(}
output: {hdf5: false}
)";
}

constexpr const char* kFlyingJoints[] = {
    "type: constant_velocity, at: [0.2, 0, 0], axis: [1, 0.2, 0]",
    "type: revolute_spherical, at: [[0.1, 0, 0], [0.4, 0.1, 0]], axis: z",
    "type: universal_spherical, at: [[0.1, 0, 0], [0.4, 0.1, 0]]",
};

}  // namespace

TEST(ShaftsAndRods, KeepEnergyAndBothMomentaOfAFlyingPair) {
  for (const char* joint : kFlyingJoints)
    for (const int order : {2, 4, 6})
      for (const char* h : {"20 ms", "5 ms"}) {
        SCOPED_TRACE(std::string(joint) + h + std::to_string(order));
        const Outcome o = run(flying_pair(joint, order), {std::string("variables.h=") + h});
        EXPECT_LT(o.summary.energy_drift, 1e-11);
        EXPECT_LT(o.summary.linear_momentum_drift, 1e-11);
        EXPECT_LT(o.summary.angular_momentum_drift, 1e-11);
        EXPECT_LT(o.summary.constraint_residual_max, 1e-11);
      }
}

TEST(ShaftsAndRods, ConvergeWithTheOrderOfTheMethod) {
  for (const char* joint : kFlyingJoints) {
    SCOPED_TRACE(joint);
    const Outcome exact = run(flying_pair(joint, 6), {"variables.h=2 ms"});
    for (const int order : {2, 4, 6}) {
      const auto error = [&](int n) {
        const Outcome o =
            run(flying_pair(joint, order), {"variables.h=" + std::to_string(1.0 / n) + " s"});
        return (o.body(1).r - exact.body(1).r).norm() + (o.body(0).W - exact.body(0).W).norm();
      };
      test::expect_order(error,
                         order == 2   ? std::vector<int>{40, 80}
                         : order == 4 ? std::vector<int>{20, 40}
                                      : std::vector<int>{4, 8},
                         order, 0.7, joint);
    }
  }
}

// A mass of 2 kg on a rod of 0.8 m that turns about y: a pendulum of any amplitude. Its period is
// 4 √(L/g) K(sin φ_0/2): φ after a quarter of it is zero. @tests{joint-plane}
// @tests{joint-distance}
TEST(RevoluteSpherical, SwingsAPointMassAsAPendulum) {
  const double L = 0.8, g = 9.81, start = 1.2;
  const double quarter = std::sqrt(L / g) * std::comp_ellint_1(std::sin(0.5 * start));
  for (const double h : {0.02, 0.002, 0.0005}) {
    const int n = static_cast<int>(std::ceil(quarter / h));
    Simulation s(io::read_model_text(R"(
format: 1
gravity: [0, 0, -9.81]
bodies: {bob: {mass: 2, point_mass: true, position: )" +
                                         ("[" + std::to_string(L * std::sin(start)) + ", 0, " +
                                          std::to_string(-L * std::cos(start)) + "]}") +
                                         R"(}
joints: {rod: {type: revolute_spherical, bodies: [ground, bob], distance: 0.8, at_body: [[0, 0, 0], [0, 0, 0]], axis: -y, x_axis: -z}}
analysis: {type: dynamics, duration: )" + std::to_string(quarter) +
                                         " s, step: " + std::to_string(quarter / n) + R"( s}
output: {hdf5: false}
)",
                                     "rod.yaml"));
    EXPECT_NEAR(s.joint(0).coordinates.at(0), start, 1e-6);
    const RunSummary summary = s.run();
    EXPECT_NEAR(s.joint(0).coordinates.at(0), 0.0, 10.0 * h * h + 1e-5);
    EXPECT_NEAR(s.joint(0).rates.at(0), -2.0 * std::sqrt(g / L) * std::sin(0.5 * start),
                20.0 * h * h + 1e-5);
    EXPECT_NEAR(s.body(0).r.norm(), L, 1e-13);
    EXPECT_LT(std::abs(s.body(0).r.y()), 1e-13);
    // The force on the bob: m (g + L φ̇²).
    EXPECT_NEAR(s.joint(0).force.z(), 2.0 * (g + 4.0 * g * std::pow(std::sin(0.5 * start), 2)),
                400.0 * h * h + 1e-3);
    EXPECT_LT(summary.energy_drift, 1e-12);
  }
}

namespace {

std::string leash(double restitution) {
  return R"(
format: 1
variables: {h: 1 ms}
gravity: [0, 0, -9.81]
bodies: {ball: {mass: 2, inertia: [0.01, 0.01, 0.01], position: [0, 0, -0.2]}}
joints: {it: {type: slack_link, bodies: [ground, ball], at: [[0, 0, 0], [0, 0, -0.2]], limits: {upper: 0.5, restitution: )" +
         std::to_string(restitution) + R"(, band: 0.2 mm}}}
analysis: {type: dynamics, duration: 0.35 s, step: h}
output: {hdf5: false}
)";
}

}  // namespace

// Fall of 0.3 m and rebound with e times the speed: z = −0.5 + e v t − g t²/2.
// @tests{turn-law}
TEST(SlackLink, LetsAFallingBodyReboundByTheRestitution) {
  const double g = 9.81, t = 0.35, v = std::sqrt(2.0 * g * 0.3), fall = v / g;
  for (const double e : {1.0, 0.5})
    for (const double dt : {5e-3, 1e-3, 2e-4}) {
      const Outcome o = run(leash(e), {"variables.h=" + std::to_string(dt) + " s"});
      const double after = t - fall;
      const double z = o.body(0).r.z(), w = o.body(0).v.z();
      // The impact lies within a step; the energy after it does not depend on its time.
      EXPECT_NEAR(0.5 * w * w + g * (z + 0.5), e * e * g * 0.3, 2e-3 * g * 0.3) << e << ' ' << dt;
      EXPECT_NEAR(z, -0.5 + e * v * after - 0.5 * g * after * after, 2.0 * dt + 2e-4)
          << e << ' ' << dt;
      EXPECT_LT(o.summary.energy_drift, 1e-9) << e << ' ' << dt;
    }
}

TEST(SlackLink, CarriesItsBodyAtFullLengthWithoutRestitution) {
  for (const char* h : {"5 ms", "1 ms", "0.2 ms"}) {
    Simulation s(io::read_model_text(leash(0.0), "leash.yaml",
                                     {std::string("variables.h=") + h, "analysis.duration=1 s"}));
    const RunSummary summary = s.run();
    EXPECT_EQ(summary.end, RunEnd::finished) << summary.message;
    EXPECT_NEAR(s.joint(0).coordinates.at(0), 0.5, 1.1e-4) << h;
    EXPECT_NEAR(s.joint(0).stops.at(0), -2.0 * 9.81, 0.02) << h;
  }
}

TEST(SlackLink, RefusesPointsOutsideItsLimits) {
  try {
    (void)io::read_model_text(R"(
format: 1
bodies: {ball: {mass: 2, point_mass: true, position: [0, 0, -0.7]}}
joints: {leash: {type: slack_link, bodies: [ground, ball], at: [[0, 0, 0], [0, 0, -0.7]], limits: {upper: 0.5}}}
analysis: {type: dynamics, duration: 1 s, step: 1 ms}
)",
                              "leash.yaml");
    FAIL();
  } catch (const std::exception& e) {
    EXPECT_NE(std::string(e.what()).find("joints.leash.limits: the points are 0.7 m apart at the "
                                         "start, which is outside. Move the points, or widen the "
                                         "limits."),
              std::string::npos)
        << e.what();
  }
}

}  // namespace polhode::shafts_and_rods_tests
