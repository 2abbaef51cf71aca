// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>

#include <polhode/core/assert.hpp>

namespace polhode {

constinit bool evaluates_assertions = false;

void assertion_failed(const char* text, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: assertion failed: %s\n", file, line, text);
  std::abort();
}

}  // namespace polhode
