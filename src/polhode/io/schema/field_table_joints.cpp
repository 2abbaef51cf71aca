// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/schema/field_table.hpp>
#include <polhode/model/model.hpp>

namespace polhode::io {

using namespace dimensions;
using enum FieldKind;

namespace {

Field friction_number(const std::string& name, const SpecMember& member, const Dimension& dimension,
                      const std::string& meaning, const std::string& standard,
                      const Range& range = kNotNegative) {
  return {.name = name,
          .kind = kNumber,
          .dimension = dimension,
          .meaning = meaning,
          .standard = standard,
          .range = range,
          .member = member};
}

const Field kMu =
    friction_number("mu", &JointFrictionSpec::mu, kNone, "Coefficient of friction.", "0");
const Field kMoment0 = friction_number("moment", &JointFrictionSpec::constant, kMoment,
                                       "Friction moment without load, as of a seal.", "0");
const Field kForce0 = friction_number("force", &JointFrictionSpec::constant, kForce,
                                      "Friction force without load, as of a seal.", "0");
const Field kBearing = friction_number(
    "length", &JointFrictionSpec::length, kLength,
    "Length of the bearing; 0: moments transverse to the axis cause no friction.", "0");

void add_bristle(std::vector<Field>& fields, bool turns) {
  fields.push_back(friction_number(
      "stiffness", &JointFrictionSpec::stiffness, turns ? kAngularStiffness : kStiffness,
      "Stiffness of the bristle in static friction.",
      turns ? "1e-5 rad under the bodies' weight" : "1e-5 of the bodies' size under their weight",
      kPositive));
  fields.push_back(
      friction_number("damping", &JointFrictionSpec::damping, turns ? kAngularDamping : kDamping,
                      "Damping of the bristle in static friction.", "0.7 of critical damping"));
}

FieldTable revolute() {
  FieldTable t{
      "friction revolute",
      "Friction of a pin in its bearing. It slips at mu (radius F + 2 radius/length M + "
      "face_radius F_z) + moment, with the reaction's force F and moment M transverse to the axis "
      "and its axial force F_z.",
      {kMu,
       friction_number("radius", &JointFrictionSpec::radius, kLength, "Radius of the pin.", "0"),
       friction_number("face_radius", &JointFrictionSpec::face_radius, kLength,
                       "Mean radius of the faces that carry F_z.", "0"),
       kBearing, kMoment0}};
  add_bristle(t.fields, true);
  return t;
}

FieldTable prismatic() {
  FieldTable t{
      "friction prismatic",
      "Friction of a slider in its guide. It slips at mu (F + 2/length M + M_z/radius) + force, "
      "with the reaction's force F and moment M transverse to the axis and its moment M_z about "
      "it.",
      {kMu,
       friction_number("radius", &JointFrictionSpec::radius, kLength,
                       "Lever arm at which the guide carries M_z; 0: M_z causes no friction.", "0"),
       kBearing, kForce0}};
  add_bristle(t.fields, false);
  return t;
}

FieldTable cylindrical() {
  FieldTable t{
      "friction cylindrical",
      "Friction of a sleeve on its shaft, with one friction cone for both motions: it slips where "
      "the resultant of the axial force and of the moment about the axis over radius reaches mu (F "
      "+ 2/length M) + force, with the reaction's force F and moment M transverse to the axis.",
      {kMu,
       friction_number("radius", &JointFrictionSpec::radius, kLength,
                       "Radius of the shaft; 0: rotation without friction.", "0"),
       kBearing, kForce0}};
  add_bristle(t.fields, false);
  return t;
}

FieldTable spherical() {
  FieldTable t{
      "friction spherical",
      "Friction of a ball in its socket. It slips at the moment mu radius F + moment, with "
      "the reaction's force F.",
      {kMu,
       friction_number("radius", &JointFrictionSpec::radius, kLength, "Radius of the ball.", "0"),
       kMoment0}};
  add_bristle(t.fields, true);
  return t;
}

FieldTable universal() {
  FieldTable t{
      "friction universal",
      "Friction of the two pins of the cross, x of the first body and y of the second. Each slips "
      "at mu (radius F + 2 radius/length M + face_radius F_p) + moment, with the reaction's force "
      "F transverse to the pin and F_p along it, and its moment M transverse to both.",
      {kMu,
       friction_number("radius", &JointFrictionSpec::radius, kLength, "Radius of the pins.", "0"),
       friction_number("face_radius", &JointFrictionSpec::face_radius, kLength,
                       "Mean radius of the faces that carry F_p.", "0"),
       kBearing, kMoment0}};
  add_bristle(t.fields, true);
  return t;
}

FieldTable limits(const std::string& title, const std::string& what, bool turns) {
  const Dimension& x = turns ? kAngle : kLength;
  return {
      title,
      "Stops of the joint's " + what + ". Give one of them or both.",
      {friction_number("lower", &JointLimitsSpec::lower, x, "Lower end.", "no stop", kAnyNumber),
       friction_number("upper", &JointLimitsSpec::upper, x, "Upper end.", "no stop", kAnyNumber),
       friction_number("restitution", &JointLimitsSpec::restitution, kNone,
                       "Coefficient of restitution: speed after an impact over speed before it.",
                       "0", {.least = 0.0, .most = 1.0}),
       friction_number("band", &JointLimitsSpec::band, x,
                       "Width of the barrier: the stop acts from half of it before the limit to "
                       "half of it beyond.",
                       turns ? "1e-3 rad" : "1e-3 of the bodies' size", kPositive),
       friction_number(
           "stiffness", &JointLimitsSpec::stiffness, turns ? kAngularStiffness : kStiffness,
           "k of the barrier k band²/3 (1/s - 3 + 3s - s²) over the part s of the band.",
           "carries the bodies' weight in its middle and stops them in a step", kPositive)}};
}

}  // namespace

const std::vector<KindTable>& friction_tables() {
  static const std::vector<KindTable> tables{{"revolute", revolute()},
                                             {"prismatic", prismatic()},
                                             {"cylindrical", cylindrical()},
                                             {"spherical", spherical()},
                                             {"universal", universal()}};
  return tables;
}

const FieldTable& angle_limit_fields() {
  static const FieldTable table = limits("angle limits", "angle about its z axis", true);
  return table;
}

const FieldTable& stroke_limit_fields() {
  static const FieldTable table = limits("stroke limits", "displacement along its z axis", false);
  return table;
}

const FieldTable& distance_limit_fields() {
  static const FieldTable table = [] {
    FieldTable t = limits("distance limits", "distance of its points", false);
    for (Field& field : t.fields)
      if (field.name == "lower" || field.name == "upper") field.range = kNotNegative;
    return t;
  }();
  return table;
}

const FieldTable& enforcement_fields() {
  static const FieldTable table{
      "enforcement",
      "Enforcement of a joint by a stiffness instead of exact multipliers.",
      {
          {.name = "type",
           .kind = kChoice,
           .meaning = "Compliant springs (penalty), or an augmented Lagrangian, which is exact.",
           .required = true,
           .choices = {"penalty", "augmented"},
           .member = &JointEnforcement::law},
          {.name = "stiffness",
           .kind = kNumber,
           .dimension = kStiffness,
           .meaning = "Stiffness against displacements, if the joint constrains any.",
           .range = kPositive,
           .member = &JointEnforcement::stiffness},
          {.name = "turning_stiffness",
           .kind = kNumber,
           .dimension = kAngularStiffness,
           .meaning = "Stiffness against rotations, if the joint constrains any.",
           .range = kPositive,
           .member = &JointEnforcement::turning_stiffness},
      }};
  return table;
}

}  // namespace polhode::io
