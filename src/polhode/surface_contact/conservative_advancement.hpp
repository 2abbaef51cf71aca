// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace polhode::surface_contact {

/// Part of the initial clearance that remains in front of a surface at the end of a displacement.
inline constexpr double kLeave = 0.1;
/// Largest number of advances along a displacement, each as long as the distance allows.
inline constexpr int kMaxAdvances = 200;

/// Largest part of a displacement, at most `most`, on which features do not come nearer than
/// `least`, by conservative advancement.
/// @param distance  At the start of the displacement [m].
/// @param length  Upper bound of the approach on all of it [m]. @param clearance  (part of the
/// displacement) → distance there.
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

}  // namespace polhode::surface_contact
