// SPDX-License-Identifier: Apache-2.0
// Optional columns of bodies' probes, for a disc on an arm whose motion is known.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/io/results/csv_probes.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::test::body_columns_tests {

namespace {

/// An arm turns about z at 2 t², a disc on its end at 1 m about the arm's x at 3 t.
std::string text(const std::string& probe) {
  return R"(
format: 1
bodies:
  arm: {mass: 1, inertia: [0.1, 0.2, 0.3], position: [0.5, 0, 0]}
  disc: {mass: 1, inertia: [0.2, 0.1, 0.1], position: [1, 0, 0]}
joints:
  base: {type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: z}
  spindle: {type: revolute, bodies: [arm, disc], at: [1, 0, 0], axis: x}
loads:
  turn: {type: rotary_motor, joint: base, angle: 2*t^2}
  spin: {type: rotary_motor, joint: spindle, angle: 3*t}
analysis: {type: dynamics, duration: 0.5 s, step: 0.5 ms}
output: {hdf5: false, probes: {disc: {body: disc, )" +
         probe + "}}}\n";
}

std::vector<double> at_end(const std::string& probe, std::vector<std::string>* header = nullptr) {
  Simulation s(io::read_model_text(text(probe), "columns.yaml"));
  EXPECT_EQ(s.run().end, RunEnd::finished);
  const ProbeTarget target = probe_target(s, s.model().output.probes[0]);
  if (header) *header = target.header;
  const std::vector<double> row = probe_row(target, s);
  EXPECT_EQ(row.size(), target.header.size());
  return row;
}

void expect_numbers(const std::vector<double>& row, std::size_t first,
                    const std::vector<double>& wanted, double tolerance) {
  ASSERT_GE(row.size(), first + wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k)
    EXPECT_NEAR(row[first + k], wanted[k], tolerance) << k;
}

constexpr double kT = 0.5, kPhi = 2.0 * kT * kT, kRate = 4.0 * kT, kPsi = 3.0 * kT;

}  // namespace

// Turns about z, then about the arm's x: Euler angles of zxy and the rest. The velocity's error is
// of the order of the step squared. @tests{euler-angles}
TEST(BodyColumns, ContainTheRotation) {
  std::vector<std::string> header;
  expect_numbers(at_end("rotation: zxy", &header), 10, {kPhi, kPsi, 0.0}, 1e-9);
  EXPECT_EQ(header[10], "euler1z [rad]");
  const Mat3 R = (Eigen::AngleAxisd(kPhi, Vec3::UnitZ()) * Eigen::AngleAxisd(kPsi, Vec3::UnitX()))
                     .toRotationMatrix();
  std::vector<double> rows;
  for (int i = 0; i < 9; ++i) rows.push_back(R(i / 3, i % 3));
  expect_numbers(at_end("rotation: matrix"), 10, rows, 1e-9);
  const Eigen::AngleAxisd turn(R);
  const Vec3 chi = turn.angle() * turn.axis();
  expect_numbers(at_end("rotation: vector"), 10, {chi[0], chi[1], chi[2]}, 1e-9);
  const Quat q(R);
  expect_numbers(at_end("rotation: quaternion"), 10, {q.w(), q.x(), q.y(), q.z()}, 1e-9);
}

// ω = (3 cos φ, 3 sin φ, φ̇), its rate, and the same relative to the arm. @tests{relative-motion}
TEST(BodyColumns, ContainTheAngularMotion) {
  const double c = std::cos(kPhi), s = std::sin(kPhi);
  expect_numbers(at_end("angular: true"), 10,
                 {3.0 * c, 3.0 * s, kRate, -3.0 * kRate * s, 3.0 * kRate * c, 4.0}, 1e-6);
  const std::vector<double> row = at_end("angular: true, seen_from: arm, point: [0, 0.2, 0]");
  const double y = 0.2 * std::cos(kPsi), z = 0.2 * std::sin(kPsi);
  // Position in the arm's own coordinates, whose origin is its centre of mass.
  expect_numbers(
      row, 1,
      {0.5, y, z, 0.0, -3.0 * z, 3.0 * y, 0.0, -9.0 * y, -9.0 * z, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0},
      1e-6);
}

// A point of the ground as the disc sees it: the inverse of the disc's motion.
// @tests{relative-motion}
TEST(BodyColumns, AreThoseOfTheGroundSeenFromABody) {
  const auto of_ground = [](const std::string& probe) {
    std::string model = text(probe);
    model.replace(model.find("body: disc"), 10, "body: ground");
    return model;
  };
  Simulation s(io::read_model_text(
      of_ground("seen_from: disc, point: [0.3, 0.1, 0.2], rotation: matrix, angular: true"),
      "columns.yaml"));
  ASSERT_EQ(s.run().end, RunEnd::finished);
  const std::vector<double> row = probe_row(probe_target(s, s.model().output.probes[0]), s);
  const Mat3 R = (Eigen::AngleAxisd(kPhi, Vec3::UnitZ()) * Eigen::AngleAxisd(kPsi, Vec3::UnitX()))
                     .toRotationMatrix();
  const double c = std::cos(kPhi), sine = std::sin(kPhi);
  const Vec3 w(3.0 * c, 3.0 * sine, kRate), r = Vec3(0.3, 0.1, 0.2) - Vec3(c, sine, 0.0);
  const Vec3 place = R.transpose() * r;
  const Vec3 v = R.transpose() * (-Vec3(-kRate * sine, kRate * c, 0.0) - w.cross(r));
  const Vec3 spin = R.transpose() * -w;
  expect_numbers(row, 1, {place[0], place[1], place[2], v[0], v[1], v[2]}, 1e-6);
  std::vector<double> turned;
  for (int i = 0; i < 9; ++i) turned.push_back(R(i % 3, i / 3));
  expect_numbers(row, 10, turned, 1e-9);
  expect_numbers(row, 19, {spin[0], spin[1], spin[2]}, 1e-6);
  try {
    (void)io::read_model_text(of_ground("angular: true"), "columns.yaml");
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what())
                  .find("the ground does not move. Name a body, or the one "
                        "that it is seen_from."),
              std::string::npos)
        << error.what();
  }
}

