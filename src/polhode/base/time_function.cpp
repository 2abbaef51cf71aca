// SPDX-License-Identifier: Apache-2.0
#include <polhode/base/time_function.hpp>

#include <algorithm>
#include <cmath>

namespace polhode {

TimeBounds TimeFunction::bounds(double from, double to) const {
  constexpr int kParts = 64;
  const double h = (to - from) / kParts;
  TimeBounds bounds;
  double before = 0.0, last = 0.0;
  for (int k = 0; k <= kParts; ++k) {
    const double now = (*this)(from + h * k);
    bounds.size = std::max(bounds.size, std::abs(now));
    if (k > 1 && h > 0.0)
      bounds.curvature = std::max(bounds.curvature, std::abs(now - 2.0 * last + before) / (h * h));
    before = last;
    last = now;
  }
  return bounds;
}

}  // namespace polhode
