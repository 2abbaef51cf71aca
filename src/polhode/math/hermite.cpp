// SPDX-License-Identifier: Apache-2.0
#include <Eigen/LU>

#include <polhode/math/hermite.hpp>

namespace polhode {

namespace {

/// A derivative of the powers 1, x, x², ...
Eigen::VectorXd powers(Eigen::Index count, double x, int derivative) {
  Eigen::VectorXd row = Eigen::VectorXd::Zero(count);
  double power = 1.0;
  for (Eigen::Index k = derivative; k < count; ++k) {
    double factor = 1.0;
    for (int d = 0; d < derivative; ++d) factor *= static_cast<double>(k - d);
    row[k] = factor * power;
    power *= x;
  }
  return row;
}

}  // namespace

Eigen::VectorXd hermite_weights(std::span<const HermiteCondition> conditions, double x,
                                int derivative) {
  const auto n = static_cast<Eigen::Index>(conditions.size());
  Eigen::MatrixXd A(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const HermiteCondition& c = conditions[static_cast<std::size_t>(i)];
    A.col(i) = powers(n, c.x, c.derivative);
  }
  return A.partialPivLu().solve(powers(n, x, derivative));
}

}  // namespace polhode
