// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/surface_contact/point_band.hpp>

namespace polhode::surface_contact {

namespace {

using contact::ContactPhase;

/// Part of its band that remains for a point that starts at the lower end of it.
constexpr double kLeftOfBand = 0.05;
/// Part that remains for a point that an impact pressed down there; one nearer to the floor keeps a
/// little of its energy.
constexpr double kLeftAfterImpact = 1e-4;
constexpr int kHalvings = 60;

}  // namespace

double lowered_for(const SurfaceLaw& law, double gap_at_start) {
  const contact::NormalLaw& normal = law.normal;
  if (normal.is_spring() || !(gap_at_start < normal.reach())) return 0.0;
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

SurfaceLaw beginning_later(const SurfaceLaw& law, double by) {
  SurfaceLaw own = law;
  if (by != 0.0) own.normal.later = law.normal.reach() - by;
  return own;
}

namespace {

double energy_of(const contact::NormalLaw& law, std::span<const GapTerm> terms) {
  double sum = 0.0;
  for (const GapTerm& t : terms) sum += t.weight * law.energy(t.gap);
  return sum;
}

double force_of(const contact::NormalLaw& law, std::span<const GapTerm> terms) {
  double sum = 0.0;
  for (const GapTerm& t : terms) sum += t.weight * law.force(t.gap);
  return sum;
}

/// Height above the floor of the deepest term that counts; the whole band if none does.
double least_height(const SurfaceLaw& law, std::span<const GapTerm> terms) {
  double least = law.normal.band();
  for (const GapTerm& t : terms)
    if (t.weight > 0.0) least = std::min(least, t.gap - law.normal.floor());
  return least;
}

}  // namespace

/// b(g) at a fixed gap increases with the upper end of the band.
double lowered_to_store(const SurfaceLaw& law, std::span<const GapTerm> terms, double energy,
                        double least, LoweredLaw own) {
  const double x = least_height(law, terms), whole = law.normal.band();
  double low = least, high = std::max(low, whole - std::max(x, kLeftAfterImpact * whole));
  for (int k = 0; k < kHalvings && energy > 0.0; ++k) {
    const double middle = 0.5 * (low + high);
    (energy_of(own(law, middle).normal, terms) > energy ? low : high) = middle;
  }
  return high;
}

/// f(g) at a fixed gap does so too.
double lowered_to_press(const SurfaceLaw& law, std::span<const GapTerm> terms, double pressure,
                        double least, LoweredLaw own) {
  const double whole = law.normal.band();
  double low = least, high = std::max(low, whole - least_height(law, terms));
  if (!(pressure > 0.0)) return high;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (force_of(own(law, middle).normal, terms) > pressure ? low : high) = middle;
  }
  return high;
}

PointPhase PointPhase::in_step(const SurfaceLaw& law, double gap, double speed,
                               LoweredLaw own) const {
  PointPhase now = *this;
  if (law.normal.is_spring() || !open()) return now;
  now.set(ContactPhase::rest);
  if (!(gap >= own(law, lowered).normal.reach() && speed < 0.0)) return now;
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

double PointPhase::turn(const SurfaceLaw& law, std::span<const GapTerm> terms, double held,
                        LoweredLaw own) {
  if (open()) return 0.0;
  const bool first = is(ContactPhase::compression);
  const double e = restitution;
  set(first && e > 0.0 ? ContactPhase::restitution : ContactPhase::rest);
  if (!first || e == 1.0) return 0.0;
  const double energy = energy_of(own(law, lowered).normal, terms);
  lowered = std::min(lowered_to_store(law, terms, e * e * energy, lowered, own),
                     lowered_to_press(law, terms, held, lowered, own));
  return energy - energy_of(own(law, lowered).normal, terms);
}

SurfaceLaw PointPhase::law(const SurfaceLaw& law, LoweredLaw own) const {
  SurfaceLaw now = own(law, lowered);
  if (!in_impact()) return now;
  now.mu = 0.0;
  now.end_share = is(ContactPhase::compression) && restitution == 0.0 ? 1.0 : 0.0;
  return now;
}

}  // namespace polhode::surface_contact
