// SPDX-License-Identifier: Apache-2.0
// Newton's method for equilibria, at one load factor: closed forms, convergence, failures,
// stability.
#include <polhode/statics/static_newton.hpp>

#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <statics/static_models.hpp>

namespace polhode::static_newton_tests {
namespace {

using test::add_body, test::add_joint, test::add_load;
using testing::HasSubstr;

const Vec3 kDown(0, -9.81, 0);

/// 2 kg on a spring of 400 N/m below the ground; it slides along z.
struct Weight {
  Weight() {
    system.set_gravity({0, 0, -10});
    body = add_body(system, "weight", 2.0, {0, 0, -1});
    add_joint(system, "prismatic", "guide", kGround, body, {0, 0, -1}, Vec3::Zero());
    add_load(system, "spring_damper",
             {.name = "spring",
              .bodies = {kGround, body},
              .values = {{"stiffness", 400.0}, {"free_length", 1.0}}});
    system.finish();
    state = system.initial_state();
  }
  System system;
  State state;
  int body = 0;
};

/// A rod of 2 kg with its centre at 0.7 m, on a hinge with a torsional spring k, under gravity.
struct Rod {
  Rod(double k, const Vec3& gravity) {
    system.set_gravity(gravity);
    rod = add_body(system, "rod", 2.0, {kArm, 0, 0});
    add_joint(system, "revolute", "hinge", kGround, rod, Vec3::Zero(), {-kArm, 0, 0});
    add_load(system, "torsional_spring",
             {.name = "spring",
              .bodies = {kGround, rod},
              .values = {{"stiffness", k}},
              .angle = system.group<Joint>().items()[0].axis_angle()});
    system.finish();
    state = system.initial_state();
  }
  [[nodiscard]] double angle() const {
    const Vec3 r = system.motion(state, rod).r;
    return std::atan2(r.y(), r.x());
  }
  static constexpr double kArm = 0.7;
  System system;
  State state;
  int rod = 0;
};

TEST(StaticNewton, LoadsASpringInProportionToTheLoadFactor) {
  Weight weight;
  StaticNewton newton(weight.system, {});
  for (const double factor : {0.25, 0.5, 1.0, 2.0}) {
    const StaticStep step = newton.solve(weight.state, factor);
    ASSERT_TRUE(step.converged) << step.reason;
    EXPECT_EQ(step.load_factor, factor);
    EXPECT_NEAR(weight.system.motion(weight.state, weight.body).r.z(), -1.0 - factor * 20.0 / 400.0,
                1e-14);
    EXPECT_LE(step.iterations, 3);
    EXPECT_EQ(step.unstable, 0);
    EXPECT_LE(step.residual, 1e-9 * step.force);
    EXPECT_NEAR(step.force, 2.0 * factor * 20.0, 1e-9);  // the sizes of weight and spring force
  }
}

TEST(StaticNewton, ConvergesQuadratically) {
  const double k = 20.0;
  Rod rod(k, kDown);
  StaticNewton newton(rod.system, {});
  const StaticStep step = newton.solve(rod.state, 1.0);
  ASSERT_TRUE(step.converged) << step.reason;
  EXPECT_NEAR(k * rod.angle(), -2.0 * 9.81 * Rod::kArm * std::cos(rod.angle()), 1e-11);
  ASSERT_GE(step.increments.size(), 3u);
  for (std::size_t i = 1; i < step.increments.size(); ++i)
    EXPECT_LE(step.increments[i], 3.0 * step.increments[i - 1] * step.increments[i - 1] + 1e-13)
        << i;
}

TEST(StaticNewton, LeavesTheStateAfterAFailureAndNamesTheBody) {
  Rod rod(20.0, kDown);
  const State before = rod.state;
  StaticOptions options;
  options.max_iterations = 1;
  StaticNewton newton(rod.system, options);
  const StaticStep step = newton.solve(rod.state, 1.0);
  EXPECT_FALSE(step.converged);
  EXPECT_FALSE(step.reason.empty());
  EXPECT_THAT(step.worst, HasSubstr("body 'rod'"));
  EXPECT_EQ(std::memcmp(rod.state.blocks.data(), before.blocks.data(),
                        before.blocks.size() * sizeof(BodyBlock)),
            0);
  EXPECT_EQ(rod.state.lambda, before.lambda);
}

TEST(StaticNewton, EndsWhenItIsStopped) {
  Rod rod(20.0, kDown);
  const std::atomic<bool> stop = true;
  StaticOptions options;
  options.stop = &stop;
  StaticNewton newton(rod.system, options);
  EXPECT_FALSE(newton.solve(rod.state, 1.0).converged);
  newton.set_stop(nullptr);
  EXPECT_TRUE(newton.solve(rod.state, 1.0).converged);
}

// An upright rod falls where m g a is more than the stiffness of its spring.
TEST(StaticNewton, CountsTheUnstableDirections) {
  const double weight = 2.0 * 9.81 * Rod::kArm;  // moment per angle
  for (const double part : {0.5, 0.99, 1.01, 3.0}) {
    Rod rod(part * weight, {-9.81, 0, 0});  // gravity along the rod, towards the hinge
    StaticNewton newton(rod.system, {});
    const StaticStep step = newton.solve(rod.state, 1.0);
    ASSERT_TRUE(step.converged) << step.reason;
    EXPECT_EQ(step.unstable, part < 1.0 ? 1 : 0) << part;
    EXPECT_LT(std::abs(rod.angle()), 1e-12);
    const SoftestMotion softest = newton.softest();
    EXPECT_EQ(softest.stiffness < 0.0, part < 1.0) << part;
    EXPECT_THAT(softest.text, HasSubstr("rod"));
  }
}

// The predicted state is only a start: the equilibrium is that of the state's history.
TEST(StaticNewton, FindsTheSameEquilibriumFromAPrediction) {
  Rod plain(20.0, kDown), predicted(20.0, kDown);
  StaticNewton newton(plain.system, {}), other(predicted.system, {});
  ASSERT_TRUE(newton.solve(plain.state, 1.0).converged);
  State start = predicted.state;
  ASSERT_TRUE(other.solve(start, 0.9).converged);
  const StaticStep step = other.solve(predicted.state, 1.0, &start);
  ASSERT_TRUE(step.converged) << step.reason;
  EXPECT_NEAR(predicted.angle(), plain.angle(), 1e-12);
}

}  // namespace
}  // namespace polhode::static_newton_tests
