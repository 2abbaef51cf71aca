// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/model/model.hpp>

namespace polhode {

/// Names the first load, drive or prescribed displacement whose function of time is no finite
/// number in [from, to], with that time: the reason of a step that fails. Empty: all are finite.
[[nodiscard]] std::string not_finite_in(const Model& model, double from, double to);

}  // namespace polhode
