// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/model/model.hpp>

namespace polhode::io {

/// SHA-256 of everything that a run depends on, including contents of mesh files, but not the
/// duration, steps, solver or output, so that a run may be continued for longer. Time functions are
/// represented by their values at a few hundred times.
[[nodiscard]] std::string model_fingerprint(const Model& model);

}  // namespace polhode::io
