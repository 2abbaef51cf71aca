// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <polhode/beams/muscle_curves.hpp>

namespace polhode {

namespace {

/// b1 exp(−½ ((l − b2)/(b3 + b4 l))²).
struct Bell {
  double b1, b2, b3, b4;
};
constexpr Bell kBells[] = {
    {0.815, 1.055, 0.162, 0.063}, {0.433, 0.717, -0.030, 0.200}, {0.100, 1.000, 0.354, 0.000}};
/// Shape of the passive curve, and the strain at which it reaches the largest isometric force.
constexpr double kPassive = 4.0, kPassiveStrain = 0.6;
constexpr double kD1 = -0.3211346127989808, kD2 = -8.149, kD3 = -0.374, kD4 = 0.8825327733249912;

}  // namespace

CurveValue active_force_length(double l) {
  CurveValue f;
  for (const auto& [b1, b2, b3, b4] : kBells) {
    const double width = b3 + b4 * l, x = (l - b2) / width;
    const double bell = b1 * std::exp(-0.5 * x * x);
    f.value += bell;
    f.slope -= bell * x * (1.0 - x * b4) / width;
  }
  return f;
}

CurveValue passive_force_length(double l) {
  const double rate = kPassive / kPassiveStrain, whole = std::expm1(kPassive);
  const double x = rate * (l - 1.0);
  return {std::expm1(x) / whole, rate * std::exp(x) / whole};
}

double passive_energy(double l) {
  const double rate = kPassive / kPassiveStrain, whole = std::expm1(kPassive);
  return ((std::exp(rate * (l - 1.0)) - std::exp(-rate)) / rate - l) / whole;
}

CurveValue force_velocity(double v) {
  const double x = kD2 * v + kD3;
  return {kD1 * std::asinh(x) + kD4, kD1 * kD2 / std::sqrt(x * x + 1.0)};
}

}  // namespace polhode
