// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/schema/field_table.hpp>

namespace polhode {

using namespace dimensions;
using enum FieldKind;

namespace {

Field friction_number(const std::string& name, const Dimension& dimension,
                      const std::string& meaning, const std::string& standard,
                      const Range& range = kNotNegative) {
  return {.name = name,
          .kind = kNumber,
          .dimension = dimension,
          .meaning = meaning,
          .standard = standard,
          .range = range};
}

const Field kMu = friction_number("mu", kNone, "Coefficient of friction.", "0");
const Field kMoment0 =
    friction_number("moment", kMoment, "Moment at which it slips without load, as of a seal.", "0");
const Field kForce0 =
    friction_number("force", kForce, "Force at which it slips without load, as of a seal.", "0");
const Field kBearing = friction_number(
    "length", kLength, "Length of the bearing; 0: moments across the axis press nothing.", "0");

void add_bristle(std::vector<Field>& fields, bool turns) {
  fields.push_back(friction_number("stiffness", turns ? kAngularStiffness : kStiffness,
                                   "Of the bristle that holds before it slips.",
                                   turns ? "gives way by 1e-5 rad at the bodies' weight"
                                         : "gives way by 1e-5 of the bodies' size at their weight",
                                   kPositive));
  fields.push_back(friction_number("damping", turns ? kAngularDamping : kDamping,
                                   "Of the bristle while it holds.", "0.7 of critical damping"));
}

FieldTable revolute() {
  FieldTable t{
      "friction revolute",
      "Friction of a pin in its bearing. It slips at mu (radius F + 2 radius/length M + "
      "face_radius F_z) + moment, with the reaction's force F and moment M across the "
      "axis and its force F_z along it.",
      {kMu, friction_number("radius", kLength, "Radius of the pin.", "0"),
       friction_number("face_radius", kLength, "Mean radius of the faces that take F_z.", "0"),
       kBearing, kMoment0}};
  add_bristle(t.fields, true);
  return t;
}

FieldTable prismatic() {
  FieldTable t{"friction prismatic",
               "Friction of a slider in its guide. It slips at mu (F + 2/length M + M_z/radius) + "
               "force, with the reaction's force F and moment M across the axis and its moment "
               "M_z about it.",
               {kMu,
                friction_number("radius", kLength,
                                "Arm at which the guide takes M_z; 0: M_z presses nothing.", "0"),
                kBearing, kForce0}};
  add_bristle(t.fields, false);
  return t;
}

FieldTable cylindrical() {
  FieldTable t{"friction cylindrical",
               "Friction of a sleeve on its shaft, one cone for both motions: it slips where the "
               "force along the axis and the moment about it over radius together reach "
               "mu (F + 2/length M) + force, with the reaction's force F and moment M across the "
               "axis.",
               {kMu,
                friction_number("radius", kLength,
                                "Radius of the shaft; 0: it turns without friction.", "0"),
                kBearing, kForce0}};
  add_bristle(t.fields, false);
  return t;
}

FieldTable spherical() {
  FieldTable t{
      "friction spherical",
      "Friction of a ball in its socket. It slips at the moment mu radius F + moment, with "
      "the reaction's force F.",
      {kMu, friction_number("radius", kLength, "Radius of the ball.", "0"), kMoment0}};
  add_bristle(t.fields, true);
  return t;
}

FieldTable universal() {
  FieldTable t{
      "friction universal",
      "Friction of the two pins of the cross, x of the first body and y of the second. Each "
      "slips at mu (radius F + 2 radius/length M + face_radius F_p) + moment, with the "
      "reaction's force F across the pin and F_p along it, and its moment M across both.",
      {kMu, friction_number("radius", kLength, "Radius of the pins.", "0"),
       friction_number("face_radius", kLength, "Mean radius of the faces that take F_p.", "0"),
       kBearing, kMoment0}};
  add_bristle(t.fields, true);
  return t;
}

FieldTable limits(const std::string& title, const std::string& what, bool turns) {
  const Dimension& x = turns ? kAngle : kLength;
  return {
      title,
      "Stops of the joint's " + what + ". Give one of them or both.",
      {friction_number("lower", x, "Lower end.", "no stop", kAnyNumber),
       friction_number("upper", x, "Upper end.", "no stop", kAnyNumber),
       friction_number("restitution", kNone, "Speed after an impact over that before it.", "0",
                       {.least = 0.0, .most = 1.0}),
       friction_number("band", x,
                       "The stop acts from half of this in front of the end to half of it behind.",
                       turns ? "1e-3 rad" : "1e-3 of the bodies' size", kPositive),
       friction_number(
           "stiffness", turns ? kAngularStiffness : kStiffness,
           "k of the barrier k band²/3 (1/s - 3 + 3s - s²) over the part s of the band.",
           "bears the bodies' weight in its middle and stops them in a step", kPositive)}};
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
      "Stiffness by which a joint is held, where multipliers would hold it exactly.",
      {
          {.name = "type",
           .kind = kChoice,
           .meaning = "Springs that give way, or an augmented Lagrangian, which holds exactly.",
           .required = true,
           .choices = {"penalty", "augmented"}},
          {.name = "stiffness",
           .kind = kNumber,
           .dimension = kStiffness,
           .meaning = "Against displacements; of a joint that holds some.",
           .range = kPositive},
          {.name = "turning_stiffness",
           .kind = kNumber,
           .dimension = kAngularStiffness,
           .meaning = "Against rotations; of a joint that holds some.",
           .range = kPositive},
      }};
  return table;
}

}  // namespace polhode
