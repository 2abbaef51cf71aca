// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
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

namespace polhode::io {

/// Source of a part: a file, or a map within one.
struct PartSource {
  std::string prefix;  ///< Prefix of its names in the whole model.
  const SourceTree* tree = nullptr;
  const SourceNode* root = nullptr;
};

/// Start value of a coordinate of a joint.
struct JointStart {
  int joint = 0;  ///< Index into Model::joints.
  std::string coordinate;
  std::string name;  ///< As an IndependentCoordinate.
  std::string path;  ///< Of the key, for messages.
  SourceLocation place;
  double value = 0.0;  ///< SI.
  bool is_rate = false;
};

/// Longest name [characters]: file systems allow 255 with the endings of files.
inline constexpr std::size_t kLongestName = 200;

/// Files and numbers of the parts of a model, shared by all its readers: parts within parts
/// multiply.
struct PartsRead {
  std::size_t count = 0, bytes = 0;  ///< Parts, and bytes of their files each time they are used.
  std::map<std::string, std::shared_ptr<const SourceTree>> trees{};  ///< By full path.
};

/// Shared data of the readers of the parts of one model.
struct ReadContext {
  const SourceTree& tree;
  Diagnostics& diagnostics;
  UnitSystem units{};
  Variables variables{};
  std::string folder{};  ///< Of the model file; paths of mesh files are relative to it.
  Model model{};
  std::unordered_map<std::string, int> bodies{}, joints{}, loads{};  ///< Index by name.
  std::unordered_map<std::string, int> materials{}, solids{};        ///< Likewise.
  /// By name; nothing if an error was found.
  std::map<std::string, std::optional<SectionSpec>> sections{};
  std::map<std::string, std::optional<int>> cables{};       ///< Index by name, likewise.
  std::vector<std::string> controllers{};                   ///< Names, before they are read.
  std::vector<bool> material_is_sound{}, solid_is_sound{};  ///< No error was found in the entries.
  std::vector<bool> body_is_sound{};  ///< No error was found in the body's placement.
  std::string source_file{};          ///< Model file, as shown in messages.
  Variables given_variables{};        ///< Of a part: set by the whole.
  std::vector<JointStart> starts{};   ///< Of the file's own joints, until bodies are placed.
  bool has_starts = false;            ///< Joints that are read do not start as described.
  std::vector<PartSource> parts{};    ///< Including nested parts.
  /// The file and those containing it as a part, full paths.
  std::vector<std::string> files_above{};
  std::shared_ptr<PartsRead> parts_read = std::make_shared<PartsRead>();

  /// Adds an error of a value.
  void fault(const SourceNode& node, const std::string& path, std::string what, std::string hint);
  [[nodiscard]] std::vector<std::string> body_names() const;  ///< With ground.
  [[nodiscard]] std::vector<std::string> joint_names() const;
  [[nodiscard]] std::vector<std::string> load_names() const;
  [[nodiscard]] std::vector<std::string> material_names() const;
  [[nodiscard]] std::vector<std::string> solid_names() const;
};

/// Value as a dimension-checked number or expression; null after an error.
std::shared_ptr<const Expression> read_expression(ReadContext& context, const SourceNode& node,
                                                  const std::string& path, bool allow_time);

/// Number in SI; nothing after an error.
std::optional<double> read_number(ReadContext& context, const SourceNode& node,
                                  const std::string& path, const Field& field);
/// Number that may depend on time, or a table; null after an error.
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

/// Nonempty list of names, each once.
std::optional<std::vector<std::string>> read_names(ReadContext& context, const SourceNode& node,
                                                   const std::string& path);
/// Number, or a nonempty list of them.
std::optional<std::vector<double>> read_number_list(ReadContext& context, const SourceNode& node,
                                                    const std::string& path, const Field& field);
/// Index of a material or solid.
std::optional<int> read_material_name(ReadContext& context, const SourceNode& node,
                                      const std::string& path);
std::optional<int> read_solid_name(ReadContext& context, const SourceNode& node,
                                   const std::string& path);
/// Nonnegative integer; list of such numbers.
std::optional<int> read_index(ReadContext& context, const SourceNode& node,
                              const std::string& path);
std::optional<std::vector<int>> read_indices(ReadContext& context, const SourceNode& node,
                                             const std::string& path);
/// Nodes or faces of a solid: a set's name, a map, or a list of these.
std::optional<std::vector<solids::Selection>> read_selections(ReadContext& context,
                                                              const SourceNode& node,
                                                              const std::string& path);
/// Path from the root, links followed as far as there are files.
std::string full_path(const std::string& file);
/// Path of an existing file, relative to the model file's folder.
std::optional<std::string> read_file_name(ReadContext& context, const SourceNode& node,
                                          const std::string& path);

/// Whether this name is allowed for a body, joint, load or probe; adds an error if not.
bool check_name(ReadContext& context, const SourceNode::Key& key, const SourceNode& value,
                const std::string& collection);

/// An expression of the field's variable, or a table over it.
TimeFunctionPtr read_law(ReadContext& context, const SourceNode& node, const std::string& path,
                         const Field& field);

/// A map that is read according to a table of fields.
class Section {
 public:
  /// Reports unknown and missing keys, and a value that is no map.
  /// @param place  Of the object, where a missing key is reported.
  Section(ReadContext& context, const SourceNode& node, SourceLocation place, std::string path,
          const FieldTable& table);

