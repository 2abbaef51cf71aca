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

/// Load at which stability changes between two equilibria: by bisection, and by linear
/// interpolation of the vanishing stiffness.
/// @param first, after  Numbers of unstable directions of the one below and the one above.
/// @returns nothing if the equilibrium above lies on another branch.
[[nodiscard]] std::optional<LimitPoint> locate_stability_change(const System& system,
                                                                const StaticOptions& options,
                                                                LoadInterval interval, int first,
                                                                int after);

/// End of the branch of equilibria connected with the one below: by bisection, following the branch
/// from below as far as it exists. @eq{statics-jump}
/// @param continued  Set to the equilibrium on the branch from below at the load above, if that
///                   branch does not end before.
/// @returns nothing if the two are connected, as their distance decreases with the interval, or if
///          the branch continues.
[[nodiscard]] std::optional<LimitPoint> locate_jump(const System& system,
                                                    const StaticOptions& options,
                                                    LoadInterval interval,
                                                    std::optional<State>& continued);

/// Load at which a branch ends, from its last two equilibria: near a limit point the square of the
/// vanishing stiffness is linear in the load. @eq{statics-limit-point}
/// @returns nothing if the stiffness does not vanish soon.
[[nodiscard]] std::optional<LimitPoint> extrapolate_limit(const System& system,
                                                          const StaticOptions& options,
                                                          const LoadInterval& interval);

}  // namespace polhode
