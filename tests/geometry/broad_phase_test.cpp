// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <polhode/geometry/broad_phase.hpp>

#include "support/random_steps.hpp"

namespace polhode::broad_phase_tests {
namespace {

using geometry::Bounds;
using Pairs = std::vector<std::pair<int, int>>;

Pairs by_trying_all(const std::vector<geometry::Bounds>& boxes) {
  Pairs pairs;
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i)
    for (int j = i + 1; j < static_cast<int>(boxes.size()); ++j)
      if ((boxes[i].low.array() <= boxes[j].high.array()).all() &&
          (boxes[j].low.array() <= boxes[i].high.array()).all())
        pairs.emplace_back(i, j);
  return pairs;
}

Pairs found(const std::vector<geometry::Bounds>& boxes) {
  geometry::BroadPhase broad;
  Pairs pairs;
  broad.find(boxes, pairs);
  std::sort(pairs.begin(), pairs.end());
  EXPECT_EQ(std::adjacent_find(pairs.begin(), pairs.end()), pairs.end()) << "a pair twice";
  return pairs;
}

std::vector<geometry::Bounds> boxes_in_a_cube(int n, double side, double largest, double ratio) {
  test::Random random(7);
  std::vector<geometry::Bounds> boxes;
  for (int i = 0; i < n; ++i) {
    const Vec3 centre = random.vector(0.5 * side);
    const double size = largest * std::pow(ratio, -0.5 * (1.0 + random.number()));
    const Vec3 half = 0.5 * size * (Vec3::Constant(0.7) + 0.3 * random.vector().cwiseAbs());
    boxes.push_back({centre - half, centre + half});
  }
  return boxes;
}

TEST(BroadPhase, AgreesWithTestingAllPairs) {
  for (const double ratio : {1.0, 4.0, 1000.0}) {
    const auto boxes = boxes_in_a_cube(600, 5.0, 0.8, ratio);
    EXPECT_EQ(found(boxes), by_trying_all(boxes)) << ratio;
  }
}

TEST(BroadPhase, HandlesDistantBoxesAndFlatScenes) {
  auto boxes = boxes_in_a_cube(300, 3.0, 0.5, 2.0);
  for (geometry::Bounds& b : boxes) b.low.z() = -0.1, b.high.z() = 0.1;
  boxes.push_back({Vec3::Constant(1e6), Vec3::Constant(1e6 + 1.0)});
  boxes.push_back({Vec3(-1e7, 0, 0), Vec3(-1e7 + 1.0, 1, 1)});
  EXPECT_EQ(found(boxes), by_trying_all(boxes));
  EXPECT_TRUE(found({}).empty());
  EXPECT_TRUE(found({boxes[0]}).empty());
}

TEST(BroadPhase, GivesTheSameOrderAgain) {
  const auto boxes = boxes_in_a_cube(400, 3.0, 0.5, 4.0);
  geometry::BroadPhase one, other;
  Pairs first, second;
  one.find(boxes_in_a_cube(100, 1.0, 0.5, 1.0), first);  // buffers that contain other data
  one.find(boxes, first);
  other.find(boxes, second);
  EXPECT_EQ(first, second);
}

TEST(BroadPhase, LeavesOutBoxesThatAreNotFinite) {
  std::vector<geometry::Bounds> boxes = boxes_in_a_cube(40, 1.0, 0.5, 4.0);
  const Pairs wanted = by_trying_all(boxes);
  for (const double lost : {std::nan(""), HUGE_VAL, -1e200, 1e308}) {
    std::vector<geometry::Bounds> more = boxes;
    more.push_back({Vec3(0.0, lost, 0.0), Vec3(1.0, std::abs(lost), 1.0)});
    EXPECT_EQ(found(more), wanted) << lost;
  }
}

}  // namespace
}  // namespace polhode::broad_phase_tests
