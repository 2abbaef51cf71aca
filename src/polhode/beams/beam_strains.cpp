// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numbers>

#include <polhode/beams/beam_strains.hpp>
#include <polhode/math/hat.hpp>

namespace polhode {

namespace {

using Mat3x9 = Eigen::Matrix<double, 3, 9>;
using Mat4x9 = Eigen::Matrix<double, 4, 9>;

/// φ = f(|v|², c) v for v = axial vector of R and c = ½(tr R − 1), f = atan2(s, c)/s with s = |v|;
/// s² and c are treated as independent, as R may be an average of rotations.
struct Logarithm {
  Vec3 v, phi;
  double c = 0.0, s2 = 0.0, r2 = 0.0;
  double f = 0.0, f_s = 0.0, f_c = 0.0;  ///< f_s: by s².

  explicit Logarithm(const Vec15& iota) {
    const Eigen::Map<const Mat3> R(iota.data() + 6);
    v = vee(R);
    c = 0.5 * (R.trace() - 1.0);
    s2 = v.squaredNorm();
    r2 = c * c + s2;
    if (small()) {
      const double y = s2 / (c * c);
      f = series<0>(y) / c;
      f_s = series<1>(y) / (c * c * c);
    } else {
      const double s = std::sqrt(s2);
      f = std::atan2(s, c) / s;
      f_s = 0.5 * (c / r2 - f) / s2;
    }
    f_c = -1.0 / r2;
    phi = f * v;
  }
  [[nodiscard]] double f_ss() const {
    if (small()) return series<2>(s2 / (c * c)) / (c * c * c * c * c);
    return (-c / (r2 * r2) - 3.0 * f_s) / (2.0 * s2);
  }
  [[nodiscard]] double f_sc() const { return 1.0 / (r2 * r2); }
  [[nodiscard]] double f_cc() const { return 2.0 * c / (r2 * r2); }

  [[nodiscard]] Mat3 phi_by_v() const {
    Mat3 m = 2.0 * f_s * v * v.transpose();
    m.diagonal().array() += f;
    return m;
  }

 private:
  [[nodiscard]] bool small() const { return c > 0.0 && s2 < 0.01 * c * c; }
  /// Derivative of atan(√y)/√y = Σ (−y)^k/(2k + 1), for y < 0.01.
  template <int kDerivative>
  static double series(double y) {
    double sum = 0.0;
    for (int k = 9; k >= kDerivative; --k) {
      double term = (k % 2 == 0 ? 1.0 : -1.0) / (2 * k + 1);
      for (int d = 0; d < kDerivative; ++d) term *= k - d;
      sum = sum * y + term;
    }
    return sum;
  }
};

/// (v, c) by R, column by column.
Mat4x9 axial_and_trace() {
  Mat4x9 W = Mat4x9::Zero();
  const auto at = [](int row, int column) { return 3 * column + row; };
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    W(k, at(j, i)) = 0.5;
    W(k, at(i, j)) = -0.5;
    W(3, at(k, k)) = 0.5;
  }
  return W;
}
const Mat4x9 kByR = axial_and_trace();

/// φ by (v, c).
Eigen::Matrix<double, 3, 4> phi_by_vc(const Logarithm& log) {
  Eigen::Matrix<double, 3, 4> J;
  J << log.phi_by_v(), log.f_c * log.v;
  return J;
}

}  // namespace

Vec15 beam_invariants(const BeamFrames& frames) {
  Vec15 iota;
  iota.segment<3>(0) = frames.D_1.transpose() * frames.offset;
  iota.segment<3>(3) = frames.D_2.transpose() * frames.offset;
  Eigen::Map<Mat3>(iota.data() + 6) = frames.D_1.transpose() * frames.D_2;
  return iota;
}

/// η by the partial fractions of the cotangent, η = Σ_n 2/(4π²n² − x): the first term, and the rest
/// as a power series whose coefficients decrease by 1/4 of (x/4π²).
Eta beam_eta(double x) {
  constexpr int kTerms = 14;
  static const std::array<double, kTerms> rest = [] {  // ζ(2k) − 1
    std::array<double, kTerms> z{};
    for (int k = 0; k < kTerms; ++k) {
      const int power = 2 * (k + 1);
      constexpr int kLast = 400;  // then Euler and Maclaurin
      double sum = 0.5 * std::pow(kLast, -power) + std::pow(kLast, 1 - power) / (power - 1) +
                   power * std::pow(kLast, -power - 1) / 12.0 -
                   power * (power + 1.0) * (power + 2.0) * std::pow(kLast, -power - 3) / 720.0;
      for (int n = kLast - 1; n >= 2; --n) sum += std::pow(n, -power);
      z[static_cast<std::size_t>(k)] = sum;
    }
    return z;
  }();
  constexpr double kPi = std::numbers::pi;
  constexpr double kPerX = 1.0 / (4.0 * kPi * kPi), kFactor = 2.0 * kPerX;
  const double y = kPerX * x, pole = 1.0 / (1.0 - y);
  double s0 = 0.0, s1 = 0.0, s2 = 0.0;  // Horner, with derivatives
  for (int k = kTerms - 1; k >= 0; --k) {
    s2 = s2 * y + s1;
    s1 = s1 * y + s0;
    s0 = s0 * y + rest[static_cast<std::size_t>(k)];
  }
  return {kFactor * (pole + s0), kFactor * kPerX * (pole * pole + s1),
          kFactor * kPerX * kPerX * 2.0 * (pole * pole * pole + s2)};
}

