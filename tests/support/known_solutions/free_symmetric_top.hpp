// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode::test {

/// The torque-free symmetric top with J_r = diag(J_1, J_1, J_3), body axes those of the world at
/// the start (Goldstein, Classical Mechanics, §5.6).
///
/// The body turns about its own axis at s = W_3 (1 − J_3/J_1), and that about the fixed angular
/// momentum h at |h|/J_1: Λ(t) = exp(t h/J_1) exp(t s e_3).
struct FreeSymmetricTop {
  double J_1, J_3;
  Vec3 W_0;

  [[nodiscard]] Vec3 h() const { return {J_1 * W_0[0], J_1 * W_0[1], J_3 * W_0[2]}; }
  [[nodiscard]] double spin() const { return W_0[2] * (1.0 - J_3 / J_1); }
  [[nodiscard]] Quat orientation(double t) const {
    const Vec3 precession = h() / J_1;
    return Quat(Eigen::AngleAxisd(t * precession.norm(), precession.normalized())) *
           Quat(Eigen::AngleAxisd(t * spin(), Vec3::UnitZ()));
  }
  [[nodiscard]] Vec3 W(double t) const {
    return Eigen::AngleAxisd(-t * spin(), Vec3::UnitZ()) * W_0;
  }
};

}  // namespace polhode::test
