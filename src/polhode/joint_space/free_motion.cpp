// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <polhode/joint_space/free_motion.hpp>
#include <polhode/math/exp_map.hpp>
#include <polhode/math/hat.hpp>

namespace polhode {

namespace {

/// Coefficients of the tangent of the exponential map B(χ) = I + c₁ χ̂ + c₂ χ̂², and d_i =
/// (dc_i/dχ)/χ, by their power series, which converge to round-off up to several turns.
struct SpinSeries {
  double c1 = 0.0, c2 = 0.0, d1 = 0.0, d2 = 0.0;

  explicit SpinSeries(double chi_squared) {
    double power = 1.0, before = 0.0;  // (−χ²)ᵏ, and −(−χ²)^(k−1)
    double factorial = 2.0;            // (2k + 2)!
    for (int k = 0; k < 24; ++k) {
      c1 += power / factorial;
      c2 += power / (factorial * (2 * k + 3));
      d1 += 2 * k * before / factorial;
      d2 += 2 * k * before / (factorial * (2 * k + 3));
      factorial *= (2.0 * k + 3.0) * (2.0 * k + 4.0);
      before = -power;
      power *= -chi_squared;
    }
  }
};

/// B(χ): angular velocity in the axes of the reference frame, by the rate of the rotation vector.
Mat3 spin_by_rate(const Vec3& chi) {
  const SpinSeries f(chi.squaredNorm());
  const Mat3 X = hat(chi);
  return Mat3::Identity() + f.c1 * X + f.c2 * X * X;
}

/// Its rate of change.
Mat3 spin_by_rate_change(const Vec3& chi, const Vec3& rate) {
  const SpinSeries f(chi.squaredNorm());
  const Mat3 X = hat(chi), V = hat(rate);
  const double along = chi.dot(rate);
  return f.d1 * along * X + f.c1 * V + f.d2 * along * X * X + f.c2 * (V * X + X * V);
}

}  // namespace

FreeMotion::FreeMotion(const std::vector<std::string>& names, bool equal_turns)
    : equal_turns_(equal_turns) {
  for (const std::string& name : names)
    (name.size() == 1 ? slides_ : turns_).push_back(name.back() - 'x');
}

bool FreeMotion::counts_turns(int k) const {
  return k >= static_cast<int>(slides_.size()) && !is_rotation_vector();
}

RelativePose FreeMotion::pose(const double* q) const {
  RelativePose pose;
  for (int axis : slides_) pose.d[axis] = *q++;
  Vec3 chi = Vec3::Zero();
  for (int axis : turns_) {
    if (is_rotation_vector())
      chi[axis] = *q++;
    else
      pose.R *= exp_map(*q++ * Vec3::Unit(axis));
  }
  if (is_rotation_vector()) pose.R = exp_map(chi);
  return pose;
}

void FreeMotion::read(const RelativePose& pose, double* q) const {
  for (int axis : slides_) *q++ = pose.d[axis];
  if (is_rotation_vector()) {
    const Vec3 chi = log_map(pose.R);
    for (int axis : turns_) *q++ = chi[axis];
    return;
  }
  if (turns_.size() == 1) {  // about z from x to y, and cyclic
    const int x = (turns_[0] + 1) % 3, y = (x + 1) % 3;
    *q = std::atan2(pose.R(y, x), pose.R(x, x));
  }
  if (turns_.size() == 2) {
    const int i = turns_[0], j = turns_[1], k = 3 - i - j;
    const double sense = (i + 1) % 3 == j ? 1.0 : -1.0;  // e_i × e_j = sense e_k
    q[0] = std::atan2(sense * pose.R(k, j), pose.R(j, j));
    q[1] = std::atan2(sense * pose.R(i, k), pose.R(i, i));
  }
}

Mat3 FreeMotion::spin(const double* q) const {
  return spin_by_rate(Eigen::Map<const Vec3>(q + slides_.size()));
}

void FreeMotion::directions(const PlacedFrames& at, const double* q, MotionVector* s) const {
  for (int axis : slides_) *s++ = {at.R_a.col(axis), Vec3::Zero()};
  const auto turn = [&](const Vec3& e) { *s++ = {at.x_b.cross(e), e}; };
  if (equal_turns_) {
    Vec3 chi = Vec3::Zero();
    for (std::size_t k = 0; k < turns_.size(); ++k) chi[turns_[k]] = q[slides_.size() + k];
    const Mat3 B = at.R_a * spin_by_rate(chi);
    for (int axis : turns_) turn(B.col(axis));
  } else if (turns_.size() == 2) {
    turn(at.R_a.col(turns_[0]));
    turn(at.R_b.col(turns_[1]));
  } else {
    for (int axis : turns_) turn(at.R_a.col(axis));
  }
}

void FreeMotion::direction_rates(const PlacedFrames& at, const double* q, const double* rates,
                                 const MotionVector& of_a, const MotionVector& of_b,
                                 MotionVector* s) const {
  for (int axis : slides_) *s++ = {of_a.angular.cross(at.R_a.col(axis)), Vec3::Zero()};
  const Vec3 x_dot = of_b.at(at.x_b);
  const auto turn = [&](const Vec3& e, const Vec3& e_dot) {
    *s++ = {x_dot.cross(e) + at.x_b.cross(e_dot), e_dot};
  };
  if (equal_turns_) {
    Vec3 chi = Vec3::Zero(), chi_dot = Vec3::Zero();
    for (std::size_t k = 0; k < turns_.size(); ++k) {
      chi[turns_[k]] = q[slides_.size() + k];
      chi_dot[turns_[k]] = rates[slides_.size() + k];
    }
    const Mat3 B = at.R_a * spin_by_rate(chi);
    const Mat3 B_dot = at.R_a * spin_by_rate_change(chi, chi_dot);
    for (int axis : turns_) turn(B.col(axis), of_a.angular.cross(B.col(axis)) + B_dot.col(axis));
  } else if (turns_.size() == 2) {
    const Vec3 e = at.R_a.col(turns_[0]), f = at.R_b.col(turns_[1]);
    turn(e, of_a.angular.cross(e));
    turn(f, of_b.angular.cross(f));
  } else {
    for (int axis : turns_) turn(at.R_a.col(axis), of_a.angular.cross(at.R_a.col(axis)));
  }
}

}  // namespace polhode
