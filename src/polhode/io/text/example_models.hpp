// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

namespace polhode::io {

/// A parameter of a generator of models.
struct GeneratorParameter {
  std::string name;
  std::string standard;  ///< Default.
  std::string meaning;   ///< One line; a choice lists its words.
};

/// Generator of the text of a model of any size.
struct ModelGenerator {
  std::string name;
  std::string meaning;  ///< One line.
  std::vector<GeneratorParameter> parameters;
  std::string (*text)(const std::map<std::string, std::string>& values);
};

/// Every generator: n_four_bar, chain, binary_tree.
[[nodiscard]] const std::vector<ModelGenerator>& model_generators();

/// Text of a generated model; missing values have their defaults.
/// @throws InputError for an unknown parameter or a value out of range.
[[nodiscard]] std::string generate_model(const ModelGenerator& generator,
                                         const std::map<std::string, std::string>& values);

}  // namespace polhode::io
