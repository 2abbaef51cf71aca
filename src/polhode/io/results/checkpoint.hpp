// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/simulation/simulation_details.hpp>

namespace polhode::io {

/// Saves a state for an exactly equal continuation of the run. The file is written atomically and
/// has a checksum. @throws FileError
void write_checkpoint(const std::string& path, const Model& model, const System& system,
                      const State& state);

/// Reads a checkpoint of this model.
/// @param note  Set to a sentence if the run can be continued, but not with the same bits: with
///         another instruction set.
/// @throws FileError if it cannot be read; InputError if it is no checkpoint, is damaged, has
///         another format version, or belongs to another model or a method of another order.
[[nodiscard]] State read_checkpoint(const std::string& path, const Model& model,
                                    const System& system, std::string* note = nullptr);

}  // namespace polhode::io
