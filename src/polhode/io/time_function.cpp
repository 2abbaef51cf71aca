// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/time_function.hpp>

#include <algorithm>
#include <cmath>

namespace polhode {
namespace {

/// Solves a tridiagonal system (Thomas); lower[0] and upper[n-1] are not used.
std::vector<double> solve_tridiagonal(const std::vector<double>& lower,
                                      std::vector<double> diagonal,
                                      const std::vector<double>& upper, std::vector<double> right) {
  const std::size_t n = diagonal.size();
  for (std::size_t k = 1; k < n; ++k) {
    const double factor = lower[k] / diagonal[k - 1];
    diagonal[k] -= factor * upper[k - 1];
    right[k] -= factor * right[k - 1];
  }
  for (std::size_t k = n; k-- > 0;) {
    if (k + 1 < n) right[k] -= upper[k] * right[k + 1];
    right[k] /= diagonal[k];
  }
  return right;
}

/// Second derivatives of the cubic spline through the points: continuous slopes at each of them,
///   h₋ M₋/6 + (h₋ + h₊) M/3 + h₊ M₊/6 = (v₊ − v)/h₊ − (v − v₋)/h₋.
/// Natural: M = 0 at the ends. Periodic: the ends are one point (Sherman-Morrison for the corners).
std::vector<double> spline_curvatures(const std::vector<double>& t, const std::vector<double>& v,
                                      bool periodic) {
  const std::size_t n = t.size() - 1;  // Intervals.
  const auto h = [&](std::size_t k) { return t[k + 1] - t[k]; };
  const auto slope = [&](std::size_t k) { return (v[k + 1] - v[k]) / h(k); };
  std::vector<double> M(n + 1, 0.0);
  if (!periodic) {
    if (n < 2) return M;
    std::vector<double> lower(n - 1), diagonal(n - 1), upper(n - 1), right(n - 1);
    for (std::size_t k = 1; k < n; ++k) {
      lower[k - 1] = h(k - 1) / 6.0;
      diagonal[k - 1] = (h(k - 1) + h(k)) / 3.0;
      upper[k - 1] = h(k) / 6.0;
      right[k - 1] = slope(k) - slope(k - 1);
    }
    const std::vector<double> inner = solve_tridiagonal(lower, diagonal, upper, right);
    std::copy(inner.begin(), inner.end(), M.begin() + 1);
    return M;
  }
  // Unknowns M_0 ... M_{n-1}; the point before 0 is n-1.
  std::vector<double> lower(n), diagonal(n), upper(n), right(n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t before = k == 0 ? n - 1 : k - 1;
    lower[k] = h(before) / 6.0;
    diagonal[k] = (h(before) + h(k)) / 3.0;
    upper[k] = h(k) / 6.0;
    right[k] = slope(k) - slope(before);
  }
  if (n <= 2) {  // The neighbours coincide.
    if (n == 2) {
      const double off = lower[0] + upper[0];
      const double determinant = diagonal[0] * diagonal[1] - off * off;
      M[0] = (right[0] * diagonal[1] - off * right[1]) / determinant;
      M[1] = (right[1] * diagonal[0] - off * right[0]) / determinant;
    }
  } else {
    const double corner = lower[0];
    const double gamma = -diagonal[0];
    std::vector<double> changed = diagonal;
    changed[0] -= gamma;
    changed[n - 1] -= corner * corner / gamma;
    std::vector<double> u(n, 0.0);
    u[0] = gamma;
    u[n - 1] = corner;
    const std::vector<double> x = solve_tridiagonal(lower, changed, upper, right);
    const std::vector<double> z = solve_tridiagonal(lower, changed, upper, u);
    const double ratio = corner / gamma;
    const double factor = (x[0] + ratio * x[n - 1]) / (1.0 + z[0] + ratio * z[n - 1]);
    for (std::size_t k = 0; k < n; ++k) M[k] = x[k] - factor * z[k];
  }
  M[n] = M[0];
  return M;
}

}  // namespace

TableFunction::TableFunction(std::vector<double> times, std::vector<double> values,
                             Interpolation interpolation, bool periodic)
    : times_(std::move(times)),
      values_(std::move(values)),
      interpolation_(interpolation),
      periodic_(periodic) {
  if (interpolation_ == Interpolation::kCubic)
    curvatures_ = spline_curvatures(times_, values_, periodic_);
}

int TableFunction::interval(double& t) const {
  const double first = times_.front(), last = times_.back();
  if (periodic_) {
    t = first + std::fmod(t - first, last - first);
    if (t < first) t += last - first;
    if (t >= last) t = first;
  }
  if (t < first) return -1;
  if (t >= last) return static_cast<int>(times_.size()) - 1;
  return static_cast<int>(std::upper_bound(times_.begin(), times_.end(), t) - times_.begin()) - 1;
}

double TableFunction::operator()(double t) const {
  const int interval = this->interval(t);
  if (interval < 0) return values_.front();
  const auto k = static_cast<std::size_t>(interval);
  if (k + 1 == times_.size() || interpolation_ == Interpolation::kStep) return values_[k];
  const double h = times_[k + 1] - times_[k];
  const double b = (t - times_[k]) / h, a = 1.0 - b;
  const double straight = a * values_[k] + b * values_[k + 1];
  if (interpolation_ == Interpolation::kLinear) return straight;
  return straight +
         h * h / 6.0 * ((a * a * a - a) * curvatures_[k] + (b * b * b - b) * curvatures_[k + 1]);
}

TimeRates TableFunction::rates(double t, TimeSide side) const {
  t = beside(t, side);
  TimeRates r{(*this)(t), 0.0, 0.0};
  const int interval = this->interval(t);
  if (interval < 0 || interval + 1 >= static_cast<int>(times_.size())) return r;
  if (interpolation_ == Interpolation::kStep) return r;
  const auto k = static_cast<std::size_t>(interval);
  const double h = times_[k + 1] - times_[k], b = (t - times_[k]) / h, a = 1.0 - b;
  r.rate = (values_[k + 1] - values_[k]) / h;
  if (interpolation_ == Interpolation::kLinear) return r;
  r.rate +=
      h / 6.0 * ((1.0 - 3.0 * a * a) * curvatures_[k] + (3.0 * b * b - 1.0) * curvatures_[k + 1]);
  r.second = a * curvatures_[k] + b * curvatures_[k + 1];
  return r;
}

}  // namespace polhode
