// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace polhode::cli {

/// A model of examples/, as it stood when the program was built.
struct ExampleText {
  std::string name;  ///< Of its folder.
  std::string text;
};

[[nodiscard]] const std::vector<ExampleText>& example_texts();

}  // namespace polhode::cli
