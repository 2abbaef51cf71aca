// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <polhode/core/error.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::read_model_tests {
namespace {

constexpr double kPi = std::numbers::pi;
/// Rounding of a few operations on numbers of size 1.
constexpr double kRounding = 1e-14;

Model read(const std::string& rest, const io::Overrides& overrides = {}) {
  return io::read_model_text("format: 1\n" + rest, "m.yaml", overrides);
}

std::string first_fault(const std::string& rest, const io::Overrides& overrides = {}) {
  try {
    static_cast<void>(read(rest, overrides));
  } catch (const io::ModelErrors& errors) {
    return errors.diagnostics().front().path + ": " + errors.diagnostics().front().what;
  }
  return "";
}

const std::string kTwo =
    "bodies:\n"
    "  a: {mass: 1, inertia: [1, 1, 1], position: [1, 0, 0], orientation: {axis: z, angle: 90 "
    "deg}}\n"
    "  b: {mass: 2, inertia: [1, 1, 1], position: [3, 0, 0], orientation: {axis: x, angle: 30 "
    "deg}}\n";

Vec3 world_point(const Model& model, int body, const Vec3& Z) {
  if (body == kGround) return Z;
  const BodySpec& b = model.bodies[static_cast<std::size_t>(body)];
  return b.position + b.orientation * Z;
}

Mat3 world_axes(const Model& model, int body, const Mat3& R) {
  if (body == kGround) return R;
  return model.bodies[static_cast<std::size_t>(body)].orientation.toRotationMatrix() * R;
}

TEST(ReadModel, ResolvesUnitsToSi) {
  const Model m = read(
      "units: {length: mm, mass: g, time: ms, angle: deg}\n"
      "gravity: [0, 0, -9.81 m/s^2]\n"
      "bodies:\n  b: {mass: 5, inertia: [2, 2, 2], position: [1, 2 cm, 3], "
      "velocity: [1, 0, 0], angular_velocity: [90, 1 rad/s, 0]}\n");
  const BodySpec& b = m.bodies[0];
  EXPECT_DOUBLE_EQ(b.mass, 5e-3);
  EXPECT_DOUBLE_EQ(b.inertia(0, 0), 2e-9);  // g mm².
  EXPECT_NEAR((b.position - Vec3(1e-3, 2e-2, 3e-3)).norm(), 0.0, kRounding);
  EXPECT_DOUBLE_EQ(b.velocity.x(), 1.0);  // mm/ms.
  EXPECT_NEAR(b.angular_velocity.x(), 500.0 * kPi, 1e3 * kRounding);
  EXPECT_DOUBLE_EQ(b.angular_velocity.y(), 1.0);
  EXPECT_DOUBLE_EQ(m.gravity.z(), -9.81);
}

TEST(ReadModel, TakesColorsByNameAndCode) {
  const std::string body = "bodies:\n  b: {mass: 1, inertia: [1, 1, 1], color: ";
  EXPECT_EQ(read(body + "\"#40C0ff\"}\n").bodies[0].color, "#40C0ff");
  EXPECT_EQ(read(body + "teal}\n").bodies[0].color, "#2f8f8b");
  EXPECT_EQ(read(kTwo).bodies[0].color, "");
  EXPECT_EQ(first_fault(body + "gren}\n"), "bodies.b.color: 'gren' is no color");
  EXPECT_EQ(first_fault(body + "\"#40c0f\"}\n"), "bodies.b.color: '#40c0f' is no color");
}

TEST(ReadModel, TakesEveryFormOfOrientationForTheSameTurn) {
  // A turn by 90 deg about z.
  for (const char* form :
       {"{axis: z, angle: 90 deg}", "{quaternion: [0.70710678, 0, 0, 0.70710678]}",
        "{rotation_vector: [0, 0, pi/2]}", "{matrix: [[0, -1, 0], [1, 0, 0], [0, 0, 1]]}",
        "{euler: {sequence: zyx, angles: [pi/2, 0, 0]}}",
        "{euler: {sequence: XYZ, angles: [0, 0, pi/2]}}"}) {
    const Model m = read(std::string("bodies:\n  b: {mass: 1, inertia: [1, 1, 1], orientation: ") +
                         form + "}\n");
    EXPECT_NEAR((m.bodies[0].orientation * Vec3::UnitX() - Vec3::UnitY()).norm(), 0.0, 1e-8)
        << form;
  }
}

TEST(ReadModel, TurnsEulerAnglesAboutBodyOrWorldAxes) {
  const auto orientation = [](const std::string& euler) {
    return read("bodies:\n  b: {mass: 1, inertia: [1, 1, 1], orientation: {euler: " + euler +
                "}}\n")
        .bodies[0]
        .orientation;
  };
  // About the body's axes in one order is about the world's in the other.
  const Quat body = orientation("{sequence: zyx, angles: [0.3, 0.4, 0.5]}");
  const Quat world = orientation("{sequence: XYZ, angles: [0.5, 0.4, 0.3]}");
  EXPECT_NEAR(body.angularDistance(world), 0.0, 1e-7);
  const Mat3 expected =
      (Eigen::AngleAxisd(0.3, Vec3::UnitZ()) * Eigen::AngleAxisd(0.4, Vec3::UnitY()) *
       Eigen::AngleAxisd(0.5, Vec3::UnitX()))
          .toRotationMatrix();
  EXPECT_NEAR((body.toRotationMatrix() - expected).norm(), 0.0, kRounding);
}

TEST(ReadModel, ComputesMassPropertiesOfShapes) {
  const Model m = read(
      "bodies:\n"
      "  box: {shape: {box: [1, 2, 3]}, density: 10}\n"
      "  scaled: {shape: {box: [1, 2, 3]}, mass: 6}\n"
      "  two: {shape: [{box: [1, 1, 1], position: [2, 0, 0]}, {box: [1, 1, 1], density: 30}], "
      "density: 10, position: [5, 0, 0]}\n");
  EXPECT_DOUBLE_EQ(m.bodies[0].mass, 60.0);
  EXPECT_NEAR(m.bodies[0].inertia(0, 0), 60.0 * (4.0 + 9.0) / 12.0, 1e-12);
  EXPECT_NEAR(m.bodies[1].inertia(0, 0), 6.0 * (4.0 + 9.0) / 12.0, 1e-12);
  const BodySpec& two = m.bodies[2];  // Placed by its origin; the centre of mass follows.
  EXPECT_DOUBLE_EQ(two.mass, 40.0);
  EXPECT_NEAR((two.com - Vec3(0.5, 0, 0)).norm(), 0.0, kRounding);
  EXPECT_NEAR((two.position - Vec3(5.5, 0, 0)).norm(), 0.0, kRounding);
}

TEST(ReadModel, PutsTheFramesOfAJointOnBothBodies) {
  const Model m =
      read(kTwo +
           "joints:\n  j: {type: revolute, bodies: [a, b], at: [2, 1, 0], axis: [0, 1, 1]}\n"
           "  g: {type: spherical, bodies: [ground, b], at: [1, 2, 3]}\n");
  const JointSpec& j = m.joints[0];
  EXPECT_NEAR((world_point(m, j.a, j.Z_a) - Vec3(2, 1, 0)).norm(), 0.0, kRounding);
  EXPECT_NEAR((world_point(m, j.b, j.Z_b) - Vec3(2, 1, 0)).norm(), 0.0, kRounding);
  const Mat3 F_a = world_axes(m, j.a, j.R_a), F_b = world_axes(m, j.b, j.R_b);
  EXPECT_NEAR((F_a - F_b).norm(), 0.0, kRounding);
  EXPECT_NEAR((F_a.col(2) - Vec3(0, 1, 1).normalized()).norm(), 0.0, kRounding);
  EXPECT_NEAR((F_a.transpose() * F_a - Mat3::Identity()).norm(), 0.0, kRounding);
  EXPECT_NEAR(F_a.determinant(), 1.0, kRounding);
  EXPECT_FALSE(j.assembled_start);
  EXPECT_EQ(m.joints[1].Z_a, Vec3(1, 2, 3));
}

TEST(ReadModel, PutsTheAxesOfAUniversalJointOnXOfAAndYOfB) {
  const Model m = read(
      kTwo +
      "joints:\n  j: {type: universal, bodies: [a, b], at: [2, 0, 0], axes: [[0, 3, 4], x]}\n");
  const JointSpec& j = m.joints[0];
  EXPECT_NEAR((world_axes(m, j.a, j.R_a).col(0) - Vec3(0, 0.6, 0.8)).norm(), 0.0, kRounding);
  EXPECT_NEAR((world_axes(m, j.b, j.R_b).col(1) - Vec3::UnitX()).norm(), 0.0, kRounding);
}

TEST(ReadModel, TakesPointsAndAxesOfEachBody) {
  const Model m = read(
      "bodies:\n"
      "  a: {mass: 1, inertia: [1, 1, 1], com: [1, 0, 0], position: [0, 0, 0], position_of: "
      "origin}\n"
      "  b: {mass: 1, inertia: [1, 1, 1], position: [3, 0, 0]}\n"
      "joints:\n  j: {type: cylindrical, bodies: [a, b], at_body: [[1, 0, 1], [0, 0, 1]], "
      "axis_body: [z, [0.1, 0, 1]]}\n");
  const JointSpec& j = m.joints[0];
  EXPECT_TRUE(j.assembled_start);
  EXPECT_NEAR((j.Z_a - Vec3(0, 0, 1)).norm(), 0.0, kRounding);
  EXPECT_NEAR((j.R_b.col(2) - Vec3(0.1, 0, 1).normalized()).norm(), 0.0, kRounding);
  // The shortest turn between the axes leaves the joint's angle at zero.
  const double angle = std::atan2(j.R_a.col(1).dot(j.R_b.col(0)), j.R_a.col(0).dot(j.R_b.col(0)));
  EXPECT_NEAR(angle, 0.0, kRounding);
}

TEST(ReadModel, MeasuresDistancesAtTheStart) {
  const Model m =
      read(kTwo + "joints:\n  rod: {type: distance, bodies: [a, b], at: [[1, 0, 0], [3, 2, 0]]}\n");
  EXPECT_NEAR(m.joints[0].parameters.at("distance"), std::sqrt(8.0), kRounding);
  EXPECT_FALSE(m.joints[0].assembled_start);
}

TEST(ReadModel, LocksFreedomsByAJointToGround) {
  const Model m =
      read("bodies:\n  b: {mass: 1, inertia: [1, 1, 1], position: [1, 2, 3], hold: [rx, z]}\n");
  ASSERT_EQ(m.joints.size(), 1U);
  EXPECT_EQ(m.joints[0].name, "b.hold");
  EXPECT_EQ(m.joints[0].type, "generic");
  EXPECT_EQ(m.joints[0].free, (std::vector<std::string>{"x", "y", "ry", "rz"}));
  EXPECT_EQ(m.joints[0].Z_a, Vec3(1, 2, 3));
}

TEST(ReadModel, ReadsForcesOverTime) {
  const Model m =
      read(kTwo +
           "loads:\n  f: {type: force, body: a, at: [2, 0, 0], force: [\"5*sin(2*pi*t)\", "
           "{table: [[0, 0], [1, 2 kN]]}, 3]}\n");
  const LoadSpec& f = m.loads[0];
  EXPECT_DOUBLE_EQ((*(*f.vector)[0])(0.25), 5.0);
  EXPECT_DOUBLE_EQ((*(*f.vector)[1])(0.5), 1000.0);
  EXPECT_TRUE((*f.vector)[2]->is_constant());
  EXPECT_EQ(f.b, 0);
  EXPECT_NEAR((world_point(m, f.b, f.Z_b) - Vec3(2, 0, 0)).norm(), 0.0, kRounding);
}

TEST(ReadModel, AppliesOverrides) {
  const std::string text = "variables: {L: 1}\n" + kTwo +
                           "joints:\n  j: {type: spherical, bodies: [a, b], at: [L, 0, 0]}\n";
  EXPECT_EQ(world_point(read(text, {"L=2*3"}), 0, read(text, {"L=2*3"}).joints[0].Z_a).x(), 6.0);
  EXPECT_EQ(read(text, {"bodies.a.mass=7 g"}).bodies[0].mass, 7e-3);
  EXPECT_EQ(*read(text, {"analysis.step=1e-3"}).analysis.step, 1e-3);
  EXPECT_NEAR(
      world_point(read(text, {"joints.j.at.2=5"}), 1, read(text, {"joints.j.at.2=5"}).joints[0].Z_b)
          .z(),
      5.0, kRounding);
  EXPECT_EQ(read(text, {"gravity=[0, 0, -1]"}).gravity.z(), -1.0);
  const std::string ball = "bodies:\n  ball: {shape: {sphere: 1}, mass: 1}\ncontacts: {}\n";
  EXPECT_EQ(read(ball, {"contacts.default.friction=0.3"}).contacts.standard.friction, 0.3);
}

TEST(ReadModel, LocatesAnInvalidOverride) {
  try {
    static_cast<void>(read(kTwo, {"bodies.a.mass=2 m"}));
    FAIL();
  } catch (const io::ModelErrors& errors) {
    EXPECT_EQ(errors.diagnostics().front().place.file, "--set bodies.a.mass=2 m");
    EXPECT_EQ(errors.diagnostics().front().place.line, 0);
  }
}

TEST(ReadModel, ReportsSettingsThatDoNotFitTogether) {
  EXPECT_EQ(first_fault(kTwo + "analysis: {order: 6, rho_inf: 0.5, step: 1}\n"),
            "analysis.order: order 6 cannot be combined with rho_inf 0.5");
  EXPECT_EQ(first_fault(kTwo + "analysis: {rho_inf: -0.1}\n"),
            "analysis.rho_inf: must lie in [0, 1], but is -0.1");
}

TEST(ReadModel, ReportsAFileThatCannotBeRead) {
  EXPECT_THROW(static_cast<void>(io::read_model("no_such_folder/no_such_file.yaml")),
               io::FileError);
}

TEST(Model, FindsBodiesAndJointsByName) {
  const Model m = read(kTwo);
  EXPECT_EQ(m.body_index("ground"), kGround);
  EXPECT_EQ(m.body_index("b"), 1);
  try {
    static_cast<void>(m.body_index("c"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.what_is_wrong(), "unknown body 'c'");
  }
  EXPECT_THROW(static_cast<void>(m.joint_index("j")), InputError);
}

}  // namespace
}  // namespace polhode::read_model_tests
