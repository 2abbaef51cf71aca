// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <polhode/core/types.hpp>

namespace polhode {

/// One quantity of three runs, each finer than the one before, at common times.
struct RefinedSeries {
  std::vector<double> t;      ///< Common times, increasing [s].
  std::array<Mat, 3> values;  ///< Coarse, middle, fine: a row a time, a column a component. A NaN
                              ///< is a value that does not exist, such as the gap of far bodies.
};

/// Facts of the runs that are known beforehand.
struct RefinementRule {
  std::array<double, 3> h{};   ///< Lengths of a step, or their means, of the three runs [s].
  std::vector<double> orders;  ///< Orders that the method may show: 2, or 1 and 2 with impacts.
  double floor = 0.0;          ///< Size of rounding, in the quantity's unit; part of every bar.
  double negligible = 0.0;     ///< Differences below are noise and need not fall.
  double matters = 0.0;        ///< Differences that do not fall are small below this: they have a
                               ///< wide bar; above, nothing is certain.
  double window = 0.05;        ///< Part of the time over which an order is observed [-].
  double bar_window = 0.01;    ///< The same for the largest difference that makes a bar [-].
  double least_order = 0.5;    ///< Below, differences do not fall [-].
  double close = 0.1;          ///< How far, of an order, an observed one may be from it [-].
  double safety_close = 1.25;  ///< Factor of the bar where the order is as expected [-].
  double safety_far = 3.0;     ///< Factor of the bar elsewhere [-].
};

/// Error of the finest of three runs as they show it, and the time from which on they show nothing.
struct ConvergenceReport {
  std::optional<double> order;      ///< Observed: median over the time that converges [-].
  bool as_expected = false;         ///< It is one of RefinementRule::orders.
  bool noise = false;               ///< All differences are negligible: there is no order to see.
  std::optional<double> lost_from;  ///< First time from which on differences do not fall [s].
  std::vector<double> order_at;  ///< Observed about each time; NaN where there is nothing to see.
  std::vector<double> bar;   ///< Bound of |fine − exact| at each time; infinite where it is lost.
  Mat extrapolated;          ///< Richardson's value, by time and component.
  double largest_bar = 0.0;  ///< Of the time that converges.
  /// Bound of |coarse − exact| over the same time: what the model's own step is good for.
  double largest_own = 0.0;
};

/// The order p by which differences of three runs fall.
///
/// @eq{certify-order}
/// @param coarse  Size of the difference of the coarse and the middle run, above zero.
/// @param fine    The same of the middle and the fine run, above zero.
/// @param h       Lengths of a step of the three runs, falling.
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
