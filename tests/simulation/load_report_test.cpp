// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <polhode/io/results/csv_probes.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/model_builder.hpp>
#include <support/scratch.hpp>

namespace polhode::test::load_report_tests {
namespace {

constexpr double kRounding = 1e-12;

Vec3 vector_of(const std::vector<double>& report) { return {report[0], report[1], report[2]}; }

LoadSpec wrench(const std::string& type, int body, const Vec3& value, bool body_fixed) {
  LoadSpec load;
  load.name = load.type = type;
  load.b = body;
  load.body_fixed = body_fixed;
  load.vector =
      TimeVector{std::make_shared<Constant>(value[0]), std::make_shared<Constant>(value[1]),
                 std::make_shared<Constant>(value[2])};
  return load;
}

/// A free body on two spring-dampers to the ground, pushed by a force, and a hinged one with a
/// torsional spring beyond one turn.
Simulation sample() {
  ModelBuilder m;
  const int b = m.body("b", {1, 2, 3}, 2.5, {0.4, 0.5, 0.6});
  m.at(b).velocity = {0.3, -0.2, 0.5};
  m.at(b).angular_velocity = {1, 2, -1};
  m.spring("one", kGround, {0, 0, 0}, b, {1.1, 2.3, 3}, {{"stiffness", 40.0}, {"damping", 3.0}});
  m.spring("two", b, {1, 2, 3.2}, kGround, {4, 0, 1}, {{"stiffness", 25.0}, {"free_length", 1.0}});
  m.model.loads.push_back(wrench("force", b, {1, -2, 0.5}, true));
  const int wheel = m.body("wheel", {9, 0, 0}, 1.0, {0.1, 0.2, 0.3});
  m.at(wheel).angular_velocity = {0, 0, 30.0};
  m.joint("axle", "revolute", kGround, wheel, {9, 0, 0});
  m.torsional_spring("spiral", "axle", {{"stiffness", 2.0}, {"damping", 0.1}, {"free_angle", 0.3}});
  m.model.loads.push_back(wrench("moment", wheel, {0, 0, 0.7}, false));
  m.model.analysis.duration = 1.0;
  m.model.analysis.step = 0.005;
  return Simulation(m.model);
}

TEST(LoadReport, SpringsStartWithTheirInitialLengthAndWithoutForce) {
  const Simulation s = sample();
  const std::vector<double> one = s.load(0);
  ASSERT_EQ(one.size(), 6U);
  const Vec3 arm(1.1, 2.3, 3.0),
      velocity = Vec3(0.3, -0.2, 0.5) + Vec3(1, 2, -1).cross(Vec3(0.1, 0.3, 0));
  const double length = arm.norm(), rate = arm.dot(velocity) / length;
  EXPECT_NEAR(one[3], length, kRounding);
  EXPECT_NEAR(one[4], rate, kRounding);
  EXPECT_NEAR(one[5], 0.0, kRounding);
  EXPECT_NEAR((vector_of(one) + 3.0 * rate * arm / length).norm(), 0.0, kRounding);
}

// What the springs and the force report is all that acts on the body: m a.
TEST(LoadReport, ForcesAddUpToTheAcceleration) {
  Simulation s = sample();
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(s.step(1.0).accepted);
  // The second spring's b is the ground: its report is the force on the ground.
  const Vec3 force = vector_of(s.load(0)) - vector_of(s.load(1)) + vector_of(s.load(2));
  EXPECT_NEAR((force / 2.5 - s.point(0, Vec3::Zero()).acceleration).norm(), 0.0, 1e-10);
  EXPECT_NEAR(vector_of(s.load(2)).norm(), Vec3(1, -2, 0.5).norm(), kRounding);
  const std::vector<double> two = s.load(1);
  EXPECT_NEAR(two[5], 0.5 * 25.0 * (two[3] - 1.0) * (two[3] - 1.0), kRounding);
  EXPECT_NEAR(vector_of(two).norm(), 25.0 * std::abs(two[3] - 1.0), 1e-10);
}

TEST(LoadReport, ATorsionalSpringHasTheAngleOfItsJointAndTheAxialMoment) {
  Simulation s = sample();
  while (s.joint(0).coordinates[0] < 7.0) ASSERT_TRUE(s.step(1.0).accepted);
  const std::vector<double> spiral = s.load(3);
  const JointReport axle = s.joint(0);
  EXPECT_NEAR(spiral[3], axle.coordinates[0], kRounding);
  EXPECT_NEAR(spiral[4], axle.rates[0], 1e-10);
  const double turned = spiral[3] - 0.3;
  EXPECT_NEAR(spiral[5], turned * turned, 1e-10);
  const Vec3 moment(0, 0, -2.0 * turned - 0.1 * spiral[4]);
  EXPECT_NEAR((vector_of(spiral) - moment).norm(), 0.0, 1e-9);
  EXPECT_EQ(vector_of(s.load(4)), Vec3(0, 0, 0.7));
}

TEST(LoadReport, IsRecordedByProbes) {
  const Scratch scratch;
  ModelBuilder m;
  const int b = m.body("b", {0, 0, 2}, 1.0, {1, 1, 1});
  m.spring("s", kGround, {0, 0, 0}, b, {0, 0, 2}, {{"stiffness", 3.0}, {"free_length", 1.0}});
  m.model.loads.push_back(wrench("moment", b, {1, 2, 3}, false));
  ProbeSpec spring, moment;
  spring.name = spring.target = "s";
  moment.name = moment.target = "moment";
  spring.kind = moment.kind = "load";
  m.model.output.probes = {spring, moment};
  m.model.analysis.step = 0.1;
  const Simulation s(m.model);
  io::CsvProbes probes(s, scratch / "probes");
  probes.record(s);
  probes.flush();
  EXPECT_EQ(io::read_file(scratch / "probes/s.csv"),
            "t [s],fx [N],fy [N],fz [N],length [m],rate [m/s],energy [J]\n0,-0,-0,-3,2,0,1.5\n");
  EXPECT_EQ(io::read_file(scratch / "probes/moment.csv"),
            "t [s],mx [N m],my [N m],mz [N m]\n0,1,2,3\n");
}

}  // namespace
}  // namespace polhode::test::load_report_tests
