// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <polhode/io/read/read_context.hpp>

namespace polhode::io {

/// Symmetric positive semidefinite matrix of six rows; nothing after an error.
std::optional<Mat6> read_stiffness_matrix(ReadContext& context, Section& section,
                                          const std::string& key, const SourceNode& node);

/// Checks that a resistance dissipates at any rate.
void check_resistance(Section& section, const std::string& key, const TimeFunction& law);

}  // namespace polhode::io
