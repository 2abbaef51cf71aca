// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <vector>

#include <Eigen/LU>
#include <polhode/statics/clarke_combination.hpp>

namespace polhode {

namespace {

constexpr std::size_t kMax = 4;

}  // namespace

void ClarkeCombination::add(const Vec& residual) {
  residuals_.push_back(residual);
  if (residuals_.size() > kMax) residuals_.pop_front();
}

/// Shortest convex combination, by enumeration of the subsets of residuals: where all weights of
/// the shortest affine combination are positive it is a convex one, and the shortest of these is
/// the minimum.
Vec ClarkeCombination::shortest() const {
  const auto count = static_cast<int>(residuals_.size());
  Eigen::MatrixXd products(count, count);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) products(i, j) = residuals_[i].dot(residuals_[j]);
  double least = products(count - 1, count - 1);
  Eigen::VectorXd best = Eigen::VectorXd::Unit(count, count - 1);
  for (unsigned set = 1; set < 1U << count; ++set) {
    std::vector<int> sides;
    for (int i = 0; i < count; ++i)
      if (set & 1U << i) sides.push_back(i);
    const auto k = static_cast<Eigen::Index>(sides.size());
    // 2 P w = μ 1, 1·w = 1
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(k + 1, k + 1);
    for (Eigen::Index i = 0; i < k; ++i) {
      for (Eigen::Index j = 0; j < k; ++j) A(i, j) = products(sides[i], sides[j]);
      A(i, k) = A(k, i) = products.trace() / count;
    }
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(A);
    if (!lu.isInvertible()) continue;
    const Eigen::VectorXd w = lu.solve(Eigen::VectorXd::Unit(k + 1, k) * A(0, k)).head(k);
    if (!(w.minCoeff() >= 0.0)) continue;
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(count);
    for (Eigen::Index i = 0; i < k; ++i) weights[sides[i]] = w[i];
    const double size = weights.dot(products * weights);
    if (size < least) {
      least = size;
      best = weights;
    }
  }
  Vec mixture = Vec::Zero(residuals_.back().size());
  for (int i = 0; i < count; ++i) mixture += best[i] * residuals_[i];
  return mixture;
}

}  // namespace polhode
