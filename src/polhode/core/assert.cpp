// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <polhode/core/assert.hpp>

namespace polhode {

constinit bool evaluates_assertions = false;

namespace {

/// Request of the environment, which leaves on what a program has switched on before.
[[maybe_unused]] const bool kOfEnvironment = [] {
  const char* value = std::getenv("POLHODE_ASSERTIONS");
  if (value && *value != '\0' && std::strcmp(value, "0") != 0) evaluates_assertions = true;
  return evaluates_assertions;
}();

}  // namespace

void assertion_failed(const char* text, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: assertion failed: %s\n", file, line, text);
  std::abort();
}

}  // namespace polhode
