// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace polhode::test {

// In one source file, so that all others compile to the same code in every folder.
[[nodiscard]] std::string source_dir();  ///< Root of the sources.
[[nodiscard]] std::string test_data_dir();
[[nodiscard]] std::string cli_program();  ///< Command line of this build; "" if it is not built.

}  // namespace polhode::test
