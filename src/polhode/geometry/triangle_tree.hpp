// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <vector>

#include <polhode/geometry/nearest.hpp>

namespace polhode::geometry {

/// Bounding volume hierarchy of triangles: a search for triangles near a point. The results depend
/// on the triangles alone.
class TriangleTree {
 public:
  TriangleTree(const std::vector<Vec3>& corners, const std::vector<std::array<int, 3>>& triangles);

  /// Nearest triangle of a point; of several the first in the tree.
  struct Hit {
    int triangle = -1;  ///< −1: none within the limit.
    TriangleRegion region;
    double distance = std::numeric_limits<double>::infinity();  ///< [m]
  };
  /// Finds the nearest triangle. @param at_most  Farther triangles are ignored [m].
  [[nodiscard]] Hit nearest(const Vec3& x, double at_most) const;

  /// Triangles whose bounding boxes are within `distance` of a point, and possibly others.
  [[nodiscard]] std::vector<int> near(const Vec3& x, double distance) const;

  /// Winding number of a closed surface about a point: 1 inside, 0 outside, 2 where two parts of it
  /// overlap; in cavities 0.
  [[nodiscard]] int winding(const Vec3& x) const;

  /// Calls use(triangle) for those in leaves that, like all their ancestors, satisfy meets(box)
  /// with the box's `low` and `high`.
  template <class Meets, class Use>
  void visit(Meets&& meets, Use&& use) const;

  [[nodiscard]] const Vec3& low() const { return nodes_.front().low; }  ///< Of all triangles [m].
  [[nodiscard]] const Vec3& high() const { return nodes_.front().high; }

 private:
  struct Node {
    Vec3 low, high;
    int first = 0, count = 0;  ///< Of a leaf: into order_.
    int second_child = 0;      ///< Otherwise; the first child follows its parent.
    [[nodiscard]] double squared_distance(const Vec3& x) const {
      return (low - x).cwiseMax(x - high).cwiseMax(0.0).squaredNorm();
    }
  };
  void build(const std::vector<Vec3>& middles, int first, int last);
  /// Bound of the depth: 2^31 triangles need fewer levels.
  static constexpr int kDeepest = 64;

  std::vector<std::array<Vec3, 3>> triangles_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

template <class Meets, class Use>
void TriangleTree::visit(Meets&& meets, Use&& use) const {
  std::array<int, kDeepest> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const int index = stack[--depth];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (!meets(node)) continue;
    if (node.second_child > 0) {
      stack[depth++] = node.second_child;
      stack[depth++] = index + 1;
      continue;
    }
    for (int k = node.first; k < node.first + node.count; ++k)
      use(order_[static_cast<std::size_t>(k)]);
  }
}

}  // namespace polhode::geometry
