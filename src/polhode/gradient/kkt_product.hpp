// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/linear/kkt.hpp>

namespace polhode {

/// K x of a block matrix, or with `transposed` Kᵀ x, without the proximal ε on its diagonal.
void kkt_product(const linear::KktTopology& topology, const linear::KktValues& values, const Vec& x,
                 bool transposed, Vec& out);

}  // namespace polhode
