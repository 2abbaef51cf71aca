// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/solids/elements/memory.hpp>
#include <polhode/solids/materials/material.hpp>

namespace polhode::solids {

MemoryWeights::MemoryWeights(const Material& material, double time, double alpha_f)
    : terms(static_cast<int>(material.relaxation().size())), long_term(material.long_term_ratio()) {
  const bool at_end = alpha_f == 1.0;
  const double shift = alpha_f - 0.5;
  double follows = 0.0;
  for (int i = 0; i < terms; ++i) {
    const Relaxation& r = material.relaxation()[static_cast<std::size_t>(i)];
    const double x = time / r.time, decay = std::exp(-x);
    // Mean of exp(−s/τ) over the step: rounding must not lift it above one.
    const double k = x == 0.0 ? 1.0 : std::clamp(-std::expm1(-x) / x, decay, 1.0);
    const double g = r.ratio;
    term[i] = {g, 0.0, decay, k - decay, 1.0 - k};
    follows += g * k;
    if (at_end) {
      term[i].relaxed = -g * decay;
      start += g * (decay - k);
    } else {
      term[i].relaxed = g * (shift * (1.0 - decay) - k);
      start += g * (decay - k) - shift * g * (1.0 - decay);
      mean += g * (2.0 * k - decay);
    }
  }
  if (terms == 0) return;
  if (at_end) {
    end = long_term - 1.0 + follows;
  } else {
    mean += long_term - 1.0;
    end = shift * (long_term - 1.0 + follows);
    start -= end;
  }
}

}  // namespace polhode::solids
