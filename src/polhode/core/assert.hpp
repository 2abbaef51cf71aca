// SPDX-License-Identifier: Apache-2.0
// Assertions of internal invariants, which no model and no file can break.
#pragma once

#include <algorithm>
#include <functional>

namespace polhode {

/// Whether assertions are evaluated: with POLHODE_ASSERTIONS=1 in the environment, or if a program
/// switches them on before it starts threads, as the tests do.
extern bool evaluates_assertions;

/// Failure of an assertion: writes its text, file and line to stderr and aborts the program.
[[noreturn]] void assertion_failed(const char* text, const char* file, int line);

/// Whether every element of a range is larger than the one before.
template <class Range>
[[nodiscard]] bool is_strictly_ascending(const Range& range) {
  return std::adjacent_find(range.begin(), range.end(), std::greater_equal<>()) == range.end();
}

}  // namespace polhode

/// An assertion; its condition is evaluated only on request, see evaluates_assertions.
#define POLHODE_ASSERT(...)                          \
  (!::polhode::evaluates_assertions || (__VA_ARGS__) \
       ? static_cast<void>(0)                        \
       : ::polhode::assertion_failed(#__VA_ARGS__, __FILE__, __LINE__))
