// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/dynamics/composition.hpp>

namespace polhode {

namespace {

/// The first half of each list and its middle; the second half mirrors the first.
std::vector<double> first_half(int order) {
  if (order == 2) return {1.0};
  if (order == 4) {
    const double p = 1.0 / (4.0 - std::cbrt(4.0));
    return {p, p, 1.0 - 4.0 * p};
  }
  if (order == 6)
    return {.21375583945878254555518066964857, .18329381407425713911385974425217,
            .17692819473098943794898811709929, -.44329082681170215849622829626258,
            .11728560432865935385403585669136, .50405474843802736404832781714239};
  if (order == 8)
    return {
        .13020248308889008087881763, .56116298177510838456196441,  -.38947496264484728640807860,
        .15884190655515560089621075, -.39590389413323757733623154, .18453964097831570709183254,
        .25837438768632204729397911, .29501172360931029887096624,  -.60550853383003451169892108};
  throw InputError("analysis.order", format("must be 2, 4, 6 or 8, but is {}", order),
                   "2 is the basic step, the others are compositions of it");
}

}  // namespace

std::vector<double> composition_stages(int order, bool doubled) {
  std::vector<double> stages = first_half(order);
  for (int i = static_cast<int>(stages.size()) - 2; i >= 0; --i) stages.push_back(stages[i]);
  if (!doubled) return stages;
  std::vector<double> twice;
  for (double gamma : stages) twice.insert(twice.end(), {0.5 * gamma, 0.5 * gamma});
  return twice;
}

}  // namespace polhode
