// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/dynamics/body_motion.hpp>
#include <polhode/math/hat.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// Momentum (linear, about the world's origin) of a body.
[[nodiscard]] inline Vec6 momentum_of(const BodySpec& body, const BodyMotion& m) {
  Vec6 h;
  h.head<3>() = body.mass * m.v;
  h.tail<3>() = m.r.cross(h.head<3>()) + m.q * (body.inertia * m.W);
  return h;
}

/// Rate of change of it at given accelerations of the centre of mass, and angular.
[[nodiscard]] inline Vec6 momentum_rate_of(const BodySpec& body, const BodyMotion& m, const Vec3& a,
                                           const Vec3& alpha) {
  const Vec3 A = m.q.conjugate() * alpha;
  Vec6 h;
  h.head<3>() = body.mass * a;
  h.tail<3>() = m.r.cross(h.head<3>()) + m.q * (body.inertia * A + m.W.cross(body.inertia * m.W));
  return h;
}

/// Mass matrix of a body for motion vectors.
[[nodiscard]] inline Mat6 mass_of(const BodySpec& body, const BodyMotion& m) {
  const Mat3 r = hat(m.r), Lambda = m.Lambda();
  Mat6 M;
  M << body.mass * Mat3::Identity(), -body.mass * r, body.mass * r,
      Lambda * body.inertia * Lambda.transpose() - body.mass * r * r;
  return M;
}

}  // namespace polhode
