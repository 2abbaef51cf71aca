// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/schema/field_table.hpp>

namespace polhode {

using namespace dimensions;
using enum FieldKind;

const FieldTable& part_fields() {
  static const FieldTable table{
      "part",
      "A model within the model. Its bodies, joints, loads, materials, sections, beams, cables, "
      "solids and parts are taken over under its prefix, so that others can name them; its title, "
      "gravity, contacts, analysis and output are for itself alone.",
      {
          {.name = "file",
           .kind = kText,
           .meaning = "Model file of the part, seen from the folder of this file."},
          {.name = "model",
           .kind = kSection,
           .meaning = "The part itself, as in a model file; instead of file.",
           .table = "model"},
          {.name = "prefix",
           .kind = kText,
           .meaning = "Stands before all names of the part.",
           .standard = "the part's name and '_'"},
          {.name = "position",
           .kind = kVector,
           .dimension = kLength,
           .meaning = "Of the origin of the part's coordinates.",
           .standard = "[0, 0, 0]"},
          {.name = "orientation",
           .kind = kSection,
           .meaning = "Turn from the part's axes to those of this model.",
           .standard = "along the axes of this model",
           .table = "orientation"},
          {.name = "mirror",
           .kind = kChoice,
           .meaning = "The coordinate of the part that changes its sign before it is placed; the "
                      "same coordinate of each body changes its sign, too.",
           .standard = "not mirrored",
           .choices = {"x", "y", "z"}},
          {.name = "variables",
           .kind = kVariables,
           .meaning = "Values for variables of the part; bare numbers count in its units."},
      }};
  return table;
}

}  // namespace polhode
