// SPDX-License-Identifier: Apache-2.0
// Steps that must be rejected: a rotation that is too large, a joint that reaches its mirror image,
// a motion that cannot be continued.
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/simulation/simulation_details.hpp>
#include <support/known_solutions/free_symmetric_top.hpp>
#include <support/published_cases.hpp>

namespace polhode::test::refusal_tests {
namespace {

TEST(StepRefusal, HalvesAStepThatTurnsABodyTooFar) {
  // |Θ| = 2 tan(ω Δt/2) in a Cayley step: 30 rad/s over 0.1 s would turn by 3 rad.
  const FreeSymmetricTop exact{1.0, 2.0, {0.0, 0.0, 30.0}};
  Model model = free_symmetric_top(exact.W_0);
  model.analysis.step = 0.1;
  model.analysis.duration = 1.0;
  Simulation s(std::move(model));
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_GT(r.rejected_steps, 0);
  EXPECT_GT(r.steps, 10);
  EXPECT_NEAR(r.t, 1.0, 1e-12);
  EXPECT_LE((s.body(0).W - exact.W(1.0)).norm(), 1e-11 * 30.0);
  EXPECT_LE(r.energy_drift, 1e-12);
}

TEST(StepRefusal, OfALargeTurnStillFollowsTheTumblingBody) {
  // Steps of half a turn are rejected until |Θ| ≤ 2, where the motion is approximate, but energy
  // and momentum are exact.
  const FreeSymmetricTop exact{1.0, 2.0, {3.0, 0.0, 12.0}};
  Model model = free_symmetric_top(exact.W_0);
  model.analysis.step = 0.25;
  model.analysis.duration = 2.0;
  Simulation s(std::move(model));
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_GT(r.rejected_steps, 0);
  EXPECT_LE(r.energy_drift, 1e-12);
  EXPECT_LE(r.angular_momentum_drift, 1e-12);
}

/// Two hinged bodies on stiff springs that turn about any axis, in steps that are much too long.
/// With unlimited rotations in a step the hinge may end in its mirror image, with opposite axes,
/// which its rows allow.
Model thrown_about(unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const auto random = [&] {
    const double x = u(generator), y = u(generator), z = u(generator);
    return Vec3(x, y, z);
  };
  ModelBuilder m;
  const int a = m.body("a", {0.5, 0, 0}, 1.0, {0.02, 0.1, 0.1});
  const int b = m.body("b", {1.5, 0, 0}, 1.0, {0.02, 0.1, 0.1});
  const Vec3 omega = 5.0 * random();
  m.joint("hinge", "revolute", a, b, {1, 0, 0}, random().normalized());
  m.turning(a, omega);
  m.turning(b, omega);
  m.at(b).angular_velocity += 5.0 * random();
  const Vec3 one = random(), two = random();
  const std::map<std::string, double> stiff{{"stiffness", 200.0}, {"free_length", 0.1}};
  m.spring("one", kGround, {one.x(), one.y(), 1.0}, a, {0.3, 0.2, 0}, stiff);
  m.spring("two", kGround, {two.x(), two.y(), -1.0}, b, {1.7, 0.2, 0}, stiff);
  m.model.analysis.step = 0.1;
  m.model.analysis.duration = 2.0;
  m.model.analysis.max_step_rotation = 50.0;
  return m.model;
}

TEST(StepRefusal, RejectsAStepThatReachesTheMirrorImageOfAJointAndHalvesIt) {
  int mirrored = 0;
  for (unsigned seed = 0; seed < 2000 && mirrored < 2; ++seed) {
    const Model model = thrown_about(seed);
    Model once = model;  // a single trial, so that its reason is reported
    once.analysis.min_step = 0.9 * *once.analysis.step;
    once.analysis.duration = *once.analysis.step;
    const RunSummary trial = Simulation(once).run();
    if (trial.message.find("mirror image") == std::string::npos) continue;
    ++mirrored;
    EXPECT_THAT(trial.message,
                testing::HasSubstr("joint 'hinge': reached the mirror image of its assembly"));
    EXPECT_EQ(trial.end, RunEnd::not_converged);
    EXPECT_EQ(trial.t, 0.0);

    Simulation s(model);
    const StepReport first = s.step(model.analysis.duration);
    ASSERT_TRUE(first.accepted) << first.message;
    EXPECT_GT(first.rejected, 0);
    EXPECT_LE(first.dt, 0.5 * *model.analysis.step);
    const RunSummary r = s.run();
    ASSERT_EQ(r.end, RunEnd::finished) << r.message;
    const JointSpec& hinge = s.model().joints[0];
    const Vec3 on_a = s.body(0).q * hinge.R_a.col(2), on_b = s.body(1).q * hinge.R_b.col(2);
    EXPECT_NEAR(on_a.dot(on_b), 1.0, 1e-10) << seed;
    EXPECT_LE(r.energy_drift, 1e-10) << seed;
  }
  EXPECT_GE(mirrored, 1) << "none of these steps reaches a mirror image, so this test needs others";
}

// A four-bar in large steps near its dead points keeps its assembly mode.
TEST(StepRefusal, KeepsTheHingesOfAFourBarAsTheyWereAssembled) {
  for (const double step : {0.02, 0.05, 0.1}) {
    Model model = n_four_bar(1);
    model.analysis.step = step;
    model.analysis.duration = 5.0;
    Simulation s(std::move(model));
    const RunSummary r = s.run();
    ASSERT_EQ(r.end, RunEnd::finished) << r.message;
    for (const JointSpec& joint : s.model().joints) {
      const auto axis = [&](int body, const Mat3& R) -> Vec3 {
        return body == kGround ? Vec3(R.col(2)) : Vec3(s.body(body).q * R.col(2));
      };
      EXPECT_NEAR(axis(joint.a, joint.R_a).dot(axis(joint.b, joint.R_b)), 1.0, 1e-10)
          << joint.name << " at a step of " << step;
    }
    EXPECT_LE(r.energy_drift, 1e-10);
  }
}

/// A motor without a limit drives a rotor, which becomes too fast for the smallest step: the Cayley
/// vector's length is the mean angular velocity times the step, so at 0.5 ms its limit, 2, is
/// reached at 4000 rad/s.
Model runaway() {
  ModelBuilder m;
  const int frame = m.body("frame", {0.5, 0, 0}, 2.0, {0.01, 0.1, 0.1});
  const int rotor = m.body("rotor", {1, 0, 0}, 1.0, {0.02, 0.02, 0.05});
  m.joint("shoulder", "revolute", kGround, frame, Vec3::Zero());
  m.joint("shaft", "revolute", frame, rotor, {1, 0, 0});
  m.moment("motor", rotor, {0, 0, 200.0});
  m.model.analysis.step = 2e-3;
  m.model.analysis.min_step = 0.5e-3;
  m.model.analysis.duration = 10.0;
  return m.model;
}

TEST(StepRefusal, EndsARunThatNoStepCanFollowAndNamesTheBody) {
  Simulation s(runaway());
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::not_converged);
  EXPECT_THAT(r.message, testing::HasSubstr("body 'rotor'"));
  EXPECT_THAT(r.message, testing::HasSubstr("max_step_rotation"));
  // 200 N m on 0.05 kg m² reach 4000 rad/s after 1 s. The state is the last one before that.
  EXPECT_NEAR(r.t, 2.0 / 0.5e-3 * 0.05 / 200.0, 2e-3);
  EXPECT_NEAR(s.body(1).W.z(), 200.0 / 0.05 * r.t, 0.01 * s.body(1).W.z());
  EXPECT_LE(r.energy_drift, 1e-11);
  EXPECT_LE(r.constraint_residual_max, 1e-12);
}

/// A load that is not defined after a certain time.
Model hopeless() {
  ModelBuilder m;
  const int a = m.body("arm", {0.5, 0.0, 0.0}, 1.0, {0.01, 0.1, 0.1});
  m.joint("shoulder", "revolute", kGround, a, Vec3::Zero());
  struct Blows final : TimeFunction {
    double operator()(double t) const override {
      return t < 0.05 ? 1.0 : std::numeric_limits<double>::quiet_NaN();
    }
  };
  LoadSpec load;
  load.name = "push";
  load.type = "force";
  load.b = a;
  const auto blows = std::make_shared<Blows>();
  load.vector = TimeVector{blows, blows, blows};
  m.model.loads.push_back(load);
  m.model.analysis.step = 0.01;
  m.model.analysis.duration = 1.0;
  return m.model;
}

TEST(StepRefusal, KeepsTheLastGoodStateWhenALoadHasNoValue) {
  Simulation s(hopeless());
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::not_converged);
  EXPECT_THAT(r.message, testing::HasSubstr("load 'push' is not a finite number at t = "));
  // The last accepted state is kept.
  EXPECT_NEAR(r.t, 0.05, 0.0101);
  EXPECT_TRUE(s.body(0).r.allFinite());
  EXPECT_LE(r.constraint_residual_max, 1e-12);
}

}  // namespace
}  // namespace polhode::test::refusal_tests
