// SPDX-License-Identifier: Apache-2.0
// Moments that a program sets between steps.
#include <cmath>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/held_values.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode {
namespace held_values_test {

/// Error left by Newton's method.
constexpr double kNewton = 1e-6;

/// A disc on an axle, driven by a held moment.
Model disc(const std::string& analysis) {
  Model model = io::read_model_text(
      "format: 1\nbodies: {disc: {mass: 1, inertia: [0.1, 0.1, 0.2]}}\n"
      "joints: {axle: {type: revolute, bodies: [ground, disc], at: [0, 0, 0], axis: z}}\n"
      "analysis: {duration: 1, " +
          analysis + "}\n",
      "disc.yaml", {});
  LoadSpec load;
  load.name = "held";
  load.type = "rotary_motor";
  load.joint = "axle";
  load.drive = "moment";
  const auto numbers = std::make_shared<HeldNumbers>();
  numbers->now = numbers->used = {0.0};
  load.value = std::make_shared<HeldValue>(numbers, 0);
  model.loads.push_back(load);
  return model;
}

TEST(HeldValues, ActFromTheNextStepOn) {
  for (const char* analysis : {"step: 10 ms", "step: 10 ms, rho_inf: 0.6", "tolerance: 1e-7"}) {
    SCOPED_TRACE(analysis);
    Simulation simulation(disc(analysis));
    const auto held = held_numbers(simulation.model());
    ASSERT_TRUE(held);
    double turned = 0.0, speed = 0.0;
    for (int k = 0; k < 20; ++k) {
      const double moment = k % 2 == 0 ? 3.0 : -2.0, end = 0.01 * (k + 1);
      held->now[0] = moment;
      EXPECT_NEAR(simulation.angular_acceleration(0).z(), moment / 0.2, 1e-9);
      while (simulation.time() < end - 1e-12) ASSERT_TRUE(simulation.step(end).accepted);
      turned += 0.01 * speed + 0.5 * 1e-4 * moment / 0.2;
      speed += 0.01 * moment / 0.2;
      // A constant moment about one axis is integrated exactly by each step.
      EXPECT_NEAR(simulation.joint(0).rates[0], speed, kNewton);
      EXPECT_NEAR(simulation.joint(0).coordinates[0], turned, kNewton);
    }
  }
}

TEST(HeldValues, BelongToOneSimulation) {
  const Model model = disc("step: 10 ms");
  Simulation one(model), other(model);
  held_numbers(one.model())->now[0] = 1.0;
  EXPECT_EQ(held_numbers(other.model())->now[0], 0.0);
  EXPECT_EQ(held_numbers(model)->now[0], 0.0);
  ASSERT_TRUE(one.step(1.0).accepted);
  Simulation copy(one.model(), one.state());
  EXPECT_EQ(held_numbers(copy.model())->now[0], 1.0);
  ASSERT_TRUE(one.step(1.0).accepted);
  ASSERT_TRUE(copy.step(1.0).accepted);
  EXPECT_EQ(one.state_hash(), copy.state_hash());
  EXPECT_GT(one.joint(0).rates[0], 0.0);
}

}  // namespace held_values_test
}  // namespace polhode
