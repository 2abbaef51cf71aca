// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/schema/field_table.hpp>

namespace polhode {

using namespace dimensions;
using enum FieldKind;

namespace {

const Field kFriction{.name = "friction",
                      .kind = kNumber,
                      .meaning = "Coefficient of friction.",
                      .standard = "0",
                      .range = kNotNegative};
const Field kRestitution{
    .name = "restitution",
    .kind = kNumber,
    .meaning = "Speed of separation over speed of approach: 1 gives all energy back.",
    .standard = "0",
    .range = {0.0, 1.0}};

std::vector<Field> law_fields() {
  return {
      {.name = "law",
       .kind = kChoice,
       .meaning = "Potential of the normal force: a barrier on a thin band around the surface, "
                  "which no load breaks through, or a force linear in the overlap, or that of "
                  "Hertz, with overlap to the power 3/2. nonsmooth: no forces but impulses, for "
                  "many bodies without joints; in default only.",
       .standard = "barrier",
       .choices = {"barrier", "linear", "hertz", "nonsmooth"}},
      {.name = "gap_tolerance",
       .kind = kNumber,
       .dimension = kLength,
       .meaning = "The barrier acts at gaps between minus and plus this length.",
       .standard = "1e-3 of the smaller shape",
       .range = kPositive},
      {.name = "stiffness",
       .kind = kNumber,
       .dimension = kStiffness,
       .meaning = "Of the barrier or of the linear law, for each contact point.",
       .standard = "from weight, reference_load and step",
       .range = kPositive},
      {.name = "hertz_stiffness",
       .kind = kNumber,
       .meaning = "Of law hertz: force over overlap^1.5, in N/m^1.5 whatever 'units' says.",
       .standard = "likewise",
       .range = kPositive},
      {.name = "reference_load",
       .kind = kNumber,
       .dimension = kForce,
       .meaning = "A normal force that the barrier carries at gap 0; it chooses the stiffness.",
       .standard = "the weight of the lighter body",
       .range = kPositive},
      {.name = "reference_pressure",
       .kind = kNumber,
       .dimension = kPressure,
       .meaning = "Of surfaces of solids, and of cables on their diameter: a pressure that the "
                  "barrier carries at gap 0; it chooses the stiffness.",
       .standard = "from elasticity, density and step",
       .range = kPositive},
      kRestitution,
      {.name = "rebound",
       .kind = kChoice,
       .meaning = "How restitution comes about: by the speed with which the contact opens, exact "
                  "at any step, or by a damper beside a linear or Hertz potential (Gonthier, "
                  "Carvalho and Martins), which wants some twenty steps in a contact.",
       .standard = "exit",
       .choices = {"exit", "damped"}},
      kFriction,
      {.name = "static_friction",
       .kind = kNumber,
       .meaning = "Coefficient while it sticks.",
       .standard = "as friction",
       .range = kNotNegative},
      {.name = "friction_across",
       .kind = kNumber,
       .meaning = "Coefficient across direction; friction then acts along it.",
       .standard = "as friction",
       .range = kPositive},
      {.name = "direction",
       .kind = kDirection,
       .meaning = "Of friction beside friction_across, in coordinates of the first body.",
       .standard = "x"},
      {.name = "rolling_friction",
       .kind = kNumber,
       .dimension = kLength,
       .meaning = "Largest moment against rolling over normal force.",
       .standard = "0",
       .range = kNotNegative},
      {.name = "torsional_friction",
       .kind = kNumber,
       .dimension = kLength,
       .meaning = "Largest moment about the normal over normal force.",
       .standard = "0",
       .range = kNotNegative},
      {.name = "friction_stiffness",
       .kind = kNumber,
       .dimension = kStiffness,
       .meaning = "Of the bristle that holds while it sticks.",
       .standard = "that of the normal force",
       .range = kPositive},
      {.name = "friction_damping",
       .kind = kNumber,
       .dimension = kDamping,
       .meaning = "Of the bristle while it sticks.",
       .standard = "0.7 of the critical one",
       .range = kPositive},
  };
}

FieldTable pair_table(const std::string& title, const std::string& meaning) {
  FieldTable t{title,
               meaning,
               {
                   {.name = "between",
                    .kind = kBodyPair,
                    .meaning = "Two bodies, a fixed one too, or a body and a solid."},
                   {.name = "materials",
                    .kind = kNames,
                    .meaning = "Two contact materials, or one twice, instead of between."},
               }};
  for (Field& f : law_fields()) {
    f.standard = f.name == "friction" || f.name == "restitution"
                     ? "default's; of materials, their combination"
                     : "default's";
    t.fields.push_back(std::move(f));
  }
  return t;
}

}  // namespace

const FieldTable& contacts_fields() {
  static const FieldTable table{
      "contacts",
      "Contact between the shapes of bodies, and of surfaces of solids with them. Without this "
      "section all pass through one another; with it, an empty one too, every shape meets those of "
      "all other bodies but neighbours at a joint, and every solid meets the shapes of all bodies "
      "but those it is bonded to. Beams and cables take part that have the key contact.",
      {
          {.name = "default",
           .kind = kSection,
           .meaning = "The law of pairs for which nothing else is stated.",
           .table = "contact law"},
          {.name = "materials",
           .kind = kNamed,
           .meaning = "Contact materials by name, for the key contact of bodies, shapes, solids, "
                      "beams and "
                      "cables.",
           .table = "contact material"},
          {.name = "combine",
           .kind = kSection,
           .meaning = "How two materials make a pair.",
           .table = "contact combination"},
          {.name = "pairs",
           .kind = kNamed,
           .meaning = "Laws of pairs of bodies, of a body and a solid or cable, or of materials, "
                      "by a name "
                      "of your choice; those that name bodies go before those of materials.",
           .table = "contact pair"},
          {.name = "exclude",
           .kind = kBodyPairs,
           .meaning = "Pairs of bodies, solids and cables that do not meet."},
          {.name = "joint_neighbours",
           .kind = kBoolean,
           .meaning = "Bodies with a common joint meet, and solids the bodies they are bonded to.",
           .standard = "false"},
          {.name = "sensors",
           .kind = kNamed,
           .meaning = "Pairs of bodies that pass through one another and report it, by name.",
           .table = "contact sensor"},
          {.name = "overlaps",
           .kind = kChoice,
           .meaning = "What to do with what overlaps at the start: refuse it by name, or move "
                      "bodies and solids apart, the lighter ones farther.",
           .standard = "error",
           .choices = {"error", "resolve"}},
          {.name = "sweeps",
           .kind = kInteger,
           .meaning = "With law: nonsmooth, how often a step goes over all points at most.",
           .standard = "100",
           .range = {1.0, 1e6}},
          {.name = "sweep_tolerance",
           .kind = kNumber,
           .meaning = "With law: nonsmooth, change of a point's speed in a sweep, over what "
                      "gravity adds in a step, below which a step is solved.",
           .standard = "1e-3",
           .range = kPositive},
          {.name = "record",
           .kind = kBoolean,
           .meaning = "Keep results of every pair of bodies that may meet; false: only of those "
                      "that pairs, sensors and probes name.",
           .standard = "true for at most 100 pairs"},
      }};
  return table;
}

const FieldTable& contact_law_fields() {
  static const FieldTable table{"contact law", "What two surfaces do to each other.", law_fields()};
  return table;
}

const FieldTable& contact_pair_fields() {
  static const FieldTable table =
      pair_table("contact pair", "A law of its own for two bodies or two materials.");
  return table;
}

const FieldTable& contact_sensor_fields() {
  static const FieldTable table{"contact sensor",
                                "Reports when two bodies overlap; they exert no force.",
                                {{.name = "between",
                                  .kind = kBodyPair,
                                  .meaning = "Two bodies; a fixed one too.",
                                  .required = true}}};
  return table;
}

const FieldTable& contact_material_fields() {
  static const FieldTable table{
      "contact material",
      "A surface. Two of them make a pair by combination, unless pairs states one.",
      {kFriction, kRestitution}};
  return table;
}

const FieldTable& contact_combination_fields() {
  static const std::vector<std::string> ways{"geometric_mean", "mean", "minimum", "maximum",
                                             "product"};
  static const FieldTable table{"contact combination",
                                "How friction and restitution of a pair follow from those of its "
                                "materials.",
                                {{.name = "friction",
                                  .kind = kChoice,
                                  .meaning = "Of the two coefficients.",
                                  .standard = "geometric_mean",
                                  .choices = ways},
                                 {.name = "restitution",
                                  .kind = kChoice,
                                  .meaning = "Of the two restitutions.",
                                  .standard = "minimum",
                                  .choices = ways}}};
  return table;
}

const FieldTable& contact_side_fields() {
  static const FieldTable table{
      "contact side",
      "How a shape takes part in contact. On a body it holds for all its shapes; on a shape it "
      "goes "
      "before that of the body.",
      {
          {.name = "touches",
           .kind = kBoolean,
           .meaning = "false: the shape meets nothing; it is weighed and drawn only.",
           .standard = "true"},
          {.name = "material",
           .kind = kText,
           .meaning = "Name of a contact material.",
           .standard = "friction and restitution of contacts.default"},
          {.name = "groups",
           .kind = kNames,
           .meaning = "Groups it belongs to; names are yours.",
           .standard = "[default]"},
          {.name = "meets",
           .kind = kNames,
           .meaning = "Groups it meets; two shapes touch if both say so.",
           .standard = "all"},
      }};
  return table;
}

const FieldTable& solid_contact_fields() {
  static const FieldTable table = [] {
    FieldTable t{"solid contact",
                 "How the surface of a solid takes part in contact.",
                 {{.name = "surface",
                   .kind = kSelection,
                   .meaning = "The faces that may touch, among those of the solid's boundary.",
                   .standard = "the whole boundary",
                   .table = "selection"},
                  {.name = "self",
                   .kind = kBoolean,
                   .meaning = "true: it touches itself, too, where it is folded.",
                   .standard = "false"}}};
    for (const Field& field : contact_side_fields().fields) t.fields.push_back(field);
    t.fields[2].meaning = "false: the solid meets nothing.";
    return t;
  }();
  return table;
}

const FieldTable& hull_fields() {
  static const FieldTable table{
      "hull",
      "The convex hull of points: one of points, file.",
      {
          {.name = "points",
           .kind = kPoints,
           .dimension = kLength,
           .meaning = "In the shape's coordinates; four at least, not in a plane."},
          {.name = "file",
           .kind = kText,
           .meaning = "An STL or OBJ file whose corners are the points, seen from the model file's "
                      "folder."},
          {.name = "scale",
           .kind = kNumber,
           .dimension = kLength,
           .meaning = "Length of one unit of the file.",
           .standard = "1",
           .range = kPositive},
      }};
  return table;
}

const FieldTable& height_field_fields() {
  static const FieldTable table{
      "height field",
      "Ground as heights over a grid in the shape's x and y, centred; two triangles in each cell.",
      {
          {.name = "spacing",
           .kind = kNumber,
           .dimension = kLength,
           .meaning = "Between the points of the grid, along x and y.",
           .required = true,
           .range = kPositive},
          {.name = "heights",
           .kind = kRows,
           .dimension = kLength,
           .meaning = "Along z: a list of rows, y growing from row to row, x along a row.",
           .required = true},
      }};
  return table;
}

}  // namespace polhode
