// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/format.hpp>
#include <polhode/io/schema/field_table.hpp>
#include <polhode/solids/mesh/generators.hpp>

namespace polhode::io {

using namespace dimensions;
using enum FieldKind;

namespace {

KindTable generator_table(const solids::MeshGenerator& generator) {
  KindTable kind{generator.name, {"mesh " + generator.name, sentence(generator.meaning), {}}};
  if (!generator.sides.empty())
    kind.table.meaning += " Sets of nodes for selections: " + generator.sides + ".";
  for (const solids::MeshParameter& p : generator.parameters) {
    const bool length = p.kind == solids::MeshParameter::Kind::kLength ||
                        p.kind == solids::MeshParameter::Kind::kPoint;
    Field field{.name = p.name,
                .kind = kNumberList,
                .dimension = length ? kLength : kNone,
                .meaning = sentence(p.meaning) + (p.values.empty() ? "" : " [" + p.values + "]"),
                .required = p.preset.empty()};
    for (const double x : p.preset)
      field.standard += (field.standard.empty() ? "" : ", ") + format("{:g}", x);
    if (p.preset.size() > 1) field.standard = "[" + field.standard + "]";
    if (p.kind != solids::MeshParameter::Kind::kPoint) field.range = kPositive;
    kind.table.fields.push_back(std::move(field));
  }
  return kind;
}

}  // namespace

const std::vector<KindTable>& mesh_generator_tables() {
  static const std::vector<KindTable> tables = [] {
    std::vector<KindTable> list;
    for (const solids::MeshGenerator& generator : solids::mesh_generators())
      if (solids::cell_shape(generator.elements.front()).dimension == 3)
        list.push_back(generator_table(generator));
    return list;
  }();
  return tables;
}

const FieldTable& solid_fields() {
  static const FieldTable table{
      "solid",
      "A deformable solid: a mesh of elements of one kind, with one material or several.",
      {
          {.name = "mesh",
           .kind = kSection,
           .meaning = "The mesh and its position.",
           .required = true,
           .table = "solid mesh"},
          {.name = "element",
           .kind = kText,
           .meaning = "Kind of element, or a cell such as hex8: the kind is then chosen for the "
                      "material. 'polhode info --kinds elements' lists them.",
           .standard = "chosen for the cells of the mesh and the material"},
          {.name = "material",
           .kind = kMaterial,
           .meaning = "Name of a material.",
           .required = true},
          {.name = "density",
           .kind = kNumber,
           .dimension = kDensity,
           .meaning = "Density of the undeformed material.",
           .standard = "the material's",
           .range = kPositive},
          {.name = "regions",
           .kind = kNamed,
           .meaning = "Elements with another material, by name.",
           .table = "region",
           .since = "0.3"},
          {.name = "fibre_directions",
           .kind = kPoints,
           .meaning = "Directions of fibres in place of the materials', along the mesh's axes: one "
                      "for each family of each element, in the order of the elements.",
           .standard = "those of the materials",
           .since = "0.3"},
          {.name = "stress",
           .kind = kChoice,
           .meaning = "Stress over a step: a discrete gradient, which conserves energy at any "
                      "step, or the stress at the middle of the step, for comparison.",
           .standard = "conserving",
           .choices = {"conserving", "midpoint"}},
          {.name = "bonded",
           .kind = kBonds,
           .meaning = "Nodes that move rigidly with a body, by name of the body; with ground they "
                      "are fixed."},
          {.name = "prescribed",
           .kind = kNamed,
           .meaning = "Nodes with prescribed displacement, by name.",
           .table = "prescribed"},
          {.name = "contact",
           .kind = kSection,
           .meaning = "How its surface takes part in contact, see contacts.",
           .table = "solid contact"},
          {.name = "velocity",
           .kind = kVector,
           .dimension = kVelocity,
           .meaning = "Velocity of the centre of mass at the start, world.",
           .standard = "rigid motion with the first body it is bonded to, or at rest"},
          {.name = "angular_velocity",
           .kind = kVector,
           .dimension = kAngularVelocity,
           .meaning = "Angular velocity at the start, about the centre of mass, world axes.",
           .standard = "as velocity; [0, 0, 0] if velocity is given"},
      }};
  return table;
}

const FieldTable& solid_mesh_fields() {
  static const FieldTable table = [] {
    FieldTable t{
        "solid mesh",
        "One of: file, a generator, nodes with elements. Mesh coordinates are local; position and "
        "orientation place the mesh in the world.",
        {
            {.name = "file",
             .kind = kText,
             .meaning =
                 "Path of a mesh file (.msh, .vtu, .inp), relative to the model file's folder."},
            {.name = "group",
             .kind = kText,
             .meaning = "Use only the elements of this set of the file.",
             .standard = "all solid elements"},
            {.name = "scale",
             .kind = kNumber,
             .dimension = kLength,
             .meaning = "Length of one unit of the file.",
             .standard = "1",
             .range = kPositive},
        }};
    for (const KindTable& generator : mesh_generator_tables())
      t.fields.push_back({.name = generator.name,
                          .kind = kSection,
                          .meaning = generator.table.meaning,
                          .table = generator.table.title});
    t.fields.insert(
        t.fields.end(),
        {
            {.name = "nodes",
             .kind = kPoints,
             .dimension = kLength,
             .meaning = "Positions of nodes; requires elements. The first node is number 0."},
            {.name = "elements",
             .kind = kIndexLists,
             .meaning = "Nodes of each element, by number: 8, 20 or 27 for a hexahedron, 4 or 10 "
                        "for a tetrahedron, 6 for a wedge, in the order of VTK."},
            {.name = "sets",
             .kind = kIndexSets,
             .meaning = "Sets of nodes by number, for selections; requires nodes."},
            {.name = "position",
             .kind = kVector,
             .dimension = kLength,
             .meaning = "Position of the origin of the mesh's coordinates, world.",
             .standard = "[0, 0, 0]"},
            {.name = "orientation",
             .kind = kSection,
             .meaning = "Rotation from the world's axes to the mesh's.",
             .standard = "along the world's axes",
             .table = "orientation"},
        });
    return t;
  }();
  return table;
}

const FieldTable& region_fields() {
  static const FieldTable table{
      "region",
      "Elements of a solid with a material of their own. They share the nodes of their "
      "neighbours.",
      {
          {.name = "material",
           .kind = kMaterial,
           .meaning = "Name of a material.",
           .required = true,
           .since = "0.3"},
          {.name = "element",
           .kind = kText,
           .meaning = "Kind of element, in place of the solid's.",
           .standard = "that of the solid",
           .since = "0.3"},
          {.name = "within",
           .kind = kSelection,
           .meaning = "Elements of which this selection contains all nodes; a set of elements of "
                      "the mesh by its name.",
           .table = "selection",
           .since = "0.3"},
          {.name = "elements",
           .kind = kIndices,
           .meaning = "Elements by number, the first is 0, in the order of the mesh.",
           .since = "0.3"},
          {.name = "density",
           .kind = kNumber,
           .dimension = kDensity,
           .meaning = "Density of the undeformed material.",
           .standard = "the material's",
           .range = kPositive,
           .since = "0.3"},
      }};
  return table;
}

const FieldTable& prescribed_fields() {
  static const FieldTable table = [] {
    FieldTable t{"prescribed",
                 "Nodes of a solid with prescribed displacement from the start. Components left "
                 "out are free.",
                 {{.name = "nodes",
                   .kind = kSelection,
                   .meaning = "The nodes.",
                   .required = true,
                   .table = "selection"}}};
    for (const char* axis : {"x", "y", "z"})
      t.fields.push_back(
          {.name = axis,
           .kind = kTimeNumber,
           .dimension = kLength,
           .meaning = std::string("Displacement along the world's ") + axis + " since the start.",
           .standard = "free"});
    return t;
  }();
  return table;
}

const FieldTable& selection_fields() {
  static const FieldTable table{
      "selection",
      "Nodes or faces of a solid: the name of a set, a map with one of these keys, or a list of "
      "such selections, which is their union. A face belongs to a selection if all its nodes do. "
      "Coordinates are those of the mesh, before position and orientation.",
      {
          {.name = "set", .kind = kText, .meaning = "Name of a set of the mesh."},
          {.name = "plane", .kind = kSection, .meaning = "Nodes on a plane.", .table = "plane"},
          {.name = "box", .kind = kSection, .meaning = "Nodes in a box.", .table = "box"},
          {.name = "sphere",
           .kind = kSection,
           .meaning = "Nodes in a sphere, or on it.",
           .table = "sphere"},
          {.name = "nodes",
           .kind = kIndices,
           .meaning = "Nodes by number, the first is 0, in the order of the mesh."},
          {.name = "tolerance",
           .kind = kNumber,
           .dimension = kLength,
           .meaning = "Largest distance of a node from the plane, box or sphere.",
           .standard = "1e-6 of the mesh's extent",
           .range = kPositive},
      }};
  return table;
}

const FieldTable& plane_fields() {
  static const FieldTable table{
      "plane",
      "A plane, given by its normal and its coordinate along it.",
      {
          {.name = "axis", .kind = kDirection, .meaning = "Its normal.", .required = true},
          {.name = "at",
           .kind = kLevel,
           .dimension = kLength,
           .meaning = "Coordinate along the normal: min and max are the ends of the mesh.",
           .required = true},
      }};
  return table;
}

const FieldTable& box_fields() {
  static const FieldTable table{"box",
                                "A box along the mesh's axes.",
                                {
                                    {.name = "from",
                                     .kind = kVector,
                                     .dimension = kLength,
                                     .meaning = "One corner.",
                                     .required = true},
                                    {.name = "to",
                                     .kind = kVector,
                                     .dimension = kLength,
                                     .meaning = "The opposite corner.",
                                     .required = true},
                                }};
  return table;
}

const FieldTable& sphere_fields() {
  static const FieldTable table{"sphere",
                                "A ball, or its surface.",
                                {
                                    {.name = "centre",
                                     .kind = kVector,
                                     .dimension = kLength,
                                     .meaning = "Its centre.",
                                     .required = true},
                                    {.name = "radius",
                                     .kind = kNumber,
                                     .dimension = kLength,
                                     .meaning = "Its radius.",
                                     .required = true,
                                     .range = kPositive},
                                    {.name = "surface",
                                     .kind = kBoolean,
                                     .meaning = "Only nodes on the surface.",
                                     .standard = "false"},
                                }};
  return table;
}

}  // namespace polhode::io
