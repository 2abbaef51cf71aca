// SPDX-License-Identifier: Apache-2.0
#include <polhode/solve/block_cg.hpp>

#include <Eigen/Cholesky>

#include <polhode/so3/hat.hpp>

namespace polhode {

namespace {

/// Adds Pᵀ C P with P = [I, −arm^].
void add_spring(const Mat3& C, const Vec3& arm, Mat6& block) {
  const Mat3 hat_C = hat(arm) * C;
  block.topLeftCorner<3, 3>() += C;
  block.topRightCorner<3, 3>() += hat_C.transpose();
  block.bottomLeftCorner<3, 3>() += hat_C;
  block.bottomRightCorner<3, 3>() -= hat_C * hat(arm);
}

}  // namespace

bool BlockCg::set(std::span<const Mat6> blocks, std::span<const ContactSpring> springs) {
  springs_ = springs;
  own_.resize(blocks.size());
  inverse_.resize(blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b)
    inverse_[b] = own_[b] = 0.5 * (blocks[b] + blocks[b].transpose());
  for (const ContactSpring& s : springs) {
    if (s.a != kGround) add_spring(s.C, s.arm_a, inverse_[s.a]);
    if (s.b != kGround) add_spring(s.C, s.arm_b, inverse_[s.b]);
  }
  for (Mat6& B : inverse_) {
    const Eigen::LLT<Mat6> factor(B);
    if (factor.info() != Eigen::Success) return false;
    B = factor.solve(Mat6::Identity());
  }
  return true;
}

void BlockCg::multiply(const std::vector<Vec6>& p, std::vector<Vec6>& y) const {
  for (std::size_t b = 0; b < p.size(); ++b) y[b].noalias() = own_[b] * p[b];
  for (const ContactSpring& s : springs_) {
    Vec3 u = Vec3::Zero();
    if (s.a != kGround) u += p[s.a].head<3>() + p[s.a].tail<3>().cross(s.arm_a);
    if (s.b != kGround) u -= p[s.b].head<3>() + p[s.b].tail<3>().cross(s.arm_b);
    const Vec3 F = s.C * u;
    if (s.a != kGround) {
      y[s.a].head<3>() += F;
      y[s.a].tail<3>() += s.arm_a.cross(F);
    }
    if (s.b != kGround) {
      y[s.b].head<3>() -= F;
      y[s.b].tail<3>() -= s.arm_b.cross(F);
    }
  }
}

int BlockCg::solve(std::span<const Vec6> rhs, std::vector<Vec6>& x, double part, int most) {
  const std::size_t n = rhs.size();
  x.assign(n, Vec6::Zero());
  r_.assign(rhs.begin(), rhs.end());
  z_.resize(n);
  p_.resize(n);
  y_.resize(n);
  double rz = 0.0;
  for (std::size_t b = 0; b < n; ++b) {
    z_[b].noalias() = inverse_[b] * r_[b];
    p_[b] = z_[b];
    rz += r_[b].dot(z_[b]);
  }
  const double enough = part * rz;
  int k = 0;
  while (k < most && rz > enough) {
    ++k;
    multiply(p_, y_);
    double curvature = 0.0;
    for (std::size_t b = 0; b < n; ++b) curvature += p_[b].dot(y_[b]);
    if (!(curvature > 0.0)) break;
    const double alpha = rz / curvature;
    double next = 0.0;
    for (std::size_t b = 0; b < n; ++b) {
      x[b] += alpha * p_[b];
      r_[b] -= alpha * y_[b];
      z_[b].noalias() = inverse_[b] * r_[b];
      next += r_[b].dot(z_[b]);
    }
    const double beta = next / rz;
    rz = next;
    for (std::size_t b = 0; b < n; ++b) p_[b] = z_[b] + beta * p_[b];
  }
  return k;
}

}  // namespace polhode
