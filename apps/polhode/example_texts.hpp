// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace polhode::cli {

/// A file that the model of an example names.
struct ExampleFile {
  std::string name;  ///< Without a folder.
  std::string text;
};

/// A model of examples/, as of the build of the program.
struct ExampleText {
  std::string name;  ///< Of its folder.
  std::string text;
  std::vector<ExampleFile> files;
};

[[nodiscard]] const std::vector<ExampleText>& example_texts();

}  // namespace polhode::cli
