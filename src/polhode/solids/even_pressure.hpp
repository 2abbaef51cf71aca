// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <polhode/solids/solid_elements.hpp>

namespace polhode::solids {

/// Adds the stiffness by which that of elements with the pressure p evened out in each of them,
/// p̄ = Σ w J p/Σ w J, differs from their own: Σ w (p − p̄) ∂²J/∂x∂x over the integration points.
/// @eq{even-pressure}
/// @param X, x  Reference and present positions of all nodes [m].
/// @param slots  Nodes::slots() of the group.
/// @param blocks  3×3 blocks of the graph of nodes [N/m].
void even_pressure(const SolidElements& elements, std::span<const Vec3> X, const double* x,
                   std::span<const int> slots, std::vector<double>& blocks);

}  // namespace polhode::solids
