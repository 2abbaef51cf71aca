// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include <polhode/core/source_location.hpp>

namespace polhode::io {

/// One error of a model file.
struct Diagnostic {
  SourceLocation place;  ///< file:line:column; line 0: the place has no line (an override).
  std::string path;      ///< Path in the model, e.g. joints.B.bodies; may be empty.
  std::string what;      ///< Including the given value; no full stop at the end.
  std::string hint;      ///< What to do; complete sentences, may be empty.
  std::string
      excerpt;  ///< Source line with the erroneous part underlined, two lines; may be empty.

  /// `file:line:column: error: path: what. hint.` and the excerpt below it.
  [[nodiscard]] std::string text() const;
};

/// All errors of a model file.
class ModelErrors : public std::invalid_argument {
 public:
  explicit ModelErrors(std::vector<Diagnostic> diagnostics);

  [[nodiscard]] const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }
  /// All messages with their excerpts, in the order of the file; the same as what().
  [[nodiscard]] std::string text() const { return what(); }

 private:
  std::vector<Diagnostic> diagnostics_;
};

}  // namespace polhode::io
