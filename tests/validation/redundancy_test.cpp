// SPDX-License-Identifier: Apache-2.0
// Mechanisms with redundant rows, and singular positions where the rank is deficient.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/newton/rank_report.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/published_cases.hpp>

namespace polhode::test::redundancy_tests {
namespace {

struct Overconstrained {
  std::string name;
  Model model;
  int rows, redundant, mobility;
  double step;
};

std::vector<Overconstrained> overconstrained() {
  // Mobility is counted by hand: one of each, and the redundant rows follow from 6 n − rows.
  return {
      {"Bricard", bricard(), 30, 1, 1, 0.01},
      {"Bennett", bennett(), 20, 3, 1, 0.01},
      {"NFourBar3", n_four_bar(3, 0.3), 50, 9, 1, 0.01},
      {"DoorOnTwoHinges", door(), 10, 5, 1, 0.01},
  };
}

class Redundancy : public testing::TestWithParam<Overconstrained> {};

TEST_P(Redundancy, IsReportedWithTheJointsThatShareIt) {
  const Overconstrained& c = GetParam();
  const Simulation s(c.model);
  const RankReport r = rank_report(s.system(), s.state());
  EXPECT_EQ(r.rows, c.rows);
  EXPECT_EQ(r.redundant, c.redundant);
  EXPECT_EQ(r.mobility, c.mobility);
  EXPECT_GE(r.names.size(), 2U);
}

TEST_P(Redundancy, DoesNotDisturbTheMotion) {
  Model model = GetParam().model;
  model.analysis.step = GetParam().step;
  model.analysis.duration = 10.0;
  Simulation s(std::move(model));
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_EQ(r.rejected_steps, 0);
  // Lengths are a metre: the joints hold to some round-offs of that.
  EXPECT_LE(r.constraint_residual_max, 1e-13);
  EXPECT_LE(r.energy_drift, 1e-10);
  EXPECT_LE(r.angular_momentum_drift, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Of, Redundancy, testing::ValuesIn(overconstrained()),
                         [](const auto& p) { return p.param.name; });

/// Largest departure of the verticals from parallel: the four-bars must stay on that branch.
double branch_deviation(const Simulation& s, int N) {
  double most = 0.0;
  const Vec3 first = s.body(0).q * Vec3::UnitX();
  for (int i = 1; i <= N; ++i) most = std::max(most, (s.body(i).q * Vec3::UnitX() - first).norm());
  return most;
}

// The flat position has N + 1 motions to first order, and the mechanism leaves it in one of them
// only. Energy carries the mechanism through it, at any fraction of a step.
struct Grid {
  int N;
  double step, phi;
};
class FlatFourBar : public testing::TestWithParam<Grid> {};

TEST_P(FlatFourBar, IsPassedOnTheSameBranch) {
  const auto [N, step, phi] = GetParam();
  Model model = n_four_bar(N, phi);
  model.analysis.step = step;
  model.analysis.duration = 4.0;
  Simulation s(std::move(model));
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_LE(r.energy_drift, 1e-10);
  EXPECT_LE(r.constraint_residual_max, 1e-12);
  EXPECT_LE(branch_deviation(s, N), 1e-6) << "the mechanism left its branch";
}

std::vector<Grid> grids() {
  std::vector<Grid> all;
  for (const int N : {1, 3})
    for (const double step : {0.0025, 0.01, 0.01 * std::numbers::sqrt2, 0.02})
      for (const double phi : {0.0, 0.1, 0.777}) all.push_back({N, step, phi});
  return all;
}
INSTANTIATE_TEST_SUITE_P(OnAnyGrid, FlatFourBar, testing::ValuesIn(grids()));

class FlatStart : public testing::TestWithParam<int> {};

TEST_P(FlatStart, RunsInTheDirectionOfItsVelocities) {
  const int N = GetParam();
  Model model = n_four_bar(N, 0.5 * std::numbers::pi);
  model.analysis.step = 0.01;
  model.analysis.duration = 4.0;
  Simulation s(std::move(model));
  const RankReport rank = rank_report(s.system(), s.state());
  EXPECT_EQ(rank.mobility, N + 1);
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_LE(r.energy_drift, 1e-9);
  EXPECT_LE(branch_deviation(s, N), 1e-6);
}
INSTANTIATE_TEST_SUITE_P(Of, FlatStart, testing::Values(1, 2, 3));

// A motor that turns the first hinge: increments after the second are those of the proximal
// iteration alone, which need not be continued (2.28 iterations at 10 ms if it is). Upper ends move
// on circles.
TEST(DrivenFourBar, NeedsTwoIterationsAStepAndFollowsItsMotor) {
  for (const double step : {0.02, 0.01, 0.001, 0.0001}) {
    const int N = 40;
    Model model = n_four_bar(N);
    LoadSpec motor;
    motor.name = "motor";
    motor.type = "rotary_motor";
    motor.joint = "ground0";
    motor.drive = "speed";
    motor.value = std::make_shared<Constant>(-1.0);
    model.loads.push_back(motor);
    model.analysis.step = step;
    model.analysis.duration = step < 0.001 ? 0.2 : 4.0;
    Simulation s(std::move(model));
    const RunSummary r = s.run();
    ASSERT_EQ(r.end, RunEnd::finished) << r.message;
    EXPECT_LE(static_cast<double>(r.newton_iterations), 2.05 * static_cast<double>(r.steps))
        << step;
    EXPECT_LE(r.constraint_residual_max, 1e-13) << step;
    EXPECT_LE(r.energy_drift, 1e-10) << step;
    const Vec3 arm(std::sin(s.time()), std::cos(s.time()), 0.0);
    for (int i = 0; i <= N; ++i)
      EXPECT_LE((s.body(i).r + s.body(i).q * kFourBarB0 - Vec3(i, 0.0, 0.0) - arm).norm(), 1e-11)
          << step << ' ' << i;
  }
}

}  // namespace
}  // namespace polhode::test::redundancy_tests
