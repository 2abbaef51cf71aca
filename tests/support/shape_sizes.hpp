// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include <polhode/geometry/shapes.hpp>

namespace polhode::test {

/// Sizes for any kind of shape: as many of the lengths as it has, in the first permutation that it
/// accepts.
/// @param lengths  All different [m]; at least as many as sizes.
[[nodiscard]] inline std::vector<double> fitting_sizes(const geometry::ShapeKind& kind,
                                                       std::vector<double> lengths) {
  lengths.resize(kind.sizes.size());
  const std::vector<double> first = lengths;
  while (kind.misfit && !kind.misfit(lengths).empty()) {
    std::next_permutation(lengths.begin(), lengths.end());
    if (lengths == first) return {};
  }
  return lengths;
}

}  // namespace polhode::test
