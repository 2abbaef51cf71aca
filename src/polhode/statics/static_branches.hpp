// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <polhode/statics/statics.hpp>

namespace polhode {

/// Largest distance of two states: of bodies and nodes in lengths of the model, of rotations [rad].
[[nodiscard]] double state_distance(const System& system, const State& a, const State& b);

/// Two equilibria at loads one above the other.
struct LoadInterval {
  State below, above;
  double low = 0.0, high = 0.0;
};

/// Relation of two equilibria.
enum class BranchRelation {
  same,       ///< Connected, or not told apart.
  changes,    ///< Connected, and stability changes between them.
  ends,       ///< The branch of the one below ends before the load above.
  continues,  ///< The branch of the one below goes on without the one above.
};

/// Relation of two equilibria, with what was found on the way.
struct BranchCheck {
  BranchRelation relation = BranchRelation::same;
  LimitPoint point;    ///< Where stability changes or the branch ends.
  StaticStep further;  ///< A further equilibrium of a branch that continues, at its load factor,
  State state;         ///< and its state.
};

/// Search along the branch of the equilibrium below for the one above, by bisection of the load. An
/// equilibrium between belongs to the branch from below if it has the same number of unstable
/// directions or, if both ends have, if it is nearer to the one below. @eq{statics-jump}
/// @param first, after  Numbers of unstable directions of the one below and the one above; −1: not
///                      known.
[[nodiscard]] BranchCheck follow_branch(const System& system, const StaticOptions& options,
                                        LoadInterval interval, int first, int after);

/// Load at which a branch ends, from its last two equilibria: near a limit point the square of the
/// vanishing stiffness is linear in the load. @eq{statics-limit-point}
/// @returns nothing if the stiffness does not vanish soon.
[[nodiscard]] std::optional<LimitPoint> extrapolate_limit(const System& system,
                                                          const StaticOptions& options,
                                                          const LoadInterval& interval);

}  // namespace polhode
