// SPDX-License-Identifier: Apache-2.0
// Static friction above that of sliding: the bound of all points of two bodies together.
#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::static_friction_tests {
namespace {

/// Speed of a body that is pulled with half its weight per second, at a time after the start [m/s].
double speed_after(double t, const char* bodies, const char* law, const char* step) {
  Simulation run(io::read_model_text(format(R"(
format: 1
gravity: [0, 0, -10]
bodies:
  floor: {{fixed: true, shape: {{plane: z}}}}
  {}
loads: {{pull: {{type: force, body: a, force: ["5*t", 0, 0]}}}}
contacts: {{default: {{law: {}, friction: 0.5, static_friction: 0.6}}}}
analysis: {{type: dynamics, duration: {:.17g} s, step: {}}}
)",
                                            bodies, law, t, step),
                                     "m.yaml"));
  EXPECT_EQ(run.run().end, RunEnd::finished);
  return run.body(1).v.x();
}

/// Slip begins at 0.6 of the weight to 1 % and continues with 0.5: 12 ms at 1 m/s².
/// @tests{contact-patch}
TEST(StaticFriction, IsThatOfTheWholeContactPatch) {
  const char* kBox = "a: {shape: {box: [0.2, 0.2, 0.1]}, mass: 1, position: [0, 0, 0.05]}";
  const char* kCylinder = "a: {shape: {cylinder: [0.1, 0.1]}, mass: 1, position: [0, 0, 0.05]}";
  const char* kStack =
      "a: {shape: {box: [0.2, 0.2, 0.1]}, mass: 1, position: [0, 0, 0.15]}\n"
      "  b: {shape: {box: [0.3, 0.3, 0.1]}, mass: 1, position: [0, 0, 0.05]}";
  for (const char* bodies : {kBox, kCylinder, kStack})
    for (const auto& [law, step] : {std::pair("barrier", "6 ms"), std::pair("hertz", "2 ms"),
                                    std::pair("hertz", "0.5 ms"), std::pair("linear", "1 ms")}) {
      EXPECT_LT(std::abs(speed_after(1.188, bodies, law, step)), 3e-3) << law << ' ' << step << '\n'
                                                                       << bodies;
      EXPECT_GT(speed_after(1.212, bodies, law, step), 3e-3) << law << ' ' << step << '\n'
                                                             << bodies;
    }
}

/// A block laid on 30 degrees, tan = 0.577, at rest and with gap 0: static friction of 0.6 holds it
/// although sliding friction of 0.5 would not, while it settles in its band and after.
/// @tests{contact-patch}
TEST(StaticFriction, HoldsABlockOnAnIncline) {
  for (const char* shape : {"box: [0.4, 0.4, 0.2]", "cylinder: [0.4, 0.2]"})
    for (const char* step : {"10 ms", "5 ms", "1 ms", "0.1 ms"}) {
      Simulation run(io::read_model_text(format(R"(
format: 1
gravity: [0, 0, -9.81]
variables: {{tilt: 30 deg, a: sin(tilt), b: cos(tilt)}}
bodies:
  incline: {{fixed: true, shape: {{plane: [a, 0, b]}}}}
  block: {{shape: {{{}}}, mass: 2, position: [0.1*a, 0, 0.1*b], orientation: {{axis: y, angle: tilt}}}}
contacts: {{default: {{friction: 0.5, static_friction: 0.6}}}}
analysis: {{type: dynamics, duration: 0.3 s, step: {}}}
)",
                                                shape, step),
                                         "m.yaml"));
      const Vec3 start = run.body("block").r;
      EXPECT_EQ(run.run().end, RunEnd::finished);
      EXPECT_LT((run.body("block").r - start).norm(), 1e-5) << shape << ' ' << step;
    }
}

}  // namespace
}  // namespace polhode::static_friction_tests
