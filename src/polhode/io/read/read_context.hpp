// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <polhode/io/schema/field_table.hpp>
#include <polhode/io/text/expression.hpp>
#include <polhode/io/text/source_tree.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// The file, or the map within one, that a part was read from.
struct PartSource {
  std::string prefix;  ///< Of its names in the whole model.
  const SourceTree* tree = nullptr;
  const SourceNode* root = nullptr;
};

/// All that the readers of the parts of one model share.
struct ReadContext {
  const SourceTree& tree;
  Diagnostics& diagnostics;
  UnitSystem units{};
  Variables variables{};
  std::string folder{};  ///< Of the model file; mesh files are seen from it.
  Model model{};
  std::unordered_map<std::string, int> bodies{}, joints{}, loads{};  ///< Index by name.
  std::unordered_map<std::string, int> materials{}, solids{};        ///< Likewise.
  /// By name; nothing if a fault was found.
  std::map<std::string, std::optional<SectionSpec>> sections{};
  std::map<std::string, std::optional<int>> cables{};       ///< Index by name, likewise.
  std::vector<std::string> controllers{};                   ///< Names, before they are read.
  std::vector<bool> material_is_sound{}, solid_is_sound{};  ///< No fault was found in the entries.
  std::vector<bool> body_is_sound{};  ///< No fault was found in the body's place.
  std::string source_file{};          ///< The model file, as messages show it.
  Variables given_variables{};        ///< Of a part: what the whole sets.
  std::vector<PartSource> parts{};    ///< Parts of parts too.
  std::vector<std::shared_ptr<const SourceTree>> owned_trees{};  ///< Of the parts' files.
  std::vector<std::string> files_above{};  ///< The file and those it is a part of, in full.

  /// Adds a fault of a value.
  void fault(const SourceNode& node, const std::string& path, std::string what, std::string hint);
  [[nodiscard]] std::vector<std::string> body_names() const;  ///< With ground.
  [[nodiscard]] std::vector<std::string> joint_names() const;
  [[nodiscard]] std::vector<std::string> load_names() const;
  [[nodiscard]] std::vector<std::string> material_names() const;
  [[nodiscard]] std::vector<std::string> solid_names() const;
};

/// The text of a value as a dimension-checked number or expression; null after a fault.
std::shared_ptr<const Expression> read_expression(ReadContext& context, const SourceNode& node,
                                                  const std::string& path, bool allow_time);

/// A number in SI; nothing after a fault.
std::optional<double> read_number(ReadContext& context, const SourceNode& node,
                                  const std::string& path, const Field& field);
/// A number that may depend on time, or a table; null after a fault.
TimeFunctionPtr read_time_number(ReadContext& context, const SourceNode& node,
                                 const std::string& path, const Field& field);
std::optional<std::vector<double>> read_numbers(ReadContext& context, const SourceNode& node,
                                                const std::string& path, const Field& field,
                                                std::size_t count);
std::optional<Vec3> read_vector(ReadContext& context, const SourceNode& node,
                                const std::string& path, const Field& field);
std::optional<TimeVector> read_time_vector(ReadContext& context, const SourceNode& node,
                                           const std::string& path, const Field& field);
std::optional<std::array<Vec3, 2>> read_vector_pair(ReadContext& context, const SourceNode& node,
                                                    const std::string& path, const Field& field);
/// A unit vector from a letter (x, -x, ...) or three numbers.
std::optional<Vec3> read_direction(ReadContext& context, const SourceNode& node,
                                   const std::string& path);
std::optional<std::array<Vec3, 2>> read_direction_pair(ReadContext& context, const SourceNode& node,
                                                       const std::string& path);
std::optional<bool> read_boolean(ReadContext& context, const SourceNode& node,
                                 const std::string& path);
std::optional<std::string> read_text(ReadContext& context, const SourceNode& node,
                                     const std::string& path);
std::optional<std::string> read_choice(ReadContext& context, const SourceNode& node,
                                       const std::string& path,
                                       const std::vector<std::string>& choices);
/// Words out of a list, each at most once, in the order of the list.
std::optional<std::vector<std::string>> read_choices(ReadContext& context, const SourceNode& node,
                                                     const std::string& path, const Field& field);
/// Index of a body; kGround for ground.
std::optional<int> read_body(ReadContext& context, const SourceNode& node, const std::string& path);
std::optional<std::array<int, 2>> read_body_pair(ReadContext& context, const SourceNode& node,
                                                 const std::string& path);

