// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

#include <polhode/linear/kkt.hpp>

namespace polhode::test {

/// Pseudo-random numbers between -1 and 1, the same on every machine.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : engine_(seed) {}
  double operator()() { return 2.0 * static_cast<double>(engine_()) / 4294967295.0 - 1.0; }
  int below(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }

 private:
  std::mt19937 engine_;
};

inline void add_pair(linear::KktTopology& t, int a, int b, int rows) {
  t.pairs.push_back({a, b, rows, t.rows});
  t.rows += rows;
}

/// Values like those of a mechanism: bodies near the unit matrix, B near Gᵀ, exact rows.
inline linear::KktValues random_values(const linear::KktTopology& topology, Numbers& number) {
  const auto fill = [&](auto& m, double size) {
    for (int i = 0; i < m.rows(); ++i)
      for (int j = 0; j < m.cols(); ++j) m(i, j) = size * number();
  };
  linear::KktValues values;
  for (int b = 0; b < topology.bodies; ++b) {
    Mat6 K;
    fill(K, 0.05);
    values.diagonal.push_back(K + Mat6::Identity());
  }
  for (std::size_t p = 0; p < topology.pairs.size(); ++p) {
    linear::KktValues::Pair v;
    fill(v.K_ab, 0.05);
    fill(v.K_ba, 0.05);
    fill(v.G_a, 1.0);
    fill(v.G_b, 1.0);
    fill(v.B_a, 0.01);
    fill(v.B_b, 0.01);
    v.B_a += v.G_a.transpose();
    v.B_b += v.G_b.transpose();
    v.C.setConstant(1e-12);
    values.pairs.push_back(v);
  }
  return values;
}

}  // namespace polhode::test
