// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace polhode {

/// Stage lengths, in parts of the step, of a symmetric composition of ρ∞ = 1 steps. Each stage
/// conserves energy and momenta and ends on the constraints, so the composition does.
///
/// Order 2: one stage. Order 4: Suzuki (1990), five stages. Order 6: Sofroniou & Spaletta (2005),
/// eleven. Order 8: Kahan & Li (1997), seventeen. Some stages run backwards in time.
///
/// @param order     2, 4, 6 or 8.
/// @param doubled   Each stage as two equal steps: needed for orders 6 and 8 if there are
/// multiplier rows, because a single step reflects the constraint-normal velocity while two are
/// near the identity.
/// @throws InputError for any other order.
[[nodiscard]] std::vector<double> composition_stages(int order, bool doubled);

}  // namespace polhode
