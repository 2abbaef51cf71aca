// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/system/regular_state.hpp>

namespace polhode {

namespace {

/// Allowed error of the length of a quaternion [-].
constexpr double kUnit = 1e-12;

bool is_regular(const BodyBlock& block, int lane) {
  double square = 0.0;
  for (const auto& q : block.q) square += q[lane] * q[lane];
  if (!(std::abs(square - 1.0) < kUnit)) return false;
  for (int i = 0; i < 3; ++i)
    if (!std::isfinite(block.r[i][lane]) || !std::isfinite(block.v[i][lane]) ||
        !std::isfinite(block.W[i][lane]))
      return false;
  return true;
}

bool all_finite(const std::vector<double>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

bool is_regular(const State& state) {
  for (const BodyBlock& block : state.blocks)
    for (int lane = 0; lane < kLanes; ++lane)
      if (!is_regular(block, lane)) return false;
  return all_finite(state.lambda) && all_finite(state.node_x) && all_finite(state.node_v);
}

}  // namespace polhode
