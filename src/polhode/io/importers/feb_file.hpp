// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <polhode/io/importers/ignored_tags.hpp>
#include <polhode/io/importers/node_builder.hpp>
#include <polhode/io/importers/xml_file.hpp>

namespace polhode::io {

/// A number of an FEBio file that a load controller may multiply.
struct FebValue {
  double factor = 0.0;
  std::optional<int> controller;         ///< Number of the load controller.
  const XmlFile::Element* at = nullptr;  ///< Null: the standard value, given nowhere.
  [[nodiscard]] bool is_zero() const { return factor == 0.0; }
  [[nodiscard]] bool is_constant() const { return factor == 0.0 || !controller; }
};

/// An FEBio file, whose values are texts of tags, with commas or blanks between numbers.
class FebFile {
 public:
  using Element = XmlFile::Element;

  /// All outlive this object.
  FebFile(XmlFile& file, std::vector<ImportNote>& list, const ImportOptions& import_options)
      : xml(file), notes(list), ignored(file, list), options(import_options) {}

  XmlFile& xml;
  std::vector<ImportNote>& notes;
  IgnoredTags ignored;
  const ImportOptions& options;

  /// Whether there was an error so far.
  [[nodiscard]] bool has_faults() const { return xml.has_faults(); }

  /// Error about a part that a model cannot represent, or a note where partial imports are allowed.
  /// The tag counts as read.
  void refuse(const Element& at, const std::string& what, const std::string& hint);
  void approximated(const Element& at, std::string what);
  [[nodiscard]] NodeBuilder make(const Element& at) const { return {xml.line(at)}; }

  /// All child tags, as read.
  std::vector<const Element*> children(const Element& parent);
  /// Child tag, as read; error if there are several.
  const Element* child(const Element& parent, const char* tag);
  /// Text of a child; "" if there is none.
  std::string text(const Element& parent, const char* tag);
  /// Type of a tag, in lower case; "" after an error.
  std::string type(const Element& e);
  /// From `least` to `most` numbers in the text of a tag; nothing after an error.
  std::optional<std::vector<double>> numbers(const Element& e, std::size_t least, std::size_t most);
  /// Marks child tags as read, without a note.
  void skip_all(const Element& parent, std::initializer_list<const char*> tags);
  /// Number of a child; nothing if there is none, or after an error. One that changes by a load
  /// controller is refused.
  std::optional<double> number(const Element& parent, const char* tag);
  std::optional<Vec3> vector(const Element& parent, const char* tag);
  /// Direction of a child, of length 1; the standard one if there is none, or after an error.
  Vec3 direction(const Element& parent, const char* tag, const Vec3& standard);
  bool boolean(const Element& parent, const char* tag, bool standard);
  /// Number of a child with its load controller.
  FebValue value(const Element& parent, const char* tag, double standard = 0.0);
  /// Vector of a child with its load controller, by component; zero if there is none.
  std::array<FebValue, 3> vector_value(const Element& parent, const char* tag);
  /// Whole numbers in the text of a tag: "1, 2, 5:8, 10:20:2"; error if there are too many.
  std::vector<std::int64_t> integers(const Element& e);
  /// Whole number in an attribute that must be there; nothing after an error.
  std::optional<std::int64_t> id(const Element& e, const char* key = "id");
  /// Refuses a tag that has a load controller.
  void refuse_controller(const Element& e);
  /// Load controller of a tag.
  std::optional<int> controller(const Element& e);

  /// Name that a model file allows, which none of `taken` has, and that is added to it.
  std::string name(const Element& e, const std::string& wanted, std::set<std::string>& taken);
};

/// Text in lower case.
[[nodiscard]] std::string lower_case(std::string text);

}  // namespace polhode::io
