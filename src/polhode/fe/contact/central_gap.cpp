// SPDX-License-Identifier: Apache-2.0
#include <polhode/fe/contact/central_gap.hpp>

namespace polhode {

namespace {

constexpr int kLengths = NearestFour::kLengths;
/// Changes of squared lengths below this part of them have no direction.
constexpr double kNoDirection = 1e-14;

}  // namespace

/// @eq{central-gap}
CentralGap::CentralGap(const FourMoves& from, const NearestFour& at_n, const FourMoves* to,
                       const NearestFour& at_n1, double alpha_f, bool conserving)
    : alpha_(alpha_f),
      d_n_(at_n.distance),
      d_n1_(at_n1.distance),
      d_alpha_((1.0 - alpha_f) * d_n_ + alpha_f * d_n1_) {
  const int sets = to ? 2 : 1, last = kLengths * (sets - 1);
  points_ = 4 * sets;
  lengths_ = kLengths * sets;
  for (int set = 0; set < sets; ++set) {
    const FourMoves& moves = set == 0 ? from : *to;
    Vec3 x[4];
    moves.at(alpha_f, x);
    for (int i = 0; i < 4; ++i) {
      x_alpha_[4 * set + i] = x[i];
      x_n1_[4 * set + i] = moves.x_n1[i];
    }
  }
  change_.resize(lengths_);
  double size = 0.0;
  for (int set = 0; set < sets; ++set) {
    const FourMoves& moves = set == 0 ? from : *to;
    for (int l = 0; l < kLengths; ++l) {
      const int i = NearestFour::kEnds[l][0], j = NearestFour::kEnds[l][1];
      ends_[kLengths * set + l][0] = 4 * set + i;
      ends_[kLengths * set + l][1] = 4 * set + j;
      const Vec3 du = moves.u[i] - moves.u[j], x = moves.x_n1[i] - moves.x_n1[j];
      change_[kLengths * set + l] = (2.0 * x - du).dot(du);
      size += x.squaredNorm();
    }
  }
  const FourMoves& at_end = to ? *to : from;
  g_n1_.setZero(lengths_);
  g_n1_.segment<kLengths>(last) = at_n1.gradient();
  H_n1_.setZero(lengths_, lengths_);
  H_n1_.block<kLengths, kLengths>(last, last) = at_n1.hessian(at_end.x_n1);
  mean_ = alpha_ * g_n1_;
  mean_.head<kLengths>() += (1.0 - alpha_) * at_n.gradient();
  g_ = mean_;
  sign_ = mean_.unaryExpr([](double g) { return g < 0.0 ? -1.0 : 1.0; });
  change_squared_ = mean_.cwiseAbs().dot(change_.cwiseAbs2());
  // Off the middle of the step ḡ is not the mean that tangential moves drop out of.
  if (!conserving || alpha_ != 0.5 ||
      !(change_squared_ > kNoDirection * kNoDirection * size * size)) {
    change_squared_ = 0.0;
    return;
  }
  kappa_ = ((d_n1_ - d_n_) * (d_n1_ + d_n_) - mean_.dot(change_)) / change_squared_;
  g_ += kappa_ * mean_.cwiseAbs().cwiseProduct(change_);
}

/// ∂s/∂x by point.
CentralGap::Slopes CentralGap::slopes(const Vec3 (&x)[kMostPoints]) const {
  Slopes B = Slopes::Zero(lengths_, 3 * points_);
  for (int l = 0; l < lengths_; ++l) {
    const int i = ends_[l][0], j = ends_[l][1];
    const Vec3 s = 2.0 * (x[i] - x[j]);
    B.block<1, 3>(l, 3 * i) = s.transpose();
    B.block<1, 3>(l, 3 * j) = -s.transpose();
  }
  return B;
}

CentralGap::Force CentralGap::force(double lambda) const {
  Force f = Force::Zero(3 * points_);
  const double mu = lambda / (2.0 * d_alpha_);
  for (int l = 0; l < lengths_; ++l) {
    const int i = ends_[l][0], j = ends_[l][1];
    const Vec3 along = 2.0 * mu * g_[l] * (x_alpha_[i] - x_alpha_[j]);
    f.segment<3>(3 * i) += along;
    f.segment<3>(3 * j) -= along;
  }
  return f;
}

CentralGap::Force CentralGap::slope() const {
  return slopes(x_n1_).transpose() * g_n1_ / (2.0 * d_n1_);
}

CentralGap::Stiffness CentralGap::stiffness(const contact::ForceAndSlope& lambda) const {
  const double mu = lambda.value / (2.0 * d_alpha_);
  const Lengths d_slope = g_n1_ / (2.0 * d_n1_);
  const Lengths mu_slope = (lambda.slope / (2.0 * d_alpha_) - mu * alpha_ / d_alpha_) * d_slope;
  Square Q = g_ * mu_slope.transpose();
  if (change_squared_ > 0.0) {
    const Lengths weighted = mean_.cwiseAbs().cwiseProduct(change_);
    const Lengths of_mean = change_ + kappa_ * sign_.cwiseProduct(change_.cwiseAbs2());
    const Lengths kappa_slope =
        (g_n1_ - mean_ - alpha_ * H_n1_.transpose() * of_mean - 2.0 * kappa_ * weighted) /
        change_squared_;
    const Lengths factor = Lengths::Ones(lengths_) + kappa_ * sign_.cwiseProduct(change_);
    Q += mu * alpha_ * factor.asDiagonal() * H_n1_;
    Q += mu * weighted * kappa_slope.transpose();
    Q.diagonal() += mu * kappa_ * mean_.cwiseAbs();
  } else {
    Q += mu * alpha_ * H_n1_;
  }
  const Slopes B_alpha = slopes(x_alpha_), B_n1 = slopes(x_n1_);
  const Slopes QB = Q * B_n1;
  Stiffness K = B_alpha.transpose() * QB;
  for (int l = 0; l < lengths_; ++l) {
    const int i = ends_[l][0], j = ends_[l][1];
    const double k = 2.0 * alpha_ * mu * g_[l];
    for (int r = 0; r < 3; ++r) {
      K(3 * i + r, 3 * i + r) += k;
      K(3 * j + r, 3 * j + r) += k;
      K(3 * i + r, 3 * j + r) -= k;
      K(3 * j + r, 3 * i + r) -= k;
    }
  }
  return K;
}

}  // namespace polhode
