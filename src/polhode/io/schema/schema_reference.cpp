// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/geometry/shapes.hpp>
#include <polhode/io/schema/field_table.hpp>
#include <polhode/io/schema/schema.hpp>
#include <polhode/io/text/expression.hpp>

namespace polhode::io {
namespace {

/// Short description of a value's form.
std::string form(const Field& field) {
  using enum FieldKind;
  switch (field.kind) {
    case kNumber:
      return "number";
    case kTimeNumber:
      return "number over time";
    case kLaw:
      return format("expression of {}, or table", field.variable);
    case kInteger:
      return "whole number";
    case kBoolean:
      return "true, false";
    case kText:
      return "text";
    case kChoice:
      return name_list(field.choices);
    case kChoices:
      return "list of " + name_list(field.choices);
    case kVector:
      return "3 numbers";
    case kTimeVector:
      return "3 numbers over time";
    case kVectorPair:
      return "2 vectors";
    case kDirection:
      return "direction";
    case kDirectionPair:
      return "2 directions";
    case kNumbers:
      return "list of numbers";
    case kMatrix:
      return "3 rows of 3 numbers";
    case kBody:
      return "body";
    case kBodyPair:
      return "2 bodies";
    case kNames:
      return "list of names";
    case kBodyPairs:
      return "list of pairs of bodies";
    case kRows:
      return "list of rows of numbers";
    case kJoint:
      return "joint";
    case kLoad:
      return "load";
    case kMaterial:
      return "material";
    case kSolid:
      return "solid";
    case kSelection:
      return "selection";
    case kBonds:
      return "map from bodies to selections";
    case kMatrix6:
      return "6 rows of 6 numbers";
    case kBeamBonds:
      return "map from bodies to start, end or both";
    case kAttachments:
      return "list of [body, point]";
    case kPoints:
      return "list of vectors";
    case kIndices:
      return "list of whole numbers";
    case kIndexLists:
      return "list of lists of whole numbers";
    case kIndexSets:
      return "map from names to lists of whole numbers";
    case kNumberList:
      return "number, or list of numbers";
    case kLevel:
      return "min, max, or number";
    case kShapes:
      return "shape, or list of shapes";
    case kSections:
      return "map or list of maps, see " + field.table;
    case kInertiaTensor:
      return "3 numbers, or map";
    case kStep:
      return "auto, or number";
    case kVariables:
      return "map from names to numbers";
    case kCoordinates:
      return "number, or map from coordinates to numbers";
    case kNamed:
      return "map from names, see " + field.table;
    case kSection:
      break;
  }
  return "map, see " + field.table;
}

std::string bounds(const Range& range) {
  const double infinity = std::numeric_limits<double>::infinity();
  if (range.least == -infinity && range.most == infinity) return "";
  if (range.least == range.most) return format("= {:g}", range.least);
  if (range.most == infinity) return format("{} {:g}", range.above_least ? ">" : ">=", range.least);
  return format("{}{:g}, {:g}{}", range.above_least ? "(" : "[", range.least, range.most,
                range.below_most ? ")" : "]");
}

std::string cell(std::string text) {
  for (std::size_t k = 0; (k = text.find('|', k)) != std::string::npos; k += 2)
    text.insert(k, "\\");
  for (std::size_t k = 0; (k = text.find('<', k)) != std::string::npos; k += 4)
    text.replace(k, 1, "&lt;");
  return text;
}

std::string versions(const Field& field) {
  return field.changed.empty() ? field.since
                               : format("{}, changed in {}", field.since, field.changed);
}

std::string table_page(const FieldTable& table) {
  std::string page = format("## {}\n\n{}\n\n", table.title, table.meaning);
  page += "| key | value | SI unit | range | when left out | meaning | since |\n";
  page += "| --- | --- | --- | --- | --- | --- | --- |\n";
  for (const Field& field : table.fields) {
    const std::string left_out = field.required ? "**required**" : field.standard;
    page += format("| `{}` | {} | {} | {} | {} | {} | {} |\n", field.name, cell(form(field)),
                   field.dimension.si_unit(), bounds(field.range), cell(left_out),
                   cell(field.meaning), versions(field));
  }
  return page + "\n";
}

std::string in_code(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "`" : ", `") + name + "`";
  return text;
}

}  // namespace

std::string reference_markdown() {
  std::string page =
      "# The model file\n\n<!-- Generated from the field tables in src/polhode/io/schema; the test "
      "Schema says how. -->\n\nA model file is YAML 1.2 or JSON. Unknown keys, duplicate keys, "
      "anchors, tags, several documents, numbers that are not finite and more than 64 levels are "
      "refused; all errors are reported at once, with their position. Booleans are `true` and "
      "`false`.\n\n## Numbers\n\nA number is written alone (`2.5`), with its unit after a space "
      "(`30 deg`, `5 N/mm`, `100 kg/m^3`), or as an expression of the `variables` (`-speed*L/2`), "
      "which may be followed by a unit (`2*pi rad/s`). A value that may depend on time is an "
      "expression of `t` or a table; `t` is the time since the start in the file's unit of "
      "time.\n\nA number without a unit has the `units` of the file. Dimensions are checked in "
      "expressions: a variable with a unit has that dimension, a variable without one has any. "
      "Angles count as dimensionless in products, so that a speed may be an angular velocity times "
      "a length. The functions sin, cos and tan take numbers without a unit in radians for any "
      "`units`.\n\n";
  page += "* Units: " + in_code(unit_names()) +
          "; m, g, s, rad, N, Pa, J, W and Hz take the prefixes n, u, m, c, k, M, G. They are "
          "combined by spaces, `*`, `/` and `^`; g is the gram, g0 standard gravity.\n";
  page += "* Taken names: " + in_code(reserved_names()) + ".\n";
  page +=
      "* More functions: `mod(x, y)` is the remainder of x by y, with the sign of y; `step(x, a)` "
      "is "
      "0 below a and 1 from a on; `pulse(x, a, b)` is 1 from a until before b, else 0; "
      "`ramp(x, a, b)` rises evenly from 0 at a to 1 at b, and `smoothstep(x, a, b)` without a "
      "jump "
      "of its slope. A variable may have such a name.\n";
  page +=
      "* Operators: `+ - * / ^`, brackets, `< <= > >= == !=`, `&& || !`, `c ? a : b`.\n\n"
      "Directions are `x`, `y`, `z`, `-x`, `-y`, `-z`, or three numbers of any length but zero. "
      "Names consist of letters, digits, `_` and `-`.\n\n"
      "On the command line `--set L=1.2` sets a variable and `--set joints.A.at.0=0.1` any entry; "
      "list entries count from 0.\n\n"
      "The last column of a table names the version that reads a key first, and the last one in "
      "which its meaning or what is taken when it is left out has changed. 0.1 is the version "
      "before the first release.\n\n";
  for (const FieldTable* table : all_field_tables()) page += table_page(*table);
  page += "## sizes of shapes\n\nFull lengths, in this order or by name.\n\n";
  page += "| shape | sizes |\n| --- | --- |\n";
  for (const geometry::ShapeKind& kind : geometry::shape_kinds()) {
    std::string sizes;
    for (const geometry::ShapeSize& size : kind.sizes)
      sizes += (sizes.empty() ? "" : "; ") + format("`{}`: {}", size.name, size.meaning);
    page += format("| `{}` | {} |\n", kind.name, cell(sizes));
  }
  return page;
}

}  // namespace polhode::io
