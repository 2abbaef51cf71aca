// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/schema/field_table.hpp>

namespace polhode::io {

using namespace dimensions;
using enum FieldKind;

namespace {

Field moving_number(const std::string& name, const Dimension& dimension, const std::string& meaning,
                    const std::string& standard = "") {
  return {.name = name,
          .kind = kTimeNumber,
          .dimension = dimension,
          .meaning = meaning,
          .standard = standard,
          .required = standard.empty()};
}

void add_rotation(std::vector<Field>& fields, const std::string& axes) {
  fields.push_back({.name = "rotation_vector",
                    .kind = kTimeVector,
                    .dimension = kAngle,
                    .meaning = "Axis times angle, components along " + axes +
                               ". One of rotation_vector, euler, quaternion, or none of them."});
  fields.push_back({.name = "euler",
                    .kind = kSection,
                    .meaning = "Three successive rotations.",
                    .table = moving_euler_fields().title});
  fields.push_back({.name = "quaternion",
                    .kind = kSection,
                    .meaning = "It is normalised.",
                    .table = moving_quaternion_fields().title});
}

}  // namespace

const FieldTable& motion_fields() {
  static const FieldTable table = [] {
    FieldTable t{"motion",
                 "Prescribed motion of a joint's frame on its first body, relative to its initial "
                 "position, as functions of time: a displacement, and a rotation about the "
                 "displaced point. In statics they follow the load factor.",
                 {}};
    for (const char* axis : {"x", "y", "z"})
      t.fields.push_back(moving_number(
          axis, kLength, std::string("Displacement along the joint's ") + axis + " at rest.", "0"));
    add_rotation(t.fields, "the joint's initial axes");
    return t;
  }();
  return table;
}

const FieldTable& body_motion_fields() {
  static const FieldTable table = [] {
    FieldTable t{
        "body motion",
        "Prescribed motion of a body, as functions of time; components left out are free. A "
        "rotation prescribes all three components: to prescribe one or two, use a joint.",
        {}};
    for (const char* axis : {"x", "y", "z"}) {
      t.fields.push_back(moving_number(
          axis, kLength,
          std::string("Displacement of the centre of mass, along the world's ") + axis + ".",
          "free"));
    }
    add_rotation(t.fields, "the world's axes");
    t.fields.push_back({.name = "measured_from",
                        .kind = kChoice,
                        .meaning = "Reference of displacement and rotation: the body's position "
                                   "and orientation in this file, or the world's origin and axes.",
                        .standard = "start",
                        .choices = {"start", "world"}});
    return t;
  }();
  return table;
}

const FieldTable& moving_euler_fields() {
  static const FieldTable table{
      "moving euler",
      "Euler angles as functions of time. Lower-case letters are rotations about moving axes "
      "(intrinsic), upper-case letters about fixed ones (extrinsic).",
      {{.name = "sequence",
        .kind = kText,
        .meaning = "Three letters, e.g. zxz or XYZ; neighbours differ.",
        .required = true},
       {.name = "angles",
        .kind = kTimeVector,
        .dimension = kAngle,
        .meaning = "One for each letter.",
        .required = true}}};
  return table;
}

const FieldTable& moving_quaternion_fields() {
  static const FieldTable table{
      "moving quaternion",
      "A quaternion as four functions of time, of any length but zero.",
      {moving_number("w", kNone, "Scalar part."), moving_number("x", kNone, "Vector part, x."),
       moving_number("y", kNone, "Vector part, y."), moving_number("z", kNone, "Vector part, z.")}};
  return table;
}

}  // namespace polhode::io
