// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>

#include <polhode/solids/mesh/mesh_cursor.hpp>

namespace polhode::solids {

/// One tag of an XML file.
struct XmlTag {
  std::string name;
  bool closes = false;  ///< </name>
  bool empty = false;   ///< <name … />
  std::map<std::string, std::string, std::less<>> attributes;
  std::size_t at = 0;  ///< Byte of its '<'.

  /// An attribute; empty if there is none.
  [[nodiscard]] const std::string& operator[](std::string_view attribute) const;
  [[nodiscard]] bool has(std::string_view attribute) const {
    return attributes.find(attribute) != attributes.end();
  }
};

/// Reader of the tags of an XML file, and the text between them. Comments, declarations and
/// instructions are skipped; entities in attributes are decoded.
class XmlTags {
 public:
  explicit XmlTags(MeshCursor& in) : in_(in) {}

  /// Next tag; the cursor is then behind it. Without a name at the end of the file.
  XmlTag next();
  /// Text from the cursor up to the next tag; the cursor is then at that tag.
  std::string_view text();
  /// Skips the content of a tag that has been read, including its closing tag.
  void skip(const XmlTag& tag);

 private:
  std::string attribute_value();

  MeshCursor& in_;
};

}  // namespace polhode::solids