  [[nodiscard]] const SourceNode* find(const std::string& name) const;
  [[nodiscard]] bool has(const std::string& name) const { return find(name) != nullptr; }
  /// Whether a key is missing and no unknown key resembles it, which would be reported instead.
  [[nodiscard]] bool misses(const std::string& name) const;
  [[nodiscard]] bool has_unknown_key() const { return has_unknown_key_; }
  [[nodiscard]] std::string path(const std::string& name) const {
    return path_.empty() ? name : path_ + "." + name;
  }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const SourceLocation& place() const { return place_; }

  /// Reads the fields that are bound to members of this type of spec; members without a valid value
  /// stay as they are.
  /// @param by_hand  Keys that are left out, because they have rules of their own.
  /// @throws std::logic_error if the table is that of another spec, or has no such keys.
  template <class Spec>
  void read_into(Spec& spec, const std::vector<std::string_view>& by_hand = {}) {
    for (const std::string_view key : by_hand) static_cast<void>(table_.at(key));
    for (const Field* field : fields_of<Spec>(table_))
      if (std::find(by_hand.begin(), by_hand.end(), field->name) == by_hand.end())
        read_value(*field, field->member.in(spec));
  }

  std::optional<double> number(const std::string& name);
  std::optional<double> step(const std::string& name);  ///< A time; nothing for auto.
  std::optional<std::vector<double>> number_list(const std::string& name);
  std::optional<int> integer(const std::string& name);
  std::optional<bool> boolean(const std::string& name);
  std::optional<std::string> text(const std::string& name);
  std::optional<std::string> choice(const std::string& name);
  std::optional<std::vector<std::string>> choices(const std::string& name);
  std::optional<Vec3> vector(const std::string& name);
  TimeFunctionPtr time_number(const std::string& name);  ///< Null if absent or invalid.
  TimeFunctionPtr law(const std::string& name);          ///< Likewise.
  std::optional<TimeVector> time_vector(const std::string& name);
  std::optional<std::array<Vec3, 2>> vector_pair(const std::string& name);
  std::optional<Vec3> direction(const std::string& name);
  std::optional<std::array<Vec3, 2>> direction_pair(const std::string& name);
  std::optional<int> body(const std::string& name);
  std::optional<std::array<int, 2>> body_pair(const std::string& name);
  std::optional<std::vector<std::string>> names(const std::string& name);

  /// Adds an error of one key, or of the whole object if the key is absent.
  void fault(const std::string& name, std::string what, std::string hint);
  /// Adds an error of the whole object.
  void fault(std::string what, std::string hint);
  /// Reports that two keys exclude each other, if both are given.
  bool refuse_both(const std::string& one, const std::string& other, const std::string& hint);

 private:
  void read_value(const Field& field, const SpecValue& member);

