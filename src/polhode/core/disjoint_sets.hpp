// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace polhode {

/// Connected components of numbered items (union-find with path halving: Tarjan and van Leeuwen,
/// J. ACM 31, 1984). The smallest number of a component represents it.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t items = 0) : parent_(items) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  /// Smallest item of the component of an item.
  [[nodiscard]] int first_of(int item) {
    while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
    return item;
  }
  /// Makes one component of those of two items.
  void join(int a, int b) {
    const int x = first_of(a), y = first_of(b);
    parent_[std::max(x, y)] = std::min(x, y);
  }

 private:
  std::vector<int> parent_;
};

}  // namespace polhode
