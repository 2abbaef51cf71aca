// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/assert.hpp>
#include <support/paths.hpp>

namespace polhode::test {

std::string source_dir() { return POLHODE_SOURCE_DIR; }
std::string test_data_dir() { return POLHODE_TEST_DATA_DIR; }
std::string cli_program() {
#ifdef POLHODE_CLI
  return POLHODE_CLI;
#else
  return "";
#endif
}

/// Assertions of every test.
[[maybe_unused]] const bool kEvaluated = evaluates_assertions = true;

}  // namespace polhode::test
