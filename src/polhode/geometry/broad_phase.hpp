// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>
#include <vector>

#include <polhode/core/types.hpp>

namespace polhode::geometry {

/// An axis-parallel box in the world.
struct Bounds {
  Vec3 low, high;
};

/// Search for pairs of overlapping boxes, by one grid for every class of sizes (ratio 2).
///
/// Boxes are stored in the cell of their centre; a cell is as large as the largest box of its
/// class, so partners are in neighbouring cells. The order of the pairs depends on the boxes alone.
/// Buffers are reused from call to call.
class BroadPhase {
 public:
  /// Finds pairs (i, j), i < j, of boxes that overlap or touch. Rounding may add pairs that are
  /// apart by a ten-millionth of the scene. A box that is not finite meets none.
  void find(std::span<const Bounds> boxes, std::vector<std::pair<int, int>>& pairs);

 private:
  struct SizeClass {
    double cell = 0.0;
    Vec3 origin = Vec3::Zero();
    int count[3] = {1, 1, 1};
    std::vector<int> start;  ///< First box of each cell; x fastest.
    std::vector<int> id;     ///< By position.
    std::vector<float> low[3], high[3];
  };
  void fill(SizeClass& c, std::span<const Bounds> boxes, const std::vector<int>& members);
  void within(const SizeClass& c, std::vector<std::pair<int, int>>& pairs);
  void between(const SizeClass& small, const SizeClass& large,
               std::vector<std::pair<int, int>>& pairs);
  void test(const SizeClass& of, int box, const SizeClass& in, int first, int last,
            std::vector<std::pair<int, int>>& pairs);

  std::vector<SizeClass> classes_;
  std::vector<std::vector<int>> members_;
  std::vector<int> cell_of_, hits_;
};

}  // namespace polhode::geometry
