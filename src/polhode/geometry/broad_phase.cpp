// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/geometry/broad_phase.hpp>

namespace polhode::geometry {

namespace {

/// Largest number of grid cells per box: a scene with outliers gets larger cells.
constexpr double kCellsPerBox = 4.0;

/// Farthest coordinate of a box: differences of two and their products are finite [m].
constexpr double kFarthest = 1e150;

bool is_placed(const Bounds& box) {
  return (box.low.array().abs() < kFarthest).all() && (box.high.array().abs() < kFarthest).all();
}

float rounded_down(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) <= x ? f
                                     : std::nextafter(f, -std::numeric_limits<float>::infinity());
}
float rounded_up(double x) { return -rounded_down(-x); }

}  // namespace

void BroadPhase::fill(SizeClass& c, std::span<const Bounds> boxes,
                      const std::vector<int>& members) {
  const auto n = static_cast<int>(members.size());
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  double size = 0.0;
  for (int i : members) {
    const Vec3 centre = 0.5 * (boxes[i].low + boxes[i].high);
    low = low.cwiseMin(centre);
    high = high.cwiseMax(centre);
    size = std::max(size, (boxes[i].high - boxes[i].low).maxCoeff());
  }
  c.origin = low;
  c.cell = std::max(size * (1.0 + 1e-6), std::numeric_limits<double>::min());
  const auto cells = [&] {
    double product = 1.0;
    for (int k = 0; k < 3; ++k) product *= std::floor((high[k] - low[k]) / c.cell) + 1.0;
    return product;
  };
  while (cells() > kCellsPerBox * n + 64.0) c.cell *= 1.25;
  for (int k = 0; k < 3; ++k) c.count[k] = static_cast<int>((high[k] - low[k]) / c.cell) + 1;

  const double per_cell = 1.0 / c.cell;
  c.start.assign(static_cast<std::size_t>(c.count[0]) * c.count[1] * c.count[2] + 1, 0);
  cell_of_.resize(static_cast<std::size_t>(n));
  for (int m = 0; m < n; ++m) {
    const Bounds& box = boxes[members[m]];
    int at[3];
    for (int k = 0; k < 3; ++k)
      at[k] = std::min(c.count[k] - 1,
                       static_cast<int>((0.5 * (box.low[k] + box.high[k]) - low[k]) * per_cell));
    cell_of_[m] = (at[2] * c.count[1] + at[1]) * c.count[0] + at[0];
    ++c.start[cell_of_[m] + 1];
  }
  for (std::size_t k = 1; k < c.start.size(); ++k) c.start[k] += c.start[k - 1];
  c.id.resize(static_cast<std::size_t>(n));
  for (int k = 0; k < 3; ++k) {
    c.low[k].resize(static_cast<std::size_t>(n));
    c.high[k].resize(static_cast<std::size_t>(n));
  }
  std::vector<int> next(c.start.begin(), c.start.end() - 1);
  for (int m = 0; m < n; ++m) {
    const int at = next[cell_of_[m]]++;
    c.id[at] = members[m];
    for (int k = 0; k < 3; ++k) {
      c.low[k][at] = rounded_down(boxes[members[m]].low[k]);
      c.high[k][at] = rounded_up(boxes[members[m]].high[k]);
    }
  }
}

void BroadPhase::test(const SizeClass& of, int box, const SizeClass& in, int first, int last,
                      std::vector<std::pair<int, int>>& pairs) {
  if (first >= last) return;
  if (hits_.size() < static_cast<std::size_t>(last - first))
    hits_.resize(static_cast<std::size_t>(last - first));
  const float lx = of.low[0][box], ly = of.low[1][box], lz = of.low[2][box];
  const float hx = of.high[0][box], hy = of.high[1][box], hz = of.high[2][box];
  const float *ax = in.low[0].data(), *ay = in.low[1].data(), *az = in.low[2].data();
  const float *bx = in.high[0].data(), *by = in.high[1].data(), *bz = in.high[2].data();
  int count = 0;
  for (int j = first; j < last; ++j) {
    hits_[count] = j;
    count += (ax[j] <= hx) & (lx <= bx[j]) & (ay[j] <= hy) & (ly <= by[j]) & (az[j] <= hz) &
             (lz <= bz[j]);
  }
  const int i = of.id[box];
  for (int k = 0; k < count; ++k) {
    const int j = in.id[hits_[k]];
    pairs.emplace_back(std::min(i, j), std::max(i, j));
  }
}

