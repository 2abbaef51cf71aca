// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/dynamics/momentum_step.hpp>
#include <polhode/math/quaternion.hpp>

namespace polhode::test {

/// A body in an arbitrary step, for tests of laws and tangents.
struct SampleStep {
  explicit SampleStep(double rho_inf, double dt = 0.1) {
    context.ga = GeneralizedAlpha::from_spectral_radius(rho_inf);
    context.dt = dt;
    at_n.r = {0.5, -1.0, 2.0};
    at_n.q = quaternion_from_rotation_vector({0.3, 0.8, -0.5});
    at_n.v = {1.0, 0.2, -0.7};
    at_n.W = {0.9, -1.4, 2.1};
    at_n.a = {0.3, -0.6, 0.2};
    at_n.A = {-0.8, 0.5, 1.2};
    at_n.h_dot = {0.4, 1.1, -0.9};
  }

  /// The step with the Newton increment d = (Δr, Δθ) applied.
  [[nodiscard]] BodyStep displaced(const Vec& d) const {
    return newmark_step(at_n, u + d.head<3>(), compose_cayley(Vec3(d.tail<3>()), theta), context);
  }
  [[nodiscard]] BodyStep step() const { return displaced(Vec::Zero(6)); }

  StepContext context;
  BodyMotion at_n;
  Vec3 u = Vec3(0.11, 0.04, -0.06);
  Vec3 theta = Vec3(0.12, -0.17, 0.22);
};

}  // namespace polhode::test
