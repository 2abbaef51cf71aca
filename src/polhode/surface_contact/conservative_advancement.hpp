// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace polhode {

/// What is left in front of a surface at the end of a way, of what there was at its start.
inline constexpr double kLeave = 0.1;
/// Ways are followed by advances of the distance's own size, at most so many.
inline constexpr int kMaxAdvances = 200;

/// The part of a way, at most `most`, on which features do not come nearer than `least`, followed
/// by advances of their distance.
/// @param distance  At the start of the way [m].
/// @param length    They come nearer by no more than this on all of it [m].
/// @param room      (part of the way) → distance there.
template <class Clearance>
[[nodiscard]] double conservative_advancement(double most, double distance, double least,
                                              double length, Clearance&& clearance) {
  if (distance - least >= length * most) return most;
  double part = 0.0;
  for (int k = 0; k < kMaxAdvances && part < most; ++k) {
    part += (distance - least) / length;
    distance = clearance(std::min(part, most));
    if (distance <= least) break;
  }
  return std::min(most, part);
}

}  // namespace polhode
