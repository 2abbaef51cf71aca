// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <polhode/core/names.hpp>
#include <polhode/io/text/model_errors.hpp>

namespace polhode::io {

/// Text of a model file, by lines, for excerpts.
class SourceText {
 public:
  SourceText() = default;
  SourceText(std::string name, std::string text);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  /// Offset of a line in the text; 1-based.
  [[nodiscard]] std::size_t offset(int line_number) const;
  /// A line without its end; 1-based, empty beyond the end.
  [[nodiscard]] std::string_view line(int number) const;
  /// A line and, below it, a caret and tildes under the value or key that starts at the column.
  /// @param length  Bytes to underline; 0: as far as the value reaches on its line.
  [[nodiscard]] std::string excerpt(int line_number, int column, int length = 0) const;

 private:
  std::string name_, text_;
  std::vector<std::size_t> line_starts_;
};

/// Collection of the errors of one file and of its parts.
class Diagnostics {
 public:
  explicit Diagnostics(const SourceText& source) : source_(&source) {}

  /// Registers another file, of a part, for excerpts.
  void know(std::shared_ptr<const SourceText> source) { of_parts_.push_back(std::move(source)); }

  /// @param length  Bytes to underline; 0: as far as the value reaches on its line.
  void add(const SourceLocation& place, std::string path, std::string what, std::string hint,
           int length = 0);
  /// Adds existing errors.
  void take(const std::vector<Diagnostic>& faults);
  [[nodiscard]] bool empty() const { return list_.empty(); }
  [[nodiscard]] std::size_t size() const { return list_.size(); }
  /// @throws ModelErrors if there is an error, in the order of the file, those of parts last.
  void throw_if_any();

 private:
  /// Number of a file: 0 for the model file, then those of parts.
  [[nodiscard]] std::size_t file_number(const std::string& name) const;

  const SourceText* source_;
  std::vector<Diagnostic> list_;
  std::vector<std::shared_ptr<const SourceText>> of_parts_;
};

}  // namespace polhode::io
