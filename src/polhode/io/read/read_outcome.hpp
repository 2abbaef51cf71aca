// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/gradient/outcome.hpp>

namespace polhode::io {

/// Outcome from its text, as parse_outcome(), or from misfit:TABLE: a table with commas, whose
/// header names the time, 't [s]' or 'time', and channels of positions and velocities, in SI units;
/// a cell without a number is not measured.
/// @throws InputError for a table that cannot be read.
[[nodiscard]] Outcome read_outcome(const std::string& text);

}  // namespace polhode::io