/// Cells adjacent in x are adjacent in memory: four sections instead of 13 cells.
void BroadPhase::within(const SizeClass& c, std::vector<std::pair<int, int>>& pairs) {
  static constexpr int kRows[4][2] = {{1, 0}, {-1, 1}, {0, 1}, {1, 1}};  // dy, dz
  for (int z = 0; z < c.count[2]; ++z)
    for (int y = 0; y < c.count[1]; ++y)
      for (int x = 0; x < c.count[0]; ++x) {
        const int cell = (z * c.count[1] + y) * c.count[0] + x;
        const int right = x + 1 < c.count[0] ? cell + 2 : cell + 1;
        for (int box = c.start[cell]; box < c.start[cell + 1]; ++box) {
          test(c, box, c, box + 1, c.start[right], pairs);
          for (const auto& row : kRows) {
            const int yy = y + row[0], zz = z + row[1];
            if (yy < 0 || yy >= c.count[1] || zz >= c.count[2]) continue;
            const int base = (zz * c.count[1] + yy) * c.count[0];
            const int from = base + std::max(0, x - 1), to = base + std::min(c.count[0], x + 2);
            test(c, box, c, c.start[from], c.start[to], pairs);
          }
        }
      }
}

void BroadPhase::between(const SizeClass& small, const SizeClass& large,
                         std::vector<std::pair<int, int>>& pairs) {
  const double per_cell = 1.0 / large.cell;
  for (int box = 0; box < static_cast<int>(small.id.size()); ++box) {
    int from[3], to[3];
    bool any = true;
    for (int k = 0; k < 3; ++k) {
      // Centres of partners are at most half a cell beyond the box.
      const double low = (static_cast<double>(small.low[k][box]) - large.origin[k]) * per_cell;
      const double high = (static_cast<double>(small.high[k][box]) - large.origin[k]) * per_cell;
      from[k] = std::max(0, static_cast<int>(std::floor(std::clamp(low - 0.51, -1.0, 1e9))));
      to[k] = std::min(large.count[k] - 1,
                       static_cast<int>(std::floor(std::clamp(high + 0.51, -1.0, 1e9))));
      any = any && from[k] <= to[k];
    }
    if (!any) continue;
    for (int z = from[2]; z <= to[2]; ++z)
      for (int y = from[1]; y <= to[1]; ++y) {
        const int base = (z * large.count[1] + y) * large.count[0];
        test(small, box, large, large.start[base + from[0]], large.start[base + to[0] + 1], pairs);
      }
  }
}

void BroadPhase::find(std::span<const Bounds> boxes, std::vector<std::pair<int, int>>& pairs) {
  pairs.clear();
  if (boxes.empty()) return;
  double least = std::numeric_limits<double>::infinity();
  for (const Bounds& b : boxes)
    if (is_placed(b)) least = std::min(least, (b.high - b.low).maxCoeff());
  least = std::max(least, std::numeric_limits<double>::min());
  members_.clear();
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
    if (!is_placed(boxes[i])) continue;  // of a motion that is lost: no cell can be computed
    // The smallest size is in the middle of its class: similar sizes fall into one.
    const double ratio = (boxes[i].high - boxes[i].low).maxCoeff() / least;
    const auto c = static_cast<std::size_t>(std::clamp(std::log2(ratio) + 0.5, 0.0, 60.0));
    if (c >= members_.size()) members_.resize(c + 1);
    members_[c].push_back(i);
  }
  std::erase_if(members_, [](const std::vector<int>& m) { return m.empty(); });
  classes_.resize(members_.size());
  for (std::size_t c = 0; c < members_.size(); ++c) fill(classes_[c], boxes, members_[c]);
  for (std::size_t c = 0; c < classes_.size(); ++c) {
    within(classes_[c], pairs);
    for (std::size_t d = c + 1; d < classes_.size(); ++d) between(classes_[c], classes_[d], pairs);
  }
}

}  // namespace polhode::geometry
