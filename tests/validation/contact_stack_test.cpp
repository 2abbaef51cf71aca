// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>

#include "support/run_text.hpp"

namespace polhode::contact_stack_tests {
namespace {

using namespace test;

void run_to(Simulation& run, double t) {
  while (run.time() < t - 1e-9) run.step(t);
}

/// Ten boxes, each a little smaller than the one below, for a minute.
TEST(ContactStack, OfTenBoxesStandsForAMinute) {
  std::string bodies;
  for (int k = 0; k < 10; ++k) {
    const double side = 0.2 * std::pow(0.98, k);
    bodies += format(
        "  box_{0}: {{shape: {{box: [{1:.17g}, {1:.17g}, 0.1]}}, mass: 1, "
        "position: [0, 0, {2:.17g}]}}\n",
        k, side, 0.1 * k + 0.05);
  }
  Simulation run = made(
      "format: 1\ngravity: [0, 0, -9.81]\nbodies:\n  floor: {fixed: true, shape: {plane: z}}\n" +
      bodies +
      "contacts: {default: {friction: 0.5}}\n"
      "analysis: {type: dynamics, duration: 60 s, step: 20 ms}\n");
  run_to(run, 1.0);
  std::vector<Vec3> start;
  for (int k = 1; k <= 10; ++k) start.push_back(run.body(k).r);
  run_to(run, 60.0);
  for (int k = 1; k <= 10; ++k) {
    EXPECT_LT((run.body(k).r - start[k - 1]).norm(), 1e-5) << k;
    EXPECT_LT(run.body(k).v.norm(), 1e-6) << k;
  }
  EXPECT_LT(run.summary().energy_drift, 1e-10);
}

/// Two plates that lean against each other, each at an angle φ to the vertical: they stand if the
/// friction of the floor carries the thrust, μ ≥ ½ tan φ − t/(2 h) (moments about the foot), and
/// slide apart otherwise.
TEST(ContactStack, CardHouseOfTwoPlatesStandsByItsFriction) {
  const double phi = 20.0 / 180.0 * std::numbers::pi, height = 1.0, thick = 0.02;
  for (const double factor : {1.1, 0.9}) {
    const double mu = (0.5 * std::tan(phi) - 0.5 * thick / height) * factor;
    std::string bodies;
    for (const double sign : {-1.0, 1.0}) {
      const Quat q(Eigen::AngleAxisd(sign * phi, Vec3::UnitY()));
      // The inner upper edges touch at x = 0, the inner lower ones stand on the floor.
      const Vec3 top = q * Vec3(sign * 0.5 * thick, 0.0, 0.5 * height);
      const Vec3 foot = q * Vec3(sign * 0.5 * thick, 0.0, -0.5 * height);
      bodies += format(
          "  {}: {{shape: {{box: [{:.17g}, 0.6, {:.17g}]}}, mass: 1, "
          "orientation: {{axis: y, angle: {:.17g}}}, position: [{:.17g}, 0, {:.17g}]}}\n",
          sign < 0.0 ? "right" : "left", thick, height, sign * phi, -top.x(), -foot.z());
    }
    Simulation run = made(
        "format: 1\ngravity: [0, 0, -9.81]\nbodies:\n  floor: {fixed: true, shape: {plane: z}}\n" +
        bodies +
        format("contacts: {{default: {{friction: {:.17g}}}}}\n"
               "analysis: {{type: dynamics, duration: 60 s, step: 5 ms}}\n",
               mu));
    run_to(run, factor > 1.0 ? 1.0 : 3.0);
    if (factor > 1.0) {
      const Vec3 settled = run.body("right").r;
      run_to(run, 60.0);
      EXPECT_GT(settled.z(), 0.4) << "fell";
      EXPECT_LT((run.body("right").r - settled).norm(), 1e-5) << "creeps";
    } else {
      EXPECT_LT(run.body("right").r.z(), 0.3) << "stands";
    }
  }
}

}  // namespace
}  // namespace polhode::contact_stack_tests
