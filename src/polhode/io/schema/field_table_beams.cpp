// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/schema/field_table.hpp>
#include <polhode/model/beam_spec.hpp>

namespace polhode::io {

using namespace dimensions;
using enum FieldKind;

namespace {

Field size(const char* name, const char* meaning) {
  return {.name = name,
          .kind = kNumber,
          .dimension = kLength,
          .meaning = meaning,
          .required = true,
          .range = kPositive};
}

/// Dimensions without a name in the library of units: N m², kg/m, kg m.
constexpr Dimension kBendingStiffness{3, 1, -2, 0}, kMassPerLength{-1, 1, 0, 0},
    kInertiaPerLength{1, 1, 0, 0};

Field stiffness(const char* name, const Dimension& dimension, const char* meaning) {
  return {.name = name,
          .kind = kNumber,
          .dimension = dimension,
          .meaning = meaning,
          .standard = "from matrix",
          .range = kPositive};
}

Field factor(const char* name, const char* meaning) {
  return {.name = name,
          .kind = kNumber,
          .meaning = meaning,
          .standard = "from the shape",
          .range = kPositive};
}

KindTable section(const std::string& name, const std::string& meaning,
                  const std::vector<Field>& more) {
  KindTable kind{name, {"section " + name, meaning, {}}};
  kind.table.fields.push_back({.name = "type",
                               .kind = kChoice,
                               .meaning = "The kind of section.",
                               .required = true,
                               .choices = {name}});
  kind.table.fields.insert(kind.table.fields.end(), more.begin(), more.end());
  return kind;
}

/// Section of a shape filled with a material.
KindTable shaped(const std::string& name, const std::string& meaning, std::vector<Field> sizes) {
  sizes.push_back({.name = "material",
                   .kind = kMaterial,
                   .meaning = "A material with youngs_modulus, poisson_ratio and density; its "
                              "relaxation time is also that of the beam.",
                   .required = true});
  sizes.push_back(factor("torsion_factor", "Factor of the shape's torsion constant."));
  sizes.back().standard = "1";
  sizes.push_back(factor("shear_factor_y", "Shear factor along y instead of Cowper's."));
  sizes.push_back(factor("shear_factor_z", "Shear factor along z instead of Cowper's."));
  return section(name, meaning, sizes);
}

}  // namespace

const std::vector<KindTable>& section_tables() {
  static const std::vector<KindTable> tables = {
      shaped("rectangle", "A full rectangle.",
             {size("height", "Size along the section's y."), size("width", "Along its z.")}),
      shaped("circle", "A full circle.", {size("diameter", "Diameter.")}),
      shaped("tube", "A round tube.",
             {size("outer", "Outer diameter."), size("inner", "Inner diameter.")}),
      shaped("i", "A doubly symmetric I: its web along y, its flanges along z.",
             {size("height", "Overall height, along y."),
              size("width", "Width of the flanges, along z."), size("web", "Thickness of the web."),
              size("flange", "Thickness of a flange.")}),
      section("general", "A section given by its stiffnesses: six numbers, or a coupled matrix.",
              {stiffness("EA", kForce, "Axial force per extension."),
               stiffness("GA_y", kForce, "Shear force along y per shear, shear factor included."),
               stiffness("GA_z", kForce, "Shear force along z per shear, shear factor included."),
               stiffness("GJ", kBendingStiffness, "Torque per twist."),
               stiffness("EI_y", kBendingStiffness, "Bending moment about y per curvature."),
               stiffness("EI_z", kBendingStiffness, "Bending moment about z per curvature."),
               {.name = "matrix",
                .kind = kMatrix6,
                .meaning = "Stiffness matrix instead of the six, in SI: (N, V_y, V_z, M_x, M_y, "
                           "M_z) by strain, symmetric and positive definite."},
               {.name = "mass_per_length",
                .kind = kNumber,
                .dimension = kMassPerLength,
                .meaning = "Mass per length.",
                .required = true,
                .range = kPositive},
               {.name = "inertia_per_length",
                .kind = kVector,
                .dimension = kInertiaPerLength,
                .meaning = "Rotary inertia per length about x, y, z.",
                .required = true},
               {.name = "relaxation_time",
                .kind = kNumber,
                .dimension = kTime,
                .meaning = "Relaxation time: viscous section forces are this times stiffness times "
                           "rate of strain.",
                .standard = "0",
                .range = kNotNegative}}),
  };
  return tables;
}

const FieldTable& beam_fields() {
  static const FieldTable table{
      "beam",
      "A geometrically exact beam. Its nodes are bodies: mast.start, mast.end, or mast.3 by number "
      "from 0, wherever a body is named.",
      {
          {.name = "points",
           .kind = kPoints,
           .dimension = kLength,
           .meaning =
               "[start, ..., end], world at the start of the run, unstressed. Corners are rigid."},
          {.name = "arc",
           .kind = kPoints,
           .dimension = kLength,
           .meaning = "Instead of points: [start, a point between, end] of an arc of a circle."},
          {.name = "elements",
           .kind = kInteger,
           .meaning =
               "Number of elements of the whole beam, distributed over its segments by length.",
           .required = true,
           .range = {1.0, 1e6}},
          {.name = "section", .kind = kText, .meaning = "Name of a section.", .required = true},
          {.name = "up",
           .kind = kDirection,
           .meaning = "Direction of the section's y; made perpendicular to the beam.",
           .standard = "z, or x where the beam runs along z"},
          {.name = "bonded",
           .kind = kBeamBonds,
           .meaning = "Bodies its ends are fixed to: {plate: start, ground: end}. Gives joints of "
                      "these names, mast.start and mast.end, with their reactions."},
          {.name = "velocity",
           .kind = kVector,
           .dimension = kVelocity,
           .meaning = "Velocity of the first point at the start, world.",
           .standard = "that of the body it is fixed to, else [0, 0, 0]"},
          {.name = "angular_velocity",
           .kind = kVector,
           .dimension = kAngularVelocity,
           .meaning = "Angular velocity of the whole beam, about its first point, world.",
           .standard = "that of the body it is fixed to, else [0, 0, 0]"},
          {.name = "consistent_mass",
           .kind = kNumber,
           .meaning =
               "Part of the translational mass that is consistent; the rest is lumped at nodes.",
           .standard = "0.5; 0 with contact",
           .range = {0.0, 1.0}},
          {.name = "contact",
           .kind = kSection,
           .meaning =
               "The beam touches bodies, other beams and itself as a round bar; needs 'contacts'.",
           .standard = "no contact",
           .table = "beam contact"},
          {.name = "residual_bending_flexibility",
           .kind = kBoolean,
           .meaning = "Add the bending flexibility missing in an element of constant strains to "
                      "its shear flexibility.",
           .standard = "true"},
      }};
  return table;
}

const FieldTable& beam_contact_fields() {
  static const FieldTable table = [] {
    FieldTable t{"beam contact",
                 "How a beam takes part in contact: every node carries half of each adjacent "
                 "element as a round bar.",
                 {{.name = "radius",
                   .kind = kNumber,
                   .dimension = kLength,
                   .meaning = "Radius of the bar.",
                   .standard = "half the smaller of the section's height and width",
                   .range = kPositive,
                   .member = &BeamContactSpec::radius}}};
    const std::vector<Field>& side = contact_side_fields().fields;
    t.fields.insert(t.fields.end(), side.begin(), side.end());
    return t;
  }();
  return table;
}

const FieldTable& cable_fields() {
  static const FieldTable table{
      "cable",
      "A cable, rope, rod or truss member: straight elastic segments from point to point, each "
      "with its own elongation.",
      {
          {.name = "through",
           .kind = kAttachments,
           .dimension = kLength,
           .meaning = "[[body, point], ...]: points in the coordinates of the body (ground: "
                      "world). [body] is its centre of mass; [mast, end] the end of a beam.",
           .required = true},
          {.name = "stiffness",
           .kind = kNumber,
           .dimension = kForce,
           .meaning =
               "EA: force per strain. A sliding cable may have a tension or a muscle instead.",
           .range = kPositive},
          {.name = "free_length",
           .kind = kNumber,
           .dimension = kLength,
           .meaning = "Unstressed length of the whole cable.",
           .standard = "that at the start",
           .range = kPositive,
           .member = &CableLineSpec::free_length},
          {.name = "damping",
           .kind = kNumber,
           .dimension = kDamping,
           .meaning = "Damping of the whole cable: force per rate of elongation, while taut.",
           .standard = "0",
           .range = kNotNegative,
           .member = &CableLineSpec::damping},
          {.name = "tension_only",
           .kind = kBoolean,
           .meaning = "Slack when shorter than its free length. false: a rod.",
           .standard = "true",
           .member = &CableLineSpec::tension_only},
          {.name = "slides",
           .kind = kBoolean,
           .meaning = "The cable slides over its points between the ends: one tension in all "
                      "segments, from the whole length, unless it has friction.",
           .standard = "false; true with tension or muscle"},
          {.name = "friction",
           .kind = kNumber,
           .meaning = "Coefficient of friction of a sliding cable on these points.",
           .standard = "0",
           .range = kNotNegative},
          {.name = "wraps",
           .kind = kNumberList,
           .meaning = "Number of whole turns about each of these points, in addition to the "
                      "cable's deflection there; with friction.",
           .standard = "0 each",
           .range = kNotNegative},
          {.name = "tension",
           .kind = kTimeNumber,
           .dimension = kForce,
           .meaning = "Given tension of a sliding cable, in addition to that of its stiffness.",
           .standard = "0"},
          {.name = "muscle",
           .kind = kSection,
           .meaning = "The cable is a muscle with its path through the points.",
           .table = "muscle"},
          {.name = "around",
           .kind = kNamed,
           .meaning = "Obstacles by name, which a sliding cable or muscle runs around.",
           .table = "obstacle"},
          {.name = "strain",
           .kind = kChoice,
           .meaning = "Measure of strain: l/L - 1, or (l^2/L^2 - 1)/2.",
           .standard = "engineering",
           .choices = {"engineering", "green"},
           .member = &CableLineSpec::strain},
          {.name = "mass_per_length",
           .kind = kNumber,
           .dimension = kMassPerLength,
           .meaning = "Mass per length: adds point masses (stay.0, stay.1, ...), with spherical "
                      "joints at its points.",
           .standard = "0",
           .range = kNotNegative,
           .member = &CableLineSpec::mass_per_length},
          {.name = "elements",
           .kind = kInteger,
           .meaning = "Number of elements from one point to the next, if it has mass.",
           .standard = "1",
           .range = {1.0, 1e6},
           .member = &CableLineSpec::elements},
          {.name = "contact",
           .kind = kSection,
           .meaning = "The cable touches bodies, beams and other cables as a round rope; needs "
                      "'contacts'.",
           .standard = "no contact",
           .table = "cable contact"},
      }};
  return table;
}

const FieldTable& muscle_fields() {
  static const FieldTable table{
      "muscle",
      "A Hill-type muscle with a rigid tendon, curves of De Groote et al. (2016).",
      {
          {.name = "max_force",
           .kind = kNumber,
           .dimension = kForce,
           .meaning = "Isometric force of the active muscle at the optimal length.",
           .required = true,
           .range = kPositive,
           .member = &HillMuscle::max_force},
          {.name = "optimal_length",
           .kind = kNumber,
           .dimension = kLength,
           .meaning = "Optimal length of the fibres, at which their force is largest.",
           .required = true,
           .range = kPositive,
           .member = &HillMuscle::optimal_length},
          {.name = "tendon_length",
           .kind = kNumber,
           .dimension = kLength,
           .meaning = "Length of the rigid tendon.",
           .standard = "0",
           .range = kNotNegative,
           .member = &HillMuscle::tendon_length},
          {.name = "pennation",
           .kind = kNumber,
           .dimension = kAngle,
           .meaning = "Pennation angle at the optimal length; the muscle has constant width.",
           .standard = "0",
           .range = {0.0, 1.4},
           .member = &HillMuscle::pennation},
          {.name = "max_velocity",
           .kind = kNumber,
           .meaning = "Largest speed of shortening, in optimal lengths a second.",
           .standard = "10",
           .range = kPositive,
           .member = &HillMuscle::max_velocity},
          {.name = "damping",
           .kind = kNumber,
           .meaning = "Damping of the fibres: force over max_force, by velocity over max_velocity.",
           .standard = "0",
           .range = kNotNegative,
           .member = &HillMuscle::damping},
          {.name = "activation",
           .kind = kTimeNumber,
           .meaning = "Activation over time, from 0 to 1.",
           .required = true,
           .member = &HillMuscle::activation},
      }};
  return table;
}

const FieldTable& obstacle_fields() {
  static const FieldTable table{
      "obstacle",
      "A sphere, cylinder or ellipsoid fixed to a body, without mass or friction: between two of "
      "its points the cable is the shortest line around it, straight where it is not in the way.",
      {
          {.name = "type",
           .kind = kChoice,
           .meaning = "Its surface; a cylinder has no ends.",
           .required = true,
           .choices = {"sphere", "cylinder", "ellipsoid"}},
          {.name = "body", .kind = kBody, .meaning = "Its body, or ground.", .required = true},
          {.name = "at",
           .kind = kVector,
           .dimension = kLength,
           .meaning = "Its centre, of a cylinder a point of the axis, in the coordinates of the "
                      "body (ground: world).",
           .standard = "[0, 0, 0]"},
          {.name = "radius",
           .kind = kNumber,
           .dimension = kLength,
           .meaning = "Radius of a sphere or cylinder.",
           .range = kPositive},
          {.name = "semi_axes",
           .kind = kVector,
           .dimension = kLength,
           .meaning = "Of an ellipsoid: half of its sizes along its axes."},
          {.name = "axis",
           .kind = kDirection,
           .meaning = "Of a cylinder: its axis, in body coordinates (ground: world).",
           .standard = "z"},
          {.name = "orientation",
           .kind = kSection,
           .meaning = "Of an ellipsoid: rotation of its axes relative to the body's.",
           .standard = "those of the body",
           .table = "orientation"},
          {.name = "side",
           .kind = kDirection,
           .meaning = "Direction from its centre to the side on which the cable passes, in body "
                      "coordinates (ground: world): it never crosses the opposite half-plane.",
           .standard = "the shorter way"},
          {.name = "after",
           .kind = kInteger,
           .meaning = "Number of the point of the cable before it, from 1.",
           .standard = "1, of a cable with two points",
           .range = {1.0, 1e6}},
      }};
  return table;
}

const FieldTable& cable_contact_fields() {
  static const FieldTable table = [] {
    FieldTable t{"cable contact",
                 "How a cable takes part in contact: all along its centre line.",
                 {{.name = "radius",
                   .kind = kNumber,
                   .dimension = kLength,
                   .meaning = "Radius of the cable.",
                   .required = true,
                   .range = kPositive,
                   .member = &CableContactSpec::radius},
                  {.name = "self",
                   .kind = kBoolean,
                   .meaning = "true: the cable also touches itself, where it is wound or folded.",
                   .standard = "false",
                   .member = &CableContactSpec::self}}};
    const std::vector<Field>& side = contact_side_fields().fields;
    t.fields.insert(t.fields.end(), side.begin(), side.end());
    return t;
  }();
  return table;
}

}  // namespace polhode::io
