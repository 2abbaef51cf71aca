// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace polhode::cli {

/// Contents of the program with their licences: THIRD_PARTY.md as of the build.
[[nodiscard]] const char* licences_text();

}  // namespace polhode::cli
