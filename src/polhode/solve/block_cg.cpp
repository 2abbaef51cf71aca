// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/solve/block_cg.hpp>

namespace polhode {

namespace {

/// Adds Pᵀ C P with P = [I, −arm^].
void add_spring(const Mat3& C, const Vec3& arm, Mat6& block) {
  Mat3 turned, turned_twice;  // arm^ C, and arm^ C arm^ᵀ
  for (int j = 0; j < 3; ++j) turned.col(j) = arm.cross(C.col(j));
  for (int j = 0; j < 3; ++j) turned_twice.col(j) = arm.cross(Vec3(turned.row(j)));
  block.topLeftCorner<3, 3>() += C;
  block.topRightCorner<3, 3>() += turned.transpose();
  block.bottomLeftCorner<3, 3>() += turned;
  block.bottomRightCorner<3, 3>() += turned_twice;
}

/// In place, by elimination without exchange of rows. @returns false if not positive.
bool invert(Mat6& B) {
  double* a = B.data();
  for (int k = 0; k < 6; ++k) {
    const double pivot = a[7 * k];
    if (!(pivot > 0.0)) return false;
    const double inverse = 1.0 / pivot;
    double column[6];
    for (int i = 0; i < 6; ++i) column[i] = a[6 * k + i] * inverse;
    for (int j = 0; j < 6; ++j) {
      if (j == k) continue;
      const double f = a[6 * j + k];
      for (int i = 0; i < 6; ++i) a[6 * j + i] -= f * column[i];
      a[6 * j + k] = f * inverse;
    }
    for (int i = 0; i < 6; ++i) a[6 * k + i] = -column[i];
    a[7 * k] = inverse;
  }
  return true;
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
  return std::all_of(inverse_.begin(), inverse_.end(), [](Mat6& B) { return invert(B); });
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
