// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include <polhode/statics/statics.hpp>
#include <statics/static_models.hpp>
#include <support/bar_elements.hpp>

namespace polhode::statics_tests {
namespace {

using test::add_body, test::add_joint, test::add_load, test::constant;

TEST(Statics, AWeightStretchesASpringByItsForceOverItsStiffness) {
  System system;
  system.set_gravity({0, 0, -10});
  const int body = add_body(system, "weight", 2.0, {0, 0, -1});
  add_joint(system, "prismatic", "guide", kGround, body, {0, 0, -1}, Vec3::Zero());
  add_load(system, "spring_damper",
           {.name = "spring",
            .bodies = {kGround, body},
            .values = {{"stiffness", 400.0}, {"free_length", 1.0}}});
  system.finish();
  State state = system.initial_state();
  const StaticReport report = solve_statics(system, state);
  ASSERT_TRUE(report.converged) << report.message;
  EXPECT_EQ(report.steps.size(), 1u);
  EXPECT_NEAR(system.motion(state, body).r.z(), -1.05, 1e-14);
  EXPECT_EQ(report.unstable, 0);
}

/// A rod hinged at its end, held by a torsional spring about the hinge: k φ = m g a cos φ.
/// @tests{statics-residual}
TEST(Statics, ARodOnATorsionalSpringFindsTheAngleOfItsTranscendentalEquation) {
  const double k = 3.0, m = 2.0, g = 9.81, a = 0.7;
  System system;
  system.set_gravity({0, -g, 0});
  const int rod = add_body(system, "rod", m, {a, 0, 0});
  add_joint(system, "revolute", "hinge", kGround, rod, Vec3::Zero(), {-a, 0, 0});
  const auto angle = system.group<Joint>().items()[0].axis_angle();
  ASSERT_TRUE(angle);
  add_load(
      system, "torsional_spring",
      {.name = "spring", .bodies = {kGround, rod}, .values = {{"stiffness", k}}, .angle = angle});
  system.finish();
  State state = system.initial_state();
  const StaticReport report = solve_statics(system, state);
  ASSERT_TRUE(report.converged) << report.message;
  const Vec3 r = system.motion(state, rod).r;
  double phi = std::atan2(r.y(), r.x());
  EXPECT_NEAR(k * phi, -m * g * a * std::cos(phi), 1e-10);
  EXPECT_NEAR(r.norm(), a, 2e-13);
  EXPECT_NEAR(state.lambda[0] * state.lambda[0] + state.lambda[1] * state.lambda[1], m * m * g * g,
              1e-8);  // the hinge carries the weight
}

TEST(Statics, APendulumWithoutInitialStiffnessFindsItsEquilibrium) {
  System system;
  system.set_gravity({0, -9.81, 0});
  const int bob = add_body(system, "bob", 1.0, {0, -1, 0});
  add_joint(system, "revolute", "hinge", kGround, bob, Vec3::Zero(), {0, 1, 0});
  system.finish();
  State state = system.initial_state();
  const StaticReport report = solve_statics(system, state);
  ASSERT_TRUE(report.converged) << report.message;
  EXPECT_NEAR(system.motion(state, bob).r.y(), -1.0, 2e-13);
  EXPECT_EQ(report.unstable, 0);
}

TEST(Statics, AnInvertedPendulumIsFoundUnstable) {
  System system;
  system.set_gravity({0, -9.81, 0});
  const int bob = add_body(system, "bob", 1.0, {0, 1, 0});
  add_joint(system, "revolute", "hinge", kGround, bob, Vec3::Zero(), {0, -1, 0});
  system.finish();
  State state = system.initial_state();
  const StaticReport report = solve_statics(system, state);
  ASSERT_TRUE(report.converged) << report.message;
  EXPECT_EQ(report.unstable, 1);
}

TEST(Statics, AnUnsupportedBodyIsNamed) {
  System system;
  system.set_gravity({0, 0, -9.81});
  add_body(system, "stone", 1.0, Vec3::Zero());
  system.finish();
  State state = system.initial_state();
  const StaticReport report = solve_statics(system, state);
  EXPECT_FALSE(report.converged);
  EXPECT_NE(report.message.find("stone"), std::string::npos) << report.message;
}

/// A lattice of bars between ground and a rigid plate pulled along x: equilibrium of forces.
TEST(Statics, ALatticeBetweenGroundAndABodyCarriesTheLoad) {
  for (const bool turned : {false, true}) {
    System system;
    system.set_gravity({0, 0, -1});
    auto [X, bars] = test::lattice(4, 1, 1, 0.5, Vec3::Zero());
    bars->stiffness = 1e3;
    const int plate = add_body(system, "plate", 3.0, {2.25, 0.25, 0.25});
    for (const Vec3& x : X) {
      NodeData node{.position = x};
      if (x.x() < 1e-9) node.body = kGround;
      if (x.x() > 2.0 - 1e-9) {
        node.body = plate;
        node.Z = x - Vec3(2.25, 0.25, 0.25);
      }
      system.add_node(node);
    }
    bars->density = 0.01;
    system.add_elements(std::move(bars));
    add_load(system, "force",
             {.name = "pull",
              .bodies = {kGround, plate},
              .Z_b = Vec3(0.1, 0.2, 0.0),
              .vector = constant({20, 5, 3})});
    if (turned)
      add_load(system, "moment",
               {.name = "twist", .bodies = {kGround, plate}, .vector = constant({2, 1, 3})});
    system.finish();
    State state = system.initial_state();
    LoadStepper stepper(system);
    stepper.begin(state);
    ASSERT_TRUE(stepper.advance(state)) << stepper.report().message;
    EXPECT_EQ(stepper.report().unstable, turned ? -1 : 0);
    EXPECT_LE(stepper.report().steps[0].iterations, 8);
    double weight = 3.0;
    Vec3 reaction = Vec3::Zero();
    const std::vector<double>& F = stepper.newton().node_residual();
    for (int i = 0; i < system.nodes().count(); ++i) {
      weight += system.nodes().node_mass(i);
      if (system.nodes()[i].body == kGround) reaction += Eigen::Map<const Vec3>(F.data() + 3 * i);
    }
    EXPECT_LT((reaction + Vec3(20, 5, 3 - weight)).norm(), 1e-7);
  }
}

/// @tests{statics-hessian}
TEST(Statics, TheTangentOfASystemWithPotentialIsItsHessian) {
  System system;
  system.set_gravity({0, -3, -1});
  const int a = add_body(system, "a", 1.0, {0.3, 0.1, 0.2}),
            b = add_body(system, "b", 1.0, {1, 0.2, 0});
  add_joint(system, "universal", "u", a, b, {0.4, 0.1, -0.1}, {-0.3, 0, 0.1});
  add_load(system, "spring_damper",
           {.name = "s",
            .bodies = {a, b},
            .Z_a = {0, 0.3, 0.1},
            .Z_b = {0.1, -0.2, 0.3},
            .values = {{"stiffness", 40.0}, {"free_length", 0.5}}});
  add_load(
      system, "force",
      {.name = "f", .bodies = {kGround, b}, .Z_b = {0.3, 0.2, 0.1}, .vector = constant({1, 2, 3})});
  system.finish();
  State state = system.initial_state();
  for (std::size_t k = 0; k < state.lambda.size(); ++k) state.lambda[k] = 1.0 + 0.5 * double(k);
  StaticNewton newton(system, {});
  newton.assemble_at(state, 1.0);
  EXPECT_LT(newton.matrix().asymmetry(), 1e-14);
}

}  // namespace
}  // namespace polhode::statics_tests
