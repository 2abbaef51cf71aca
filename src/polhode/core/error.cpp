// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>

namespace polhode {

InputError::InputError(std::string_view where, std::string_view what, std::string_view hint)
    : std::invalid_argument(std::string(where) + ": " + std::string(what) + ". " +
                            std::string(hint) + "."),
      where_(where),
      what_(what),
      hint_(hint) {}

SolveError::SolveError(std::string_view what, std::string_view hint)
    : std::runtime_error(std::string(what) + ". " + std::string(hint) + ".") {}

}  // namespace polhode
