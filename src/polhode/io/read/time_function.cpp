// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/read/time_function.hpp>

#include <algorithm>
#include <cmath>

namespace polhode::io {
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

TimeBounds ConstantFunction::bounds(double, double) const { return {std::abs(value_), 0.0}; }

TimeBounds ExpressionFunction::bounds(double from, double to) const {
  const TimeBounds b = expression_->bounds(from, to);
  // Roots and poles have infinite slopes: samples show the behaviour from there on.
  if (!std::isfinite(b.size) || !std::isfinite(b.curvature)) return TimeFunction::bounds(from, to);
  return {std::abs(factor_) * b.size, std::abs(factor_) * b.curvature};
}

TableFunction::TableFunction(std::vector<double> times, std::vector<double> values,
                             Interpolation interpolation, bool periodic)
    : times_(std::move(times)),
      values_(std::move(values)),
      interpolation_(interpolation),
      periodic_(periodic) {
  if (interpolation_ == Interpolation::kCubic)
    curvatures_ = spline_curvatures(times_, values_, periodic_);
}

double TableFunction::in_table(double t) const {
  if (!periodic_) return t;
  const double first = times_.front(), last = times_.back();
  t = first + std::fmod(t - first, last - first);
  if (t < first) t += last - first;
  return t < last ? t : first;
}

int TableFunction::interval(double t) const {
  if (t < times_.front()) return -1;
  if (t >= times_.back()) return static_cast<int>(times_.size()) - 1;
  return static_cast<int>(std::upper_bound(times_.begin(), times_.end(), t) - times_.begin()) - 1;
}

double TableFunction::operator()(double t) const {
  t = in_table(t);
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
  const double near = beside(t, side), way = t - near, in = in_table(near);
  TimeRates r{(*this)(near), 0.0, 0.0};
  const int interval = this->interval(in);
  if (interval < 0 || interval + 1 >= static_cast<int>(times_.size())) return r;
  if (interpolation_ == Interpolation::kStep) return r;
  const auto k = static_cast<std::size_t>(interval);
  const double h = times_[k + 1] - times_[k], b = (in - times_[k]) / h, a = 1.0 - b;
  r.rate = (values_[k + 1] - values_[k]) / h;
  if (interpolation_ == Interpolation::kCubic) {
    r.rate +=
        h / 6.0 * ((1.0 - 3.0 * a * a) * curvatures_[k] + (3.0 * b * b - 1.0) * curvatures_[k + 1]);
    r.second = a * curvatures_[k] + b * curvatures_[k + 1];
  }
  return r.moved(way);
}

TimeBreak TableFunction::next_break(double t, double until) const {
  const double after = t + kSameBreak * std::abs(t);
  const double first = times_.front(), period = times_.back() - first;
  const double turns = periodic_ ? std::floor((after - first) / period) : 0.0;
  auto point = std::upper_bound(times_.begin(), times_.end(), after - turns * period);
  double at = 0.0;
  if (point != times_.end()) {
    at = *point + turns * period;
  } else if (periodic_) {  // the period's end is its first point
    point = times_.begin() + 1;
    at = *point + (turns + 1.0) * period;
  } else {
    return {};
  }
  if (!(at > after) || at > until) return {};
  if (interpolation_ == Interpolation::kStep) return {at, 0};
  if (interpolation_ == Interpolation::kLinear) return {at, 1};
  // The end value is constant before and after a table: a spline has a kink there.
  const bool at_end = point == times_.begin() || point + 1 == times_.end();
  return {at, at_end && !periodic_ ? 1 : 3};
}

TimeBounds TableFunction::bounds(double from, double to) const {
  TimeBounds b{std::max(std::abs((*this)(from)), std::abs((*this)(to))), 0.0};
  const double period = times_.back() - times_.front();
  const double start = in_table(from), end = start + (to - from);
  const auto over = [&](double low, double high) {
    auto k = std::upper_bound(times_.begin(), times_.end(), low) - times_.begin();
    k = std::max<std::ptrdiff_t>(k - 1, 0);
    for (auto i = static_cast<std::size_t>(k); i < times_.size(); ++i) {
      if (times_[i] >= high) return;
      if (times_[i] >= low) b.size = std::max(b.size, std::abs(values_[i]));
      if (interpolation_ != Interpolation::kCubic || i + 1 == times_.size()) continue;
      const double h = times_[i + 1] - times_[i];
      const double M = std::max(std::abs(curvatures_[i]), std::abs(curvatures_[i + 1]));
      b.curvature = std::max(b.curvature, M);
      b.size = std::max(b.size,
                        std::max(std::abs(values_[i]), std::abs(values_[i + 1])) + h * h / 8.0 * M);
    }
  };
  over(start, end);
  if (periodic_) over(start - period, end - period);
  if (periodic_ && to - from >= period) over(times_.front(), times_.back() + period);
  return b;
}

}  // namespace polhode::io
