// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include <polhode/beams/cable_friction.hpp>

namespace polhode {

namespace {

/// Largest number of Gauss-Seidel sweeps over the points in the search for the slip directions.
constexpr int kMaxGripSweeps = 5000;
/// Change of tension in a sweep, as a part of the largest one, at which the sweeps end.
constexpr double kGripFound = 1e-14;

}  // namespace

CableFriction::CableFriction(std::vector<double> stiffness)
    : k_(Eigen::Map<const Vec>(stiffness.data(), static_cast<Eigen::Index>(stiffness.size()))) {
  const double whole = 1.0 / k_.cwiseInverse().sum();
  stretch_ = Mat::Constant(k_.size(), k_.size(), -whole);
  stretch_.diagonal() += k_;
}

Vec CableFriction::by_slip(Eigen::Index point) const {
  Vec change = Vec::Zero(k_.size());
  change[point] = k_[point];
  change[point + 1] = -k_[point + 1];
  return change;
}

/// Slip by Gauss-Seidel iteration: each point slips until it just sticks. The matrix is diagonally
/// dominant.
CableFriction::Slip CableFriction::search(Vec N, const Vec& a, const Vec& b) const {
  const Eigen::Index points = k_.size() - 1;
  Slip slip{Vec::Zero(points), std::vector<int>(static_cast<std::size_t>(points), 0)};
  const double scale = std::max(N.cwiseAbs().maxCoeff(), 1e-300);
  for (int sweep = 0; sweep < kMaxGripSweeps; ++sweep) {
    double most = 0.0;
    for (Eigen::Index j = 0; j < points; ++j) {
      const double before = slip.q[j];
      const double first = N[j] - k_[j] * before, second = N[j + 1] + k_[j + 1] * before;
      const double up = a[j] * second - first - b[j], down = a[j] * first - second - b[j];
      double q = 0.0;
      if (up > 0.0)
        q = up / (a[j] * k_[j + 1] + k_[j]);
      else if (down > 0.0)
        q = -down / (a[j] * k_[j] + k_[j + 1]);
      slip.q[j] = q;
      slip.sign[static_cast<std::size_t>(j)] = q > 0.0 ? 1 : q < 0.0 ? -1 : 0;
      N[j] = first + k_[j] * q;
      N[j + 1] = second - k_[j + 1] * q;
      most = std::max(most, std::abs(q - before) * (k_[j] + k_[j + 1]));
    }
    if (most <= kGripFound * scale) break;
  }
  return slip;
}

/// @eq{cable-capstan}
CableFriction::Held CableFriction::hold(const Vec& trial, const Vec& ratio) const {
  const Eigen::Index pieces = k_.size(), points = pieces - 1;
  Held held{trial, Mat::Identity(pieces, pieces), Mat::Zero(pieces, points), false};
  // Σ N_k/k_k is invariant under slip: a cable that is slack on the whole is slack everywhere.
  const Vec share = k_.cwiseInverse() / k_.cwiseInverse().sum();
  const double mean = share.dot(trial);
  if (mean <= 0.0) {
    held.tension.setConstant(mean);
    held.by_trial = Vec::Ones(pieces) * share.transpose();
    held.slips = true;
    return held;
  }
  const Slip slip = search(trial, ratio, Vec::Zero(points));
  std::vector<Eigen::Index> active;
  for (Eigen::Index j = 0; j < points; ++j)
    if (slip.sign[static_cast<std::size_t>(j)] != 0) active.push_back(j);
  if (active.empty()) return held;
  held.slips = true;
  // With known directions the slips solve linear equations, rows·(N + ways·q) = 0.
  const auto count = static_cast<Eigen::Index>(active.size());
  Mat rows = Mat::Zero(count, pieces), ways(pieces, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index j = active[static_cast<std::size_t>(i)];
    const bool up = slip.sign[static_cast<std::size_t>(j)] > 0;
    rows(i, up ? j + 1 : j) = ratio[j];
    rows(i, up ? j : j + 1) = -1.0;
    ways.col(i) = by_slip(j);
  }
  const Mat correct = ways * (rows * ways).inverse();
  held.by_trial -= correct * rows;
  held.tension = held.by_trial * trial;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index j = active[static_cast<std::size_t>(i)];
    const bool up = slip.sign[static_cast<std::size_t>(j)] > 0;
    held.by_ratio.col(j) = -correct.col(i) * ratio[j] * held.tension[up ? j + 1 : j];
  }
  return held;
}

Vec CableFriction::hold_differences(const Vec& trial, const Vec& most) const {
  const Slip slip = search(trial, Vec::Ones(most.size()), most);
  Vec N = trial;
  for (Eigen::Index j = 0; j < most.size(); ++j) N += slip.q[j] * by_slip(j);
  return N;
}

double CableFriction::energy(const Vec& parts) const {
  return 0.5 * parts.cwiseAbs2().cwiseQuotient(k_).sum();
}

}  // namespace polhode
