// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

namespace polhode {

/// A value that a generator of models takes.
struct GeneratorParameter {
  std::string name;
  std::string standard;  ///< Value when left out.
  std::string meaning;   ///< One line; a choice lists its words.
};

/// Writes the text of a model of any size.
struct ModelGenerator {
  std::string name;
  std::string meaning;  ///< One line.
  std::vector<GeneratorParameter> parameters;
  std::string (*text)(const std::map<std::string, std::string>& values);
};

/// Every generator: n_four_bar, chain, binary_tree.
[[nodiscard]] const std::vector<ModelGenerator>& model_generators();

/// The text of a generated model; values that are left out take their standard.
/// @throws InputError for an unknown parameter or a value out of range.
[[nodiscard]] std::string generate_model(const ModelGenerator& generator,
                                         const std::map<std::string, std::string>& values);

}  // namespace polhode
