// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <polhode/contact_laws/normal_law.hpp>

namespace polhode::contact {

double NormalLaw::floor() const {
  if (potential != NormalPotential::barrier) return -std::numeric_limits<double>::infinity();
  return lower ? *lower : -tolerance;
}

double NormalLaw::energy(double gap) const {
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

NormalLaw::WithSlope NormalLaw::force_and_slope(double gap) const {
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
  const bool in_0 = gap_0 < reach(), in_1 = gap_1 < reach();
  if (!in_0 && !in_1) return {0.0, 0.0};
  if (in_0 != in_1) {
    const double change = gap_1 - gap_0;
    const double lambda = -(energy(gap_1) - energy(gap_0)) / change;
    return {lambda, (force_and_slope(gap_1).value - lambda) / change};
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
