// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace polhode::cli {

/// A model of examples/, as of the build of the program.
struct ExampleText {
  std::string name;  ///< Of its folder.
  std::string text;
};

[[nodiscard]] const std::vector<ExampleText>& example_texts();

}  // namespace polhode::cli
