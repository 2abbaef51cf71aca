// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include <joints/joint_cases.hpp>

#include <gtest/gtest.h>
#include <polhode/math/exp_map.hpp>

namespace polhode::test::joint_tests {
namespace {

constexpr double kPi = std::numbers::pi;

BodyStep at(const Mat3& Lambda, const Vec3& r = Vec3::Zero(), const Vec3& W = Vec3::Zero()) {
  return BodyStep::at_instant(r, Lambda, Vec3::Zero(), W);
}

/// From one orientation to another, at rest in place.
BodyStep turning(const Mat3& from, const Mat3& to) {
  BodyStep s = at(to);
  s.Lambda_n = from;
  return s;
}

Mat3 about(int axis, double angle) { return exp_map(angle * Vec3::Unit(axis)); }

Joint joint_of_type(const std::string& type) {
  return Joint("j", type, {0, 1}, joint_kind(type).recipe({}, {}));
}

}  // namespace

TEST(Joint, CountsTheTurnsOfARevoluteAngle) {
  const Joint joint = joint_of_type("revolute");
  const StepContext context;
  const BodyStep a = at(Mat3::Identity());
  double history[1];
  joint.initialize({a, at(about(2, 0.4)), context, nullptr, nullptr}, history);
  EXPECT_NEAR(history[0], 0.4, 1e-15);
  double angle = 0.4;
  for (const double turn : {1.0, 1.5, 1.5, 1.5, 1.5, 1.5, -0.7}) {
    angle += turn;
    joint.commit({a, at(about(2, angle)), context, nullptr, history}, history);
    EXPECT_NEAR(history[0], angle, 1e-14);
  }
  EXPECT_GT(history[0], 2.0 * kPi);
  const BodyStep b = at(about(2, angle), Vec3::Zero(), Vec3(0.0, 0.0, -3.0));
  const JointCoordinates c = joint.coordinates({a, b, context, nullptr, history});
  EXPECT_EQ(c.count, 1);
  EXPECT_NEAR(c.value[0], angle, 1e-14);
  EXPECT_NEAR(c.rate[0], -3.0, 1e-14);
}

// b = a turned about x of a by 0.5, then about the new y by 4: a cardan joint's two angles.
TEST(Joint, MeasuresBothAnglesOfAUniversalJoint) {
  const Joint joint = joint_of_type("universal");
  const StepContext context;
  const BodyStep a = at(about(1, 0.3));
  double history[2];
  joint.initialize({a, a, context, nullptr, nullptr}, history);
  for (int i = 1; i <= 4; ++i)
    joint.commit(
        {a, at(about(1, 0.3) * about(0, 0.125 * i) * about(1, 1.0 * i)), context, nullptr, history},
        history);
  EXPECT_NEAR(history[0], 0.5, 1e-14);
  EXPECT_NEAR(history[1], 4.0, 1e-14);
}

TEST(Joint, MeasuresTheRotationVectorOfASphericalJoint) {
  const Joint joint = joint_of_type("spherical");
  const StepContext context;
  const Mat3 R_a = about(0, 0.7);
  const Vec3 chi(0.3, -0.4, 1.2), omega(1.0, 2.0, -3.0);
  const BodyStep a = at(R_a);
  const Mat3 R_b = R_a * exp_map(chi);
  const BodyStep b = at(R_b, Vec3::Zero(), R_b.transpose() * (R_a * omega));
  const JointCoordinates c = joint.coordinates({a, b, context, nullptr, nullptr});
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(c.value[static_cast<std::size_t>(i)], chi[i], 1e-14);
    EXPECT_NEAR(c.rate[static_cast<std::size_t>(i)], omega[i], 1e-14);
  }
}

// A body at rest hanging 2 m below its hinge: what the ground exerts on it is up.
TEST(Joint, ReportsTheForceOfTheGroundOnAHangingBodyWhicheverIsNamedFirst) {
  const StepContext context;
  const double weight = 20.0;
  const Vec3 arm(0.0, 2.0, 0.0);
  const BodyStep ground = BodyStep::ground(1.0), body = at(Mat3::Identity());
  JointFrames f;
  f.Z_a = arm;
  f.Z_b = arm;
  const double on_b[6] = {0.0, weight, 0.0, 0.0, 0.0, 0.0};
  const Joint joint("h", "fixed", {kGround, 0}, joint_kind("fixed").recipe(f, {}));
  const Reaction first = joint.reaction({ground, body, context, on_b, nullptr}, false);
  EXPECT_EQ(first.force, Vec3(0.0, weight, 0.0));
  EXPECT_EQ(first.moment, Vec3::Zero());
  // With sides exchanged it is the weight, which the body exerts on the ground.
  const double on_ground[6] = {0.0, -weight, 0.0, 0.0, 0.0, 0.0};
  const Joint other("h", "fixed", {0, kGround}, joint_kind("fixed").recipe(f, {}));
  EXPECT_EQ(other.reaction({body, ground, context, on_ground, nullptr}, false).force,
            Vec3(0.0, -weight, 0.0));
}

TEST(Joint, RefusesItsMirrorImage) {
  const StepContext context;
  const BodyStep a = turning(Mat3::Identity(), Mat3::Identity());
  const auto accepted = [&](const char* type, const Mat3& to) {
    const BodyStep b = turning(Mat3::Identity(), to);
    return joint_of_type(type).acceptable({a, b, context, nullptr, nullptr});
  };
  for (const char* type : {"revolute", "cylindrical", "planar", "parallel_axes"}) {
    EXPECT_TRUE(accepted(type, about(2, 3.0))) << type;
    EXPECT_FALSE(accepted(type, about(0, kPi))) << type << ": axes antiparallel";
  }
  for (const char* type : {"fixed", "prismatic"}) {
    EXPECT_TRUE(accepted(type, about(2, 0.1))) << type;
    EXPECT_FALSE(accepted(type, about(2, kPi))) << type << ": turned about z by half a turn";
    EXPECT_FALSE(accepted(type, about(0, kPi))) << type;
  }
  for (const char* type : {"spherical", "universal", "point_on_line"})
    EXPECT_TRUE(accepted(type, about(0, kPi))) << type << ": has no mirror image";
}

// Frames may be given antiparallel; then this orientation is kept.
TEST(Joint, KeepsTheOrientationOfTheStart) {
  const StepContext context;
  const BodyStep a = turning(Mat3::Identity(), Mat3::Identity());
  const BodyStep stays = turning(about(0, kPi), about(0, kPi));
  EXPECT_TRUE(joint_of_type("revolute").acceptable({a, stays, context, nullptr, nullptr}));
}

TEST(Joint, HasAMotionBasisIfItHasThreeRowsOrMore) {
  for (const char* type : {"distance", "point_in_plane", "point_on_line", "parallel_axes"}) {
    JointParameters p;
    p.values["distance"] = 1.0;
    const Joint joint("j", type, {0, 1}, joint_kind(type).recipe({}, p));
    EXPECT_FALSE(joint.motion_basis().has_value()) << type;
    EXPECT_FALSE(joint.reversible()) << type;
  }
  for (const char* type :
       {"spherical", "revolute", "prismatic", "cylindrical", "universal", "planar", "fixed"}) {
    EXPECT_TRUE(joint_of_type(type).motion_basis().has_value()) << type;
    EXPECT_TRUE(joint_of_type(type).reversible()) << type;
  }
}

}  // namespace polhode::test::joint_tests
