// SPDX-License-Identifier: Apache-2.0
// Records between the ends of steps.
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

#include "support/paths.hpp"

namespace polhode::dense_output_tests {
namespace {

Model model_of(const std::string& text, double tolerance, double every) {
  Model m = io::read_model_text(text, "model.yaml");
  m.analysis.step.reset();
  m.analysis.tolerance = tolerance;
  m.output.every = every;
  return m;
}

Model example(const std::string& name, double tolerance, double every, double duration) {
  Model m = io::read_model(test::source_dir() + "/examples/" + name + "/model.yaml");
  m.analysis.step.reset();
  m.analysis.order.reset();
  m.analysis.tolerance = tolerance;
  m.analysis.duration = duration;
  m.output.every = every;
  return m;
}

/// Runs a model and looks at all records. @returns the number between ends of steps.
int records_between(Simulation& simulation, const std::function<void(Simulation&)>& look) {
  int between = 0;
  const RunSummary end = simulation.run([&](Simulation& s) {
    between += s.between_steps() ? 1 : 0;
    look(s);
  });
  EXPECT_EQ(end.end, RunEnd::finished);
  EXPECT_TRUE(end.trusted()) << (end.distrust.empty() ? "" : end.distrust.front());
  return between;
}
int records_between(const Model& model, const std::function<void(Simulation&)>& look) {
  Simulation simulation(model);
  return records_between(simulation, look);
}

class AtTolerance : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(DenseOutput, AtTolerance, testing::Values(1e-4, 1e-6, 1e-8),
                         [](const testing::TestParamInfo<double>& at) {
                           return format("e{:.0f}", -std::log10(at.param));
                         });

/// x'' + 2 β x' + ω² x = 0 from x = 0.1 at rest, with its energies.
TEST_P(AtTolerance, ADampedOscillatorHasItsClosedForm) {
  const double tolerance = GetParam();
  const double omega = 10.0, beta = 1.0, damped = std::sqrt(omega * omega - beta * beta);
  const Model m = model_of(R"(
format: 1
bodies:
  mass: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.1, 0, 0]}
joints:
  rail: {type: prismatic, bodies: [ground, mass], at_body: [[0, 0, 0], [0, 0, 0]], axis: x}
loads:
  spring: {type: translational_spring, joint: rail, stiffness: 100, damping: 2}
analysis: {duration: 2 s}
)",
                           tolerance, 0.004);
  const int between = records_between(m, [&](Simulation& s) {
    const double t = s.time(), decay = 0.1 * std::exp(-beta * t);
    const double x = decay * (std::cos(damped * t) + beta / damped * std::sin(damped * t));
    const double v = -decay * omega * omega / damped * std::sin(damped * t);
    const BodyMotion at = s.body(0);
    EXPECT_NEAR(at.r.x(), x, 3.0 * tolerance) << "at " << t;
    EXPECT_NEAR(at.v.x(), v, 60.0 * tolerance) << "at " << t;
    EXPECT_NEAR(s.point(0, Vec3::Zero()).acceleration.x(), -omega * omega * x - 2.0 * beta * v,
                600.0 * tolerance);
    const Balance b = s.balance();
    EXPECT_NEAR(b.dissipated, 0.5 - 0.5 * v * v - 50.0 * x * x, 60.0 * tolerance) << "at " << t;
    EXPECT_NEAR(b.kinetic + b.potential + b.dissipated, 0.5, 60.0 * tolerance) << "at " << t;
  });
  EXPECT_GT(between, 400);
}

/// A flywheel under a constant moment: φ = M t²/(2 I), work M φ, impulse M t.
TEST_P(AtTolerance, WorkAndImpulseOfAMotorHaveTheirClosedForm) {
  const double tolerance = GetParam();
  const Model m = model_of(R"(
format: 1
bodies:
  wheel: {mass: 1, inertia: [0.1, 0.1, 0.2]}
joints:
  hub: {type: revolute, bodies: [ground, wheel], at: [0, 0, 0], axis: z}
loads:
  motor: {type: rotary_motor, joint: hub, moment: 3}
analysis: {duration: 2 s}
)",
                           tolerance, 0.01);
  EXPECT_GT(records_between(m,
                            [&](Simulation& s) {
                              const double t = s.time(), angle = 7.5 * t * t;
                              EXPECT_NEAR(s.joint("hub").coordinates[0], angle, 10.0 * tolerance);
                              const std::vector<double> load = s.load("motor");
                              const std::size_t n = load.size();
                              EXPECT_NEAR(load[n - 2], 3.0 * angle, 1e-5 + 30.0 * tolerance);
                              EXPECT_NEAR(load[n - 1], 3.0 * t, 1e-6) << "at " << t;
                              EXPECT_NEAR(s.balance().put_in, 3.0 * angle, 500.0 * tolerance);
                            }),
            100);
}

