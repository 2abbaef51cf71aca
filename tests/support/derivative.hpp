// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/types.hpp>

namespace polhode::test {

/// Central difference of f at zero displacement, one column per component of the displacement.
///
/// The step is 1e-5 of unit size: truncation 1e-10 of the third derivative, rounding 1e-11 of f.
/// Displacements whose natural size is not one are to be scaled by the caller.
[[nodiscard]] inline Mat central_difference(const std::function<Vec(const Vec&)>& f, int columns,
                                            double step = 1e-5) {
  Mat numeric;
  for (int j = 0; j < columns; ++j) {
    Vec d = Vec::Zero(columns);
    d[j] = step;
    const Vec ahead = f(d);
    d[j] = -step;
    const Vec column = (ahead - f(d)) / (2.0 * step);
    if (j == 0) numeric.resize(column.size(), columns);
    numeric.col(j) = column;
  }
  return numeric;
}

/// Expects a matrix of derivatives to be that of f at zero displacement, by central differences.
///
/// @param analytic   f's size × the displacement's size.
/// @param f          Value at a displacement from the point of linearization.
/// @param what       Name of the tangent, first word of the message.
/// @param tolerance  Relative to the largest entry of either matrix, or to 1 if both are smaller.
inline void expect_derivative(const Mat& analytic, const std::function<Vec(const Vec&)>& f,
                              const std::string& what, double tolerance = 1e-7,
                              double step = 1e-5) {
  const Mat numeric = central_difference(f, static_cast<int>(analytic.cols()), step);
  ASSERT_EQ(analytic.rows(), numeric.rows()) << what << ": wrong number of rows";
  ASSERT_TRUE(analytic.allFinite() && numeric.allFinite()) << what << ": not finite";
  if (analytic.size() == 0) return;
  const double scale =
      std::max({1.0, analytic.cwiseAbs().maxCoeff(), numeric.cwiseAbs().maxCoeff()});
  Eigen::Index row = 0;
  Eigen::Index col = 0;
  const double error = (analytic - numeric).cwiseAbs().maxCoeff(&row, &col) / scale;
  EXPECT_LT(error, tolerance) << what << ": worst at (" << row << ", " << col << "): analytic "
                              << testing::PrintToString(analytic(row, col))
                              << ", central difference "
                              << testing::PrintToString(numeric(row, col));
}

}  // namespace polhode::test
