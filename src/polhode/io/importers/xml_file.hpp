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
  /// Place of a tag, also in an included file.
  [[nodiscard]] SourceLocation place(const Element& element) const;
  /// Line of a tag; of one in an included file that of the <include>.
  [[nodiscard]] int line(const Element& element) const;
  [[nodiscard]] SourceLocation place(int line) const { return place(*source_, line); }
  void fault(const Element& element, std::string what, std::string hint);
  [[nodiscard]] bool has_faults() const { return !diagnostics_.empty(); }

  /// Replaces each <include file="..."/> by what the root tag of that file contains.
  /// @param folder  Folder to which the names of included files are relative.
  void include_files(const std::string& folder);

  /// Puts the root tag of a file, with its content, below a tag.
  /// @param name  Of the file, for messages.
  /// @returns the root tag, or null after an error.
  const Element* include_below(const Element& at, const std::string& path, const std::string& name);

  /// First child of a name, or null.
  const Element* child(const Element& parent, const char* name);
  /// All children of a name.
  std::vector<const Element*> children(const Element& parent, const char* name);
  /// Marks a tag as read, without what it contains.
  void mark_read(const Element& element) { read_.insert(&element); }
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

  /// Text of a tag without blanks at its ends; nothing if there is none.
  [[nodiscard]] static std::optional<std::string> content(const Element& element);
  /// From `least` to `most` numbers in the text of a tag; nothing if it has none, or after an
  /// error.
  std::optional<std::vector<double>> content_numbers(const Element& element, std::size_t least,
                                                     std::size_t most);

  /// A tag or attribute that was not read.
  struct Unread {
    SourceLocation place;
    std::string what;  ///< "<tag> in <parent>" or "attribute 'a' of <tag>".
  };
  /// All that was not read, in the order of the file; not the content of tags that were not read.
  [[nodiscard]] std::vector<Unread> unread() const;

 private:
  /// Root tag of an included file; null after an error.
  const Element* parse_included(const Element& at, const std::string& name, std::string text,
                                tinyxml2::XMLDocument& part);
  /// Notes where the copy of a part of the last included file is from.
  void locate(const tinyxml2::XMLNode& copy, const tinyxml2::XMLNode& original, int line);
  /// Notes where the copy of a part of the file itself is from.
  void locate_part(const tinyxml2::XMLNode& copy, const tinyxml2::XMLNode& original);
  std::optional<std::vector<double>> numbers_in(const Element& element, const std::string& what,
                                                const std::string& text, std::size_t least,
                                                std::size_t most);
  [[nodiscard]] static SourceLocation place(const SourceText& source, int line);
  tinyxml2::XMLNode* include_file(tinyxml2::XMLElement& include, const std::string& folder);
  void list_unread(const Element& element, std::vector<Unread>& list) const;

  std::shared_ptr<const SourceText> source_;
  Diagnostics& diagnostics_;
  std::unique_ptr<tinyxml2::XMLDocument> document_;
  const Element* root_ = nullptr;
  std::unordered_set<const void*> read_;  ///< Tags and attributes.
  /// Where an included tag is from.
  struct Included {
    int line;          ///< Of the <include>.
    std::size_t part;  ///< Number of the file.
    int own_line;
  };
  std::unordered_map<const void*, Included> included_;
  std::vector<std::shared_ptr<const SourceText>> parts_;
  std::unordered_set<std::string> included_files_;
  std::size_t bytes_ = 0;  ///< Of all files.
};

}  // namespace polhode::io
