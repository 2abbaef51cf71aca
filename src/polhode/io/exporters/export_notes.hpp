// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/io/exporters/export_model.hpp>
#include <polhode/io/text/model_errors.hpp>

namespace polhode::io {

/// Collection of all that a format cannot represent, and of what differs.
class ExportNotes {
 public:
  explicit ExportNotes(bool partial) : partial_(partial) {}

  /// Refuses a part of the model, or lists it if it may be left out.
  /// @param what  Without a full stop. @param hint  One sentence.
  void refuse(const SourceLocation& place, const std::string& path, const std::string& what,
              const std::string& hint);
  /// Refuses a part that cannot be left out.
  void fault(const SourceLocation& place, const std::string& path, const std::string& what,
             const std::string& hint);
  void add(ExportNote::Kind kind, const std::string& path, const std::string& what) {
    notes_.push_back({kind, path, what});
  }
  /// @throws ModelErrors if something was refused.
  void throw_if_any() const;
  [[nodiscard]] const std::vector<ExportNote>& notes() const { return notes_; }

 private:
  bool partial_;
  std::vector<Diagnostic> faults_;
  std::vector<ExportNote> notes_;
};

}  // namespace polhode::io
