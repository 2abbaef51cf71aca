// SPDX-License-Identifier: Apache-2.0
// How long a full rebuild of the broad phase takes: 1e5 boxes of like size with 8 pairs a body, and
// sizes spread over a ratio of 4 with 22 pairs a body. Prints the best of several rebuilds.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>

#include <polhode/geometry/broad_phase.hpp>

using namespace polhode;

int main() {
  for (const double ratio : {1.0, 4.0}) {
    const int n = 100000;
    std::mt19937 engine(1);
    const auto number = [&] { return static_cast<double>(engine()) / 4294967295.0; };
    const double side = std::cbrt(n / 1.9) * 0.2 * (ratio > 1.0 ? 1.6 : 1.0);
    std::vector<Vec3> centre(n);
    std::vector<double> half(n);
    for (int i = 0; i < n; ++i) {
      centre[i] = side * Vec3(number(), number(), number());
      half[i] = 0.1 * std::pow(ratio, number());
    }
    geometry::BroadPhase broad;
    std::vector<geometry::Bounds> boxes(n);
    std::vector<std::pair<int, int>> pairs;
    double best = 1e9;
    for (int repeat = 0; repeat < 8; ++repeat) {
      for (int i = 0; i < n; ++i) {
        centre[i] += 0.002 * Vec3(number() - 0.5, number() - 0.5, number() - 0.5);
        const Vec3 reach = Vec3::Constant(half[i] + 0.002);
        boxes[i] = {centre[i] - reach, centre[i] + reach};
      }
      const auto start = std::chrono::steady_clock::now();
      broad.find(boxes, pairs);
      const std::chrono::duration<double, std::milli> spent =
          std::chrono::steady_clock::now() - start;
      best = std::min(best, spent.count());
    }
    std::printf("{\"boxes\": %d, \"size_ratio\": %g, \"pairs_per_body\": %.1f, \"ms\": %.1f}\n", n,
                ratio, static_cast<double>(pairs.size()) / n, best);
  }
}
