// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>
#include <utility>

#include <polhode/core/assert.hpp>
#include <polhode/geometry/ray.hpp>
#include <polhode/geometry/triangle_tree.hpp>

namespace polhode::geometry {

namespace {

constexpr int kLeaf = 4;

}  // namespace

TriangleTree::TriangleTree(const std::vector<Vec3>& corners,
                           const std::vector<std::array<int, 3>>& triangles) {
  std::vector<Vec3> middles;
  for (const auto& t : triangles) {
    const auto corner = [&](std::size_t k) { return corners[static_cast<std::size_t>(t[k])]; };
    triangles_.push_back({corner(0), corner(1), corner(2)});
    middles.emplace_back((corner(0) + corner(1) + corner(2)) / 3.0);
  }
  order_.resize(triangles.size());
  std::iota(order_.begin(), order_.end(), 0);
  build(middles, 0, static_cast<int>(order_.size()));
  POLHODE_ASSERT(std::accumulate(nodes_.begin(), nodes_.end(), std::size_t{0},
                                 [](std::size_t n, const Node& node) {
                                   return n + static_cast<std::size_t>(node.count);
                                 }) == order_.size());
}

/// Splits the triangles along the longest side of the bounding box of their centres.
void TriangleTree::build(const std::vector<Vec3>& middles, int first, int last) {
  const Vec3 far = Vec3::Constant(std::numeric_limits<double>::infinity());
  Node node{far, -far, first, last - first, 0};
  Vec3 low = far, high = -far;
  for (int k = first; k < last; ++k) {
    const auto t = static_cast<std::size_t>(order_[static_cast<std::size_t>(k)]);
    for (const Vec3& x : triangles_[t]) {
      node.low = node.low.cwiseMin(x);
      node.high = node.high.cwiseMax(x);
    }
    low = low.cwiseMin(middles[t]);
    high = high.cwiseMax(middles[t]);
  }
  const std::size_t here = nodes_.size();
  nodes_.push_back(node);
  if (node.count <= kLeaf) return;
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const int half = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + last,
                   [&](int s, int t) {
                     const double a = middles[static_cast<std::size_t>(s)][axis],
                                  b = middles[static_cast<std::size_t>(t)][axis];
                     return a != b ? a < b : s < t;
                   });
  nodes_[here].count = 0;
  build(middles, first, half);
  nodes_[here].second_child = static_cast<int>(nodes_.size());
  build(middles, half, last);
}

TriangleTree::Hit TriangleTree::nearest(const Vec3& x, double at_most) const {
  Hit hit;
  double least = at_most * at_most;
  std::array<std::pair<int, double>, kDeepest> stack;
  std::size_t depth = 0;
  stack[depth++] = {0, nodes_.front().squared_distance(x)};
  while (depth > 0) {
    const auto [index, squared] = stack[--depth];
    if (!(squared < least)) continue;
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (node.second_child > 0) {
      std::pair<int, double> a{index + 1, 0.0}, b{node.second_child, 0.0};
      a.second = nodes_[static_cast<std::size_t>(a.first)].squared_distance(x);
      b.second = nodes_[static_cast<std::size_t>(b.first)].squared_distance(x);
      if (a.second < b.second) std::swap(a, b);
      stack[depth++] = a;
      stack[depth++] = b;  // the nearer one first
      continue;
    }
    for (int k = node.first; k < node.first + node.count; ++k) {
      const int t = order_[static_cast<std::size_t>(k)];
      const auto& c = triangles_[static_cast<std::size_t>(t)];
      const TriangleRegion region = nearest_on_triangle(x, c[0], c[1], c[2]);
      const double d = (x - region.nearest).squaredNorm();
      if (!(d < least)) continue;
      least = d;
      hit = {t, region, d};
    }
  }
  hit.distance = std::sqrt(hit.distance);
  return hit;
}

std::vector<int> TriangleTree::near(const Vec3& x, double distance) const {
  std::vector<int> found;
  visit([&](const Node& node) { return node.squared_distance(x) <= distance * distance; },
        [&](int t) { found.push_back(t); });
  return found;
}

int TriangleTree::winding(const Vec3& x) const {
  int around = 0;
  visit(
      [&](const Node& node) {
        const Eigen::Array3d enters = (node.low - x).array() / kAnyRay.array(),
                             leaves = (node.high - x).array() / kAnyRay.array();
        return leaves.minCoeff() >= std::max(0.0, enters.maxCoeff());
      },
      [&](int t) {
        const auto& c = triangles_[static_cast<std::size_t>(t)];
        around += crossing(kAnyRay, c[0] - x, c[1] - x, c[2] - x);
      });
  return around;
}

}  // namespace polhode::geometry
