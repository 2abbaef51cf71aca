// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <polhode/solids/materials/toe_fibre.hpp>

namespace polhode::solids {
namespace {

// Gauss-Legendre on [0, 1], 8 points: exact to degree 15.
constexpr double kPoint[4] = {0.5 - 0.5 * 0.1834346424956498, 0.5 - 0.5 * 0.5255324099163290,
                              0.5 - 0.5 * 0.7966664774136267, 0.5 - 0.5 * 0.9602898564975363};
constexpr double kWeight[4] = {0.5 * 0.3626837833783620, 0.5 * 0.3137066458778873,
                               0.5 * 0.2223810344533745, 0.5 * 0.1012285362903763};

/// dF/dI and d²F/dI², I = 1 + y.
struct Slopes {
  double first, second;
};

Slopes slopes(const ToeFibre& f, double y) {
  const double I = 1.0 + y, stretch = std::sqrt(I);
  if (stretch > f.stretch_m) {
    const double c6 = f.c3 * std::expm1(f.c4 * (f.stretch_m - 1.0)) - f.c5 * f.stretch_m;
    return {(f.c5 * stretch + c6) / (2.0 * I),
            f.c5 / (4.0 * stretch * I) - (f.c5 * stretch + c6) / (2.0 * I * I)};
  }
  const double rise = std::expm1(f.c4 * y / (1.0 + stretch));
  return {f.c3 * rise / (2.0 * I),
          f.c3 * (f.c4 * (1.0 + rise) / (4.0 * stretch * I) - rise / (2.0 * I * I))};
}

/// Means over [a, b] of dF/dI, and of τ d²F/dI² with τ from 0 to 1.
Slopes means(const ToeFibre& f, double a, double b) {
  Slopes sum{0.0, 0.0};
  for (int i = 0; i < 4; ++i)
    for (const double tau : {kPoint[i], 1.0 - kPoint[i]}) {
      const Slopes s = slopes(f, a + tau * (b - a));
      sum.first += kWeight[i] * s.first;
      sum.second += kWeight[i] * tau * s.second;
    }
  return sum;
}

/// Length of steps that eight points integrate to rounding: small in the exponent and in y itself.
double longest(const ToeFibre& f, double y) { return std::min(0.5 / f.c4, 0.25) * (1.0 + y); }

/// ∫ dF/dI from a to b > a without a kink in between, in sufficiently short panels.
double smooth_rise(const ToeFibre& f, double a, double b) {
  const int panels = 1 + static_cast<int>((b - a) / longest(f, a));
  double sum = 0.0;
  for (int i = 0; i < panels; ++i)
    sum += means(f, a + (b - a) * i / panels, a + (b - a) * (i + 1) / panels).first;
  return sum * (b - a) / panels;
}

double rise(const ToeFibre& f, double a, double b) {
  const double kink = f.stretch_m * f.stretch_m - 1.0;
  if (a < kink && kink < b) return smooth_rise(f, a, kink) + smooth_rise(f, kink, b);
  return smooth_rise(f, a, b);
}

}  // namespace

MaterialKind ToeFibre::kind() {
  constexpr double kPositive = std::numeric_limits<double>::min();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {
      .name = kKind,
      .meaning = "λ dF/dλ = c₃ (exp(c₄ (λ − 1)) − 1), straight beyond λ_m: ligament, tendon",
      .parameters = {{"c3", "Pa", {}, kPositive, kInfinity, "scale of the exponential toe"},
                     {"c4", "-", {}, kPositive, 1e4, "rate at which fibres uncrimp"},
                     {"c5", "Pa", 0.0, 0.0, kInfinity, "modulus of the straightened fibre"},
                     {"straight_stretch", "-", 1e6, 1.0, 1e6, "λ_m at which fibres are straight"}}};
}

ToeFibre ToeFibre::from(const ParameterValues& v) {
  return {v.at("c3"), v.at("c4"), v.at("c5"), v.at("straight_stretch")};
}

double ToeFibre::energy_of(double y) const { return y > 0.0 ? rise(*this, 0.0, y) : 0.0; }

void ToeFibre::difference_of(double y_0, double y_1, double* value, double* derivative) const {
  const double a = std::min(y_0, y_1), b = std::max(y_0, y_1), step = y_1 - y_0;
  if (!(b - a < 1e4)) {  // NaN, or far beyond any solid
    *value = *derivative = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  const double kink = stretch_m * stretch_m - 1.0;
  const bool crosses = a < kink && kink < b;
  if (!crosses && b - a < longest(*this, a)) {
    const Slopes mean = means(*this, y_0, y_1);
    *value = mean.first;
    *derivative = mean.second;
    return;
  }
  *value = rise(*this, a, b) / (b - a);
  const Slopes end = slopes(*this, y_1);
  *derivative = std::abs(step) > 1e-8 ? (end.first - *value) / step : 0.5 * end.second;
}

}  // namespace polhode::solids
