// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <polhode/io/schema/spec_member.hpp>
#include <polhode/io/text/units.hpp>

namespace polhode::io {

/// Kinds of values in a model file.
enum class FieldKind : unsigned char {
  kNumber,      ///< A number, with unit, or an expression.
  kTimeNumber,  ///< The same, also of t, or a table over t.
  kLaw,         ///< An expression of a coordinate or rate, or a table over it.
  kInteger,
  kBoolean,  ///< true or false.
  kText,
  kChoice,         ///< One of a list of words.
  kChoices,        ///< A list of such words.
  kVector,         ///< Three numbers.
  kTimeVector,     ///< Three numbers that may depend on time.
  kVectorPair,     ///< Two vectors, one for each body.
  kDirection,      ///< x, y, z, -x, -y, -z or a vector of any length but zero.
  kDirectionPair,  ///< Two directions, one for each body.
  kNumbers,        ///< A list of numbers.
  kMatrix,         ///< Three rows of three numbers.
  kBody,           ///< Name of a body, or ground.
  kBodyPair,       ///< Two such names.
  kJoint,          ///< Name of a joint.
  kLoad,           ///< Name of a load.
  kMaterial,       ///< Name of a material.
  kSolid,          ///< Name of a deformable solid.
  kSelection,      ///< Nodes or faces of a solid: the name of a set, a section, or a list of these.
  kBonds,          ///< A map from bodies to selections.
  kPoints,         ///< A list of vectors.
  kIndices,        ///< A list of nonnegative integers.
  kIndexLists,     ///< A list of such lists.
  kIndexSets,      ///< A map from names to such lists.
  kLevel,          ///< min, max or a number.
  kNumberList,     ///< A number, or a list of any length.
  kMatrix6,        ///< Six rows of six numbers.
  kBeamBonds,      ///< A map from bodies to ends of a beam.
  kAttachments,    ///< A list of points on bodies.
  kSection,        ///< A map with a table of its own.
  kSections,       ///< Such a map, or a list of them.
  kNamed,          ///< A map from names the user chooses to sections.
  kShapes,         ///< A shape or a list of shapes.
  kInertiaTensor,  ///< Three principal moments, or a map of the tensor's entries.
  kStep,           ///< A time, or auto.
  kVariables,      ///< A map from names to numbers.
  kNames,          ///< A list of names.
  kBodyPairs,      ///< A list of pairs of bodies.
  kRows,           ///< Rows of numbers, all of one length.
  kCoordinates,    ///< A number, or a map from coordinates of a joint to numbers.
};

/// Range of a number, in SI.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above_least = false;  ///< least itself is not allowed.
  bool below_most = false;   ///< most itself is not allowed.
};
inline constexpr Range kAnyNumber{};
inline constexpr Range kPositive{0.0, std::numeric_limits<double>::infinity(), true};
inline constexpr Range kNotNegative{0.0, std::numeric_limits<double>::infinity(), false};

/// A key of the model file.
struct Field {
  std::string name{};
  FieldKind kind = FieldKind::kNumber;
  Dimension dimension{};
  std::string meaning{};   ///< One line.
  std::string standard{};  ///< Default: a value in SI, or a description; "" if none.
  bool required = false;
  Range range{};
  std::vector<std::string> choices{};
  std::string table{};     ///< Of kSection and kNamed: title of the section's table.
  std::string variable{};  ///< Of kLaw: its variable, x or v.
  Dimension of{};          ///< Dimension of the variable.
  /// Member of the spec that stores the value, for Section::read_into() and the fingerprint of the
  /// model; none: both are written by hand.
  SpecMember member{};
  /// Field with another value of which a run may be continued: not part of the fingerprint.
  bool may_change = false;
  std::string since = "0.1";  ///< Version that reads the key first.
  std::string changed{};      ///< Last version in which the key got another meaning or default.
};

/// The keys of one kind of object.
struct FieldTable {
  std::string title;    ///< e.g. "body", "joint revolute".
  std::string meaning;  ///< One or two sentences.
  std::vector<Field> fields;

