// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/io/text/source_tree.hpp>

namespace polhode::io {

/// The text of a model file with these values: what fits on a line is written on one. Read again,
/// it has the same values.
[[nodiscard]] std::string yaml_text(const SourceNode& root);

}  // namespace polhode::io
