// SPDX-License-Identifier: Apache-2.0
#include <polhode/study/grid_convergence.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace polhode {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kMinOrder = -4.0, kMaxOrder = 20.0;
/// Refinement ratio between runs below which they give no information.
constexpr double kMinRefinement = 1.05;

/// Sizes of the differences of two runs at each time; NaN where one of them has no value.
std::vector<double> sizes(const Mat& a, const Mat& b) {
  std::vector<double> list(static_cast<std::size_t>(a.rows()));
  for (std::size_t i = 0; i < list.size(); ++i)
    list[i] = (a.row(static_cast<Eigen::Index>(i)) - b.row(static_cast<Eigen::Index>(i))).norm();
  return list;
}

/// Mean and maximum of the entries of a part of two lists that exist in both.
struct Part {
  double coarse = 0.0, fine = 0.0, most = 0.0, most_fine = 0.0;
  std::size_t count = 0;
};

Part part_of(const std::vector<double>& coarse, const std::vector<double>& fine, std::size_t begin,
             std::size_t end) {
  Part part;
  for (std::size_t i = begin; i < end; ++i) {
    if (std::isnan(coarse[i]) || std::isnan(fine[i])) continue;
    part.coarse += coarse[i];
    part.fine += fine[i];
    part.most_fine = std::max(part.most_fine, fine[i]);
    part.most = std::max({part.most, coarse[i], fine[i]});
    ++part.count;
  }
  const double count = std::max<double>(1.0, static_cast<double>(part.count));
  part.coarse /= count;
  part.fine /= count;
  return part;
}

/// Part of the lists within that many entries of one.
Part part_about(const std::vector<double>& coarse, const std::vector<double>& fine, std::size_t i,
                std::size_t reach) {
  return part_of(coarse, fine, i - std::min(i, reach), std::min(fine.size(), i + reach + 1));
}

std::size_t samples_of(double part, std::size_t n) {
  return std::max<std::size_t>(
      1, static_cast<std::size_t>(std::lround(part * static_cast<double>(n))));
}

/// Error estimate of a difference with an observed order.
struct Trust {
  double order = 0.0, safety = 0.0;
  bool expected = false;
};

Trust trust(double observed, const RefinementRule& rule) {
  const auto distance = [&](double order) { return std::abs(observed - order) / order; };
  const double nearest =
      *std::min_element(rule.orders.begin(), rule.orders.end(),
                        [&](double a, double b) { return distance(a) < distance(b); });
  if (distance(nearest) <= rule.close) return {nearest, rule.safety_close, true};
  const double most = *std::max_element(rule.orders.begin(), rule.orders.end());
  return {std::clamp(observed, rule.least_order, most), rule.safety_far, false};
}

void check(const RefinedSeries& series, const RefinementRule& rule) {
  const auto rows = static_cast<Eigen::Index>(series.t.size());
  for (const Mat& values : series.values)
    if (values.rows() != rows || values.cols() != series.values[0].cols())
      throw std::invalid_argument("the runs have other times or components than one another");
  if (rule.orders.empty()) throw std::invalid_argument("no order of the method is given");
}

/// First time from which on most windows are lost; the number of times if there is none.
std::size_t first_lost(const std::vector<char>& lost, std::size_t least) {
  std::size_t count = 0, first = lost.size();
  for (std::size_t i = lost.size(); i-- > 0;) {
    count += lost[i] ? 1 : 0;
    if (lost[i] && 2 * count >= lost.size() - i && lost.size() - i >= least) first = i;
  }
  return first;
}

/// Norm of the first entries that are numbers.
std::optional<double> median(const std::vector<double>& list, std::size_t count) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < count; ++i)
    if (!std::isnan(list[i])) numbers.push_back(list[i]);
  if (numbers.empty()) return std::nullopt;
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

}  // namespace

double observed_order(double coarse, double fine, const std::array<double, 3>& h) {
  const double a = std::log(h[0] / h[1]), b = std::log(h[1] / h[2]), wanted = coarse / fine;
  // Increases with p: the ratio of the differences caused by an error C hᵖ.
  const auto ratio = [&](double p) {
    return std::abs(p) < 1e-9 ? a / b : std::expm1(p * a) / -std::expm1(-p * b);
  };
  double low = kMinOrder, high = kMaxOrder;
  if (ratio(low) >= wanted) return low;
  if (ratio(high) <= wanted) return high;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (ratio(middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

ConvergenceReport estimate_error(const RefinedSeries& series, const RefinementRule& rule) {
  check(series, rule);
  const std::size_t n = series.t.size();
  const auto& [f1, f2, f3] = series.values;
  const std::vector<double> coarse = sizes(f1, f2), fine = sizes(f2, f3),
                            own = sizes(series.own_values(), f3);
  const std::size_t half = samples_of(0.5 * rule.window, n);
  const std::size_t near = samples_of(0.5 * rule.bar_window, n);
  const double refinement = rule.h[1] / rule.h[2];
  const bool refined = refinement >= kMinRefinement && rule.h[0] / rule.h[1] >= kMinRefinement;
  const auto order_of = [&](const Part& part) {
    return refined ? observed_order(part.coarse, part.fine, rule.h) : 0.0;
  };
  const auto richardson = [&](double order) { return std::pow(refinement, order) - 1.0; };

  ConvergenceReport report;
  report.order_at.assign(n, kNaN);
  report.bar.assign(n, rule.floor);
  report.extrapolated = f3;
  const Part all = part_of(coarse, fine, 0, n);
  const auto order_or_limit = [&](const Part& part) {
    return part.fine == 0.0 ? kMaxOrder : part.coarse == 0.0 ? kMinOrder : order_of(part);
  };
  report.noise =
      all.most == 0.0 || (all.most <= rule.negligible && order_or_limit(all) < rule.least_order);
  std::vector<char> lost(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const Part part = part_about(coarse, fine, i, half), here = part_about(coarse, fine, i, near);
    lost[i] = !refined;
    if (part.count == 0 || part.most == 0.0) continue;
    // Differences that are zero between two of the runs have no order.
    const bool known = part.fine > 0.0 && part.coarse > 0.0;
    const double order = order_or_limit(part);
    const bool noise = report.noise || part.most <= rule.negligible;
    if (known && !report.noise && (!noise || order >= rule.least_order)) report.order_at[i] = order;
    if (report.noise || order < rule.least_order) {
      lost[i] = !refined || (!noise && part.fine >= rule.matters);
      report.bar[i] = rule.safety_far * here.most + rule.floor;
      continue;
    }
    const Trust t = trust(order, rule);
    const double power = richardson(t.order);
    report.bar[i] = t.safety * here.most_fine / power + rule.floor;
    const auto row = static_cast<Eigen::Index>(i);
    report.extrapolated.row(row) += (f3.row(row) - f2.row(row)) / power;
  }

  const std::size_t end = first_lost(lost, half);
  if (end < n) {
    report.lost_from = series.t[end];
    std::fill(report.bar.begin() + static_cast<std::ptrdiff_t>(end), report.bar.end(), kInfinite);
    report.extrapolated.bottomRows(static_cast<Eigen::Index>(n - end)).setConstant(kNaN);
  }
  if (const std::optional<double> order = median(report.order_at, end); !report.noise && order) {
    report.order = order;
    report.as_expected = trust(*order, rule).expected;
  }
  for (std::size_t i = 0; i < end; ++i) {
    report.largest_bar = std::max(report.largest_bar, report.bar[i]);
    if (!std::isnan(own[i]))
      report.largest_own = std::max(report.largest_own, own[i] + report.bar[i]);
  }
  return report;
}

}  // namespace polhode
