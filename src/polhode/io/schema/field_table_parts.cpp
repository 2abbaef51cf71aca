// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/schema/field_table.hpp>

namespace polhode::io {

using namespace dimensions;
using enum FieldKind;

const FieldTable& part_fields() {
  static const FieldTable table{
      "part",
      "A model within the model. Its bodies, joints, loads, materials, sections, beams, cables, "
      "solids and parts are included with its prefix before their names; its title, gravity, "
      "contacts, analysis and output apply only if it is run by itself.",
      {
          {.name = "file",
           .kind = kText,
           .meaning = "Model file of the part, relative to the folder of this file."},
          {.name = "model",
           .kind = kSection,
           .meaning = "The part itself, as in a model file; instead of file.",
           .table = "model"},
          {.name = "prefix",
           .kind = kText,
           .meaning = "Prefix of all names of the part.",
           .standard = "the part's name and '_'"},
          {.name = "position",
           .kind = kVector,
           .dimension = kLength,
           .meaning = "Position of the origin of the part's coordinates.",
           .standard = "[0, 0, 0]"},
          {.name = "orientation",
           .kind = kSection,
           .meaning = "Rotation from the part's axes to those of this model.",
           .standard = "along the axes of this model",
           .table = "orientation"},
          {.name = "mirror",
           .kind = kChoice,
           .meaning = "Mirror image: the coordinate of the part, and of each body, whose sign "
                      "changes before the part is placed.",
           .standard = "not mirrored",
           .choices = {"x", "y", "z"}},
          {.name = "variables",
           .kind = kVariables,
           .meaning = "Values of the part's variables; numbers without a unit are in its units."},
      }};
  return table;
}

}  // namespace polhode::io
