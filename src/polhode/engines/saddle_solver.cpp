// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/core/format.hpp>
#include <polhode/engines/saddle_solver.hpp>

namespace polhode {

namespace {

/// Part of the terms of its sum below which the force of a motion counts as zero.
constexpr double kFreeForce = 2e-14;
/// Part of the largest stiffness added to the diagonal in the search for free motions.
constexpr double kProbe = 1e-8;
constexpr int kProbeIterations = 3;
/// Component of a direction below which it is not named.
constexpr double kNoPart = 1e-6;

/// Pseudo-random numbers between −1 and 1, the same on every machine.
class Scatter {
 public:
  double operator()() {
    x_ = x_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(static_cast<std::int64_t>(x_)) * 0x1p-63;
  }

 private:
  std::uint64_t x_ = 88172645463325252ULL;
};

}  // namespace

bool SaddleSolver::factor(SaddleMatrix& matrix, bool symmetric,
                          const std::vector<double>& diagonal) {
  symmetric_ = symmetric;
  std::optional<linear::Mumps>& mumps = symmetric ? ldl_ : lu_;
  const int n = matrix.movable();
  if (!mumps) {
    mumps.emplace(symmetric ? linear::Mumps::Symmetry::symmetric : linear::Mumps::Symmetry::none);
    std::vector<int> rows = symmetric ? matrix.lower_row() : matrix.row();
    std::vector<int> columns = symmetric ? matrix.lower_column() : matrix.column();
    for (int i = 0; i < n; ++i) {
      rows.push_back(i);
      columns.push_back(i);
    }
    mumps->analyse(matrix.size(), rows, columns);
  }
  values_ = symmetric ? matrix.lower_values() : matrix.values();
  if (diagonal.empty())
    values_.insert(values_.end(), n, 0.0);
  else
    values_.insert(values_.end(), diagonal.begin(), diagonal.begin() + n);
  for (double x : values_)
    if (!std::isfinite(x)) return false;
  return mumps->factor(values_.data());
}

void SaddleSolver::solve(Vec& x) const { (symmetric_ ? *ldl_ : *lu_).solve(x.data()); }

std::vector<Vec> free_motions(SaddleMatrix& matrix, double length, int most,
                              const std::vector<Vec>& known) {
  const int n = matrix.movable();
  std::vector<Vec> found;
  if (n == 0) return found;
  for (Vec x : known) {
    if (static_cast<int>(found.size()) == most) return found;
    for (const Vec& other : found)
      x.head(n) -= other.head(n).dot(x.head(n)) / other.head(n).squaredNorm() * other.head(n);
    found.push_back(x / x.head(n).lpNorm<Eigen::Infinity>());
  }
  double largest = 0.0;
  for (std::size_t k = 0; k < matrix.values().size(); ++k)
    if (matrix.row()[k] < n && matrix.column()[k] < n)
      largest = std::max(largest, std::abs(matrix.values()[k]));
  const double probe = kProbe * (largest > 0.0 ? largest : 1.0);
  std::vector<double> diagonal(n, probe);
  for (int b = 0; b < matrix.bodies(); ++b)
    for (int k = 3; k < 6; ++k) diagonal[6 * b + k] *= length * length;
  SaddleSolver solver;
  if (!solver.factor(matrix, matrix.asymmetry() < 1e-7, diagonal)) return found;
  Scatter scatter;
  Vec force(matrix.size()), terms(matrix.size());
  while (static_cast<int>(found.size()) < most) {
    Vec x = Vec::Zero(matrix.size());
    for (int i = 0; i < n; ++i) x[i] = scatter();
    for (int k = 0; k < kProbeIterations; ++k) {
      for (const Vec& other : found)
        x.head(n) -= other.head(n).dot(x.head(n)) / other.head(n).squaredNorm() * other.head(n);
      for (int i = 0; i < n; ++i) x[i] *= diagonal[i] / probe;
      x.tail(matrix.size() - n).setZero();
      solver.solve(x);
      if (!x.allFinite()) return found;
      x /= x.head(n).lpNorm<Eigen::Infinity>();
    }
    for (const Vec& other : found)
      x.head(n) -= other.head(n).dot(x.head(n)) / other.head(n).squaredNorm() * other.head(n);
    x.head(n) /= x.head(n).lpNorm<Eigen::Infinity>();
    x.tail(matrix.size() - n).setZero();
    matrix.times(x, force);
    matrix.magnitudes(x, terms);
    if (force.lpNorm<Eigen::Infinity>() >
        kFreeForce * std::max(terms.lpNorm<Eigen::Infinity>(), largest))
      return found;
    found.push_back(x);
  }
  return found;
}

std::vector<int> supports_of(const std::vector<Vec>& motions, const SaddleMatrix& matrix,
                             double length) {
  const auto count = static_cast<Eigen::Index>(motions.size());
  Mat V(matrix.movable(), count);
  for (Eigen::Index k = 0; k < count; ++k)
    V.col(k) = motions[static_cast<std::size_t>(k)].head(matrix.movable());
  for (int b = 0; b < matrix.bodies(); ++b) V.middleRows(6 * b + 3, 3) *= length;
  std::vector<int> unknowns;
  for (Eigen::Index k = 0; k < count; ++k) {
    Eigen::Index row = 0, column = 0;
    V.rightCols(count - k).cwiseAbs().maxCoeff(&row, &column);
    V.col(k).swap(V.col(k + column));
    if (V(row, k) == 0.0) break;
    for (Eigen::Index j = k + 1; j < count; ++j) V.col(j) -= V(row, j) / V(row, k) * V.col(k);
    unknowns.push_back(static_cast<int>(row));
  }
  return unknowns;
}

std::string axis_text(Vec3 u) {
  for (double& c : u)
    if (std::abs(c) < kNoPart) c = 0.0;
  Eigen::Index axis = 0;
  if (u.cwiseAbs().maxCoeff(&axis) > 0.999) return std::string(1, "xyz"[axis]);
  return format("({:.3g}, {:.3g}, {:.3g})", u[0], u[1], u[2]);
}

std::string describe_motion(const System& system, const SaddleMatrix& matrix, const Vec& x) {
  const double length = system.length_scale();
  double most = 0.0;
  std::string text = "nothing moves";
  for (int b = 0; b < system.body_count(); ++b) {
    const Vec3 r = x.segment<3>(6 * b), theta = length * x.segment<3>(6 * b + 3);
    for (const bool turns : {false, true}) {
      const Vec3& d = turns ? theta : r;
      if (d.norm() <= 1.001 * most) continue;
      most = d.norm();
      text = format("body '{}' {} {}", system.bodies()[b].name,
                    turns ? "rotates about" : "moves along", axis_text(d.normalized()));
    }
  }
  const Nodes& nodes = system.nodes();
  int node = -1;
  for (int i = 0; i < nodes.count(); ++i)
    for (int c = 0; c < 3; ++c) {
      const int u = matrix.unknown(i, c);
      if (u < 0 || std::abs(x[u]) <= 1.001 * most) continue;
      most = std::abs(x[u]);
      node = i;
    }
  if (node < 0) return text;
  const NodePlace place = nodes.place_of(node);
  if (place.group < 0) return format("node {} moves", node);
  return format("'{}' moves, most at node {}", nodes.group(place.group).name(), place.number);
}

}  // namespace polhode
