// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace polhode::io {

/// JSON Schema (draft 2020-12) of the model file, for editors; made from the field tables.
[[nodiscard]] std::string json_schema();

/// Reference page of the model file in Markdown; made from the field tables.
[[nodiscard]] std::string reference_markdown();

}  // namespace polhode::io
