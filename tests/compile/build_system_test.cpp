// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/compile/build_system.hpp>
#include <polhode/core/error.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::build_system_tests {
namespace {

BodySpec body(const std::string& name, const Vec3& position = Vec3::Zero()) {
  BodySpec b;
  b.name = name;
  b.mass = 2.0;
  b.inertia = Vec3(1.0, 1.1, 1.2).asDiagonal();
  b.position = position;
  return b;
}

JointSpec joint(const std::string& name, const std::string& type, int a, int b) {
  JointSpec j;
  j.name = name;
  j.type = type;
  j.a = a;
  j.b = b;
  return j;
}

LoadSpec load(const std::string& name, const std::string& type, int a, int b) {
  LoadSpec l;
  l.name = name;
  l.type = type;
  l.a = a;
  l.b = b;
  return l;
}

std::string message(const Model& model) {
  try {
    (void)build_system(model);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

/// Constraint values of an interaction at the start, multipliers one.
Vec6 start_residual(const System& system, int interaction) {
  const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(interaction)];
  const BodyStep a = system.instant(system.initial_state(), ref.a);
  const BodyStep b = system.instant(system.initial_state(), ref.b);
  const double lambda[kMaxRows] = {1, 1, 1, 1, 1, 1}, history[2] = {0, 0};
  return joint_at(system, interaction).residual({a, b, StepContext{}, lambda, history});
}

}  // namespace

TEST(BuildSystem, NumbersMovingBodiesAndMapsFixedOnesToTheGround) {
  Model model;
  model.gravity = Vec3(0.0, 0.0, -9.81);
  model.bodies = {body("wall"), body("crank"), body("rod")};
  model.bodies[0].fixed = true;
  model.joints = {joint("A", "revolute", 0, 1), joint("B", "spherical", 1, 2),
                  joint("C", "distance", kGround, 2)};
  model.joints[2].Z_b = Vec3(0.0, 3.0, 4.0);
  model.loads = {load("push", "force", kGround, 2), load("spring", "spring_damper", 0, 2),
                 load("pull", "force", kGround, 1)};
  SystemMap map;
  const System system = build_system(model, &map);
  EXPECT_EQ(system.gravity(), model.gravity);
  EXPECT_EQ(system.body_count(), 2);
  EXPECT_EQ(map.body, (std::vector<int>{kGround, 0, 1}));
  ASSERT_EQ(map.joint.size(), 3U);
  ASSERT_EQ(map.load.size(), 3U);
  const auto name = [&](int i) { return system.name(system.interactions()[i]); };
  EXPECT_EQ(name(map.joint[0]), "A");
  EXPECT_EQ(name(map.joint[2]), "C");
  EXPECT_EQ(name(map.load[0]), "push");
  EXPECT_EQ(name(map.load[1]), "spring");
  EXPECT_EQ(name(map.load[2]), "pull");
  EXPECT_EQ(system.rows(), 5 + 3 + 1);
  // The default distance is that of the start.
  EXPECT_EQ(start_residual(system, map.joint[2])[0], 0.0);
  EXPECT_EQ(joint_at(system, map.joint[2]).parts().distance->length, 5.0);
  EXPECT_THROW((void)joint_at(system, map.load[0]), std::logic_error);
}

TEST(BuildSystem, StartsBodiesAsDescribed) {
  Model model;
  model.bodies = {body("top", Vec3(1.0, 2.0, 3.0))};
  Random random(1);
  model.bodies[0].orientation = random.orientation();
  model.bodies[0].velocity = Vec3(4.0, 5.0, 6.0);
  model.bodies[0].angular_velocity = Vec3(0.1, 0.2, 0.3);
  const System system = build_system(model);
  const BodyMotion m = system.motion(system.initial_state(), 0);
  EXPECT_EQ(m.r, Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(m.v, Vec3(4.0, 5.0, 6.0));
  EXPECT_LT((m.omega() - Vec3(0.1, 0.2, 0.3)).norm(), 1e-15);
  EXPECT_EQ(system.bodies()[0].inertia, model.bodies[0].inertia);
}

// The same joint, once to a body that is fixed, once to the ground.
TEST(BuildSystem, TreatsAFixedBodyAsGround) {
  Random random(2);
  Model model;
  model.bodies = {body("wall", random.vector()), body("door", random.vector())};
  model.bodies[0].fixed = true;
  model.bodies[0].orientation = random.orientation();
  JointSpec on_wall = joint("hinge", "cylindrical", 0, 1);
  on_wall.Z_a = random.vector();
  on_wall.R_a = random.frame();
  JointSpec on_ground = on_wall;
  on_ground.a = kGround;
  on_ground.Z_a = model.bodies[0].position + model.bodies[0].orientation * on_wall.Z_a;
  on_ground.R_a = model.bodies[0].orientation.toRotationMatrix() * on_wall.R_a;
  model.joints = {on_wall, on_ground};
  SystemMap map;
  const System system = build_system(model, &map);
  EXPECT_LT((start_residual(system, map.joint[0]) - start_residual(system, map.joint[1])).norm(),
            1e-14);
}

TEST(BuildSystem, GivesAPointMassAPlaceholderInertiaWithoutRotation) {
  Model model;
  BodySpec bob = body("bob", Vec3(0.0, -2.0, 0.0));
  bob.point_mass = true;
  bob.inertia.setZero();
  bob.angular_velocity = Vec3(1.0, 0.0, 0.0);
  model.bodies = {bob};
  model.joints = {joint("string", "distance", kGround, 0)};
  const System system = build_system(model);
  EXPECT_GT(system.bodies()[0].inertia.determinant(), 0.0);
  EXPECT_EQ(system.motion(system.initial_state(), 0).W, Vec3::Zero());
}

TEST(BuildSystem, RefusesToTurnAPointMass) {
  const auto refused = [](const JointSpec& j, const std::vector<LoadSpec>& loads = {}) {
    Model model;
    model.bodies = {body("bob", Vec3(0.0, -2.0, 0.0)), body("rod")};
    model.bodies[0].point_mass = true;
    model.joints = {j};
    model.loads = loads;
    return message(model);
  };
  const std::string why =
      " exerts a moment on 'bob', which is a point mass. Attach it at the point mass itself, or "
      "give the body an inertia.";
  EXPECT_EQ(refused(joint("pin", "revolute", 1, 0)), "joints.pin:" + why);
  EXPECT_EQ(refused(joint("table", "point_in_plane", 0, 1)), "joints.table:" + why);
  EXPECT_EQ(refused(joint("table", "point_in_plane", 1, 0)), "");
  EXPECT_EQ(refused(joint("ball", "spherical", 1, 0)), "");
  JointSpec aside = joint("ball", "spherical", 1, 0);
  aside.Z_b = Vec3(0.1, 0.0, 0.0);
  EXPECT_EQ(refused(aside), "joints.ball:" + why);
  const JointSpec fine = joint("ball", "spherical", 1, 0);
  EXPECT_EQ(refused(fine, {load("twist", "moment", kGround, 0)}), "loads.twist:" + why);
  EXPECT_EQ(refused(fine, {load("push", "force", kGround, 0)}), "");
  LoadSpec off = load("push", "force", kGround, 0);
  off.Z_b = Vec3(0.0, 0.1, 0.0);
  EXPECT_EQ(refused(fine, {off}), "loads.push:" + why);
}

TEST(BuildSystem, RefusesJointsAndLoadsThatConnectNoMovingBody) {
  Model model;
  model.bodies = {body("wall"), body("floor")};
  model.bodies[0].fixed = model.bodies[1].fixed = true;
  model.joints = {joint("weld", "fixed", 0, 1)};
  EXPECT_EQ(message(model),
            "joints.weld: connects no moving body. Name at least one body that is not fixed, or "
            "leave it out.");
  model.joints.clear();
  model.loads = {load("push", "force", kGround, 1)};
  EXPECT_EQ(message(model),
            "loads.push: connects no moving body. Name at least one body that is not fixed, or "
            "leave it out.");
}

TEST(BuildSystem, FindsTheAngleOfATorsionalSpringsJoint) {
  Model model;
  model.bodies = {body("door"), body("arm", Vec3(3.0, 0.0, 0.0))};
  model.joints = {joint("ball", "spherical", 0, 1), joint("hinge", "revolute", kGround, 0)};
  LoadSpec spring = load("closer", "torsional_spring", kGround, kGround);
  spring.parameters = {{"stiffness", 2.0}};
  spring.joint = "hinge";
  model.loads = {spring};
  SystemMap map;
  const System system = build_system(model, &map);
  const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(map.load[0])];
  EXPECT_EQ(ref.a, kGround);
  EXPECT_EQ(ref.b, 0);
  model.loads[0].joint = "ball";
  EXPECT_EQ(message(model),
            "loads.closer.joint: 'ball' is spherical, which has no angle about one axis. Use a "
            "joint with one free rotation, such as revolute or cylindrical.");
}

TEST(BuildSystem, NamesTheJointWithInvalidFreedoms) {
  Model model;
  model.bodies = {body("door")};
  model.joints = {joint("odd", "generic", kGround, 0)};
  model.joints[0].free = {"spin"};
  EXPECT_EQ(message(model),
            "joints.odd.free: 'spin' is no freedom of a joint. Use some of: x, y, z, rx, ry, rz.");
  model.joints = {joint("rod", "distance", kGround, 0)};
  EXPECT_EQ(message(model),
            "joints.rod: the two points coincide, so their distance is zero. Give two distinct "
            "points, or use a spherical joint.");
}

}  // namespace polhode::test::build_system_tests
