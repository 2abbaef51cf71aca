// SPDX-License-Identifier: Apache-2.0
// Steps that must not be taken: a body turning too far, a joint reaching its mirror image, a motion
// that cannot be continued.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/model/simulation.hpp>
#include <support/known_solutions/free_symmetric_top.hpp>
#include <support/published_cases.hpp>

namespace polhode::test {
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
  // Steps of half a turn are refused until |Θ| ≤ 2, where the motion is followed roughly but
  // energy and momentum exactly.
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

TEST(StepRefusal, KeepsJointsOutOfTheirMirrorImage) {
  // A four-bar in large steps near its dead points: axes never come out opposite, and the
  // mechanism stays the one it was.
  for (const double step : {0.02, 0.05, 0.1}) {
    Model model = n_four_bar(1);
    model.analysis.step = step;
    model.analysis.duration = 5.0;
    Simulation s(std::move(model));
    const RunSummary r = s.run();
    ASSERT_EQ(r.end, RunEnd::finished) << r.message;
    for (std::size_t j = 0; j < s.model().joints.size(); ++j) {
      const JointSpec& joint = s.model().joints[j];
      const auto axis = [&](int body, const Mat3& R) -> Vec3 {
        return body == kGround ? Vec3(R.col(2)) : Vec3(s.body(body).q * R.col(2));
      };
      EXPECT_NEAR(axis(joint.a, joint.R_a).dot(axis(joint.b, joint.R_b)), 1.0, 1e-10)
          << joint.name << " at a step of " << step;
    }
    EXPECT_LE(r.energy_drift, 1e-10);
  }
}

/// A rod that a growing force pulls out of what its joint allows: a load without bound in time.
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

TEST(StepRefusal, SaysWhoIsAtFaultWhenARunCannotGoOn) {
  Simulation s(hopeless());
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::not_converged);
  EXPECT_THAT(r.message, testing::HasSubstr("body 'arm'"));
  EXPECT_THAT(r.message, testing::HasSubstr("t = "));
  // The last good state is still there.
  EXPECT_NEAR(r.t, 0.05, 0.0101);
  EXPECT_TRUE(s.body(0).r.allFinite());
  EXPECT_LE(r.constraint_residual_max, 1e-12);
}

}  // namespace
}  // namespace polhode::test
