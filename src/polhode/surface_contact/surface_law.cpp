// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/surface_contact/surface_law.hpp>

namespace polhode {

namespace {

/// Part of its band that is left to what starts at the lower end of it.
constexpr double kLeftOfBand = 0.05;

}  // namespace

double SurfaceLaw::lowered_for(double gap_at_start) const {
  if (normal.potential != contact::NormalPotential::barrier || !(gap_at_start < normal.reach()))
    return 0.0;
  return std::min(normal.reach() - gap_at_start, (1.0 - kLeftOfBand) * normal.band());
}

SurfaceLaw SurfaceLaw::with_band_lowered(double by) const {
  SurfaceLaw law = *this;
  if (by == 0.0) return law;
  law.normal.lower = normal.floor();
  law.normal.upper = normal.reach() - by;
  law.normal.stiffness *= normal.band() / law.normal.band();
  return law;
}

}  // namespace polhode
