// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/linear/block_lu.hpp>
#include <polhode/linear/block_lu_kernels.hpp>
#include <polhode/linear/block_lu_order.hpp>

#include "linear/random_kkt.hpp"

namespace polhode::block_lu_tests {
namespace {

using test::add_pair;

linear::KktTopology revolute_chain(int n) {
  linear::KktTopology t;
  t.bodies = n;
  for (int i = 0; i < n; ++i) add_pair(t, i == 0 ? kGround : i - 1, i, 5);
  return t;
}

TEST(GatherNodes, GroupsEachBodyWithTheJointToItsParent) {
  const linear::NodeGraph graph = linear::gather_nodes(revolute_chain(4));
  EXPECT_EQ(graph.width, (std::vector<int>{11, 11, 11, 11}));
  EXPECT_EQ(graph.row_node, (std::vector<int>{0, 1, 2, 3}));
}

TEST(GatherNodes, EliminatesLoopRowsAfterBothBodies) {
  linear::KktTopology t = revolute_chain(3);
  add_pair(t, 2, 0, 1);
  const linear::NodeGraph graph = linear::gather_nodes(t);
  ASSERT_EQ(graph.width.size(), 4u);
  EXPECT_EQ(graph.width[3], 1);
  const linear::EliminationOrder order = linear::eliminate_least_degree_first(graph);
  EXPECT_GT(order.position[3], order.position[0]);
  EXPECT_GT(order.position[3], order.position[2]);
}

TEST(EliminationOrder, MakesNoFillInATree) {
  linear::KktTopology t;
  t.bodies = 63;
  for (int i = 0; i < 63; ++i) add_pair(t, i == 0 ? kGround : (i - 1) / 2, i, 3);
  const linear::EliminationOrder order =
      linear::eliminate_least_degree_first(linear::gather_nodes(t));
  std::size_t edges = 0;
  for (const auto& later : order.later) edges += later.size();
  EXPECT_EQ(edges, 62u);
}

TEST(BlockLu, CountsWorkInProportionToTheLengthOfAChain) {
  linear::BlockLu short_chain, long_chain;
  short_chain.analyse(revolute_chain(100));
  long_chain.analyse(revolute_chain(200));
  EXPECT_NEAR(long_chain.factor_flops() / short_chain.factor_flops(), 2.0, 0.02);
}

/// With fused multiply-add the last digits depend on the processor.
TEST(BlockLu, DoesWithoutFusedMultiplyAddOnRequest) {
  if (!linear::has_fused_kernels()) GTEST_SKIP() << "this processor has none";
  linear::KktTopology topology = revolute_chain(20);
  test::Numbers number(3);
  const linear::KktValues values = test::random_values(topology, number);
  const auto solution = [&](bool fused) {
    topology.fused = fused;
    linear::BlockLu lu;
    lu.analyse(topology);
    EXPECT_TRUE(lu.factor(values));
    Vec x = Vec::LinSpaced(6 * topology.bodies + topology.rows, -1.0, 2.0);
    lu.solve(x);
    return x;
  };
  const Vec with = solution(true), without = solution(false);
  EXPECT_LT((with - without).lpNorm<Eigen::Infinity>(), 1e-10 * without.lpNorm<Eigen::Infinity>());
#ifdef NDEBUG  // Compilers fuse in optimised code only.
  EXPECT_NE(with, without);
#endif
}

}  // namespace
}  // namespace polhode::block_lu_tests
