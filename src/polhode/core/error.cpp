// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>

namespace polhode {

InputError::InputError(std::string_view where, std::string_view what, std::string_view mend)
    : std::invalid_argument(std::string(where) + ": " + std::string(what) + ". " +
                            std::string(mend) + "."),
      where_(where),
      what_(what),
      mend_(mend) {}

}  // namespace polhode
