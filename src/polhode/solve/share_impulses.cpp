// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <numeric>
#include <vector>

#include <polhode/solve/share_impulses.hpp>

namespace polhode {

namespace {

/// Eigenvalues below this part of the largest count as zero.
constexpr double kPseudoInverse = 1e-9;

Vec pseudo_solution(const Mat& A, const Vec& change) {
  const Eigen::SelfAdjointEigenSolver<Mat> eigen(A);
  const Vec& values = eigen.eigenvalues();
  const double least = kPseudoInverse * values[values.size() - 1];
  Vec p = eigen.eigenvectors().transpose() * change;
  for (Eigen::Index k = 0; k < p.size(); ++k) p[k] = values[k] > least ? p[k] / values[k] : 0.0;
  return eigen.eigenvectors() * p;
}

/// Rows that would have to push are left out, one round after the other.
Vec taking_impulses(const Mat& A, const Vec& change) {
  std::vector<Eigen::Index> acting(static_cast<std::size_t>(change.size()));
  std::iota(acting.begin(), acting.end(), Eigen::Index{0});
  Vec impulses = Vec::Zero(change.size());
  while (!acting.empty()) {
    const Vec p = pseudo_solution(A(acting, acting), change(acting));
    impulses.setZero();
    impulses(acting) = p;
    const double most = p.lpNorm<Eigen::Infinity>();
    if (std::erase_if(acting,
                      [&](Eigen::Index k) { return impulses[k] > kPseudoInverse * most; }) == 0)
      return impulses;
  }
  return Vec::Zero(change.size());
}

}  // namespace

SharedImpulses share_impulses(const Mat& A, const Vec& before, Vec wanted) {
  wanted = wanted.cwiseMin(before);
  const auto lost = [&](const Vec& p) { return -p.dot(before + 0.5 * A * p); };
  SharedImpulses shared{taking_impulses(A, wanted - before)};
  shared.energy_lost = lost(shared.impulses);
  if (shared.energy_lost >= 0.0) return shared;
  const double least = std::max(0.0, wanted.cwiseQuotient(before).minCoeff());
  wanted = least * before;
  shared.impulses = taking_impulses(A, wanted - before);
  shared.energy_lost = lost(shared.impulses);
  if (!(shared.energy_lost >= 0.0)) shared = {Vec::Zero(before.size()), 0.0};
  return shared;
}

}  // namespace polhode
