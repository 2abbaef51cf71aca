// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <polhode/io/importers/import_model.hpp>
#include <polhode/io/importers/xml_file.hpp>

namespace polhode::io {

/// Tags and attributes of a file that an import ignores, with one note for each kind.
class IgnoredTags {
 public:
  using Element = XmlFile::Element;

  /// Both outlive this object.
  IgnoredTags(XmlFile& xml, std::vector<ImportNote>& notes) : xml_(xml), notes_(notes) {}

  /// Attributes that have no influence on the motion, without a note.
  void attributes(const Element& element, std::initializer_list<const char*> names);
  /// Tags that have no influence on the motion, with a note.
  void skip(const Element& parent, std::initializer_list<const char*> tags);
  /// A note, or one more of its kind. @param why  The end of the sentence.
  void add(const Element& at, const std::string& what, const std::string& why) {
    add(xml_.place(at), what, why);
  }
  /// Notes on all that has not been read.
  void add_unread();

 private:
  void add(const SourceLocation& place, const std::string& what, const std::string& why);

  XmlFile& xml_;
  std::vector<ImportNote>& notes_;
  struct Kind {
    std::size_t note;
    int times;
  };
  std::map<std::string, Kind> kinds_;
};

}  // namespace polhode::io
