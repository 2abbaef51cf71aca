// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <polhode/io/importers/ignored_tags.hpp>
#include <polhode/io/importers/robot.hpp>
#include <polhode/io/importers/xml_file.hpp>

namespace polhode::io {

/// Settings of <compiler>.
struct MjcfCompiler {
  bool degrees = true;
  std::string euler = "xyz";  ///< Order of Euler angles; capitals are fixed axes.
  bool auto_limits = true;
  std::string mesh_folder;
  bool strip_path = false;
  enum class FromGeoms : unsigned char { automatic, always, never };
  FromGeoms inertia = FromGeoms::automatic;
  double least_mass = 0.0, least_inertia = 0.0;  ///< [kg], [kg m²]
  double total_mass = -1.0;                      ///< Negative: as given [kg].
  bool balance = false;           ///< Whether impossible inertias become those of a ball.
  double groups[2] = {0.0, 5.0};  ///< Of geoms that have mass.
};

/// Parts of the physics that <flag> of <option> can switch off.
struct MjcfFlags {
  bool springs = true, dampers = true, equality = true, actuation = true, control_bounds = true;
  bool contact = true, parents_do_not_touch = true;
  std::vector<double> actuator_groups_off;
};

/// An MJCF file: a tree of tags whose attributes have defaults by class.
class MjcfFile {
 public:
  using Element = XmlFile::Element;

  /// Reads the settings and defaults. Errors go to the file's diagnostics. Both outlive this
  /// object.
  MjcfFile(XmlFile& file, std::vector<ImportNote>& list);

  XmlFile& xml;
  std::vector<ImportNote>& notes;
  IgnoredTags ignored;
  MjcfCompiler compiler;
  MjcfFlags flags;

  /// Radians of an angle in the file's unit.
  [[nodiscard]] double angle(double value) const;
  /// All tags of a name in all sections of a name.
  std::vector<const Element*> sections(const char* name);
  /// Blocks of defaults that apply to a tag: those of its class, then of the classes above it; in
  /// each class the last one first.
  std::vector<const Element*> blocks_of(const Element& e, const std::string& child_class);
  /// Marks a tag with all it contains as read, and lists those of its attributes and tags that MJCF
  /// does not have.
  void skip(const Element& e);
  /// Tags that give an attribute: the tag itself, and the defaults of its class and of those above.
  std::vector<const Element*> givers(const Element& e, const char* attribute,
                                     const std::vector<std::string>& kinds,
                                     const std::string& child_class);
  /// Tag that gives an attribute: the tag itself, or the default of its class or a class above.
  /// @param kinds  Names of its tag in defaults.
  /// @returns null if there is none.
  const Element* giver(const Element& e, const char* attribute,
                       const std::vector<std::string>& kinds, const std::string& child_class);

 private:
  struct Class {
    std::string parent;
    std::vector<const Element*> blocks;
  };
  void read_compiler(const Element& e);
  void read_defaults(const Element& e, const std::string& parent);

  std::map<std::string, Class> classes_;
  std::string main_ = "main";
};

/// A tag of an MJCF file with the defaults of its class.
struct MjcfTag {
  MjcfFile& file;
  const XmlFile::Element& e;
  std::vector<std::string> kinds;  ///< Names of its tag in defaults.
  std::string child_class;         ///< Of the bodies that contain it.
  std::string suffix = {};         ///< Of its name, as of one of several copies.

  /// Its name, with the suffix; nothing if it has none.
  [[nodiscard]] std::optional<std::string> name() const;
  [[nodiscard]] bool has(const char* attribute) const;
  [[nodiscard]] std::string text(const char* attribute, const std::string& standard = "") const;
  [[nodiscard]] double number(const char* attribute, double standard) const;
  [[nodiscard]] Vec3 vector(const char* attribute, const Vec3& standard) const;
  /// Empty if it is missing, or after an error. Where there are fewer than `most`, the others are
  /// those of defaults further above: each tag replaces only the numbers that it gives.
  [[nodiscard]] std::vector<double> numbers(const char* attribute, std::size_t least,
                                            std::size_t most) const;
  [[nodiscard]] bool boolean(const char* attribute, bool standard) const;
  /// Rotation by quat, axisangle, euler, xyaxes or zaxis.
  [[nodiscard]] Mat3 rotation() const;
  [[nodiscard]] Pose pose() const { return {vector("pos", Vec3::Zero()), rotation()}; }
};

/// Rotation that takes z to a direction about the axis normal to both.
[[nodiscard]] Mat3 rotation_to(const Vec3& z);

}  // namespace polhode::io
