// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <polhode/statics/statics.hpp>

namespace polhode {

/// Largest way between two states: of bodies and nodes in lengths of the model, of turns [rad].
[[nodiscard]] double state_distance(const System& system, const State& a, const State& b);

/// Two equilibria at loads one above the other.
struct LoadInterval {
  State below, above;
  double low = 0.0, high = 0.0;
};

/// The load at which stability changes between two equilibria: by bisection, and by the stiffness
/// that vanishes there, on a straight line between the loads.
/// @param first, after  Directions in which the one below and the one above are unstable.
/// @returns nothing if the equilibrium above lies on another branch.
[[nodiscard]] std::optional<LimitPoint> locate_stability_change(const System& system,
                                                                const StaticOptions& options,
                                                                LoadInterval interval, int first,
                                                                int after);

/// The end of the equilibria that hang together with the one below: by bisection, following those
/// from below as far as there are any. @eq{statics-jump}
/// @returns nothing if the two hang together: the way between them gets shorter with the interval.
[[nodiscard]] std::optional<LimitPoint> locate_jump(const System& system,
                                                    const StaticOptions& options,
                                                    LoadInterval interval);

}  // namespace polhode
