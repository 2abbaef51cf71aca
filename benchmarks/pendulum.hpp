// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace polhode::benchmark {

/// The angle of φ'' = k sin φ at time t, by classical Runge-Kutta of order 4 in extended precision:
/// right to about 1e-13 for the pendulums here (k up to 15 /s², 10 s).
inline double pendulum_angle(double k, double angle, double rate, double t) {
  const int steps = 200'000;
  const long double h = static_cast<long double>(t) / steps;
  const auto acceleration = [k](long double phi) { return k * std::sin(phi); };
  long double phi = angle, omega = rate;
  for (int i = 0; i < steps; ++i) {
    const long double v1 = omega, a1 = acceleration(phi);
    const long double v2 = omega + 0.5L * h * a1, a2 = acceleration(phi + 0.5L * h * v1);
    const long double v3 = omega + 0.5L * h * a2, a3 = acceleration(phi + 0.5L * h * v2);
    const long double v4 = omega + h * a3, a4 = acceleration(phi + h * v3);
    phi += h / 6.0L * (v1 + 2.0L * v2 + 2.0L * v3 + v4);
    omega += h / 6.0L * (a1 + 2.0L * a2 + 2.0L * a3 + a4);
  }
  return static_cast<double>(phi);
}

}  // namespace polhode::benchmark
