// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode {

/// Motion of one body, as set and reported.
struct BodyMotion {
  Vec3 r = Vec3::Zero();
  Quat q = Quat::Identity();
  Vec3 v = Vec3::Zero();
  Vec3 W = Vec3::Zero();
  Vec3 a = Vec3::Zero();
  Vec3 A = Vec3::Zero();
  Vec3 h_dot = Vec3::Zero();

  [[nodiscard]] Mat3 Lambda() const { return q.toRotationMatrix(); }
  [[nodiscard]] Vec3 omega() const;  ///< World angular velocity [rad/s].
};

}  // namespace polhode
