// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/system/pair_terms.hpp>

namespace polhode {

/// Adds the forces of a mass matrix that couples the centres of mass of a and b,
///
///   f_a = m_ab (a_a − a_b),  f_b = −f_a,   accelerations at t_{n+αm},
///
/// to wrenches and tangents. A consistent mass matrix [m_aa m_ab; m_ab m_bb] consists of this and
/// the row sums, which belong to the bodies. At an instant (dt = 0) accelerations are unknowns: the
/// consistent start uses coupled_mass() instead. @eq{mass-coupling}
inline void add_mass_coupling(const PairStep& step, double m_ab, PairTerms& t) {
  const StepContext& c = step.context;
  if (m_ab == 0.0 || c.dt == 0.0) return;
  const auto acceleration = [&](const BodyStep& body) -> Vec3 {
    return body.moves ? body.acceleration_m(c) : Vec3::Zero();
  };
  const Vec3 f = m_ab * (acceleration(step.a) - acceleration(step.b));
  t.wrench_a.head<3>() += f;
  t.wrench_b.head<3>() -= f;
  if (!c.tangents) return;
  const double by_r = m_ab * c.ga.alpha_m / (c.ga.beta * c.dt * c.dt);
  t.D_aa.topLeftCorner<3, 3>().diagonal().array() += by_r;
  t.D_ab.topLeftCorner<3, 3>().diagonal().array() -= by_r;
  t.D_ba.topLeftCorner<3, 3>().diagonal().array() -= by_r;
  t.D_bb.topLeftCorner<3, 3>().diagonal().array() += by_r;
}

}  // namespace polhode
