// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/schema/field_table.hpp>

#include <cctype>
#include <stdexcept>

#include <polhode/geometry/shapes.hpp>

namespace polhode::io {

using namespace dimensions;
using enum FieldKind;

const Field* FieldTable::find(std::string_view name) const {
  for (const Field& field : fields)
    if (field.name == name) return &field;
  return nullptr;
}

const Field& FieldTable::at(std::string_view name) const {
  if (const Field* field = find(name)) return *field;
  throw std::logic_error("the field table '" + title + "' has no '" + std::string(name) + "'");
}

std::vector<std::string> FieldTable::names() const {
  std::vector<std::string> result;
  for (const Field& field : fields) result.push_back(field.name);
  return result;
}

std::string sentence(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text.ends_with('.') ? text : text + ".";
}

const FieldTable& model_fields() {
  static const FieldTable table{
      "model",
      "The whole file. Bodies, joints, loads and solids keep their order.",
      {
          {.name = "format",
           .kind = kInteger,
           .meaning = "Version of the format: write 1.",
           .required = true,
           .range = {1, 1}},
          {.name = "title", .kind = kText, .meaning = "Shown in results and messages."},
          {.name = "units",
           .kind = kSection,
           .meaning = "Units of numbers without a unit.",
           .standard = "SI and radians",
           .table = "units"},
          {.name = "variables",
           .kind = kVariables,
           .meaning = "Named numbers for use in expressions; each may use those before it."},
          {.name = "gravity",
           .kind = kVector,
           .dimension = kAcceleration,
           .meaning = "Acceleration of gravity, world axes.",
           .standard = "[0, 0, 0]"},
          {.name = "import",
           .kind = kSection,
           .meaning = "A model of another program, to which this file adds.",
           .table = "import"},
          {.name = "bodies",
           .kind = kNamed,
           .meaning = "Rigid bodies by name. 'ground' exists already.",
           .table = "body"},
          {.name = "parts",
           .kind = kNamed,
           .meaning = "Models within this one by name: sub-assemblies.",
           .table = "part"},
          {.name = "joints", .kind = kNamed, .meaning = "Joints by name.", .table = "joint"},
          {.name = "loads", .kind = kNamed, .meaning = "Loads by name.", .table = "load"},
          {.name = "materials",
           .kind = kNamed,
           .meaning = "Materials of beams and deformable solids by name.",
           .table = "material"},
          {.name = "sections",
           .kind = kNamed,
           .meaning = "Cross-sections of beams by name.",
           .table = "section"},
          {.name = "beams", .kind = kNamed, .meaning = "Beams by name.", .table = "beam"},
          {.name = "cables",
           .kind = kNamed,
           .meaning = "Cables and rods by name.",
           .table = "cable"},
          {.name = "solids",
           .kind = kNamed,
           .meaning = "Deformable solids by name.",
           .table = "solid"},
          {.name = "contacts",
           .kind = kSection,
           .meaning = "Contact between the shapes of bodies.",
           .standard = "no contact",
           .table = "contacts"},
          {.name = "controllers",
           .kind = kNamed,
           .meaning = "Controllers that set loads, moments of motors, tensions or activations, by "
                      "name.",
           .table = "controller"},
          {.name = "events",
           .kind = kNamed,
           .meaning = "Events that switch joints, loads and contacts, by name.",
           .table = "event"},
          {.name = "analysis",
           .kind = kSection,
           .meaning = "What to compute and how.",
           .table = "analysis"},
          {.name = "output", .kind = kSection, .meaning = "What to record.", .table = "output"},
      }};
  return table;
}

const FieldTable& units_fields() {
  static const FieldTable table{"units",
                                "Units of numbers without a unit. Derived units follow from them: "
                                "with mm and kg a bare stiffness is in kg/s^2.",
                                {
                                    {.name = "length",
                                     .kind = kText,
                                     .dimension = kLength,
                                     .meaning = "Unit of bare lengths, e.g. mm.",
                                     .standard = "m"},
                                    {.name = "mass",
                                     .kind = kText,
                                     .dimension = kMass,
                                     .meaning = "Unit of bare masses, e.g. g.",
                                     .standard = "kg"},
                                    {.name = "time",
                                     .kind = kText,
                                     .dimension = kTime,
                                     .meaning = "Unit of bare times, e.g. ms.",
                                     .standard = "s"},
                                    {.name = "angle",
                                     .kind = kText,
                                     .dimension = kAngle,
                                     .meaning = "Unit of bare angles: rad or deg. Functions such "
                                                "as sin take bare numbers in radians.",
                                     .standard = "rad"},
                                }};
  return table;
}

const FieldTable& body_fields() {
  static const FieldTable table{
      "body",
      "A rigid body. Its mass and inertia are given, or follow from shapes with a density.",
      {
          {.name = "mass",
           .kind = kNumber,
           .dimension = kMass,
           .meaning = "With a shape and no density or inertia, the inertia is that of the shape "
                      "with this mass.",
           .standard = "from shape and density",
           .range = kPositive},
          {.name = "inertia",
           .kind = kInertiaTensor,
           .dimension = kInertia,
           .meaning = "Tensor about the centre of mass in body axes: three principal moments, or "
                      "{xx: , yy: , zz: , xy: , xz: , yz: }; xy is the tensor's entry, minus the "
                      "product of inertia of some textbooks.",
           .standard = "from shape and density"},
          {.name = "shape",
           .kind = kShapes,
           .meaning = "A shape, or a list of shapes each with its own position, for mass "
                      "properties, contact and pictures.",
           .table = "shape"},
          {.name = "density",
           .kind = kNumber,
           .dimension = kDensity,
           .meaning = "Density of the shapes that have none of their own.",
           .range = kPositive},
          {.name = "position",
           .kind = kVector,
           .dimension = kLength,
           .meaning = "Position of the centre of mass (see position_of), world.",
           .standard = "[0, 0, 0]"},
          {.name = "position_of",
           .kind = kChoice,
           .meaning = "Point that position refers to: the centre of mass, or the origin of the "
                      "body's coordinates.",
           .standard = "com; origin for a mesh, a hull or several shapes",
           .choices = {"com", "origin"}},
          {.name = "com",
           .kind = kVector,
           .dimension = kLength,
           .meaning = "Centre of mass in body coordinates.",
           .standard = "[0, 0, 0], or from the shapes"},
          {.name = "orientation",
           .kind = kSection,
           .meaning = "Rotation from the world's axes to the body's.",
           .standard = "along the world's axes",
           .table = "orientation"},
          {.name = "velocity",
           .kind = kVector,
           .dimension = kVelocity,
           .meaning = "Velocity of the centre of mass at the start, world.",
           .standard = "[0, 0, 0]"},
          {.name = "angular_velocity",
           .kind = kVector,
           .dimension = kAngularVelocity,
           .meaning = "Angular velocity at the start, world axes.",
           .standard = "[0, 0, 0]"},
          {.name = "angular_velocity_body",
           .kind = kVector,
           .dimension = kAngularVelocity,
           .meaning = "Angular velocity at the start, body axes; instead of angular_velocity."},
          {.name = "point_mass",
           .kind = kBoolean,
           .meaning = "A point mass, without rotation.",
           .standard = "false"},
          {.name = "fixed",
           .kind = kBoolean,
           .meaning = "The body never moves; it needs no mass.",
           .standard = "false"},
          {.name = "contact",
           .kind = kSection,
           .meaning = "How its shapes take part in contact; needs 'contacts'.",
           .table = "contact side"},
          {.name = "color",
           .kind = kText,
           .meaning = "Its color in pictures: \"#rrggbb\", in quotes, or red, orange, yellow, "
                      "green, teal, blue, "
                      "purple, pink, brown, black, gray or white.",
           .standard = "chosen by the page",
           .since = "0.2"},
          {.name = "hold",
           .kind = kChoices,
           .meaning = "Freedoms fixed at their start values: a generic joint to ground at the "
                      "centre of mass, world axes, named <body>.hold.",
           .choices = {"x", "y", "z", "rx", "ry", "rz"}},
          {.name = "motion",
           .kind = kSection,
           .meaning = "Prescribed motion: a generic joint to ground at the centre of mass, world "
                      "axes, whose frame moves, named <body>.motion. Components left out are free.",
           .table = "body motion"},
      }};
  return table;
}

const FieldTable& inertia_fields() {
  static const FieldTable table{
      "inertia",
      "Entries of the inertia tensor about the centre of mass, body axes.",
      {
          {.name = "xx",
           .kind = kNumber,
           .dimension = kInertia,
           .meaning = "Moment about x.",
           .required = true,
           .range = kPositive},
          {.name = "yy",
           .kind = kNumber,
           .dimension = kInertia,
           .meaning = "Moment about y.",
           .required = true,
           .range = kPositive},
          {.name = "zz",
           .kind = kNumber,
           .dimension = kInertia,
           .meaning = "Moment about z.",
           .required = true,
           .range = kPositive},
          {.name = "xy",
           .kind = kNumber,
           .dimension = kInertia,
           .meaning = "Minus the integral of x y over the mass.",
           .standard = "0"},
          {.name = "xz",
           .kind = kNumber,
           .dimension = kInertia,
           .meaning = "Minus the integral of x z over the mass.",
           .standard = "0"},
          {.name = "yz",
           .kind = kNumber,
           .dimension = kInertia,
           .meaning = "Minus the integral of y z over the mass.",
           .standard = "0"},
      }};
  return table;
}

const FieldTable& orientation_fields() {
  static const FieldTable table{
      "orientation",
      "One of: axis with angle, quaternion, rotation_vector, euler, matrix. Each maps body axes to "
      "the world's.",
      {
          {.name = "axis", .kind = kDirection, .meaning = "Axis of rotation; requires angle."},
          {.name = "angle",
           .kind = kNumber,
           .dimension = kAngle,
           .meaning = "Angle of rotation; requires axis."},
          {.name = "quaternion", .kind = kNumbers, .meaning = "Unit quaternion [w, x, y, z]."},
          {.name = "rotation_vector",
           .kind = kVector,
           .dimension = kAngle,
           .meaning = "Axis times angle."},
          {.name = "euler",
           .kind = kSection,
           .meaning = "Three successive rotations.",
           .table = "euler"},
          {.name = "matrix",
           .kind = kMatrix,
           .meaning = "Rows of the rotation matrix; its columns are the body's axes in the world."},
      }};
  return table;
}

const FieldTable& euler_fields() {
  static const FieldTable table{
      "euler",
      "Euler angles. Lower-case letters are rotations about the body's axes (intrinsic), "
      "upper-case letters about the world's (extrinsic).",
      {
          {.name = "sequence",
           .kind = kText,
           .meaning = "Three letters, e.g. zxz or XYZ; neighbours differ.",
           .required = true},
          {.name = "angles",
           .kind = kVector,
           .dimension = kAngle,
           .meaning = "One for each letter.",
           .required = true},
      }};
  return table;
}

const FieldTable& shape_fields() {
  static const FieldTable table = [] {
    FieldTable t{"shape",
                 "One key names the kind and gives its sizes, in this order, as full lengths; the "
                 "others give its position and orientation. Cylinder, capsule, cone and tube lie "
                 "along z; all are centred at their centroid.",
                 {}};
    for (const geometry::ShapeKind& kind : geometry::shape_kinds()) {
      std::string sizes;
      for (const geometry::ShapeSize& size : kind.sizes)
        sizes += (sizes.empty() ? "[" : ", ") + size.name;
      t.fields.push_back({.name = kind.name,
                          .kind = kNumbers,
                          .dimension = kLength,
                          .meaning = sentence(kind.meaning) + " Sizes: " + sizes + "].",
                          .range = kPositive});
    }
    t.fields.push_back({.name = "mesh",
                        .kind = kSection,
                        .meaning = "A closed triangle surface from a file: a path, or a map.",
                        .table = "mesh"});
    t.fields.push_back({.name = "hull",
                        .kind = kSection,
                        .meaning = "The convex hull of points.",
                        .table = "hull"});
    t.fields.push_back({.name = "height_field",
                        .kind = kSection,
                        .meaning = "Heights over a grid, for fixed bodies; without mass.",
                        .table = "height field"});
    t.fields.push_back({.name = "plane",
                        .kind = kDirection,
                        .meaning = "A plane through the shape's position with this normal, for "
                                   "fixed bodies; without mass."});
    t.fields.push_back({.name = "position",
                        .kind = kVector,
                        .dimension = kLength,
                        .meaning = "Position of the shape's centre, body coordinates.",
                        .standard = "[0, 0, 0]"});
    t.fields.push_back({.name = "orientation",
                        .kind = kSection,
                        .meaning = "Rotation from the body's axes to the shape's.",
                        .standard = "along the body's axes",
                        .table = "orientation"});
    t.fields.push_back({.name = "density",
                        .kind = kNumber,
                        .dimension = kDensity,
                        .meaning = "Density of this shape.",
                        .standard = "the body's",
                        .range = kPositive});
    t.fields.push_back({.name = "contact",
                        .kind = kSection,
                        .meaning = "How it takes part in contact.",
                        .standard = "as the body",
                        .table = "contact side"});
    return t;
  }();
  return table;
}

const FieldTable& mesh_fields() {
  static const FieldTable table{
      "mesh",
      "A closed surface of triangles in an STL or OBJ file, or an MSH of MuJoCo.",
      {
          {.name = "file",
           .kind = kText,
           .meaning = "Path, relative to the model file's folder.",
           .required = true},
          {.name = "scale",
           .kind = kNumber,
           .dimension = kLength,
           .meaning = "Length of one unit of the file.",
           .standard = "1",
           .range = kPositive},
      }};
  return table;
}

const FieldTable& time_table_fields() {
  static const FieldTable table{
      "table",
      "A value over time, given by points. Outside of the table its end values hold.",
      {
          {.name = "table",
           .kind = kNumbers,
           .meaning = "[[t, value], ...] with increasing times.",
           .required = true},
          {.name = "interpolation",
           .kind = kChoice,
           .meaning = "Between the points: straight lines, a natural cubic spline, or each value "
                      "until the next.",
           .standard = "linear",
           .choices = {"linear", "cubic", "step"}},
          {.name = "periodic",
           .kind = kBoolean,
           .meaning = "The table is periodic; its last value equals the first.",
           .standard = "false"},
      }};
  return table;
}

const FieldTable& law_table_fields() {
  static const FieldTable table{
      "law",
      "A force over a coordinate or a rate, given by points. Outside of the table its end values "
      "hold.",
      {
          {.name = "table",
           .kind = kNumbers,
           .meaning = "[[x, force], ...] with increasing x.",
           .required = true},
          {.name = "interpolation",
           .kind = kChoice,
           .meaning = "Between the points: straight lines or a natural cubic spline.",
           .standard = "linear",
           .choices = {"linear", "cubic"}},
      }};
  return table;
}

}  // namespace polhode::io
