// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/dynamics/extrapolation.hpp>

namespace polhode {

std::vector<int> extrapolation_substeps(int order) {
  if (order < 4 || order > 12 || order % 2 != 0)
    throw InputError("analysis.order", format("must be 4, 6, 8, 10 or 12, but is {}", order),
                     "Extrapolation has these orders; 2 is the basic step");
  std::vector<int> substeps;
  for (int n = 2; n <= order; n += 2) substeps.push_back(n);
  return substeps;
}

std::vector<double> member_weights(const std::vector<int>& substeps) {
  std::vector<double> weights;
  for (const double n : substeps) {
    double weight = 1.0;
    for (const double other : substeps)
      if (other != n) weight *= n * n / (n * n - other * other);
    weights.push_back(weight);
  }
  return weights;
}

}  // namespace polhode
