// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/core/types.hpp>

namespace polhode::test {

/// Rotation or Cayley vectors for tests of laws: zero, tiny, small, general, large.
inline std::vector<Vec3> sample_vectors() {
  return {Vec3::Zero(),         Vec3(1e-9, -2e-9, 5e-10), Vec3(3e-5, 6e-5, -5e-5),
          Vec3(0.0, 0.0, 0.8),  Vec3(0.3, -0.7, 0.5),     Vec3(-1.1, 0.4, 1.6),
          Vec3(1.7, -1.2, -2.2)};
}

/// Largest difference of two matrices or vectors.
inline double distance(const Mat& a, const Mat& b) { return (a - b).cwiseAbs().maxCoeff(); }

}  // namespace polhode::test
