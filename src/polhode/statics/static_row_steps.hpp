// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <polhode/statics/static_newton.hpp>

namespace polhode {

/// Ends a load step where the first contact with friction closes in it, as from there on its
/// friction holds. @eq{statics-closing}
/// @param old  The equilibrium before. @param size  Of load factors or times.
/// @param state  The equilibrium found; the one where the contact closes. @param step  Its report.
/// @returns the number of iterations.
int end_where_it_closes(const System& system, StaticNewton& newton, const State& old, double size,
                        State& state, StaticStep& step);

/// A jump of bodies that touch with friction.
struct FrictionJump {
  double load_factor = 0.0;  ///< Before it.
  std::string reason;
};

/// Looks for a jump in a load step of bodies that touched others with friction before it: friction
/// follows a path of equilibria, and after a jump it depends on the motion. Halves of the step are
/// solved anew, and the one with the longer way is halved again: a way that does not vanish is a
/// jump. @eq{statics-friction-jump}
/// @param old, state  The equilibria before and after it. @param iterations  Of the search.
/// @returns nothing if there is none.
[[nodiscard]] std::optional<FrictionJump> find_friction_jump(const System& system,
                                                             StaticNewton& newton, const State& old,
                                                             const State& state,
                                                             const StaticStep& step,
                                                             int& iterations);

}  // namespace polhode