  ReadContext& context_;
  const SourceNode& node_;
  SourceLocation place_;
  std::string path_;
  const FieldTable& table_;
  bool has_unknown_key_ = false;
  std::vector<std::string> likely_meant_;  ///< Suggestions for unknown keys.
};

/// Table of the kind given by "type", or another key; null after an error.
const FieldTable* read_kind(ReadContext& context, const SourceNode& node,
                            const SourceLocation& place, const std::string& path,
                            const std::vector<KindTable>& kinds, std::string& type,
                            const char* key = "type");

/// The shortest text of a number for messages.
std::string shown(double value);

// The parts of a model, each in its own file.
void read_units(ReadContext& context, const SourceNode& node);
void read_variables(ReadContext& context, const SourceNode& node);
/// Checks that a rotation is an Euler sequence: three letters of one case, neighbours different;
/// adds an error otherwise.
bool check_euler_sequence(Section& section, const std::string& sequence,
                          const char* key = "sequence");
/// Prescribed motion among the keys of a section; nothing if there is none.
/// @param moves  By component x, y, z: whether it is given.
std::optional<FrameMotion> read_motion(ReadContext& context, Section& section,
                                       std::array<bool, 3>& moves);
std::optional<Quat> read_orientation(ReadContext& context, const SourceNode& node,
                                     const std::string& path);
/// Variable: a number with the dimension of its unit, or of any.
Quantity read_variable(ReadContext& context, const SourceNode& node, const std::string& path);
void read_bodies(ReadContext& context, const SourceNode& node);
/// Reads parts, which become bodies, joints etc.: after the bodies and before references to them.
void read_parts(ReadContext& context, const SourceNode& node);
/// Reads all objects that a part adds to a whole. @param path  Of the map, "" for a file.
void read_things(ReadContext& context, const SourceNode& root, const std::string& path);
std::vector<ShapeSpec> read_shapes(ReadContext& context, const SourceNode& node,
                                   const std::string& path);
ContactSideSpec read_contact_side(ReadContext& context, const SourceNode& node,
                                  const std::string& path);
/// Reads the contact keys of a side among those of another section.
void read_contact_side(Section& section, ContactSideSpec& side);
void read_solid_contact(ReadContext& context, const SourceNode& node, const std::string& path,
                        SolidSpec& solid);
/// Two sides of contact.
std::optional<std::array<Side, 2>> read_side_pair(ReadContext& context, const SourceNode& node,
                                                  const std::string& path);
void read_joints(ReadContext& context, const SourceNode& node);
/// Reads start values of the coordinates of a joint, which is the next one of the model.
/// @param names  Of its coordinates.
void read_start(ReadContext& context, const Section& section, const std::string& key,
                const std::string& joint, const std::vector<std::string>& names);
/// Places the bodies at the start values of joints, after all objects of the file.
void place_starts(ReadContext& context);
void read_contacts(ReadContext& context, const SourceNode& node);
void read_materials(ReadContext& context, const SourceNode& node);
void read_sections(ReadContext& context, const SourceNode& node);
/// Reads beams and cables, which become bodies and joints: after the bodies and before references
/// to them.
void read_beams(ReadContext& context, const SourceNode& node);
void read_cables(ReadContext& context, const SourceNode& node);
/// Reads the tension of a cable: stiffness, given tension, muscle; and whether it runs over its
/// points.
void read_cable_pull(ReadContext& context, Section& section, CableLineSpec& cable);
/// Reads the obstacles of a cable, after its points.
void read_obstacles(ReadContext& context, Section& section, CableLineSpec& cable);
void read_solid_mesh(ReadContext& context, const SourceNode& node, const std::string& path,
                     MeshSpec& mesh);
void read_solids(ReadContext& context, const SourceNode& node);
void read_loads(ReadContext& context, const SourceNode& node);
/// Reads the object named by one of the keys `kinds`, and the selected quantities.
/// @param what  Of that object, for messages: "to record". @returns false after an error.
bool read_recorded(ReadContext& context, Section& section, const std::vector<std::string>& kinds,
                   const char* what, ProbeSpec& probe);
/// A reported number, given by the keys of a probe and 'channel'.
struct ReadChannel {
  ChannelSpec spec;
  Dimension dimension;  ///< Of its number.
};
std::optional<ReadChannel> read_channel(ReadContext& context, Section& section);
/// Reads controllers, after all objects whose channels they use, including contacts.
void read_controllers(ReadContext& context, const SourceNode& node);
/// A number set by a controller, {controller: name}; null after an error.
TimeFunctionPtr read_controlled_value(ReadContext& context, const SourceNode& node,
                                      const std::string& path);
/// Reads events, after the joints and loads that they switch.
void read_events(ReadContext& context, const SourceNode& node);
void read_analysis(ReadContext& context, const SourceNode& node, const SourceLocation& place);
void read_output(ReadContext& context, const SourceNode& node, const SourceLocation& place);
/// Checks that require the mesh of a solid: empty selections, nodes bonded twice, etc.
void check_solids(ReadContext& context, const SourceNode& root);
/// Checks that require the shapes: hulls without volume, open meshes, names of materials.
void check_contacts(ReadContext& context, const SourceNode& root);
/// Position of the deepest value in the file of a path such as solids.pad.mesh.elements[3].
SourceLocation place_of_path(const ReadContext& context, const SourceNode& root,
                             std::string_view path);
/// Checks that require the whole model: orders against loads, etc.
void check_model(ReadContext& context, const SourceNode& root);
/// Chooses the law of contacts where the file names none; after the analysis has been read.
void choose_law(ReadContext& context, const SourceNode& contacts);

}  // namespace polhode::io
