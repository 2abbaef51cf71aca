// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <polhode/math/hermite.hpp>

namespace polhode {
namespace {

/// A derivative of x^n.
double power(int n, double x, int derivative) {
  double factor = 1.0;
  for (int d = 0; d < derivative; ++d) factor *= n - d;
  return n < derivative ? 0.0 : factor * std::pow(x, n - derivative);
}

TEST(Hermite, IsExactForPolynomialsUpToItsDegree) {
  for (const std::vector<double>& at :
       {std::vector<double>{-1.0, 1.0}, std::vector<double>{-1.0, 0.0, 1.0}})
    for (const int highest : {0, 1, 2}) {
      std::vector<HermiteCondition> conditions;
      for (const double x : at)
        for (int d = 0; d <= highest; ++d) conditions.push_back({x, d});
      const int degree = static_cast<int>(conditions.size()) - 1;
      for (const double x : {-0.9, 0.1, 0.7, 1.2})
        for (const int derivative : {0, 1, 2})
          for (int n = 0; n <= degree + 1; ++n) {
            const Eigen::VectorXd w = hermite_weights(conditions, x, derivative);
            double sum = 0.0;
            for (std::size_t i = 0; i < conditions.size(); ++i)
              sum += w[static_cast<Eigen::Index>(i)] *
                     power(n, conditions[i].x, conditions[i].derivative);
            if (n <= degree) {
              EXPECT_NEAR(sum, power(n, x, derivative), 1e-11) << n << " at " << x;
            } else if (derivative == 0) {
              EXPECT_GT(std::abs(sum - power(n, x, 0)), 1e-4);  // and no further
            }
          }
    }
}

TEST(Hermite, TakesDerivativesThatAreLeftOutAtOnePoint) {
  // x^4 from values, rates and one second derivative.
  const std::vector<HermiteCondition> conditions{{-1, 0}, {-1, 1}, {1, 0}, {1, 1}, {1, 2}};
  const Eigen::VectorXd w = hermite_weights(conditions, 0.3);
  EXPECT_NEAR(w[0] * 1.0 - w[1] * 4.0 + w[2] * 1.0 + w[3] * 4.0 + w[4] * 12.0, std::pow(0.3, 4),
              1e-14);
}

}  // namespace
}  // namespace polhode