/// A force that jumps, between two records: x'' = 2, from 0.317 s on −1.
TEST_P(AtTolerance, AJumpOfAForceIsNoKinkElsewhere) {
  const double tolerance = GetParam(), jump = 0.317;
  const Model m = model_of(R"(
format: 1
bodies:
  mass: {mass: 1, inertia: [0.1, 0.1, 0.1]}
loads:
  push: {type: force, body: mass, force: [{table: [[0, 2], [0.317, -1]], interpolation: step}, 0, 0]}
analysis: {duration: 1 s}
)",
                           tolerance, 0.005);
  EXPECT_GT(records_between(m,
                            [&](Simulation& s) {
                              const double t = s.time(), later = std::max(0.0, t - jump);
                              const double x = t * t - 1.5 * later * later;
                              EXPECT_NEAR(s.body(0).r.x(), x, 3.0 * tolerance) << "at " << t;
                              EXPECT_NEAR(s.body(0).v.x(), 2.0 * t - 3.0 * later, 9.0 * tolerance)
                                  << "at " << t;
                            }),
            100);
}

/// A free symmetric top: its axis turns about the angular momentum at L/I.
TEST_P(AtTolerance, AFreeTopPrecessesRegularly) {
  const double tolerance = GetParam();
  const Model m = model_of(R"(
format: 1
bodies:
  top: {mass: 1, inertia: [0.2, 0.2, 0.3], angular_velocity: [3, 0, 8], velocity: [1, 2, 3]}
analysis: {duration: 3 s}
)",
                           tolerance, 0.01);
  const Vec3 L(0.2 * 3.0, 0.0, 0.3 * 8.0);
  double worst = 0.0;
  EXPECT_GT(records_between(m,
                            [&](Simulation& s) {
                              const double t = s.time();
                              const Vec3 axis =
                                  Eigen::AngleAxisd(L.norm() / 0.2 * t, L.normalized()) *
                                  Vec3::UnitZ();
                              const BodyMotion at = s.body(0);
                              worst = std::max(worst, (at.q * Vec3::UnitZ() - axis).norm());
                              EXPECT_NEAR((at.r - t * Vec3(1, 2, 3)).norm(), 0.0, 1e-12);
                              EXPECT_NEAR(at.W.z(), 8.0, 100.0 * tolerance);
                            }),
            200);
  EXPECT_LT(worst, 100.0 * tolerance);  // over 30 steps, each with an error of the tolerance
}

/// Motions and reactions of a run whose steps end at the records, at a thousandth of the tolerance.
struct Track {
  std::vector<double> numbers;
  explicit Track(const Model& model) {
    Simulation simulation(model);
    simulation.run([this](Simulation& s) {
      for (int b = 0; b < static_cast<int>(s.model().bodies.size()); ++b) {
        const BodyMotion m = s.body(b);
        for (int i = 0; i < 3; ++i) numbers.push_back(m.r[i]);
        const Vec3 z = m.q * Vec3::UnitZ(), x = m.q * Vec3::UnitX();
        for (const Vec3& axis : {x, z})
          for (int i = 0; i < 3; ++i) numbers.push_back(axis[i]);
      }
    });
  }
};

/// @tests{dense-output}
TEST_P(AtTolerance, MechanismsAreWhereStepsThatEndThereTakeThem) {
  const double tolerance = GetParam();
  struct Case {
    const char* name;
    double duration;
  };
  for (const auto& [name, duration] : {Case{"crank_rocker", 1.2},
                                       {"bricard", 1.0},
                                       {"spatial_slider_crank", 0.4},
                                       {"double_pendulum", 1.0},
                                       {"planetary_gearbox", 0.5}}) {
    Model between = example(name, tolerance, 0.004, duration);
    Model ends = between;
    ends.analysis.tolerance = 1e-3 * tolerance;
    ends.output.between_steps = false;
    const Track found(between), expected(ends);
    ASSERT_EQ(found.numbers.size(), expected.numbers.size()) << name;
    double worst = 0.0;
    for (std::size_t k = 0; k < found.numbers.size(); ++k)
      worst = std::max(worst, std::abs(found.numbers[k] - expected.numbers[k]));
    EXPECT_LT(worst, 20.0 * tolerance) << name;
  }
}

