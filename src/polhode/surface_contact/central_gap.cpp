// SPDX-License-Identifier: Apache-2.0
#include <polhode/surface_contact/central_gap.hpp>

namespace polhode::surface_contact {

namespace {

constexpr int kLengths = NearestFour::kLengths;
/// Relative change of squared lengths below which it has no direction.
constexpr double kNoCentralChange = 1e-14;

template <int kMaxSets>
typename CentralGapOf<kMaxSets>::Over between(const FourMoves& from, const NearestFour& at_n,
                                              const FourMoves* to, const NearestFour& at_n1) {
  typename CentralGapOf<kMaxSets>::Over over;
  over.sets = to ? 2 : 1;
  over.moves[0] = from;
  if (to) over.moves[1] = *to;
  over.d_n = at_n.distance;
  over.d_n1 = at_n1.distance;
  over.resize();
  const int last = kLengths * (over.sets - 1);
  over.g_n.template head<kLengths>() = at_n.gradient();
  over.g_n1.template segment<kLengths>(last) = at_n1.gradient();
  over.H_n1.template block<kLengths, kLengths>(last, last) =
      at_n1.hessian(over.moves[over.sets - 1].x_n1);
  return over;
}

}  // namespace

template <int kMaxSets>
CentralGapOf<kMaxSets>::CentralGapOf(const FourMoves& from, const NearestFour& at_n,
                                     const FourMoves* to, const NearestFour& at_n1, double alpha_f,
                                     bool conserving)
    : CentralGapOf(between<kMaxSets>(from, at_n, to, at_n1), alpha_f, conserving) {}

/// @eq{central-gap}
template <int kMaxSets>
CentralGapOf<kMaxSets>::CentralGapOf(const Over& over, double alpha_f, bool conserving)
    : points_(4 * over.sets),
      lengths_(kLengths * over.sets),
      alpha_(alpha_f),
      d_n_(over.d_n),
      d_n1_(over.d_n1),
      d_alpha_((1.0 - alpha_f) * d_n_ + alpha_f * d_n1_),
      g_n1_(over.g_n1),
      H_n1_(over.H_n1) {
  change_.resize(lengths_);
  double size = 0.0;
  for (int set = 0; set < over.sets; ++set) {
    const FourMoves& moves = over.moves[set];
    Vec3 at[4];
    moves.at(alpha_f, at);
    for (int i = 0; i < 4; ++i) {
      x_alpha_[4 * set + i] = at[i];
      x_n1_[4 * set + i] = moves.x_n1[i];
    }
    for (int l = 0; l < kLengths; ++l) {
      const int i = NearestFour::kEnds[l][0], j = NearestFour::kEnds[l][1];
      ends_[kLengths * set + l][0] = 4 * set + i;
      ends_[kLengths * set + l][1] = 4 * set + j;
      const Vec3 du = moves.u[i] - moves.u[j], x = moves.x_n1[i] - moves.x_n1[j];
      change_[kLengths * set + l] = (2.0 * x - du).dot(du);
      size += x.squaredNorm();
    }
  }
  mean_ = alpha_ * g_n1_ + (1.0 - alpha_) * over.g_n;
  g_ = mean_;
  sign_ = mean_.unaryExpr([](double g) { return g < 0.0 ? -1.0 : 1.0; });
  change_squared_ = mean_.cwiseAbs().dot(change_.cwiseAbs2());
  // Away from the midpoint ḡ is not the mean for which tangential displacements cancel.
  if (!conserving || alpha_ != 0.5 ||
      !(change_squared_ > kNoCentralChange * kNoCentralChange * size * size)) {
    change_squared_ = 0.0;
    return;
  }
  kappa_ = ((d_n1_ - d_n_) * (d_n1_ + d_n_) - mean_.dot(change_)) / change_squared_;
  g_ += kappa_ * mean_.cwiseAbs().cwiseProduct(change_);
}

/// ∂s/∂x of each point.
template <int kMaxSets>
typename CentralGapOf<kMaxSets>::Slopes CentralGapOf<kMaxSets>::slopes(
    const Vec3 (&x)[kMaxPoints]) const {
  Slopes B = Slopes::Zero(lengths_, 3 * points_);
  for (int l = 0; l < lengths_; ++l) {
    const int i = ends_[l][0], j = ends_[l][1];
    const Vec3 s = 2.0 * (x[i] - x[j]);
    B.template block<1, 3>(l, 3 * i) = s.transpose();
    B.template block<1, 3>(l, 3 * j) = -s.transpose();
  }
  return B;
}

template <int kMaxSets>
typename CentralGapOf<kMaxSets>::Force CentralGapOf<kMaxSets>::force(double lambda) const {
  Force f = Force::Zero(3 * points_);
  const double mu = lambda / (2.0 * d_alpha_);
  for (int l = 0; l < lengths_; ++l) {
    const int i = ends_[l][0], j = ends_[l][1];
    const Vec3 along = 2.0 * mu * g_[l] * (x_alpha_[i] - x_alpha_[j]);
    f.template segment<3>(3 * i) += along;
    f.template segment<3>(3 * j) -= along;
  }
  return f;
}

template <int kMaxSets>
typename CentralGapOf<kMaxSets>::Force CentralGapOf<kMaxSets>::slope() const {
  return slopes(x_n1_).transpose() * g_n1_ / (2.0 * d_n1_);
}

template <int kMaxSets>
typename CentralGapOf<kMaxSets>::Stiffness CentralGapOf<kMaxSets>::stiffness(
    const contact::ForceAndSlope& lambda) const {
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

template class CentralGapOf<2>;
template class CentralGapOf<kMaxTriangles>;

}  // namespace polhode::surface_contact