// In the disc's own axes W = (3, φ̇ sin ψ, φ̇ cos ψ), relative to the arm (3, 0, 0).
// @tests{relative-motion}
TEST(BodyColumns, ContainTheAngularMotionInTheBodysAxes) {
  const double c = std::cos(kPsi), s = std::sin(kPsi);
  const std::string own = "angular: true, axes: body";
  expect_numbers(
      at_end(own), 10,
      {3.0, kRate * s, kRate * c, 0.0, 4.0 * s + 3.0 * kRate * c, 4.0 * c - 3.0 * kRate * s}, 1e-6);
  expect_numbers(at_end(own + ", seen_from: arm"), 10, {3.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 1e-6);
}

// m v along the arm's y, J ω about the centre of mass. @tests{reported-momentum}
TEST(BodyColumns, OfAMomentumAreThoseOfTheBody) {
  const auto at_end_of = [](const std::string& probe) {
    std::string model = text("angular: true");
    model.replace(model.find("disc: {body"), std::string::npos, "it: {" + probe + "}}}\n");
    Simulation s(io::read_model_text(model, "columns.yaml"));
    EXPECT_EQ(s.run().end, RunEnd::finished);
    return probe_row(probe_target(s, s.model().output.probes[0]), s);
  };
  const double s = std::sin(kPhi), c = std::cos(kPhi), J = 0.1;
  const double kinetic = 0.5 * (kRate * kRate + 0.2 * 9.0 + J * kRate * kRate);
  expect_numbers(at_end_of("momentum: disc"), 1,
                 {-kRate * s, kRate * c, 0.0, 0.6 * c, 0.6 * s, J * kRate, kinetic}, 1e-6);
  const double s_b = std::sin(kPsi), c_b = std::cos(kPsi);
  expect_numbers(at_end_of("momentum: disc, axes: body"), 1,
                 {0.0, kRate * c_b, -kRate * s_b, 0.6, J * kRate * s_b, J * kRate * c_b, kinetic},
                 1e-6);
}

// Seven thousand kilometres away, at seven and a half a second, as in an orbit: r m v is 6e12 N m
// s.
// @tests{reported-momentum}
TEST(BodyColumns, OfAMomentumKeepTheirDigitsInAnOrbit) {
  const std::string craft = R"(
format: 1
variables: {far: 0}
bodies:
  bus: {mass: 100, inertia: [20, 70, 80], position: [far, 0, 0], velocity: [0, far/1000 + 0.1, 0], angular_velocity: [1e-3, 2e-3, -1e-3]}
  arm: {mass: 20, inertia: [1, 2, 2], position: [far + 2, 1, 0], velocity: [0, far/1000, 0.3], angular_velocity: [0, 0, 0.1]}
analysis: {duration: 1 s, step: 0.1 s}
output: {hdf5: false, probes: {one: {momentum: bus}, all: {momentum: "*"}}}
)";
  const auto momentum = [&](const char* far, std::size_t probe) {
    const Simulation s(io::read_model_text(craft, "orbit.yaml", {far}));
    const std::vector<double> row = probe_row(probe_target(s, s.model().output.probes[probe]), s);
    return Vec3(row[4], row[5], row[6]);
  };
  EXPECT_NEAR((momentum("far=7e6", 0) - Vec3(0.02, 0.14, -0.08)).norm(), 0.0, 1e-15);
  const Vec3 near = momentum("far=0", 1);
  EXPECT_NEAR(near[2], -0.08 + 0.2 - 100.0 * 20.0 / 120.0 * 2.0 * 0.1, 1e-13);
  EXPECT_NEAR((momentum("far=7e6", 1) - near).norm(), 0.0, 1e-7);  // 1e-9 m and 1e-12 m/s of 20 kg
}

