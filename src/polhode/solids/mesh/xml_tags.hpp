// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>

#include <polhode/solids/mesh/mesh_cursor.hpp>

namespace polhode {

/// One tag of an XML file.
struct XmlTag {
  std::string name;
  bool closes = false;  ///< </name>
  bool empty = false;   ///< <name … />
  std::map<std::string, std::string, std::less<>> attributes;
  std::size_t at = 0;  ///< Byte of its '<'.

  /// An attribute; empty if it is not there.
  [[nodiscard]] const std::string& operator[](std::string_view attribute) const;
  [[nodiscard]] bool has(std::string_view attribute) const {
    return attributes.find(attribute) != attributes.end();
  }
};

/// Tags of an XML file one after the other, and the text between them. Comments, declarations and
/// instructions are passed over; entities in attributes are decoded.
class XmlTags {
 public:
  explicit XmlTags(MeshCursor& in) : in_(in) {}

  /// The next tag; the cursor then stands behind it. One without a name at the end of the file.
  XmlTag next();
  /// Text from the cursor up to the next tag; the cursor then stands at that tag.
  std::string_view text();
  /// Passes over the content of a tag that has been read, up to and with its closing tag.
  void skip(const XmlTag& tag);

 private:
  std::string attribute_value();

  MeshCursor& in_;
};

}  // namespace polhode
