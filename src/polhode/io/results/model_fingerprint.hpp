// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/model/model.hpp>

namespace polhode {

/// SHA-256 over everything of a model that a run depends on, contents of mesh files included, but
/// not the duration, steps, solver or output, so that a run may be continued for longer. Time
/// functions count by their values at a few hundred times.
[[nodiscard]] std::string model_fingerprint(const Model& model);

}  // namespace polhode
