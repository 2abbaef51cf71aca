// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace polhode::test {

/// Expects the error to decrease with the given order, neither slower nor faster, between each pair
/// of neighbouring numbers of steps.
///
/// @param error   Error of the solution with n steps (any norm, the same for all).
/// @param steps   Ascending numbers of steps, all in the range where the order shows: fine enough
///                for the leading term, coarse enough that rounding is far below it.
/// @param order   Expected order p: error ~ n^-p.
/// @param within  Half width of the band around the order.
inline void expect_order(const std::function<double(int)>& error, const std::vector<int>& steps,
                         double order, double within, const std::string& what = "error") {
  ASSERT_GE(steps.size(), 2U);
  double coarse = error(steps.front());
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const double fine = error(steps[i]);
    ASSERT_TRUE(std::isfinite(coarse) && coarse > 0.0 && std::isfinite(fine) && fine > 0.0)
        << what << ": " << coarse << " with " << steps[i - 1] << " steps, " << fine << " with "
        << steps[i];
    const double measured = std::log(coarse / fine) / std::log(double(steps[i]) / steps[i - 1]);
    EXPECT_NEAR(measured, order, within) << what << ": " << coarse << " with " << steps[i - 1]
                                         << " steps, " << fine << " with " << steps[i];
    coarse = fine;
  }
}

}  // namespace polhode::test
