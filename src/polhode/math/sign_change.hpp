// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace polhode {

/// Zero of a function between two places where its signs are opposite, by the Illinois variant of
/// regula falsi (Dowell and Jarratt 1971), with a bisection every eighth time.
///
/// @param f_low, f_high  Its values at low and high.
/// @param enough  Absolute value at which the search ends.
template <class Function>
[[nodiscard]] double sign_change(const Function& f, double low, double high, double f_low,
                                 double f_high, double enough) {
  constexpr int kMaxCount = 100, kBisection = 8;
  double t = 0.5 * (low + high);
  for (int k = 0, side = 0; k < kMaxCount && high - low > 1e-15; ++k) {
    t = k % kBisection == kBisection - 1 ? 0.5 * (low + high)
                                         : (low * f_high - high * f_low) / (f_high - f_low);
    const double f_t = f(t);
    if (std::abs(f_t) < enough) break;
    if ((f_t < 0.0) == (f_low < 0.0)) {
      low = t, f_low = f_t;
      if (side == -1) f_high *= 0.5;
      side = -1;
    } else {
      high = t, f_high = f_t;
      if (side == 1) f_low *= 0.5;
      side = 1;
    }
  }
  return t;
}

}  // namespace polhode
