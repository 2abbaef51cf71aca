// SPDX-License-Identifier: Apache-2.0
// Mass of a model as a whole, its loops, and whether its velocities may jump.
#include <polhode/model/whole_mass.hpp>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/model/velocity_jumps.hpp>

namespace polhode::whole_mass_tests {
namespace {

Model read(const std::string& text) { return io::read_model_text(text, "m.yaml", {}); }

// Two halves of a bar of 6 kg and length 2, one of them laid along y and turned back by its body:
// the whole has the inertia m L²/12 of the bar.
TEST(WholeMass, IsThatOfTheBodiesInOnePlace) {
  const geometry::MassProperties whole = whole_mass(read(R"(
format: 1
bodies:
  left: {shape: {box: [1, 0.1, 0.1]}, mass: 3, position: [-0.5, 0, 7]}
  right: {shape: {box: [0.1, 1, 0.1]}, mass: 3, position: [0.5, 0, 7], orientation: {euler: {sequence: zyx, angles: [90 deg, 0, 0]}}}
  mark: {fixed: true}
)"));
  EXPECT_DOUBLE_EQ(whole.mass, 6.0);
  EXPECT_LT((whole.com - Vec3(0, 0, 7)).norm(), 1e-15);
  EXPECT_NEAR(whole.inertia(1, 1), 6.0 * (4.0 + 0.01) / 12.0, 1e-14);
  EXPECT_NEAR(whole.inertia(0, 0), 6.0 * 0.02 / 12.0, 1e-14);
  EXPECT_NEAR(whole.inertia(0, 1), 0.0, 1e-14);
}

TEST(WholeMass, OfNothingIsZero) {
  EXPECT_EQ(whole_mass(Model{}).mass, 0.0);
  EXPECT_EQ(loop_count(Model{}), 0);
}

TEST(LoopCount, IsTheJointsBeyondATree) {
  const std::string bodies = R"(
format: 1
bodies:
  a: {mass: 1, inertia: [1, 1, 1]}
  b: {mass: 1, inertia: [1, 1, 1]}
  c: {mass: 1, inertia: [1, 1, 1]}
  base: {fixed: true}
joints:
  j1: {type: spherical, bodies: [ground, a], at: [0, 0, 0]}
  j2: {type: spherical, bodies: [a, b], at: [0, 0, 0]}
)";
  EXPECT_EQ(loop_count(read(bodies)), 0);
  const std::string third = "  j3: {type: spherical, bodies: [b, c], at: [0, 0, 0]}\n";
  EXPECT_EQ(loop_count(read(bodies + third)), 0);
  // A fixed body is the ground.
  const std::string closed = third + "  j4: {type: spherical, bodies: [c, base], at: [0, 0, 0]}\n";
  EXPECT_EQ(loop_count(read(bodies + closed)), 1);
  EXPECT_EQ(loop_count(
                read(bodies + closed + "  j5: {type: spherical, bodies: [a, c], at: [0, 0, 0]}\n")),
            2);
}

TEST(VelocityJumps, NeedContactStopsEventsOrDrives) {
  const std::string model = R"(
format: 1
bodies:
  a: {mass: 1, inertia: [1, 1, 1]}
joints: {guide: {type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x}}
analysis: {duration: 1, step: 0.1}
)";
  const auto with = [&](const std::string& more) {
    return velocities_may_jump(read(model + more));
  };
  EXPECT_FALSE(with(""));
  EXPECT_FALSE(with("loads: {f: {type: force, body: a, force: [1, 0, 0]}}"));
  EXPECT_FALSE(with("loads: {m: {type: linear_motor, joint: guide, force: 3}}"));
  EXPECT_TRUE(with("loads: {m: {type: linear_motor, joint: guide, speed: 3}}"));
  EXPECT_TRUE(with("events: {e: {at: 0.5, off: [guide]}}"));
  const auto changed = [&](const std::string& old, const std::string& text) {
    std::string all = model;
    all.replace(all.find(old), old.size(), text);
    return velocities_may_jump(read(all));
  };
  EXPECT_TRUE(changed("joints:", "  ball: {shape: {sphere: 1}, mass: 1}\ncontacts: {}\njoints:"));
  EXPECT_TRUE(changed("axis: x", "axis: x, limits: {lower: -1, upper: 1}"));
  EXPECT_TRUE(changed("axis: x", "axis: x, breaks: {force: 10}"));
  EXPECT_FALSE(changed("axis: x", "axis: x, friction: {mu: 0.1}"));
  EXPECT_FALSE(changed("{duration: 1, step: 0.1}", "{type: statics}"));
}

}  // namespace
}  // namespace polhode::whole_mass_tests
