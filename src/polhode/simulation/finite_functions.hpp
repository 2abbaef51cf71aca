// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/compile/build_system.hpp>
#include <polhode/model/model.hpp>
#include <polhode/stepping/instant.hpp>

namespace polhode {

/// A load, drive or prescribed displacement that is no finite number at a time.
struct NotFinite {
  std::string place;  ///< In the model, "loads.push"; empty: there is none.
  std::string text;   ///< The sentence that names it, with the time.
};

/// Names the first load, drive or prescribed displacement whose function of time is no finite
/// number in [from, to], with that time: the reason of a step that fails.
[[nodiscard]] NotFinite not_finite_in(const Model& model, double from, double to);

/// The first function of time of a model that is not a finite number at the start.
[[nodiscard]] NotFinite not_finite_at_start(const Model& model);

/// Names the first drive of a position that starts with an infinite rate, as sqrt(t) does: no
/// motion follows it, and none of its values tells.
/// @param run  Length of the run [s].
[[nodiscard]] NotFinite endless_rate_at_start(const Model& model, const System& system,
                                              const State& start, double run);

/// Names the first function of time that grows beyond all bounds before a time, so fast that its
/// integral does not exist. Steps may pass over such a pole. Poles narrower than a 500th of the
/// time may be missed.
[[nodiscard]] NotFinite endless_in(const Model& model, double to);

/// Names the first load by a law of a coordinate or a rate, or by a function in code, that is no
/// finite number on the way on which the bodies go on from a state, up to a time.
/// @param now  Accelerations in the state.
/// @param to  End of the way [s]; in statics, where there is none, the present time.
[[nodiscard]] NotFinite not_finite_ahead(const Model& model, const System& system,
                                         const SystemMap& map, const State& state,
                                         const InstantSolution& now, double to);

}  // namespace polhode
