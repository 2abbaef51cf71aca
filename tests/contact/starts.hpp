// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/contact_laws/normal_law.hpp>
#include <polhode/dynamics/body_motion.hpp>

namespace polhode::test {

/// Gap of a barrier that carries a load at rest [m].
inline double resting_gap(double stiffness, double tolerance, double load) {
  contact::NormalLaw law;
  law.stiffness = stiffness;
  law.tolerance = tolerance;
  law.upper = 0.0;
  double low = -tolerance * (1.0 - 1e-9), high = 0.0;
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (law.force(middle) > load ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Motion of a body that is not rotated and does not rotate.
inline BodyMotion at(const Vec3& r, const Vec3& v = Vec3::Zero()) {
  BodyMotion m;
  m.r = r;
  m.v = v;
  return m;
}

}  // namespace polhode::test
