// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace polhode {

/// Numbers of equal ρ∞ = 1 steps with which the members of an extrapolation of this order divide a
/// step: 2, 4, ..., order. They are even because one step reflects the constraint-normal velocity,
/// and the fast part of a stiff damper's, while two are near the identity.
/// @param order  4, 6, 8, 10 or 12.
/// @throws InputError for any other order.
[[nodiscard]] std::vector<int> extrapolation_substeps(int order);

/// Weights with which results of n_j equal steps give the value at the step length zero. The error
/// of a symmetric step has an expansion in even powers of its length. Its leading terms cancel, one
/// fewer than there are members. @eq{extrapolation-weights}
[[nodiscard]] std::vector<double> member_weights(const std::vector<int>& substeps);

}  // namespace polhode
