// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include <polhode/solids/mesh/coincident.hpp>

namespace polhode::solids {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0x2545F4914F6CDD1DULL;
    for (std::int64_t c : cell) {
      hash = (hash ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15ULL;
      hash ^= hash >> 31;
    }
    return static_cast<std::size_t>(hash);
  }
};

}  // namespace

std::vector<int> first_coincident(const std::vector<Vec3>& points, double distance) {
  std::vector<int> first(points.size());
  if (points.empty()) return first;
  Vec3 least = points[0], most = points[0];
  for (const Vec3& x : points) {
    least = least.cwiseMin(x);
    most = most.cwiseMax(x);
  }
  // Cells wide enough that their numbers do not overflow, and few points search more than one.
  const double reach = std::max(distance, 0.0);
  const double extent = (most - least).maxCoeff();
  const double width = std::max({8.0 * reach, 1e-14 * extent, 1e-290});
  const auto cell_of = [&](double x, int k) {
    return static_cast<std::int64_t>(std::floor((x - least[k]) / width));
  };
  // Points are stored in chains by cell, newest first.
  std::unordered_map<Cell, int, CellHash> newest;
  newest.reserve(points.size());
  std::vector<int> next(points.size(), -1);
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const Vec3& x = points[i];
    Cell from, to;
    for (int k = 0; k < 3; ++k) {
      from[k] = cell_of(x[k] - reach, k);
      to[k] = cell_of(x[k] + reach, k);
    }
    int found = i;
    for (std::int64_t a = from[0]; a <= to[0]; ++a)
      for (std::int64_t b = from[1]; b <= to[1]; ++b)
        for (std::int64_t c = from[2]; c <= to[2]; ++c) {
          const auto entry = newest.find({a, b, c});
          if (entry == newest.end()) continue;
          for (int j = entry->second; j >= 0; j = next[j])
            if (j < found && (points[j] - x).norm() <= reach) found = j;
        }
    first[i] = found;
    if (found != i) continue;
    auto& head = newest.try_emplace({cell_of(x[0], 0), cell_of(x[1], 1), cell_of(x[2], 2)}, -1)
                     .first->second;
    next[i] = head;
    head = i;
  }
  return first;
}

}  // namespace polhode::solids
