// SPDX-License-Identifier: Apache-2.0
#include <polhode/linear/loop_rank.hpp>

#include <Eigen/SVD>
#include <random>

#include <gtest/gtest.h>
#include <polhode/newton/rank_report.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/models.hpp>

namespace polhode::loop_rank_tests {
namespace {

/// All rows in one dense matrix.
Mat dense(const std::vector<linear::BodyRows>& rows, int bodies) {
  Eigen::Index count = 0;
  for (const linear::BodyRows& r : rows) count += r.G.rows();
  Mat G = Mat::Zero(count, 6 * bodies);
  count = 0;
  for (const linear::BodyRows& r : rows) {
    for (std::size_t j = 0; j < r.bodies.size(); ++j)
      G.block(count, 6 * r.bodies[j], r.G.rows(), 6) =
          r.G.middleCols(6 * static_cast<Eigen::Index>(j), 6);
    count += r.G.rows();
  }
  return G;
}

/// Rows between bodies in a ring with chords, some of them combinations of earlier ones.
std::vector<linear::BodyRows> ring(int bodies, int chords, int copies, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const auto joint = [&](int a, int b, int count) {
    linear::BodyRows rows{{a, b}, Mat(count, 12)};
    for (double& x : rows.G.reshaped()) x = normal(random);
    rows.G.rowwise().normalize();
    return rows;
  };
  std::vector<linear::BodyRows> list;
  for (int b = 0; b < bodies; ++b) list.push_back(joint(b, (b + 1) % bodies, 4));
  for (int k = 0; k < chords; ++k)
    list.push_back(
        joint(k % bodies,
              (k * 7 + 3) % bodies == k % bodies ? (k + 1) % bodies : (k * 7 + 3) % bodies, 2));
  for (int k = 0; k < copies; ++k) {
    linear::BodyRows again = list[static_cast<std::size_t>(3 * k) % list.size()];
    again.G = Mat(again.G.row(0) + 0.5 * again.G.row(1));
    again.G.rowwise().normalize();
    list.push_back(again);
  }
  return list;
}

TEST(LoopRank, IsThatOfSingularValuesAndNamesTheSameRows) {
  std::mt19937 random(7);
  for (const auto& [bodies, chords, copies] :
       {std::array{3, 0, 0}, {5, 2, 1}, {12, 5, 4}, {30, 20, 9}, {20, 40, 0}}) {
    const std::vector<linear::BodyRows> rows = ring(bodies, chords, copies, random);
    const Mat G = dense(rows, bodies);
    const Eigen::JacobiSVD<Mat> svd(G, Eigen::ComputeFullU);
    const auto rank = (svd.singularValues().array() > 1e-9).count();
    const linear::LoopRank found = linear::loop_rank(rows, bodies, 1e-9);
    EXPECT_EQ(found.rank, rank) << bodies << " bodies";
    // A row is part of a redundancy if a combination that vanishes has it.
    const Mat null = svd.matrixU().rightCols(G.rows() - rank);
    ASSERT_EQ(found.dependent.size(), static_cast<std::size_t>(G.rows()));
    for (Eigen::Index i = 0; i < G.rows(); ++i)
      EXPECT_EQ(found.dependent[static_cast<std::size_t>(i)] != 0, null.row(i).norm() > 1e-7)
          << "row " << i << " of " << bodies << " bodies";
  }
}

// @tests{row-contradiction}
TEST(LoopRank, ProjectsRightSidesOntoTheLeftNullSpace) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  const std::vector<linear::BodyRows> rows = ring(12, 5, 4, random);
  const Mat G = dense(rows, 12);
  const Eigen::JacobiSVD<Mat> svd(G, Eigen::ComputeFullU);
  const Mat null =
      svd.matrixU().rightCols(G.rows() - (svd.singularValues().array() > 1e-9).count());
  ASSERT_GT(null.cols(), 0);
  Vec r(G.rows()), x(G.cols());
  for (double& value : r) value = normal(random);
  for (double& value : x) value = normal(random);
  EXPECT_LE((linear::unreachable_part(rows, 12, 1e-9, r) - null * (null.transpose() * r)).norm(),
            1e-12 * r.norm());
  EXPECT_LE(linear::unreachable_part(rows, 12, 1e-9, G * x).norm(), 1e-12 * x.norm());
}

TEST(LoopRank, ReducesManyRowsOnOneBody) {
  std::mt19937 random(3);
  std::vector<linear::BodyRows> rows;
  for (int k = 0; k < 400; ++k) {
    linear::BodyRows r{{0}, Mat::Random(1, 6)};
    r.G.rowwise().normalize();
    rows.push_back(r);
  }
  const linear::LoopRank found = linear::loop_rank(rows, 1, 1e-9);
  EXPECT_EQ(found.rank, 6);
  EXPECT_EQ(std::count(found.dependent.begin(), found.dependent.end(), 1), 400);
  EXPECT_EQ(linear::loop_rank({}, 3, 1e-9).rank, 0);
}

// One square cell has three redundant rows, a row of cells three each: 10,001 bodies, for which a
// dense factorisation would take days.
TEST(LoopRank, IsLinearAlongARowOfLoops) {
  const int N = 5000;
  const Simulation s(test::n_four_bar(N));
  const RankReport r = rank_report(s.system(), s.state());
  EXPECT_EQ(r.rows, 5 * (3 * N + 1));
  EXPECT_EQ(r.mobility, 1);
  EXPECT_EQ(r.redundant, 3 * N);
  EXPECT_EQ(r.names.size(), static_cast<std::size_t>(3 * N + 1));
}

}  // namespace
}  // namespace polhode::loop_rank_tests