// That of all bodies of a part and their rotors is what the balances have, about another point.
// @tests{reported-momentum}
TEST(BodyColumns, OfAMomentumAreThoseOfAPart) {
  Simulation s(io::read_model_text(R"(
format: 1
bodies: {other: {mass: 1, inertia: [1, 1, 1], position: [5, 0, 0]}}
parts:
  craft:
    position: [1, 2, 0]
    model:
      format: 1
      bodies:
        hub: {mass: 3, inertia: [1, 2, 2.5], velocity: [0.1, 0.3, 0], angular_velocity: [0.3, 0.2, 0.6]}
        arm: {mass: 2, inertia: [0.1, 0.4, 0.4], position: [1, 0.2, 0], velocity: [0.2, -0.4, 0.7]}
      loads:
        wheel: {type: rotor, body: hub, axis: [1, 1, 0], inertia: 0.2, moment: 0.3*t, start_speed: 50}
        gyro: {type: rotor, body: arm, axis: z, inertia: 0.1, speed: 20 + t}
        link: {type: spring_damper, bodies: [hub, arm], at: [[0, 0, 0], [1, 0.3, 0]], stiffness: 20}
analysis: {duration: 0.5 s, step: 5 ms}
output: {hdf5: false, probes: {craft: {momentum: craft_*}}}
)",
                                   "part.yaml"));
  EXPECT_EQ(s.run().end, RunEnd::finished);
  const std::vector<double> row = probe_row(probe_target(s, s.model().output.probes[0]), s);
  ASSERT_EQ(row.size(), 8U);
  const Vec3 p(row[1], row[2], row[3]), l(row[4], row[5], row[6]);
  const Vec3 centre = (3.0 * s.body(1).r + 2.0 * s.body(2).r) / 5.0;
  const Balance all = s.balance();
  EXPECT_LT((p - all.linear_momentum).norm(), 1e-12);
  EXPECT_LT((l + centre.cross(p) - all.angular_momentum).norm(), 1e-12);
  EXPECT_NEAR(row[7], all.kinetic, 1e-12 * all.kinetic);
}

// Axis of the disc relative to the arm: the spindle. Relative to the ground: from the disc's
// rotation and displacement.
// @tests{helical-rate} @tests{helical-finite}
TEST(BodyColumns, ContainHelicalAxes) {
  for (const char* which : {"instantaneous", "finite"}) {
    const bool finite = *which == 'f';
    expect_numbers(at_end(std::string("seen_from: arm, helical: ") + which), 10,
                   {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, finite ? kPsi : 3.0, 0.0}, 1e-6);
  }
  // The disc's centre goes along y' at φ̇; ω = (3, 0, φ̇) along the arm's axes.
  const std::vector<double> row = at_end("helical: instantaneous");
  const double turn = std::hypot(3.0, kRate);
  EXPECT_NEAR(row[16], turn, 1e-6);
  EXPECT_NEAR(row[17], 0.0, 1e-6);
}

TEST(BodyColumns, ReportErrors) {
  const auto fault = [](const std::string& probe) -> std::string {
    try {
      (void)io::read_model_text(text(probe), "columns.yaml");
    } catch (const std::exception& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(fault("rotation: vectr").find("output.probes.disc.rotation: is 'vectr'. Write"),
            std::string::npos);
  EXPECT_NE(fault("rotation: zzx").find("'zzx' is no Euler sequence"), std::string::npos);
  for (const auto& [probe, message] :
       {std::pair("momentum: arms",
                  "'arms' names no body. Did you mean 'arm'? Name a body, or the"),
        std::pair("momentum: disk*", "'disk*' names no body"),
        std::pair("momentum: \"*\", axes: body", "'*' has several bodies")}) {
    std::string model = text("angular: true");
    model.replace(model.find("disc: {body"), std::string::npos,
                  "it: {" + std::string(probe) + "}}}\n");
    try {
      Simulation s(io::read_model_text(model, "columns.yaml"));
      (void)probe_target(s, s.model().output.probes[0]);
      ADD_FAILURE() << probe;
    } catch (const std::exception& e) {
      EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
    }
  }
  EXPECT_NE(fault("axes: body").find("are those of the angular motion, which is not recorded"),
            std::string::npos);
  EXPECT_NE(fault("angular: true, axes: joint").find("'joint' cannot be combined with 'body'"),
            std::string::npos);
  EXPECT_NE(fault("seen_from: arn").find("unknown body 'arn'. Did you mean 'arm'?"),
            std::string::npos);
}

}  // namespace polhode::test::body_columns_tests
