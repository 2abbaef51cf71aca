// SPDX-License-Identifier: Apache-2.0
#include <polhode/contact_laws/normal_law.hpp>
#include <polhode/io/schema/field_table.hpp>
#include <polhode/model/contact_spec.hpp>

namespace polhode::io {

using namespace dimensions;
using enum FieldKind;

namespace {

const Field kFriction{.name = "friction",
                      .kind = kNumber,
                      .meaning = "Coefficient of friction.",
                      .standard = "0",
                      .range = kNotNegative};
const Field kRestitution{.name = "restitution",
                         .kind = kNumber,
                         .meaning =
                             "Coefficient of restitution, speed of separation over speed of "
                             "approach; 1 dissipates nothing.",
                         .standard = "0",
                         .range = {0.0, 1.0}};

Field bound(Field field, const SpecMember& member) {
  field.member = member;
  return field;
}

std::vector<std::string> law_words() {
  std::vector<std::string> words;
  for (const contact::PotentialWord& known : contact::kPotentialWords)
    words.emplace_back(known.word);
  words.emplace_back("rigid");
  words.emplace_back("nonsmooth");
  return words;
}

std::vector<Field> law_fields() {
  return {
      {.name = "law",
       .kind = kChoice,
       .meaning =
           "rigid: no penetration at all, exact like a joint that only pushes. Or the potential of "
           "the normal force: a barrier in a thin band at the surface, which no load exceeds; a "
           "force linear in the penetration; or Hertz's law, with penetration to the power 3/2. "
           "nonsmooth: impulses instead of forces, for many bodies without joints. The first and "
           "the last in default only.",
       .standard = "rigid for few bodies with simple shapes, see docs/reference/contacts.md; else, "
                   "or with a key of forces, barrier",
       .choices = law_words(),
       .member = &ContactLawSpec::potential},
      {.name = "gap_tolerance",
       .kind = kNumber,
       .dimension = kLength,
       .meaning =
           "Largest penetration: the barrier acts at gaps between minus this length and zero, "
           "between deformable surfaces and for cables between minus and plus this length.",
       .standard = "1e-3 of the smaller shape",
       .range = kPositive,
       .member = &ContactLawSpec::gap_tolerance},
      {.name = "stiffness",
       .kind = kNumber,
       .dimension = kStiffness,
       .meaning = "Stiffness of the barrier or of the linear law, for each contact point.",
       .standard = "from weight, reference_load and step",
       .range = kPositive,
       .member = &ContactLawSpec::stiffness},
      {.name = "hertz_stiffness",
       .kind = kNumber,
       .meaning = "Stiffness of law hertz: force over penetration^1.5, always in N/m^1.5.",
       .standard = "likewise",
       .range = kPositive},
      {.name = "reference_load",
       .kind = kNumber,
       .dimension = kForce,
       .meaning = "Normal force from which the stiffness is chosen: the barrier carries it at a "
                  "twentieth of gap_tolerance, springs at about gap_tolerance.",
       .standard = "the weight of the reduced mass; with linear and hertz, of the heaviest body",
       .range = kPositive,
       .member = &ContactLawSpec::reference_load},
      {.name = "reference_pressure",
       .kind = kNumber,
       .dimension = kPressure,
       .meaning = "Pressure from which the stiffness of surfaces of solids and of cables (on their "
                  "diameter) is chosen: the barrier carries it in the middle of its band.",
       .standard = "from elasticity, density and step",
       .range = kPositive,
       .member = &ContactLawSpec::reference_pressure},
      bound(kRestitution, &ContactLawSpec::restitution),
      {.name = "rebound",
       .kind = kChoice,
       .meaning = "Model of restitution: exit sets the speed of separation, exact at any step; "
                  "damped is a damper parallel to a linear or Hertz potential (Gonthier, Carvalho "
                  "and Martins), which needs some twenty steps in a contact.",
       .standard = "exit",
       .choices = {"exit", "damped"},
       .member = &ContactLawSpec::rebound},
      bound(kFriction, &ContactLawSpec::friction),
      {.name = "static_friction",
       .kind = kNumber,
       .meaning = "Coefficient of static friction.",
       .standard = "as friction",
       .range = kNotNegative,
       .member = &ContactLawSpec::static_friction},
      {.name = "friction_across",
       .kind = kNumber,
       .meaning = "Coefficient transverse to direction; friction is then that along it.",
       .standard = "as friction",
       .range = kPositive,
       .member = &ContactLawSpec::friction_across},
      {.name = "direction",
       .kind = kDirection,
       .meaning =
           "Direction of friction, if friction_across is given; in coordinates of the first body.",
       .standard = "x",
       .member = &ContactLawSpec::direction},
      {.name = "rolling_friction",
       .kind = kNumber,
       .dimension = kLength,
       .meaning = "Largest rolling moment over normal force.",
       .standard = "0",
       .range = kNotNegative,
       .member = &ContactLawSpec::rolling},
      {.name = "torsional_friction",
       .kind = kNumber,
       .dimension = kLength,
       .meaning = "Largest spin moment (about the normal) over normal force.",
       .standard = "0",
       .range = kNotNegative,
       .member = &ContactLawSpec::torsion},
      {.name = "friction_stiffness",
       .kind = kNumber,
       .dimension = kStiffness,
       .meaning = "Stiffness of the bristle in static friction.",
       .standard = "that of the normal force",
       .range = kPositive,
       .member = &ContactLawSpec::friction_stiffness},
      {.name = "friction_damping",
       .kind = kNumber,
       .dimension = kDamping,
       .meaning = "Damping of the bristle in static friction.",
       .standard = "0.7 of the critical one",
       .range = kPositive,
       .member = &ContactLawSpec::friction_damping},
  };
}

FieldTable pair_table(const std::string& title, const std::string& meaning) {
  FieldTable t{
      title,
      meaning,
      {
          {.name = "between",
           .kind = kBodyPair,
           .meaning = "Two bodies (one may be fixed), or a body, solid or cable and another one."},
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
      "Contact between shapes of bodies and surfaces of solids. Without this section they pass "
      "through one another. With it, even if empty, every shape can touch those of all other "
      "bodies except neighbours at a joint, and every solid can touch all shapes except those of "
      "bodies it is bonded to. Beams and cables touch if they have the key contact.",
      {
          {.name = "default",
           .kind = kSection,
           .meaning = "The law of all pairs without a law of their own.",
           .table = "contact law"},
          {.name = "materials",
           .kind = kNamed,
           .meaning = "Contact materials by name, for the key contact of bodies, shapes, solids, "
                      "beams and "
                      "cables.",
           .table = "contact material"},
          {.name = "combine",
           .kind = kSection,
           .meaning = "How the law of a pair follows from two materials.",
           .table = "contact combination"},
          {.name = "pairs",
           .kind = kNamed,
           .meaning =
               "Laws of pairs of bodies, of a body and a solid or cable, or of materials, by a "
               "name of your choice; laws of bodies have priority over laws of materials.",
           .table = "contact pair"},
          {.name = "exclude",
           .kind = kBodyPairs,
           .meaning = "Pairs of bodies, solids and cables that do not touch."},
          {.name = "joint_neighbours",
           .kind = kBoolean,
           .meaning = "Bodies with a common joint can touch, and solids can touch the bodies they "
                      "are bonded to.",
           .standard = "false",
           .member = &ContactsSpec::joint_neighbours},
          {.name = "sensors",
           .kind = kNamed,
           .meaning = "Pairs of bodies that pass through one another and report it, by name.",
           .table = "contact sensor"},
          {.name = "overlaps",
           .kind = kChoice,
           .meaning = "Treatment of overlaps at the start: refuse the model, or move bodies and "
                      "solids apart, lighter ones farther.",
           .standard = "error",
           .choices = {"error", "resolve"}},
          {.name = "sweeps",
           .kind = kInteger,
           .meaning = "With law: nonsmooth, largest number of Gauss-Seidel sweeps in a step.",
           .standard = "100, or 200 000 over the number of points if more",
           .range = {1.0, 1e6},
           .member = &ContactsSpec::sweeps},
          {.name = "sweep_tolerance",
           .kind = kNumber,
           .meaning = "With law: nonsmooth, change of speed in a sweep at which a step has "
                      "converged, relative to gravity times the step.",
           .standard = "1e-3",
           .range = kPositive,
           .member = &ContactsSpec::sweep_tolerance},
          {.name = "record",
           .kind = kBoolean,
           .meaning = "Record results of every pair of bodies that may touch; false: only of those "
                      "named in pairs, sensors and probes.",
           .standard = "true for at most 100 pairs",
           .member = &ContactsSpec::record,
           .may_change = true},
      }};
  return table;
}

const FieldTable& contact_law_fields() {
  static const FieldTable table{"contact law", "The contact law of two surfaces.", law_fields()};
  return table;
}

const FieldTable& contact_pair_fields() {
  static const FieldTable table =
      pair_table("contact pair", "The contact law of two bodies or two materials.");
  return table;
}

const FieldTable& contact_sensor_fields() {
  static const FieldTable table{"contact sensor",
                                "Reports when two bodies overlap; they exert no force.",
                                {{.name = "between",
                                  .kind = kBodyPair,
                                  .meaning = "Two bodies; one may be fixed.",
                                  .required = true}}};
  return table;
}

const FieldTable& contact_material_fields() {
  static const FieldTable table{"contact material",
                                "A contact material. The law of two materials is combined from "
                                "them, unless it is given in pairs.",
                                {bound(kFriction, &ContactMaterialSpec::friction),
                                 bound(kRestitution, &ContactMaterialSpec::restitution)}};
  return table;
}

const FieldTable& contact_combination_fields() {
  static const std::vector<std::string> ways{"geometric_mean", "mean", "minimum", "maximum",
                                             "product"};
  static const FieldTable table{
      "contact combination",
      "How friction and restitution of a pair are combined from those of its materials.",
      {{.name = "friction",
        .kind = kChoice,
        .meaning = "Combination of the two coefficients of friction.",
        .standard = "geometric_mean",
        .choices = ways,
        .member = &ContactsSpec::friction},
       {.name = "restitution",
        .kind = kChoice,
        .meaning = "Combination of the two coefficients of restitution.",
        .standard = "minimum",
        .choices = ways,
        .member = &ContactsSpec::restitution}}};
  return table;
}

const FieldTable& contact_side_fields() {
  static const FieldTable table{
      "contact side",
      "How a shape takes part in contact. On a body it holds for all its shapes; on a shape it "
      "overrides that of the body.",
      {
          {.name = "touches",
           .kind = kBoolean,
           .meaning = "false: the shape does not touch; it has mass and is drawn only.",
           .standard = "true",
           .member = &ContactSideSpec::touches},
          {.name = "material",
           .kind = kText,
           .meaning = "Name of a contact material.",
           .standard = "friction and restitution of contacts.default",
           .member = &ContactSideSpec::material},
          {.name = "groups",
           .kind = kNames,
           .meaning = "Groups it belongs to; names are free.",
           .standard = "[default]",
           .member = &ContactSideSpec::groups},
          {.name = "meets",
           .kind = kNames,
           .meaning = "Groups it can touch; two shapes touch if each accepts the other.",
           .standard = "all",
           .member = &ContactSideSpec::meets},
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
                   .meaning = "true: the solid also touches itself, where it is folded.",
                   .standard = "false"}}};
    for (const Field& field : contact_side_fields().fields) t.fields.push_back(field);
    t.fields[2].meaning = "false: the solid does not touch.";
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
           .meaning = "Points in the shape's coordinates; at least four, not in one plane."},
          {.name = "file",
           .kind = kText,
           .meaning = "An STL or OBJ file whose corners are the points; path relative to the model "
                      "file's folder."},
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
           .meaning = "Spacing of the grid, along x and y.",
           .required = true,
           .range = kPositive},
          {.name = "heights",
           .kind = kRows,
           .dimension = kLength,
           .meaning = "Heights along z: a list of rows, y growing from row to row, x along a row.",
           .required = true},
      }};
  return table;
}

}  // namespace polhode::io
