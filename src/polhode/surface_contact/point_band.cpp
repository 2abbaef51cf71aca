// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/surface_contact/point_band.hpp>

namespace polhode {

namespace {

using contact::ContactPhase;
using contact::NormalPotential;

/// Part of its band that is left to what starts at the lower end of it.
constexpr double kLeftOfBand = 0.05;
/// Part that is left to what an impact pressed down there: what is nearer to the floor keeps a
/// little of its energy.
constexpr double kLeftAfterImpact = 1e-4;
constexpr int kHalvings = 60;

}  // namespace

double lowered_for(const SurfaceLaw& law, double gap_at_start) {
  const contact::NormalLaw& normal = law.normal;
  if (normal.potential != NormalPotential::barrier || !(gap_at_start < normal.reach())) return 0.0;
  return std::min(normal.reach() - gap_at_start, (1.0 - kLeftOfBand) * normal.band());
}

SurfaceLaw with_band_lowered(const SurfaceLaw& law, double by) {
  SurfaceLaw own = law;
  if (by == 0.0) return own;
  own.normal.lower = law.normal.floor();
  own.normal.upper = law.normal.reach() - by;
  own.normal.stiffness *= law.normal.band() / own.normal.band();
  return own;
}

/// With x = gap − floor and k d̂ as it is, b = (k d̂/3)(d̂ − x)³/(d̂ x) grows with d̂.
double lowered_to_store(const SurfaceLaw& law, double gap, double energy, double most) {
  const contact::NormalLaw& normal = law.normal;
  const double x = gap - normal.floor(), whole = normal.band();
  double high = whole - most, low = std::min(high, std::max(x, kLeftAfterImpact * whole));
  const auto stored = [&](double band) {
    const double rest = std::max(0.0, band - x);
    return normal.stiffness * whole / 3.0 * rest * rest * rest / (band * x);
  };
  for (int k = 0; k < kHalvings && energy > 0.0; ++k) {
    const double middle = 0.5 * (low + high);
    (stored(middle) > energy ? high : low) = middle;
  }
  return whole - low;
}

PointPhase PointPhase::in_step(const SurfaceLaw& law, double gap, double speed) const {
  PointPhase now = *this;
  if (law.normal.potential != NormalPotential::barrier || !open()) return now;
  const SurfaceLaw own = with_band_lowered(law, lowered);
  now.set(ContactPhase::rest);
  if (!(gap >= own.normal.reach() && speed < 0.0)) return now;
  now.set(ContactPhase::compression);
  now.restitution = 1.0 - 2.0 * law.end_share;
  return now;
}

PointPhase PointPhase::at_end(const SurfaceLaw& law, double gap) const {
  PointPhase then = *this;
  const double reach = law.normal.reach();
  if (!(gap < reach - lowered)) then.phase = then.restitution = 0.0;
  if (!(gap < reach)) then.lowered = 0.0;
  return then;
}

double PointPhase::turn(const SurfaceLaw& law, double gap) {
  if (open()) return 0.0;
  const bool first = is(ContactPhase::compression);
  const double e = restitution;
  set(first && e > 0.0 ? ContactPhase::restitution : ContactPhase::rest);
  if (!first || e == 1.0) return 0.0;
  const double energy = with_band_lowered(law, lowered).normal.energy(gap);
  lowered = lowered_to_store(law, gap, e * e * energy, lowered);
  return energy - with_band_lowered(law, lowered).normal.energy(gap);
}

SurfaceLaw PointPhase::law(const SurfaceLaw& law) const {
  SurfaceLaw own = with_band_lowered(law, lowered);
  if (!in_impact()) return own;
  own.mu = 0.0;
  own.end_share = is(ContactPhase::compression) && restitution == 0.0 ? 1.0 : 0.0;
  return own;
}

}  // namespace polhode