/// A list of names that is not empty, each once.
std::optional<std::vector<std::string>> read_names(ReadContext& context, const SourceNode& node,
                                                   const std::string& path);
/// A number, or a list of them that is not empty.
std::optional<std::vector<double>> read_number_list(ReadContext& context, const SourceNode& node,
                                                    const std::string& path, const Field& field);
/// Index of a material or solid.
std::optional<int> read_material_name(ReadContext& context, const SourceNode& node,
                                      const std::string& path);
std::optional<int> read_solid_name(ReadContext& context, const SourceNode& node,
                                   const std::string& path);
/// A whole number, not negative; a list of such numbers.
std::optional<int> read_index(ReadContext& context, const SourceNode& node,
                              const std::string& path);
std::optional<std::vector<int>> read_indices(ReadContext& context, const SourceNode& node,
                                             const std::string& path);
/// Nodes or faces of a solid: a set's name, a map, or a list of these.
std::optional<std::vector<Selection>> read_selections(ReadContext& context, const SourceNode& node,
                                                      const std::string& path);
/// A path to a file that exists, seen from the model file's folder.
std::optional<std::string> read_file_name(ReadContext& context, const SourceNode& node,
                                          const std::string& path);

/// Whether a user may give this name to a body, joint, load or probe; adds a fault if not.
bool check_name(ReadContext& context, const SourceNode::Key& key, const SourceNode& value,
                const std::string& collection);

/// An expression of the field's variable, or a table over it.
TimeFunctionPtr read_law(ReadContext& context, const SourceNode& node, const std::string& path,
                         const Field& field);

/// A map that is read by the fields of a table.
class Section {
 public:
  /// Tells of unknown and missing keys, and of a value that is no map.
  /// @param place  Of the thing, where a missing key is told.
  Section(ReadContext& context, const SourceNode& node, SourceLocation place, std::string path,
          const FieldTable& table);

  [[nodiscard]] const SourceNode* find(const std::string& name) const;
  [[nodiscard]] bool has(const std::string& name) const { return find(name) != nullptr; }
  /// Whether a key is missing and no unknown key looks like it, which would say enough.
  [[nodiscard]] bool misses(const std::string& name) const;
  [[nodiscard]] bool has_unknown_key() const { return has_unknown_key_; }
  [[nodiscard]] std::string path(const std::string& name) const {
    return path_.empty() ? name : path_ + "." + name;
  }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const SourceLocation& place() const { return place_; }

  std::optional<double> number(const std::string& name);
  std::optional<std::vector<double>> number_list(const std::string& name);
  std::optional<int> integer(const std::string& name);
  std::optional<bool> boolean(const std::string& name);
  std::optional<std::string> text(const std::string& name);
  std::optional<std::string> choice(const std::string& name);
  std::optional<std::vector<std::string>> choices(const std::string& name);
  std::optional<Vec3> vector(const std::string& name);
  TimeFunctionPtr time_number(const std::string& name);  ///< Null if absent or faulty.
  TimeFunctionPtr law(const std::string& name);          ///< Likewise.
  std::optional<TimeVector> time_vector(const std::string& name);
  std::optional<std::array<Vec3, 2>> vector_pair(const std::string& name);
  std::optional<Vec3> direction(const std::string& name);
  std::optional<std::array<Vec3, 2>> direction_pair(const std::string& name);
  std::optional<int> body(const std::string& name);
  std::optional<std::array<int, 2>> body_pair(const std::string& name);
  std::optional<std::vector<std::string>> names(const std::string& name);

  /// A fault of one key, or of the whole thing where the key is absent.
  void fault(const std::string& name, std::string what, std::string hint);
  /// A fault of the whole thing.
  void fault(std::string what, std::string hint);
  /// Tells that two keys exclude each other, if both are there.
  bool refuse_both(const std::string& one, const std::string& other, const std::string& hint);

 private:
  ReadContext& context_;
  const SourceNode& node_;
  SourceLocation place_;
  std::string path_;
  const FieldTable& table_;
  bool has_unknown_key_ = false;
  std::vector<std::string> likely_meant_;  ///< By unknown keys.
};

/// The table of the kind that "type", or another key, names; null after a fault.
const FieldTable* read_kind(ReadContext& context, const SourceNode& node,
                            const SourceLocation& place, const std::string& path,
                            const std::vector<KindTable>& kinds, std::string& type,
                            const char* key = "type");

/// The shortest text of a number for messages.
std::string shown(double value);

