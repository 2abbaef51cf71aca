// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/base/types.hpp>

namespace polhode {

/// Impulses of impacts at once.
struct SharedImpulses {
  Vec impulses;
  double energy_lost = 0.0;  ///< Never below zero [J].
};

/// Impulses p ≤ 0 with which speeds go from `before` to `wanted`, A p being what p changes of them.
/// Redundant ones are shared out evenly, and impacts that would have to be pushed are left out. If
/// unequal restitutions would gain energy, the smallest counts for all.
/// @param A  Symmetric, without negative eigenvalues.
[[nodiscard]] SharedImpulses share_impulses(const Mat& A, const Vec& before, Vec wanted);

}  // namespace polhode
