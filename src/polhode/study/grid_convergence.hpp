// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <polhode/core/types.hpp>

namespace polhode {

/// One quantity of three runs of increasing refinement, at common times.
struct RefinedSeries {
  std::vector<double> t;  ///< Common times, increasing [s].
  /// Coarse, middle, fine: a row per time, a column per component. NaN: no value, such as the gap
  /// of distant bodies.
  std::array<Mat, 3> values;
  /// Values of the model's own run, if that is by another method than the coarse one; else empty.
  Mat own;
  [[nodiscard]] const Mat& own_values() const { return own.rows() > 0 ? own : values[0]; }
};

/// Known properties of the runs.
struct RefinementRule {
  std::array<double, 3> h{};   ///< Step lengths, or their means, of the three runs [s].
  std::vector<double> orders;  ///< Possible orders of the method: 2, or 1 and 2 with impacts.
  double floor = 0.0;          ///< Size of rounding, in the quantity's unit; part of every bar.
  double negligible = 0.0;     ///< Smaller differences are noise and need not decrease.
  /// Threshold for differences that do not decrease: smaller ones get a wide error bar; above, the
  /// result is not reliable.
  double matters = 0.0;
  double window = 0.05;      ///< Part of the time over which an order is observed [-].
  double bar_window = 0.01;  ///< The same for the largest difference that determines a bar [-].
  double least_order = 0.5;  ///< Smaller orders mean no convergence [-].
  /// Largest relative deviation of an observed from an expected order [-].
  double close = 0.1;
  double safety_close = 1.25;  ///< Safety factor where the order is as expected [-].
  double safety_far = 3.0;     ///< Safety factor elsewhere [-].
};

/// Error estimate of the finest of three runs, and the time from which on it is lost.
struct ConvergenceReport {
  std::optional<double> order;      ///< Observed: median over the converging time [-].
  bool as_expected = false;         ///< It is one of RefinementRule::orders.
  bool noise = false;               ///< All differences are negligible: no order can be observed.
  std::optional<double> lost_from;  ///< First time from which on differences do not decrease [s].
  std::vector<double> order_at;     ///< Observed near each time; NaN if there is none.
  std::vector<double> bar;   ///< Bound of |fine − exact| at each time; infinite where it is lost.
  Mat extrapolated;          ///< Richardson's value, by time and component.
  double largest_bar = 0.0;  ///< Over the converging time.
  /// Bound of |own − exact| over the same time: the accuracy of the model's own step.
  double largest_own = 0.0;
};

/// Order p by which differences of three runs decrease.
///
/// @eq{certify-order}
/// @param coarse  Size of the difference of the coarse and the middle run, above zero.
/// @param fine  The same of the middle and the fine run, above zero.
/// @param h  Step lengths of the three runs, decreasing.
/// @returns p between -4 and 20 [-]
[[nodiscard]] double observed_order(double coarse, double fine, const std::array<double, 3>& h);

/// Observed order, extrapolated value and error bar of a quantity over time: the grid convergence
/// index of P. J. Roache (J. Fluids Eng. 116, 1994, 405-413) with the safety factors of
/// W. L. Oberkampf and C. J. Roy (Verification and Validation in Scientific Computing, 2010, 8.7).
///
/// Sizes are Euclidean over the components. An order is observed in windows about each time, from
/// means of the differences; the bar there takes the largest difference of its window.
///
/// @eq{certify-bar} @eq{certify-extrapolated} @eq{certify-lost}
/// @throws std::invalid_argument if the times or sizes of the runs do not agree.
[[nodiscard]] ConvergenceReport estimate_error(const RefinedSeries& series,
                                               const RefinementRule& rule);

}  // namespace polhode
