// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/disjoint_sets.hpp>

namespace polhode {
namespace {

std::vector<int> first_of_all(DisjointSets& sets, int items) {
  std::vector<int> first;
  for (int i = 0; i < items; ++i) first.push_back(sets.first_of(i));
  return first;
}

TEST(DisjointSets, AreSingleItemsAtTheStart) {
  DisjointSets sets(3);
  EXPECT_EQ(first_of_all(sets, 3), (std::vector<int>{0, 1, 2}));
}

TEST(DisjointSets, AreRepresentedByTheirSmallestItemInAnyOrderOfJoining) {
  DisjointSets sets(7), reversed(7);
  const std::vector<std::pair<int, int>> joins{{5, 6}, {3, 5}, {1, 4}, {6, 4}, {5, 1}};
  for (std::size_t i = 0; i < joins.size(); ++i) {
    sets.join(joins[i].first, joins[i].second);
    const auto& back = joins[joins.size() - 1 - i];
    reversed.join(back.second, back.first);
  }
  const std::vector<int> expected{0, 1, 2, 1, 1, 1, 1};
  EXPECT_EQ(first_of_all(sets, 7), expected);
  EXPECT_EQ(first_of_all(reversed, 7), expected);
}

}  // namespace
}  // namespace polhode