double beam_angle(const Vec15& iota) { return Logarithm(iota).phi.norm(); }

Vec6 beam_strain_values(const Vec15& iota, double L) {
  const Vec3 phi = Logarithm(iota).phi;
  const Vec3 s = iota.segment<3>(0) + iota.segment<3>(3);
  const Vec3 d = iota.segment<3>(0) - iota.segment<3>(3);
  const double eta = beam_eta(phi.squaredNorm()).value;
  Vec6 e;
  e << 0.5 * (s - 0.5 * phi.cross(d) + eta * phi.cross(phi.cross(s))), phi;
  return e / L;
}

/// @eq{beam-strains}
BeamStrains beam_strains(const Vec15& iota, double L) {
  const Logarithm log(iota);
  const Vec3& phi = log.phi;
  const Vec3 s = iota.segment<3>(0) + iota.segment<3>(3);
  const Vec3 d = iota.segment<3>(0) - iota.segment<3>(3);
  const double x = phi.squaredNorm(), phi_s = phi.dot(s);
  const Eta eta = beam_eta(x);
  const Vec3 w = phi_s * phi - x * s;  // φ × (φ × s)
  BeamStrains b;
  b.e << 0.5 * (s - 0.5 * phi.cross(d) + eta.value * w), phi;
  b.e /= L;

  Mat3 by_s = 0.5 * eta.value * phi * phi.transpose();
  by_s.diagonal().array() += 0.5 - 0.5 * eta.value * x;
  const Mat3 by_d = -0.25 * hat(phi);
  Mat3 by_phi = 0.25 * hat(d) +
                0.5 * eta.value * (phi * s.transpose() - 2.0 * s * phi.transpose()) +
                eta.first * w * phi.transpose();
  by_phi.diagonal().array() += 0.5 * eta.value * phi_s;
  const Mat3x9 phi_by_R = phi_by_vc(log) * kByR;
  b.by_iota.topLeftCorner<3, 3>() = by_s + by_d;
  b.by_iota.block<3, 3>(0, 3) = by_s - by_d;
  b.by_iota.topRightCorner<3, 9>() = by_phi * phi_by_R;
  b.by_iota.bottomLeftCorner<3, 6>().setZero();
  b.by_iota.bottomRightCorner<3, 9>() = phi_by_R;
  b.by_iota /= L;
  return b;
}

Mat15 beam_strain_hessian(const Vec15& iota, double L, const Vec6& sigma) {
  const Logarithm log(iota);
  const Vec3& phi = log.phi;
  const Vec3 s = iota.segment<3>(0) + iota.segment<3>(3);
  const Vec3 d = iota.segment<3>(0) - iota.segment<3>(3);
  const Vec3 S = sigma.head<3>() / L, k = sigma.tail<3>() / L;
  const double x = phi.squaredNorm(), phi_s = phi.dot(s), phi_S = phi.dot(S), S_s = S.dot(s);
  const Eta eta = beam_eta(x);
  // σ·e = ½ S·s − ¼ S·(φ × d) + ½ η q + k·φ with q = (S·φ)(φ·s) − x S·s
  const double q = phi_S * phi_s - x * S_s;
  const Vec3 q_phi = phi_s * S + phi_S * s - 2.0 * S_s * phi;
  const Vec3 by_phi = 0.25 * S.cross(d) + 0.5 * eta.value * q_phi + eta.first * q * phi + k;

  Mat3 s_phi = 0.5 * eta.value * (phi * S.transpose() - 2.0 * S * phi.transpose()) +
               eta.first * (phi_S * phi - x * S) * phi.transpose();
  s_phi.diagonal().array() += 0.5 * eta.value * phi_S;
  const Mat3 d_phi = -0.25 * hat(S);
  const Mat3 mixed = 0.5 * eta.value * S * s.transpose() + eta.first * phi * q_phi.transpose();
  Mat3 phi_phi = mixed + mixed.transpose() + 2.0 * eta.second * q * phi * phi.transpose();
  phi_phi.diagonal().array() += eta.first * q - eta.value * S_s;

  const Vec3& v = log.v;
  const double m_v = by_phi.dot(v);
  const Eigen::Matrix<double, 3, 4> J = phi_by_vc(log);
  Eigen::Matrix4d h = J.transpose() * phi_phi * J;
  h.topLeftCorner<3, 3>() += 2.0 * log.f_s * (by_phi * v.transpose() + v * by_phi.transpose()) +
                             4.0 * log.f_ss() * m_v * v * v.transpose();
  h.diagonal().head<3>().array() += 2.0 * log.f_s * m_v;
  const Vec3 v_c = log.f_c * by_phi + 2.0 * log.f_sc() * m_v * v;
  h.topRightCorner<3, 1>() += v_c;
  h.bottomLeftCorner<1, 3>() += v_c.transpose();
  h(3, 3) += log.f_cc() * m_v;

  Mat15 H;
  H.topLeftCorner<6, 6>().setZero();
  const Mat3x9 phi_by_R = J * kByR;
  H.block<3, 9>(0, 6) = (s_phi + d_phi) * phi_by_R;
  H.block<3, 9>(3, 6) = (s_phi - d_phi) * phi_by_R;
  H.bottomLeftCorner<9, 6>() = H.topRightCorner<6, 9>().transpose();
  H.bottomRightCorner<9, 9>() = kByR.transpose() * (h * kByR);
  return H;
}

}  // namespace polhode
