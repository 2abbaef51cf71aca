// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <polhode/core/error.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/io/text/model_errors.hpp>
#include <polhode/model/model.hpp>

namespace polhode::io {

/// Positions of the things of a model in its files, for errors that are found after reading: in the
/// assembly, the solver, or a run.
class ModelPlaces {
 public:
  ModelPlaces() = default;
  /// @param overrides  As given to the reader.
  explicit ModelPlaces(const Model& model, Overrides overrides = {});

  /// The error with file, line, column and the line of the file; nothing if it is not about a model
  /// that was read from a file.
  [[nodiscard]] std::optional<Diagnostic> located(const InputError& error) const;
  [[nodiscard]] std::optional<Diagnostic> located(const SolveError& error) const;

 private:
  [[nodiscard]] std::optional<SourceLocation> place_of(const std::string& path) const;
  /// The first thing that a text names in single quotes.
  [[nodiscard]] std::optional<SourceLocation> named_in(const std::string& text) const;
  [[nodiscard]] Diagnostic at(const SourceLocation& place, std::string path, std::string what,
                              std::string hint) const;

  std::string file_;
  Overrides overrides_;
  std::map<std::string, SourceLocation> things_;  ///< By path: "joints.B".
  std::map<std::string, SourceLocation> names_;   ///< By name alone.
};

}  // namespace polhode::io
