// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include <polhode/surface_contact/rigid_mesh.hpp>

namespace polhode::surface_contact {

/// Height above the end of the barrier, as a part of its band, below which only the nearest feature
/// counts. Only iterates get there.
inline constexpr double kDeepInRigid = 1e-9;

/// Combined gap of features with multiplicities. With V = Σ w β(gᵢ) and f = −β′ the gap g = β⁻¹(V)
/// has the gradient n = Σ w f(gᵢ) nᵢ / f(g). @eq{surface-feature-sum} @eq{surface-feature-holes}
/// @param near  Features below the reach of the law, at least one; sorted here.
[[nodiscard]] SurfaceGap combined_gap(const contact::NormalLaw& law,
                                      std::vector<std::pair<SurfaceGap, int>>& near,
                                      const SurfaceGap& nearest);

}  // namespace polhode::surface_contact
