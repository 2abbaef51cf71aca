// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/newton/rank_report.hpp>

#include "engines/mechanisms.hpp"

namespace polhode::rank_report_tests {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(RankReport, FindsTheOneRedundantRowOfBricardsLinkage) {
  const System system = bricard_system().system();
  const RankReport report = rank_report(system, system.initial_state());
  EXPECT_EQ(report.rows, 30);
  EXPECT_EQ(report.rank, 29);
  EXPECT_EQ(report.mobility, 1);
  EXPECT_EQ(report.names.size(), 6u);  // every hinge is involved
}

TEST(RankReport, NamesTheHingesOfADoor) {
  const System system = door_system().system();
  const RankReport report = rank_report(system, system.initial_state());
  EXPECT_EQ(report.redundant, 5);
  EXPECT_EQ(report.mobility, 1);
  EXPECT_THAT(report.names, ElementsAre("joint 'lower hinge'", "joint 'upper hinge'"));
  EXPECT_EQ(report.text(),
            "mobility 1, 10 constraint rows, rank 5, 5 redundant among joint 'lower hinge', "
            "joint 'upper hinge'");
}

TEST(RankReport, CountsThreeRedundantRowsForEachFourBar) {
  for (const int n : {1, 2, 10}) {
    const System system = four_bars(n, 1.0).system();
    const RankReport report = rank_report(system, system.initial_state());
    EXPECT_EQ(report.redundant, 3 * n);
    EXPECT_EQ(report.mobility, 1);
  }
}

TEST(RankReport, CountsTheSameInLargeSystems) {
  const int n = 40;  // 605 rows
  const System system = four_bars(n, 1.0).system();
  const RankReport report = rank_report(system, system.initial_state());
  EXPECT_EQ(report.rows, 5 * (3 * n + 1));
  EXPECT_EQ(report.redundant, 3 * n);
  EXPECT_EQ(report.mobility, 1);
  EXPECT_EQ(report.names.size(), 3u * n + 1u);
}

TEST(RankReport, CountsTheAdditionalMotionsOfAFlatFourBar) {
  // Cranks and couplers in one line: each loop loses a row, and mobility becomes N + 1.
  const System system = four_bars(3, 0.0).system();
  EXPECT_EQ(rank_report(system, system.initial_state()).mobility, 4);
}

TEST(RankReport, FindsNothingRedundantInATree) {
  const System system = spherical_chain(7).system();
  const RankReport report = rank_report(system, system.initial_state());
  EXPECT_EQ(report.redundant, 0);
  EXPECT_EQ(report.mobility, 21);
  EXPECT_THAT(report.names, IsEmpty());
  EXPECT_EQ(report.text(), "mobility 21, 21 constraint rows, rank 21, none redundant");
}

TEST(RankReport, LeavesOutJointsThatAreNotRedundant) {
  Mechanism m = door_system();
  const int handle = m.body("handle", {1.0, 0.2, 1.0});
  m.joint("spindle", "revolute", 0, handle, {1.0, 0.0, 1.0}, Vec3::UnitY());
  const System system = m.system();
  const RankReport report = rank_report(system, system.initial_state());
  EXPECT_EQ(report.mobility, 2);
  EXPECT_THAT(report.names, ElementsAre("joint 'lower hinge'", "joint 'upper hinge'"));
}

/// Right-hand side of one row of an interaction, zero in all others.
std::vector<double> only(const System& system, const std::string& name, int row, double value) {
  std::vector<double> r(static_cast<std::size_t>(system.rows()), 0.0);
  for (const InteractionRef& ref : system.interactions())
    if (system.name(ref) == name) r[static_cast<std::size_t>(ref.first_row + row)] = value;
  return r;
}

// @tests{row-contradiction}
TEST(RankReport, NamesTheRowsThatContradictEachOther) {
  Mechanism m = door_system();
  const int handle = m.body("handle", {1.0, 0.2, 1.0});
  m.joint("spindle", "revolute", 0, handle, {1.0, 0.0, 1.0}, Vec3::UnitY());
  const System system = m.system();
  const Contradiction c =
      find_contradiction(system, system.initial_state(), only(system, "lower hinge", 0, 2.0));
  EXPECT_GT(c.part, 0.1 * c.of);
  EXPECT_LE(c.part, c.of);
  EXPECT_THAT(c.names, ElementsAre("joint 'lower hinge'", "joint 'upper hinge'"));
  const Contradiction none =
      find_contradiction(system, system.initial_state(), only(system, "spindle", 0, 2.0));
  EXPECT_LE(none.part, 1e-12);
}

TEST(RankReport, GivesAFreeBodySixMotions) {
  Mechanism m;
  m.body("free", {0, 0, 0});
  const System system = m.system();
  EXPECT_EQ(rank_report(system, system.initial_state()).mobility, 6);
}

}  // namespace
}  // namespace polhode::rank_report_tests
