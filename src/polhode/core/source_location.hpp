// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace polhode {

/// Position of an object in the user's file; line 0 means it was built in code.
struct SourceLocation {
  std::string file;
  int line = 0;    ///< 1-based.
  int column = 0;  ///< 1-based.
};

}  // namespace polhode
