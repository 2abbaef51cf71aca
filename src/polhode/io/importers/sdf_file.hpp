// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <polhode/io/importers/ignored_tags.hpp>
#include <polhode/io/importers/robot.hpp>
#include <polhode/io/importers/xml_file.hpp>

namespace polhode::io {

/// A <pose> of an SDFormat file.
struct SdfPose {
  Pose pose;
  std::string relative_to;  ///< Name of a frame; "": what the tag around it says.
};

/// An SDFormat file, whose values are texts of tags.
class SdfFile {
 public:
  using Element = XmlFile::Element;

  /// Both outlive this object.
  SdfFile(XmlFile& file, std::vector<ImportNote>& list, const ImportOptions& import_options)
      : xml(file), notes(list), ignored(file, list), options(import_options) {}

  XmlFile& xml;
  std::vector<ImportNote>& notes;
  IgnoredTags ignored;
  const ImportOptions& options;

  /// Error about a part that a model cannot represent, or a note where partial imports are allowed.
  void refuse(const Element& at, const std::string& what, const std::string& hint);
  void approximated(const Element& at, std::string what);

  /// Text of a child; "" if there is none.
  std::string text(const Element& parent, const char* tag);
  /// Text of a child that must be there; "" after an error.
  std::string required_text(const Element& parent, const char* tag);
  /// Number of a child; nothing if there is none, or after an error.
  std::optional<double> number(const Element& parent, const char* tag);
  /// Number of a child; nothing if there is none or it means infinity, or after an error.
  std::optional<double> bound(const Element& parent, const char* tag);
  /// Number of a child that is not negative; 0 if there is none.
  double not_negative(const Element& parent, const char* tag);
  std::optional<Vec3> vector(const Element& parent, const char* tag);
  bool boolean(const Element& parent, const char* tag, bool standard);
  bool flag(const Element& e, const char* attribute, bool standard);
  /// Pose of a tag: its child <pose>.
  SdfPose pose(const Element& parent);

 private:
  bool truth(const Element& e, const std::string& what, const std::string& text, bool standard);
};

}  // namespace polhode::io
