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
  EXPECT_NE(fault("seen_from: arn").find("unknown body 'arn'. Did you mean 'arm'?"),
            std::string::npos);
}

}  // namespace polhode::test::body_columns_tests
