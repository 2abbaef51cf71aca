// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <tinyxml2.h>

#include <polhode/core/types.hpp>
#include <polhode/io/text/diagnostics.hpp>

namespace polhode::io {

/// Limits of an XML file; the parsed document takes several times its bytes.
inline constexpr std::size_t kMostXmlBytes = std::size_t{1} << 26;

/// A parsed XML file, whose errors go to diagnostics with their line, and which remembers the tags
/// and attributes that were read, so that the others can be listed.
///
/// Entities are not declared in such files: a declaration is refused, so that a text cannot grow
/// when it is read.
class XmlFile {
 public:
  using Element = tinyxml2::XMLElement;

  /// @param source  The file; outlives this object, as do the diagnostics.
  /// @throws ModelErrors if it is no XML or too large.
  XmlFile(std::shared_ptr<const SourceText> source, Diagnostics& diagnostics);

  [[nodiscard]] const Element& root() const { return *root_; }
  [[nodiscard]] SourceLocation place(const Element& element) const { return place(line(element)); }
  /// Line of a tag; of one in an included file that of the <include>.
  [[nodiscard]] int line(const Element& element) const;
  [[nodiscard]] SourceLocation place(int line) const;
  void fault(const Element& element, std::string what, std::string hint);

  /// Replaces each <include file="..."/> by what the root tag of that file contains.
  /// @param folder  Folder to which the names of included files are relative.
  void include_files(const std::string& folder);

  /// First child of a name, or null.
  const Element* child(const Element& parent, const char* name);
  /// All children of a name.
  std::vector<const Element*> children(const Element& parent, const char* name);
  /// Marks a tag with all it contains as read.
  void skip(const Element& element);

  /// Attribute as text; nothing if it is missing.
  std::optional<std::string> text(const Element& element, const char* attribute);
  /// Attribute that must be there; "" after an error.
  std::string required_text(const Element& element, const char* attribute);
  /// Number; nothing if it is missing, or after an error.
  std::optional<double> number(const Element& element, const char* attribute);
  /// Three numbers; likewise.
  std::optional<Vec3> vector(const Element& element, const char* attribute);
  /// From `least` to `most` numbers; likewise.
  std::optional<std::vector<double>> numbers(const Element& element, const char* attribute,
                                             std::size_t least, std::size_t most);

  /// A tag or attribute that was not read.
  struct Unread {
    int line;
    std::string what;  ///< "<tag> in <parent>" or "attribute 'a' of <tag>".
  };
  /// All that was not read, in the order of the file; not the content of tags that were not read.
  [[nodiscard]] std::vector<Unread> unread() const;

 private:
  tinyxml2::XMLNode* include_file(tinyxml2::XMLElement& include, const std::string& folder);
  void list_unread(const Element& element, std::vector<Unread>& list) const;

  std::shared_ptr<const SourceText> source_;
  Diagnostics& diagnostics_;
  std::unique_ptr<tinyxml2::XMLDocument> document_;
  const Element* root_ = nullptr;
  std::unordered_set<const void*> read_;           ///< Tags and attributes.
  std::unordered_map<const void*, int> included_;  ///< Lines of included tags.
  std::unordered_set<std::string> included_files_;
  std::size_t bytes_ = 0;  ///< Of all files.
};

}  // namespace polhode::io
