// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>

namespace polhode {

namespace {

/// Sentences one after the other; the first may be a message with a full stop of its own.
std::string sentences(std::string_view first, std::string_view second) {
  return std::string(first) + (first.ends_with('.') ? " " : ". ") + std::string(second) + ".";
}

}  // namespace

InputError::InputError(std::string_view where, std::string_view what, std::string_view hint)
    : std::invalid_argument(std::string(where) + ": " + sentences(what, hint)),
      where_(where),
      what_(what),
      hint_(hint) {}

SolveError::SolveError(std::string_view what, std::string_view hint)
    : std::runtime_error(sentences(what, hint)) {}

}  // namespace polhode
