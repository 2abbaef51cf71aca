// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/exporters/export_notes.hpp>

namespace polhode::io {

void ExportNotes::refuse(const SourceLocation& place, const std::string& path,
                         const std::string& what, const std::string& hint) {
  if (partial_)
    add(ExportNote::Kind::left_out, path, what);
  else
    fault(place, path, what, hint + " Or allow a partial export, which leaves it out.");
}

void ExportNotes::fault(const SourceLocation& place, const std::string& path,
                        const std::string& what, const std::string& hint) {
  faults_.push_back({place, path, what, hint, ""});
}

void ExportNotes::throw_if_any() const {
  if (!faults_.empty()) throw ModelErrors(faults_);
}

}  // namespace polhode::io
