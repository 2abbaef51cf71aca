// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <polhode/io/read/read_import.hpp>
#include <polhode/io/read/read_model.hpp>

namespace polhode::io {

/// A model file that is parsed once, for many models that differ by overrides. It may be read in
/// several threads at a time.
class ParsedModel {
 public:
  /// @param overrides  Of all its models. @param filename  As for read_model_text().
  /// @throws ModelErrors if the text is no model file, or cannot import what it names.
  ParsedModel(std::string text, const std::string& filename, Overrides overrides = {});
  explicit ParsedModel(ModelText source);
  ~ParsedModel();
  ParsedModel(ParsedModel&&) noexcept;

  /// The model with further overrides, as read_model_text() reads it: none that begin with
  /// "import.".
  /// @throws ModelErrors
  [[nodiscard]] Model read(const Overrides& further = {}) const;

 private:
  struct Parsed;
  std::unique_ptr<Parsed> parsed_;
};

}  // namespace polhode::io
