// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include <Eigen/LU>

#include <polhode/dynamics/mean_turn.hpp>
#include <polhode/math/cayley.hpp>

namespace polhode {

namespace {

constexpr int kMaxIterations = 20;
constexpr double kRoundOff = 4.4e-16;
/// Part of the momenta that counts as round-off where iterations make no more progress.
constexpr double kNoGain = 1e-13;

}  // namespace

bool try_mean_turn(const Mat3& J, const Vec3& omega_n, const Vec3& tau, double dt, Vec3& mean) {
  const Vec3 h_n = J * omega_n, aim = h_n + tau;
  const double scale = h_n.norm() + tau.norm();
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kMaxIterations; ++k) {
    const Vec3 theta = dt * mean;
    const Mat3 C = cay(theta);
    const Vec3 h = C * (J * (2.0 * mean - omega_n)), residual = aim - h;
    const double size = residual.norm();
    if (size <= kRoundOff * scale || (size >= 0.5 * least && size <= kNoGain * scale)) return true;
    least = std::min(least, size);
    const double s = dt / (1.0 + 0.25 * theta.squaredNorm());
    const Mat3 tangent = 2.0 * C * J - s * hat(h) * (Mat3::Identity() + 0.5 * hat(theta));
    mean += tangent.inverse() * residual;
  }
  return false;
}

}  // namespace polhode
