// SPDX-License-Identifier: Apache-2.0
// Rods and pipes that slide and roll on rails across them. A side that bulged by a hundredth of its
// length, as it once did, took 5 % of the speed of sliding in a second.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>

namespace polhode::round_sides_tests {
namespace {

struct Rails {
  const char* name;
  std::string shape;  ///< Of each of the two, along x.
};

const std::string kAlongX = ", orientation: {axis: y, angle: 90 deg}";
const Rails kRails[] = {{"edges of boxes", "box: [4, 0.02, 0.02]"},
                        {"cylinders", "cylinder: [0.02, 4]" + kAlongX},
                        {"capsules", "capsule: [0.02, 4]" + kAlongX},
                        {"tubes", "tube: [0.02, 0.016, 4]" + kAlongX}};
const std::string kBars[] = {"cylinder: [0.1, 2]", "tube: [0.1, 0.08, 2]"};

/// A bar of 1 kg across two rails, 0.6 m apart.
/// @param motion  Its position and velocities.
Simulation bar_on(const Rails& rails, const std::string& bar, const std::string& motion,
                  const std::string& contact, double step) {
  return Simulation(io::read_model_text(
      format("format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
             "  rails: {{fixed: true, shape: [{{{0}, position: [0, 0.3, -0.01]}}, "
             "{{{0}, position: [0, -0.3, -0.01]}}]}}\n"
             "  bar: {{shape: {{{1}}}, mass: 1, inertia: [0.33, 0.33, 0.00125], "
             "orientation: {{axis: x, angle: 90 deg}}, {2}}}\n"
             "contacts: {{default: {{{3}}}}}\n"
             "analysis: {{type: dynamics, duration: 1 s, step: {4} s}}\n",
             rails.shape, bar, motion, contact, step),
      "m.yaml"));
}

template <class Check>
void for_each(const Check& check) {
  for (const Rails& rails : kRails)
    for (const std::string& bar : kBars)
      for (const std::string law : {"barrier", "nonsmooth"})
        for (const double step : {1e-2, 5e-3, 1e-3}) {
          SCOPED_TRACE(format("{} on {} by {} at {} s", bar, rails.name, law, step));
          check(rails, bar, law, step);
        }
}

/// Sides are blurred by a millionth of their length: the height varies by less than 2e-6 m.
TEST(RoundSides, SlideAlongEachOtherFreely) {
  for_each([](const Rails& rails, const std::string& bar, const std::string& law, double step) {
    Simulation s = bar_on(rails, bar, "position: [0.5, 0, 0.05], velocity: [0, 0.2, 0]",
                          format("law: {}, friction: 0", law), step);
    const RunSummary end = s.run();
    ASSERT_EQ(end.end, RunEnd::finished) << end.message;
    EXPECT_NEAR(s.body("bar").v.y(), 0.2, 4e-6);
    EXPECT_NEAR(s.body("bar").r.y(), 0.2, 2e-6);
    EXPECT_NEAR(s.body("bar").r.z(), 0.05, 5e-6);
  });
}

TEST(RoundSides, RollAcrossEachOtherFreely) {
  for_each([](const Rails& rails, const std::string& bar, const std::string& law, double step) {
    Simulation s = bar_on(
        rails, bar, "position: [-1, 0, 0.05], velocity: [1, 0, 0], angular_velocity: [0, 20, 0]",
        format("law: {}, friction: 0.3", law), step);
    const RunSummary end = s.run();
    ASSERT_EQ(end.end, RunEnd::finished) << end.message;
    EXPECT_NEAR(s.body("bar").v.x(), 1.0, 1e-5);
    EXPECT_NEAR(s.body("bar").v.y(), 0.0, 1e-9);
    EXPECT_NEAR(s.body("bar").r.z(), 0.05, 5e-6);
    EXPECT_LT(std::abs(end.contacts->numerical), 1e-8);
  });
}

/// A bar in the groove between two fixed ones of its kind, with flush ends.
TEST(RoundSides, RestInAGrooveWithFlushEnds) {
  struct Bar {
    std::string shape;
    double radius;
  };
  const Bar bars[] = {{"cylinder: [0.2, 0.5]", 0.1},
                      {"tube: [0.2, 0.16, 0.5]", 0.1},
                      {"cylinder: [0.02, 2]", 0.01}};
  for (const Bar& bar : bars)
    for (const std::string law : {"barrier", "nonsmooth"})
      for (const double step : {1e-2, 1e-3}) {
        SCOPED_TRACE(format("{} by {} at {} s", bar.shape, law, step));
        const double R = bar.radius, height = std::sqrt(3.0) * R;
        const std::string lies = "orientation: {axis: x, angle: 90 deg}";
        Simulation s(io::read_model_text(
            format("format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
                   "  left: {{fixed: true, shape: {{{0}}}, position: [-{1}, 0, 0], {2}}}\n"
                   "  right: {{fixed: true, shape: {{{0}}}, position: [{1}, 0, 0], {2}}}\n"
                   "  bar: {{shape: {{{0}}}, mass: 1, inertia: [0.1, 0.1, 0.01], "
                   "position: [0, 0, {3:.17g}], {2}}}\n"
                   "contacts: {{default: {{law: {4}, friction: 0.5}}}}\n"
                   "analysis: {{type: dynamics, duration: 0.5 s, step: {5} s}}\n",
                   bar.shape, R, lies, height, law, step),
            "m.yaml"));
        const BodyMotion start = s.body("bar");
        const RunSummary end = s.run();
        ASSERT_EQ(end.end, RunEnd::finished) << end.message;
        const BodyMotion bar_at = s.body("bar");
        EXPECT_NEAR(bar_at.r.z(), height, 2e-4 * R);
        EXPECT_NEAR(bar_at.r.x(), 0.0, 2e-4 * R);
        EXPECT_LT(start.q.angularDistance(bar_at.q), 1e-4);
        EXPECT_LT(bar_at.v.norm(), 1e-4);
      }
}

}  // namespace
}  // namespace polhode::round_sides_tests
