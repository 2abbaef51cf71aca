// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <optional>

#include <polhode/core/format.hpp>
#include <polhode/io/schema/field_table.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/loads/pair_on_nodes.hpp>
#include <polhode/loads/slide_on_beam_kind.hpp>
#include <polhode/solids/loads/registry.hpp>

namespace polhode::io {

using namespace dimensions;
using enum FieldKind;

namespace {

const Field kBodies{.name = "bodies",
                    .kind = kBodyPair,
                    .meaning =
                        "[a, b]: coordinates are those of b's frame relative to a's; a positive "
                        "angle rotates b about +z.",
                    .required = true};
const Field kAt{.name = "at",
                .kind = kVector,
                .dimension = kLength,
                .meaning = "The joint's point at the start, world; or at_body."};
const Field kPointsAt{.name = "at",
                      .kind = kVectorPair,
                      .dimension = kLength,
                      .meaning = "The points on a and on b at the start, world; or at_body."};
const Field kAtBody{.name = "at_body",
                    .kind = kVectorPair,
                    .dimension = kLength,
                    .meaning =
                        "The joint's point on a and on b, each in its body's coordinates (ground: "
                        "world); the start is then assembled."};
const Field kAxis{
    .name = "axis", .kind = kDirection, .meaning = "The joint's z at the start, world."};
const Field kAxisBody{
    .name = "axis_body",
    .kind = kDirectionPair,
    .meaning =
        "Instead of axis: z on a and on b, each in its body's axes; the start is then assembled."};
const Field kXAxisBody{
    .name = "x_axis_body",
    .kind = kDirectionPair,
    .meaning =
        "With axis_body, instead of x_axis: x on a and on b, each in its body's axes; made "
        "perpendicular to z. The angle is 0 where they agree, not at the start."};
const Field kXAxis{
    .name = "x_axis",
    .kind = kDirection,
    .meaning = "The joint's x at the start, world; made perpendicular to z.",
    .standard = "the world axis with the smallest component along z, made perpendicular"};

enum class Axis { kRequired, kOptional, kNone };

/// Specification of a joint's axes; a kind that is not listed has one relevant axis.
Axis axis_of(const std::string& name) {
  if (name == "universal" || name == "distance" || name == "slack_link") return Axis::kNone;
  if (name == "spherical" || name == "fixed" || name == "generic" || name == "universal_spherical")
    return Axis::kOptional;
  return Axis::kRequired;
}

Field parameter_field(const Parameter& p) {
  const UnitReading unit = read_unit(p.unit);
  Field field{.name = p.name, .kind = kNumber, .meaning = sentence(p.meaning)};
  if (unit.unit) field.dimension = unit.unit->dimension;
  if (p.standard) field.standard = format("{:g}", *p.standard);
  // The smallest positive number means "above zero", the largest "any".
  constexpr double kMax = std::numeric_limits<double>::max();
  const bool positive = p.least == std::numeric_limits<double>::min();
  if (p.least != -kMax) field.range.least = positive ? 0.0 : p.least;
  if (p.most != kMax) field.range.most = p.most;
  field.range.above_least = positive;
  return field;
}

Field type_field(const std::string& what, const std::string& name) {
  return {.name = "type",
          .kind = kChoice,
          .meaning = format("The kind of {}.", what),
          .required = true,
          .choices = {name}};
}

/// Adds friction and stops of the kinds that support them.
void add_resistance(const std::string& name, std::vector<Field>& fields) {
  const auto section = [&](const char* key, const std::string& table, const char* meaning) {
    fields.push_back({.name = key, .kind = kSection, .meaning = meaning, .table = table});
  };
  for (const KindTable& kind : friction_tables())
    if (kind.name == name) section("friction", kind.table.title, "Dry friction in the joint.");
  if (name == "revolute")
    section("limits", angle_limit_fields().title, "Limits of the joint's angle, as stops.");
  if (name == "prismatic" || name == "cylindrical")
    section("limits", stroke_limit_fields().title, "Limits of the joint's displacement, as stops.");
  if (name == "slack_link") {
    section("limits", distance_limit_fields().title,
            "Limits of the distance of its points, as stops.");
    fields.back().required = true;
  }
  if (name == "cylindrical")
    section("angle_limits", angle_limit_fields().title, "Limits of the joint's angle, as stops.");
}

KindTable joint_table(const JointKind& kind) {
  KindTable result{kind.name, {"joint " + kind.name, sentence(kind.meaning), {}}};
  std::vector<Field>& fields = result.table.fields;
  fields.push_back(type_field("joint", kind.name));
  fields.push_back(kBodies);
  fields.push_back(kind.points_apart ? kPointsAt : kAt);
  fields.push_back(kAtBody);
  const Axis axis = axis_of(kind.name);
  if (axis != Axis::kNone) {
    fields.push_back(kAxis);
    if (axis == Axis::kOptional)
      fields.back().standard = kind.points_apart ? "from the point of a to that of b" : "z";
    if (axis == Axis::kRequired) fields.push_back(kAxisBody);
    fields.push_back(kXAxis);
    if (axis == Axis::kRequired && !kind.points_apart) fields.push_back(kXAxisBody);
    if (axis == Axis::kRequired && kind.points_apart)
      fields.back().standard = "from the point of a to that of b, made perpendicular to z";
  }
  if (kind.name == "universal")
    fields.push_back({.name = "axes",
                      .kind = kDirectionPair,
                      .meaning = "[axis on a, axis on b] at the start, world; perpendicular.",
                      .required = true});
  if (kind.takes_free_list)
    fields.push_back({.name = "free",
                      .kind = kChoices,
                      .meaning = "The free coordinates, in the joint's axes.",
                      .required = true,
                      .choices = {"x", "y", "z", "rx", "ry", "rz"}});
  for (const Parameter& p : kind.parameters) fields.push_back(parameter_field(p));
  add_resistance(kind.name, fields);
  if (!kind.points_apart && kind.name != "fixed") {
    fields.push_back({.name = "start",
                      .kind = kCoordinates,
                      .meaning = "Value at the start of the joint's coordinate, or of each by its "
                                 "name; bodies are placed there, along chains of joints.",
                      .standard = "as the bodies are placed",
                      .since = "0.2"});
    fields.push_back(
        {.name = "start_rate",
         .kind = kCoordinates,
         .meaning = "Rate of it at the start, which sets the velocities of the bodies.",
         .standard = "as the bodies' velocities",
         .since = "0.2"});
  }
  if (!kind.points_apart)
    fields.push_back({.name = "motion",
                      .kind = kSection,
                      .meaning = "Prescribed motion of the joint's frame on the first body.",
                      .table = motion_fields().title});
  if (kind.name != "slack_link")
    fields.push_back({.name = "enforcement",
                      .kind = kSection,
                      .meaning = "Enforcement by a stiffness.",
                      .standard = "exact, by multipliers",
                      .table = enforcement_fields().title});
  fields.push_back({.name = "breaks",
                    .kind = kSection,
                    .meaning = "Reaction at which the joint breaks.",
                    .standard = "never",
                    .table = strength_fields().title});
  return result;
}

const Field kLoadBody{
    .name = "body", .kind = kBody, .meaning = "The body it acts on.", .required = true};
const Field kLoadBeam{
    .name = "beam", .kind = kText, .meaning = "Name of a beam without corners.", .required = true};
const Field kSlidingBody{.name = "body",
                         .kind = kBody,
                         .meaning = "The body whose point stays on the beam, or ground.",
                         .required = true};
const Field kBodyPointAt{.name = "at",
                         .kind = kVector,
                         .dimension = kLength,
                         .meaning = "The body's point at the start, world; or at_body."};
const Field kBodyPoint{.name = "at_body",
                       .kind = kVector,
                       .dimension = kLength,
                       .meaning = "The body's point, body coordinates.",
                       .standard = "the centre of mass"};
const Field kBodyFixed{.name = "body_fixed",
                       .kind = kBoolean,
                       .meaning = "The components rotate with the body.",
                       .standard = "false"};
const Field kBodyAxis{.name = "axis",
                      .kind = kDirection,
                      .meaning = "The axis at the start, world; or axis_body.",
                      .standard = "z"};
const Field kBodyAxisBody{
    .name = "axis_body", .kind = kDirection, .meaning = "The axis in the body's axes."};
const Field kLoadBodies{.name = "bodies", .kind = kBodyPair, .meaning = "[a, b]", .required = true};
const Field kLoadPointsBody{
    .name = "at_body",
    .kind = kVectorPair,
    .dimension = kLength,
    .meaning = "The points on a and b, each in its body's coordinates (ground: world)."};
const Field kLoadJoint{
    .name = "joint", .kind = kJoint, .meaning = "The joint it acts in.", .required = true};
const Field kLoadJoints{
    .name = "joints", .kind = kNames, .meaning = "[first joint, second joint]", .required = true};
const Field kStays{.name = "stays",
                   .kind = kBoolean,
                   .meaning = "It acts while its joint is switched off or broken, too.",
                   .standard = "false"};
const Field kLoadFrameAt{.name = "at",
                         .kind = kVector,
                         .dimension = kLength,
                         .meaning = "The point on both bodies at the start, world; or at_body."};

const Field kWheelAt{
    .name = "at",
    .kind = kVectorPair,
    .dimension = kLength,
    .meaning = "A point of the plane and the wheel's centre at the start, world; or at_body."};
const Field kPlaneNormal{
    .name = "axis",
    .kind = kDirection,
    .meaning = "The plane's normal at the start, world; it points to the wheel.",
    .standard = "z"};
const Field kOtherXAxis{.name = "other_x_axis",
                        .kind = kDirection,
                        .meaning =
                            "The x of the second curve at the start, world; made "
                            "perpendicular to z.",
                        .standard = "x_axis"};
const Field kAxle{.name = "axle",
                  .kind = kDirection,
                  .meaning = "The wheel's axle at the start, world; without effect for a ball.",
                  .standard = "y"};

KindTable load_table(const LoadKind& kind) {
  KindTable result{kind.name, {"load " + kind.name, sentence(kind.meaning), {}}};
  std::vector<Field>& fields = result.table.fields;
  fields.push_back(type_field("load", kind.name));
  switch (kind.place) {
    case LoadPlace::body:
      if (acts_on_beam(kind)) {
        fields.insert(fields.end(), {kLoadBeam, kSlidingBody, kBodyPointAt, kBodyPoint});
        break;
      }
      fields.push_back(kLoadBody);
      if (!kind.turns && !kind.vector.empty())
        fields.insert(fields.end(), {kBodyPointAt, kBodyPoint});
      break;
    case LoadPlace::axis:
      fields.insert(fields.end(), {kLoadBody, kBodyAxis, kBodyAxisBody});
      break;
    case LoadPlace::points:
      fields.insert(fields.end(), {kLoadBodies, kPointsAt, kLoadPointsBody});
      if (make_on_nodes(kind.name) == nullptr) break;
      fields[fields.size() - 3].meaning = "[a, b]: bodies, or solids at a point of them";
      fields[fields.size() - 1].meaning =
          "The points on a and b, each in the coordinates of its body or of its solid's mesh "
          "(ground: world).";
      break;
    case LoadPlace::joint:
      fields.push_back(kLoadJoint);
      fields.push_back(kStays);
      break;
    case LoadPlace::joints:
      fields.push_back(kLoadJoints);
      fields.push_back({.name = "coordinates",
                        .kind = kNames,
                        .meaning = "The free coordinate of each: x, y, z, rx, ry or rz.",
                        .standard = "the only one of each"});
      fields.push_back(kStays);
      break;
    case LoadPlace::row:
      fields.push_back({.name = "joints",
                        .kind = kNames,
                        .meaning = "[first joint, second joint, ...]",
                        .required = true});
      fields.push_back({.name = "coordinates",
                        .kind = kNames,
                        .meaning = "The free coordinate of each: x, y, z, rx, ry or rz.",
                        .standard = "the only one of each"});
      fields.push_back({.name = "factors",
                        .kind = kNumberList,
                        .meaning = "First coordinate per each of the others: rad/rad, m/rad, ..."});
      fields.push_back({.name = "offset",
                        .kind = kNumber,
                        .meaning = "First coordinate where the others are zero, rad or m.",
                        .standard = "that of the start"});
      break;
    case LoadPlace::frames:
      fields.insert(fields.end(), {kLoadBodies, kLoadFrameAt, kLoadPointsBody, kAxis, kXAxis});
      fields[fields.size() - 2].standard = "z";
      break;
    case LoadPlace::surface:
      fields.insert(fields.end(), {kLoadBodies, kPointsAt, kLoadPointsBody, kAxis, kXAxis});
      fields[fields.size() - 2].standard = "z";
      break;
    case LoadPlace::curves:
      fields.insert(fields.end(),
                    {kLoadBodies, kPointsAt, kLoadPointsBody, kAxis, kXAxis, kOtherXAxis});
      fields[fields.size() - 3].standard = "z";
      break;
    case LoadPlace::wheel:
      fields.insert(fields.end(),
                    {kLoadBodies, kWheelAt, kLoadPointsBody, kPlaneNormal, kXAxis, kAxle});
      break;
    case LoadPlace::centres:
      fields.push_back(kLoadBodies);
      break;
  }
  if (!kind.vector.empty()) {
    fields.push_back({.name = kind.vector,
                      .kind = kTimeVector,
                      .dimension = kind.turns ? kMoment : kForce,
                      .meaning = "Components along the world's axes, or the body's if body_fixed.",
                      .required = true});
    fields.push_back(kBodyFixed);
  }
  for (const Parameter& p : kind.parameters) fields.push_back(parameter_field(p));
  for (const LawParameter& l : kind.laws)
    fields.push_back({.name = l.name,
                      .kind = kLaw,
                      .dimension = read_unit(l.unit).unit.value().dimension,
                      .meaning = sentence(l.meaning),
                      .variable = l.variable,
                      .of = l.of == "-" ? kNone : read_unit(l.of).unit.value().dimension});
  for (const std::string& prefix : kind.curves)
    fields.push_back(
        {.name = prefix + "points",
         .kind = kPoints,
         .dimension = kLength,
         .meaning = format("Points of the curve in the frame on {}, z = 0, interpolated by a cubic "
                           "spline, closed if the last is the first; or {}curve_x and {}curve_y.",
                           prefix.empty() ? "a" : "b", prefix, prefix)});
  for (const ChoiceParameter& w : kind.words)
    fields.push_back({.name = w.name,
                      .kind = kChoice,
                      .meaning = sentence(w.meaning),
                      .standard = w.choices.front(),
                      .choices = w.choices});
  for (const Parameter& p : kind.vectors) {
    fields.push_back(parameter_field(p));
    fields.back().kind = kVector;
    if (p.standard) fields.back().standard = "[0, 0, 0]";
  }
  for (const Parameter& p : kind.matrices)
    fields.push_back({.name = p.name, .kind = kMatrix6, .meaning = sentence(p.meaning) + " SI."});
  if (kind.place == LoadPlace::joint && kind.name != "screw")
    fields.push_back({.name = "coordinate",
                      .kind = kChoice,
                      .meaning = "The free coordinate of the joint.",
                      .standard = "the only one of its kind",
                      .choices = kind.turns ? std::vector<std::string>{"rx", "ry", "rz"}
                                            : std::vector<std::string>{"x", "y", "z"}});
  for (const TimeParameter& d : kind.drives)
    fields.push_back({.name = d.name,
                      .kind = kTimeNumber,
                      .dimension = read_unit(d.unit).unit.value().dimension,
                      .meaning = sentence(d.meaning)});
  return result;
}

const Field kForceCoordinate{.name = "coordinate",
                             .kind = kChoice,
                             .meaning = "The free coordinate of the joint.",
                             .standard = "the only one of its kind"};

/// Table of a force or moment along a coordinate of a joint: a plain name of what motors and
/// dampers in joints do.
KindTable joint_load_table(bool turns) {
  const std::string name = turns ? kJointMoment : kJointForce, value = turns ? "moment" : "force";
  KindTable result{name,
                   {"load " + name,
                    format("{} along a free coordinate of a joint, over time or over its rate.",
                           turns ? "Moment" : "Force"),
                    {}}};
  Field coordinate = kForceCoordinate;
  coordinate.choices =
      turns ? std::vector<std::string>{"rx", "ry", "rz"} : std::vector<std::string>{"x", "y", "z"};
  const Dimension dimension = turns ? kMoment : kForce;
  result.table.fields = {
      type_field("load", name),
      kLoadJoint,
      kStays,
      coordinate,
      {.name = value,
       .kind = kTimeNumber,
       .dimension = dimension,
       .meaning = format("On the second body along the coordinate, over time; or resistance.")},
      {.name = "resistance",
       .kind = kLaw,
       .dimension = dimension,
       .meaning = "Against the motion, over the rate v of the coordinate; it has the sign of v.",
       .variable = "v",
       .of = read_unit(turns ? "rad/s" : "m/s").unit.value().dimension}};
  return result;
}

const Field kLoadSolid{
    .name = "solid", .kind = kSolid, .meaning = "The solid it acts on.", .required = true};
const Field kLoadFaces{.name = "surface",
                       .kind = kSelection,
                       .meaning = "Faces of the solid's boundary.",
                       .standard = "the whole boundary",
                       .table = "selection"};
const Field kLoadNodes{.name = "nodes",
                       .kind = kSelection,
                       .meaning = "The nodes.",
                       .required = true,
                       .table = "selection"};
const Field kFollower{.name = "follower",
                      .kind = kBoolean,
                      .meaning =
                          "A follower pressure: normal to the deformed faces, on their deformed "
                          "area; else as on the undeformed solid.",
                      .standard = "true"};
const Field kKeeps{
    .name = "keeps",
    .kind = kChoice,
    .meaning =
        "What a follower pressure conserves exactly over a step: zero force and moment "
        "on a closed surface, or the work, pressure times change of volume.",
    .standard = "momentum",
    .choices = {"momentum", "work"}};

KindTable solid_load_table(const solids::SolidLoadKind& kind) {
  KindTable result{kind.name, {"load " + kind.name, sentence(kind.meaning), {}}};
  std::vector<Field>& fields = result.table.fields;
  const auto add_function = [&](const std::optional<TimeParameter>& p, FieldKind of) {
    if (p)
      fields.push_back({.name = p->name,
                        .kind = of,
                        .dimension = read_unit(p->unit).unit.value().dimension,
                        .meaning = sentence(p->meaning),
                        .required = true});
  };
  fields = {type_field("load", kind.name), kLoadSolid};
  if (kind.place == solids::SolidLoadPlace::faces) fields.push_back(kLoadFaces);
  if (kind.place == solids::SolidLoadPlace::nodes) fields.push_back(kLoadNodes);
  add_function(kind.value, kTimeNumber);
  add_function(kind.vector, kTimeVector);
  if (kind.can_follow) fields.insert(fields.end(), {kFollower, kKeeps});
  for (const Parameter& p : kind.parameters) fields.push_back(parameter_field(p));
  return result;
}

}  // namespace

const std::vector<KindTable>& joint_tables() {
  static const std::vector<KindTable> tables = [] {
    std::vector<KindTable> list;
    for (const JointKind& kind : joint_kinds()) list.push_back(joint_table(kind));
    return list;
  }();
  return tables;
}

const std::vector<KindTable>& load_tables() {
  static const std::vector<KindTable> tables = [] {
    std::vector<KindTable> list;
    for (const LoadKind& kind : load_kinds()) {
      if (kind.name == "torsional_spring")  // first of those in joints
        for (const bool turns : {true, false}) list.push_back(joint_load_table(turns));
      list.push_back(load_table(kind));
    }
    for (const solids::SolidLoadKind& kind : solids::solid_load_kinds())
      list.push_back(solid_load_table(kind));
    return list;
  }();
  return tables;
}

}  // namespace polhode::io
