// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>
#include <polhode/system/body_block.hpp>

namespace polhode {

/// Vector of one of eight bodies.
[[nodiscard]] inline Vec3 get(const Lane3& x, int lane) {
  return {x[0][lane], x[1][lane], x[2][lane]};
}

inline void put(Lane3& x, int lane, const Vec3& value) {
  for (int i = 0; i < 3; ++i) x[i][lane] = value[i];
}

/// Matrix of one of eight bodies, stored row by row.
[[nodiscard]] inline Mat3 get(const double (&x)[9][kLanes], int lane) {
  Mat3 M;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) M(i, j) = x[3 * i + j][lane];
  return M;
}

inline void put(double (&x)[9][kLanes], int lane, const Mat3& M) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) x[3 * i + j][lane] = M(i, j);
}

}  // namespace polhode