TEST_P(AtTolerance, TheMotionDoesNotDependOnRecords) {
  for (const char* name : {"crank_rocker", "bricard", "heavy_top"}) {
    std::string hash;
    for (const double every : {10.0, 0.05, 0.0017}) {
      Simulation simulation(example(name, GetParam(), every, 0.7));
      const std::string now = simulation.run().result_hash;
      if (hash.empty()) hash = now;
      EXPECT_EQ(now, hash) << name << " every " << every;
    }
  }
}

TEST(DenseOutput, JointsAreAssembledAndTurnsCountedBetweenSteps) {
  const Model m = example("crank_rocker", 1e-6, 0.003, 2.0);
  double before = 0.0;
  const int between = records_between(m, [&](Simulation& s) {
    for (int j = 0; j < static_cast<int>(s.model().joints.size()); ++j)
      EXPECT_LT(s.joint(j).residual, 1e-10);
    const double angle = s.joint("shaft").coordinates[0];
    EXPECT_GE(angle, before);
    EXPECT_LT(angle - before, 0.05);
    before = angle;
  });
  EXPECT_GT(between, 600);
  EXPECT_NEAR(before, 21.0, 1e-5);  // 3 rad in the first half second, then 12 rad/s
}

/// A run that is continued from any step has the same records, to the last bit.
TEST(DenseOutput, AContinuedRunHasTheSameRecords) {
  const Model m = example("crank_rocker", 1e-6, 0.01, 1.0);
  std::vector<double> whole, continued;
  std::vector<State> states;
  Simulation first(m);
  const auto note = [](std::vector<double>& list) {
    return [&list](Simulation& s) {
      list.push_back(s.time());
      list.push_back(s.body(1).v.x());
      list.push_back(s.joint(0).force.x());
      list.push_back(s.load("motor").back());
    };
  };
  first.run(note(whole), [&](Simulation& s) { states.push_back(s.state()); });
  ASSERT_GT(states.size(), 6U);
  const State& from = states[states.size() / 2];
  Simulation second(m, from);
  second.run(note(continued));
  ASSERT_GT(continued.size(), 100U);
  ASSERT_LT(continued.size(), whole.size());
  EXPECT_TRUE(std::equal(continued.begin(), continued.end(),
                         whole.end() - static_cast<std::ptrdiff_t>(continued.size())));
}

TEST(DenseOutput, StepsEndAtRecordsWhereTheyAreNotToBeBetween) {
  Model m = example("heavy_top", 1e-6, 0.002, 0.2);
  m.output.between_steps = false;
  double least = 1e300, most = -1e300;
  EXPECT_EQ(records_between(m,
                            [&](Simulation& s) {
                              const Balance b = s.balance();
                              least = std::min(least, b.kinetic + b.potential);
                              most = std::max(most, b.kinetic + b.potential);
                            }),
            0);
  EXPECT_LT(most - least, 1e-11 * most);
}

/// A slider falls onto a stop and rebounds: records near impacts are those of steps of order 2.
TEST(DenseOutput, ReboundsAreWhereTheyAre) {
  const Model m = model_of(R"(
format: 1
gravity: [0, 0, -10]
bodies:
  slider: {mass: 1, inertia: [0.1, 0.1, 0.1]}
joints:
  rail: {type: prismatic, bodies: [ground, slider], at: [0, 0, 0], axis: z, limits: {lower: -0.2, restitution: 0.5}}
loads:
  drag: {type: translational_spring, joint: rail, stiffness: 0, damping: 1e-9}
analysis: {duration: 0.55 s}
)",
                           1e-6, 0.001);
  const double impact = 0.2;  // 0.2 = 5 t², then up at 1 m/s and down again after 0.2 s
  EXPECT_GT(records_between(m,
                            [&](Simulation& s) {
                              const double t = s.time();
                              double z = -5.0 * t * t;
                              if (t > impact)
                                z = -0.2 + (t - impact) - 5.0 * (t - impact) * (t - impact);
                              if (t > 0.4) z = -0.2 + 0.5 * (t - 0.4) - 5.0 * (t - 0.4) * (t - 0.4);
                              if (t < 0.499) {
                                EXPECT_NEAR(s.body(0).r.z(), z, 1e-4) << "at " << t;
                              }
                            }),
            50);
}

}  // namespace
}  // namespace polhode::dense_output_tests
