// SPDX-License-Identifier: Apache-2.0
// Differences of states, by which errors of steps are measured.
#include <gtest/gtest.h>

#include <polhode/compile/build_system.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/math/exp_map.hpp>
#include <polhode/stepping/step_error.hpp>

namespace polhode {
namespace {

System two_bodies() {
  return build_system(io::read_model_text(R"(
format: 1
bodies:
  a: {mass: 1, inertia: [1, 1, 1], position: [3, 0, 0]}
  b: {mass: 2, inertia: [1, 2, 2], position: [0, -5, 0]}
analysis: {duration: 1, step: 0.1}
)",
                                          "m.yaml", {}));
}

/// The state with the motion of body b changed.
template <class Change>
State changed(const System& system, int body, const Change& change) {
  State state = system.initial_state();
  BodyMotion m = system.motion(state, body);
  change(m);
  state.set_motion(system.slot(body), m);
  return state;
}

TEST(StateDifference, IsTheLargestOfDistancesAndRotations) {
  const System system = two_bodies();
  const State& start = system.initial_state();
  const double length = system.length_scale();
  EXPECT_EQ(state_difference(system, start, start, 0.1), 0.0);
  const State moved = changed(system, 0, [](BodyMotion& m) { m.r += Vec3(0.3, 0.4, 0.0); });
  EXPECT_NEAR(state_difference(system, start, moved, 0.0), 0.5 / length, 1e-15);
  EXPECT_NEAR(state_difference(system, moved, start, 0.0), 0.5 / length, 1e-15);
  const State turned = changed(system, 1, [](BodyMotion& m) {
    m.q = Quat(Eigen::AngleAxisd(1e-3, Vec3(1.0, 2.0, 2.0) / 3.0)) * m.q;
  });
  EXPECT_NEAR(state_difference(system, start, turned, 0.0), 1e-3, 1e-10);
  // The quaternion of the same orientation with the other sign is no difference.
  const State other = changed(system, 1, [](BodyMotion& m) { m.q.coeffs() *= -1.0; });
  EXPECT_EQ(state_difference(system, start, other, 0.0), 0.0);
}

TEST(StateDifference, CountsVelocitiesByWhatTheyMoveInTheSpan) {
  const System system = two_bodies();
  const State& start = system.initial_state();
  const State faster = changed(system, 0, [](BodyMotion& m) { m.v += Vec3(0.0, 0.0, 2.0); });
  const State spinning = changed(system, 1, [](BodyMotion& m) { m.W += Vec3(0.0, 3.0, 0.0); });
  for (const double H : {0.1, 1e-2, 1e-4}) {
    EXPECT_NEAR(state_difference(system, start, faster, H), 2.0 * H / system.length_scale(), 1e-15);
    EXPECT_NEAR(state_difference(system, start, spinning, H), 3.0 * H, 1e-15);
    EXPECT_NEAR(jump_difference(system, start, faster, H), 2.0 * H / system.length_scale(), 1e-15);
    EXPECT_NEAR(jump_difference(system, start, spinning, H), 3.0 * H, 1e-15);
  }
  EXPECT_EQ(state_difference(system, start, faster, 0.0), 0.0);
  const State moved = changed(system, 0, [](BodyMotion& m) { m.r += Vec3(1.0, 0.0, 0.0); });
  EXPECT_EQ(jump_difference(system, start, moved, 0.1), 0.0);
}

TEST(StateDifference, ExtentIsTheLargestDistanceFromTheOrigin) {
  EXPECT_EQ(extent(two_bodies()), 5.0);
}

}  // namespace
}  // namespace polhode
