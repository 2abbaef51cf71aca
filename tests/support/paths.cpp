// SPDX-License-Identifier: Apache-2.0
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

}  // namespace polhode::test
