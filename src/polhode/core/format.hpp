// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

namespace polhode {
using fmt::format;  ///< std::format is missing from our oldest compiler's library.
}  // namespace polhode
