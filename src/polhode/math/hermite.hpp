// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <span>

namespace polhode {

/// A value or derivative that an interpolating polynomial takes.
struct HermiteCondition {
  double x = 0.0;      ///< Best between -1 and 1.
  int derivative = 0;  ///< 0: the value.
};

/// Weights of the conditions in a derivative of the polynomial of least degree that satisfies them:
/// Hermite interpolation, for conditions on successive derivatives at each x.
/// @param x  Where. @param derivative  Which; 0: the value.
[[nodiscard]] Eigen::VectorXd hermite_weights(std::span<const HermiteCondition> conditions,
                                              double x, int derivative = 0);

}  // namespace polhode
