// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/linear/block_cg.hpp>

namespace polhode::linear {

inline BlockCg::Four BlockCg::cross(Four a, Four b) {
  const Four turned =
      a * __builtin_shufflevector(b, b, 1, 2, 0, 3) - __builtin_shufflevector(a, a, 1, 2, 0, 3) * b;
  return __builtin_shufflevector(turned, turned, 1, 2, 0, 3);
}

inline BlockCg::Pair BlockCg::times(const Block& block, const Pair& x) {
  Pair y{x.moved[0] * block.column[0].moved, x.moved[0] * block.column[0].turned};
  for (int k = 1; k < 6; ++k) {
    const float s = k < 3 ? x.moved[k] : x.turned[k - 3];
    y.moved += s * block.column[k].moved;
    y.turned += s * block.column[k].turned;
  }
  return y;
}

inline void BlockCg::narrow(const Mat6& from, Block& to) {
  for (int j = 0; j < 6; ++j) {
    to.column[j] = Pair{};
    for (int i = 0; i < 3; ++i) {
      to.column[j].moved[i] = static_cast<float>(from(i, j));
      to.column[j].turned[i] = static_cast<float>(from(3 + i, j));
    }
  }
}

inline Mat6 BlockCg::widened(const Block& block) {
  Mat6 M;
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 3; ++i) {
      M(i, j) = block.column[j].moved[i];
      M(3 + i, j) = block.column[j].turned[i];
    }
  return M;
}

inline void BlockCg::add(const Pair& x, Pair& to) {
  to.moved += x.moved;
  to.turned += x.turned;
}

inline double BlockCg::dot(const Pair& x, const Pair& y) {
  const Four s = x.moved * y.moved + x.turned * y.turned;
  return (static_cast<double>(s[0]) + static_cast<double>(s[1])) +
         (static_cast<double>(s[2]) + static_cast<double>(s[3]));
}

}  // namespace polhode::linear
