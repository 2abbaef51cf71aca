// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/system/state.hpp>

namespace polhode {

/// Whether motions and multipliers of a state are finite, and its quaternions have unit length.
/// Every state that a step ends with is: iterates that are not do not converge.
[[nodiscard]] bool is_regular(const State& state);

}  // namespace polhode
