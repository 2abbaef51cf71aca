// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <polhode/contact_laws/normal_law.hpp>

namespace polhode::contact {

namespace {

/// Stiffness of resting contact, with which a point carries its load at a twentieth of the
/// tolerance: k d̂ of the barrier over the load there, 3/(1/s² − 3 + 2s) at s = 0.95.
constexpr double kRestStiffness = 373.0;
/// Slope of that barrier under its load, which is also the stiffness of the bristle: with a much
/// softer bristle bodies rock, and Newton does not converge between sticking and sliding.
constexpr double kRestSlope = 38.6;
/// Stiffness of a linear spring over load/tolerance: the load presses it by 4/3 of the tolerance.
constexpr double kSoftStiffness = 0.75;
/// k d̂²/(m w²) with which a barrier stops a mass within a twentieth of its band.
constexpr double kImpactStiffness = 1.14e4;
/// Dimensionless stiffness of springs that stop a mass at the tolerance: k δ²/(m w²), of Hertz's
/// law k δ^{5/2}/(m w²).
constexpr double kLinearImpact = 1.0, kHertzImpact = 1.25;
/// Duration of an impact over the ratio of greatest depth and speed, of Hertz's law and of the
/// barrier at small depths, where its force is k δ²/d̂.
constexpr double kHertzTime = 2.9432, kBarrierTime = 2.8044;
/// Part of the way to its floor from which a spring stiffens.
constexpr double kSpringAlone = 0.75;
constexpr int kBisections = 200;

/// Solution of f = 0 for an increasing f between low and high, by bisection to the last digit.
template <class F>
double bisect(double low, double high, F&& f) {
  for (int k = 0; k < kBisections; ++k) {
    const double middle = 0.5 * (low + high);
    if (!(middle > low && middle < high)) break;
    (f(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double NormalLaw::floor() const {
  if (is_spring()) return lower ? *lower : -std::numeric_limits<double>::infinity();
  return lower ? *lower : -tolerance;
}

bool NormalLaw::is_near_floor(double gap) const {
  return is_spring() && lower && gap < kSpringAlone * *lower;
}

double NormalLaw::floor_below(double gap) { return gap / kSpringAlone; }

NormalLaw NormalLaw::barrier_at_floor() const {
  NormalLaw law;
  law.stiffness = bristle_stiffness();
  law.lower = *lower;
  law.upper = kSpringAlone * *lower;
  if (reach() < *law.upper) law.later = reach();
  return law;
}

double NormalLaw::energy(double gap) const {
  return own_energy(gap) + (is_near_floor(gap) ? barrier_at_floor().own_energy(gap) : 0.0);
}

double NormalLaw::own_energy(double gap) const {
  if (gap >= reach()) return 0.0;
  switch (potential) {
    case NormalPotential::barrier: {
      const double band = this->band(), s = (gap - floor()) / band;
      if (s <= 0.0) return std::numeric_limits<double>::infinity();
      const double first = this->first(), rest = first - s;
      // 1/s − 3 + 3s − s² = (1 − s)³/s; in general (first − s)²(1/(s first²) − 1)
      return stiffness * band * band / 3.0 * rest * rest *
             ((1.0 - s) + s * (1.0 - first) * (1.0 + first)) / (s * first * first);
    }
    case NormalPotential::linear:
      return 0.5 * stiffness * (reach() - gap) * (reach() - gap);
    case NormalPotential::hertz: {
      const double depth = reach() - gap;
      return 0.4 * stiffness * depth * depth * std::sqrt(depth);
    }
  }
  return 0.0;
}

double NormalLaw::gap_of(double energy) const {
  if (!(energy > 0.0)) return reach();
  if (is_spring() && lower)
    if (const double start = std::min(reach(), kSpringAlone * *lower); energy > own_energy(start))
      return bisect(*lower, start, [&](double gap) { return energy - this->energy(gap); });
  switch (potential) {
    case NormalPotential::barrier: {
      // (1 − s)³ = v s: decreasing and convex on the left, so Newton converges monotonically from
      // 0.
      const double band = this->band(), v = 3.0 * energy / (stiffness * band * band);
      double s = 0.0;
      for (int k = 0; k < 100; ++k) {
        const double rest = 1.0 - s;
        const double step = (rest * rest * rest - v * s) / (3.0 * rest * rest + v);
        s += step;
        if (!(step > 1e-16 * s)) break;
      }
      return band * s + floor();
    }
    case NormalPotential::linear:
      return reach() - std::sqrt(2.0 * energy / stiffness);
    case NormalPotential::hertz:
      return reach() - std::pow(2.5 * energy / stiffness, 0.4);
  }
  return 0.0;
}

/// Energy of the barrier with x = g − floor = s d̂: (k x²/3) ((1 − s)/s)³.
double NormalLaw::reach_for(double gap, double energy) const {
  if (!(energy > 0.0)) return gap;
  const double reach = own_reach_for(gap, energy);
  if (!is_near_floor(gap)) return reach;
  NormalLaw law = *this;
  return bisect(gap, reach, [&](double end) {
    law.upper = end;
    return law.energy(gap) - energy;
  });
}

double NormalLaw::own_reach_for(double gap, double energy) const {
  switch (potential) {
    case NormalPotential::barrier: {
      const double x = gap - floor();
      return floor() + x * (1.0 + std::cbrt(3.0 * energy / (stiffness * x * x)));
    }
    case NormalPotential::linear:
      return gap + std::sqrt(2.0 * energy / stiffness);
    case NormalPotential::hertz:
      return gap + std::pow(2.5 * energy / stiffness, 0.4);
  }
  return gap;
}

NormalLaw::Stiffness NormalLaw::stiffness_under(double load, double least) const {
  const auto spring = [&] { return std::max(kSoftStiffness * load / tolerance, least); };
  switch (potential) {
    case NormalPotential::barrier:
      return {std::max(kRestStiffness * load / tolerance, least),
              std::max(kRestSlope * load / tolerance, least)};
    case NormalPotential::linear:
      return {spring(), spring()};
    case NormalPotential::hertz:
      return {spring() / std::sqrt(tolerance), spring()};
  }
  return {stiffness, stiffness};
}

double NormalLaw::bristle_stiffness() const {
  switch (potential) {
    case NormalPotential::barrier:
    case NormalPotential::linear:
      return stiffness;
    case NormalPotential::hertz:
      return stiffness * std::sqrt(tolerance);
  }
  return stiffness;
}

double NormalLaw::slope_under(double load) const {
  switch (potential) {
    case NormalPotential::barrier:
      return 2.0 * std::sqrt(stiffness * load / tolerance);
    case NormalPotential::linear:
      return stiffness;
    case NormalPotential::hertz:
      return 1.5 * std::cbrt(stiffness * stiffness * load);
  }
  return stiffness;
}

double NormalLaw::depth_under(double load) const {
  switch (potential) {
    case NormalPotential::barrier:
      return std::sqrt(load * tolerance / stiffness);
    case NormalPotential::linear:
      return load / stiffness;
    case NormalPotential::hertz:
      return std::pow(load / stiffness, 2.0 / 3.0);
  }
  return 0.0;
}

double NormalLaw::stiffness_in_impact(double mass, double speed) const {
  const double per_square = speed * speed / (tolerance * tolerance);
  switch (potential) {
    case NormalPotential::barrier:
      return kImpactStiffness * mass * per_square;
    case NormalPotential::linear:
      return kLinearImpact * mass * per_square;
    case NormalPotential::hertz:
      return kHertzImpact * mass * per_square / std::sqrt(tolerance);
  }
  return stiffness;
}

double NormalLaw::impact_duration(double mass, double speed) const {
  switch (potential) {
    case NormalPotential::barrier:
      return kBarrierTime * std::cbrt(1.5 * mass * speed * speed * tolerance / stiffness) / speed;
    case NormalPotential::linear:
      return std::numbers::pi * std::sqrt(mass / stiffness);
    case NormalPotential::hertz:
      return kHertzTime * std::pow(1.25 * mass * speed * speed / stiffness, 0.4) / speed;
  }
  return 0.0;
}

NormalLaw::WithSlope NormalLaw::force_and_slope(double gap) const {
  WithSlope f = own_force(gap);
  if (!is_near_floor(gap)) return f;
  const WithSlope more = barrier_at_floor().own_force(gap);
  return {f.value + more.value, f.slope + more.slope};
}

NormalLaw::WithSlope NormalLaw::own_force(double gap) const {
  if (gap >= reach()) return {0.0, 0.0};
  switch (potential) {
    case NormalPotential::barrier: {
      const double band = this->band(), s = (gap - floor()) / band;
      const double slope = -stiffness / 3.0 * (2.0 / (s * s * s) - 2.0);
      if (later) {
        const double first = this->first(), product = s * first;
        return {stiffness * band / 3.0 * (first - s) * ((first + s) / (product * product) - 2.0),
                slope};
      }
      // 1/s² − 3 + 2s = (1 − s)²(1 + 2s)/s²
      const double part = (1.0 - s) / s;
      return {stiffness * band / 3.0 * part * part * (1.0 + 2.0 * s), slope};
    }
    case NormalPotential::linear:
      return {stiffness * (reach() - gap), -stiffness};
    case NormalPotential::hertz: {
      const double depth = reach() - gap, root = std::sqrt(depth);
      return {stiffness * depth * root, -1.5 * stiffness * root};
    }
  }
  return {0.0, 0.0};
}

NormalLaw::WithSlope NormalLaw::quotient_and_slope(double gap_0, double gap_1) const {
  WithSlope q = own_quotient(gap_0, gap_1);
  if (!is_near_floor(gap_0) && !is_near_floor(gap_1)) return q;
  const WithSlope more = barrier_at_floor().own_quotient(gap_0, gap_1);
  return {q.value + more.value, q.slope + more.slope};
}

NormalLaw::WithSlope NormalLaw::own_quotient(double gap_0, double gap_1) const {
  const bool in_0 = gap_0 < reach(), in_1 = gap_1 < reach();
  if (!in_0 && !in_1) return {0.0, 0.0};
  if (in_0 != in_1) {
    const double change = gap_1 - gap_0;
    const double lambda = -(own_energy(gap_1) - own_energy(gap_0)) / change;
    return {lambda, (own_force(gap_1).value - lambda) / change};
  }
  switch (potential) {
    case NormalPotential::barrier: {
      const double band = this->band();
      const double s_0 = (gap_0 - floor()) / band, s_1 = (gap_1 - floor()) / band,
                   first = this->first();
      return {stiffness * band / 3.0 *
                  (1.0 / (s_0 * s_1) - (1.0 / (first * first) + 2.0 * first) + s_0 + s_1),
              -stiffness / 3.0 * (1.0 / (s_0 * s_1 * s_1) - 1.0)};
    }
    case NormalPotential::linear:
      return {0.5 * stiffness * ((reach() - gap_0) + (reach() - gap_1)), -0.5 * stiffness};
    case NormalPotential::hertz: {
      const double y_0 = std::sqrt(reach() - gap_0), y_1 = std::sqrt(reach() - gap_1),
                   sum = y_0 + y_1;
      const double p = y_0 * y_0, q = y_1 * y_1;
      const double top = q * q + q * y_1 * y_0 + q * p + y_1 * y_0 * p + p * p;
      const double slope_top = 4.0 * q * y_1 + 3.0 * q * y_0 + 2.0 * y_1 * p + y_0 * p;
      const double by_y = 0.4 * stiffness * (slope_top - top / sum) / sum;
      return {0.4 * stiffness * top / sum, -by_y / (2.0 * y_1)};
    }
  }
  return {0.0, 0.0};
}

}  // namespace polhode::contact