// The parts of a model, each in its own file.
void read_units(ReadContext& context, const SourceNode& node);
void read_variables(ReadContext& context, const SourceNode& node);
/// A rotation as an Euler sequence: three letters of one case, neighbours different; adds a fault
/// if it is none.
bool check_euler_sequence(Section& section, const std::string& sequence,
                          const char* key = "sequence");
/// Prescribed motion among the keys of a section; nothing if it prescribes nothing.
/// @param moves  By component x, y, z: whether it is given.
std::optional<FrameMotion> read_motion(ReadContext& context, Section& section,
                                       std::array<bool, 3>& moves);
std::optional<Quat> read_orientation(ReadContext& context, const SourceNode& node,
                                     const std::string& path);
/// A number by name: with the dimension of its unit, or of any.
Quantity read_variable(ReadContext& context, const SourceNode& node, const std::string& path);
void read_bodies(ReadContext& context, const SourceNode& node);
/// Parts become bodies, joints and the like: read after the bodies and before what names them.
void read_parts(ReadContext& context, const SourceNode& node);
/// Everything of a model that a part gives to a whole. @param path  Of the map, "" for a file.
void read_things(ReadContext& context, const SourceNode& root, const std::string& path);
std::vector<ShapeSpec> read_shapes(ReadContext& context, const SourceNode& node,
                                   const std::string& path);
ContactSideSpec read_contact_side(ReadContext& context, const SourceNode& node,
                                  const std::string& path);
/// The keys of a side among those of another section.
void read_contact_side(Section& section, ContactSideSpec& side);
void read_solid_contact(ReadContext& context, const SourceNode& node, const std::string& path,
                        SolidSpec& solid);
/// Two bodies, or a body and a solid: sides of contact.
std::optional<std::array<int, 2>> read_side_pair(ReadContext& context, const SourceNode& node,
                                                 const std::string& path);
void read_joints(ReadContext& context, const SourceNode& node);
void read_contacts(ReadContext& context, const SourceNode& node);
void read_materials(ReadContext& context, const SourceNode& node);
void read_sections(ReadContext& context, const SourceNode& node);
/// Beams and cables become bodies and joints: read after the bodies and before what names them.
void read_beams(ReadContext& context, const SourceNode& node);
void read_cables(ReadContext& context, const SourceNode& node);
/// What a cable pulls with: stiffness, given tension, muscle; and whether it slides.
void read_cable_pull(ReadContext& context, Section& section, CableLineSpec& cable);
void read_solid_mesh(ReadContext& context, const SourceNode& node, const std::string& path,
                     MeshSpec& mesh);
void read_solids(ReadContext& context, const SourceNode& node);
void read_loads(ReadContext& context, const SourceNode& node);
/// The thing that one of the keys `kinds` names, and which of its numbers are meant.
/// @param what  Of that thing, for messages: "to record". @returns false after a fault.
bool read_recorded(ReadContext& context, Section& section, const std::vector<std::string>& kinds,
                   const char* what, ProbeSpec& probe);
/// A number that something reports, by the keys of a probe and 'channel'.
struct ReadChannel {
  ChannelSpec spec;
  Dimension dimension;  ///< Of its number.
};
std::optional<ReadChannel> read_channel(ReadContext& context, Section& section);
/// Controllers read channels of all there is: read after that, contacts too.
void read_controllers(ReadContext& context, const SourceNode& node);
/// A number that a controller sets, {controller: name}; null after a fault.
TimeFunctionPtr read_controlled_value(ReadContext& context, const SourceNode& node,
                                      const std::string& path);
/// Events switch joints and loads: read after these.
void read_events(ReadContext& context, const SourceNode& node);
void read_analysis(ReadContext& context, const SourceNode& node, const SourceLocation& place);
void read_output(ReadContext& context, const SourceNode& node, const SourceLocation& place);
/// What only the mesh of a solid shows: sets that match nothing, nodes held twice, and the like.
void check_solids(ReadContext& context, const SourceNode& root);
/// What only the shapes show: hulls without volume, open meshes, names of materials.
void check_contacts(ReadContext& context, const SourceNode& root);
/// The place of the deepest value of a path such as solids.pad.mesh.elements[3] that the file has.
SourceLocation place_of_path(const ReadContext& context, const SourceNode& root,
                             std::string_view path);
/// What only the whole model shows: orders against loads, and the like.
void check_model(ReadContext& context, const SourceNode& root);

}  // namespace polhode