  /// The field of that name, or null.
  [[nodiscard]] const Field* find(std::string_view name) const;
  /// @throws std::logic_error if there is no such field.
  [[nodiscard]] const Field& at(std::string_view name) const;
  [[nodiscard]] std::vector<std::string> names() const;
};

/// The fields of a table that are bound to this type of spec, in the table's order.
/// @throws std::logic_error if there are none: the table is that of another spec.
template <class Spec>
[[nodiscard]] std::vector<const Field*> fields_of(const FieldTable& table) {
  std::vector<const Field*> fields;
  for (const Field& field : table.fields)
    if (field.member.belongs_to<Spec>()) fields.push_back(&field);
  if (fields.empty())
    throw std::logic_error("the field table '" + table.title + "' is that of another spec");
  return fields;
}

/// Types of loads that are read as a motor of given moment or force, or as a damper in a joint.
inline constexpr const char *kJointMoment = "joint_moment", *kJointForce = "joint_force";

/// A kind of joint, load, material ... and its keys.
struct KindTable {
  std::string name;
  FieldTable table;
};

/// A phrase with a capital letter and a full stop.
std::string sentence(std::string text);

const FieldTable& model_fields();
const FieldTable& part_fields();
const FieldTable& import_fields();
const FieldTable& units_fields();
const FieldTable& body_fields();
const FieldTable& inertia_fields();
const FieldTable& orientation_fields();
const FieldTable& euler_fields();
const FieldTable& motion_fields();
const FieldTable& body_motion_fields();
const FieldTable& moving_euler_fields();
const FieldTable& moving_quaternion_fields();
const FieldTable& shape_fields();
const FieldTable& mesh_fields();
const std::vector<KindTable>& material_tables();
const FieldTable& viscosity_fields();
const FieldTable& relaxation_fields();
const std::vector<KindTable>& fibre_tables();
const std::vector<KindTable>& section_tables();
const FieldTable& beam_fields();
const FieldTable& beam_contact_fields();
const FieldTable& cable_contact_fields();
const FieldTable& cable_fields();
const FieldTable& muscle_fields();
const FieldTable& obstacle_fields();
const FieldTable& solid_fields();
const FieldTable& solid_mesh_fields();
const std::vector<KindTable>& mesh_generator_tables();
const FieldTable& region_fields();
const FieldTable& prescribed_fields();
const FieldTable& selection_fields();
const FieldTable& plane_fields();
const FieldTable& box_fields();
const FieldTable& sphere_fields();
const FieldTable& contacts_fields();
const FieldTable& contact_law_fields();
const FieldTable& contact_pair_fields();
const FieldTable& contact_sensor_fields();
const FieldTable& contact_material_fields();
const FieldTable& contact_combination_fields();
const FieldTable& contact_side_fields();
const FieldTable& solid_contact_fields();
const FieldTable& hull_fields();
const FieldTable& height_field_fields();
const FieldTable& time_table_fields();
const FieldTable& law_table_fields();
const FieldTable& event_fields();
/// Keys of a reported number, those of a probe and its name: see read_channel().
std::vector<Field> channel_fields();
const FieldTable& controller_fields();
const FieldTable& controlled_value_fields();
const FieldTable& condition_fields();
const FieldTable& strength_fields();
const FieldTable& enforcement_fields();
const FieldTable& analysis_fields();
const FieldTable& output_fields();
const FieldTable& probe_fields();
const std::vector<KindTable>& joint_tables();
const std::vector<KindTable>& load_tables();
/// Friction by kind of joint, and the stops of joints.
const std::vector<KindTable>& friction_tables();
const FieldTable& angle_limit_fields();
const FieldTable& stroke_limit_fields();
const FieldTable& distance_limit_fields();
/// Every table above, in the order of the reference page.
std::vector<const FieldTable*> all_field_tables();

}  // namespace polhode::io
