// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/schema/schema.hpp>

#include <cmath>
#include <nlohmann/json.hpp>

#include <polhode/geometry/shapes.hpp>
#include <polhode/io/schema/field_table.hpp>

namespace polhode::io {
namespace {

using json = nlohmann::ordered_json;

json reference(const std::string& name) { return {{"$ref", "#/$defs/" + name}}; }

/// Name of a table's definition: "joint revolute" is joint_revolute.
std::string definition_name(std::string title) {
  for (char& c : title)
    if (c == ' ') c = '_';
  return title;
}

json list_of(json items, int least, int most) {
  json schema = {{"type", "array"}, {"items", std::move(items)}};
  if (least > 0) schema["minItems"] = least;
  if (most > 0) schema["maxItems"] = most;
  return schema;
}

/// Adds bounds of bare numbers: zero is zero in every unit, other bounds apply to plain numbers
/// only.
void add_bounds(json& schema, const Field& field) {
  const auto holds = [&](double bound) {
    return std::isfinite(bound) && (bound == 0.0 || field.dimension.is_none());
  };
  if (holds(field.range.least))
    schema[field.range.above_least ? "exclusiveMinimum" : "minimum"] = field.range.least;
  if (holds(field.range.most))
    schema[field.range.below_most ? "exclusiveMaximum" : "maximum"] = field.range.most;
}

json choice(const std::vector<std::string>& choices) {
  json words = json::array();
  for (const std::string& word : choices) {
    words.push_back(word);
    // A choice of numbers may also be written as a number.
    if (!word.empty() && word.find_first_not_of("0123456789") == std::string::npos)
      words.push_back(std::stoi(word));
  }
  return {{"enum", words}};
}

/// Numbers of nodes.
json indices() { return list_of({{"type", "integer"}, {"minimum", 0}}, 1, 0); }

/// Sizes of a shape: a list in order, a map by name, or a number if there is only one.
json shape_sizes(const geometry::ShapeKind& kind) {
  const int count = static_cast<int>(kind.sizes.size());
  json properties = json::object(), names = json::array();
  for (const geometry::ShapeSize& size : kind.sizes) {
    properties[size.name] = reference("number");
    properties[size.name]["description"] = size.meaning;
    names.push_back(size.name);
  }
  json forms = json::array({list_of(reference("number"), count, count),
                            {{"type", "object"},
                             {"properties", properties},
                             {"required", names},
                             {"additionalProperties", false}}});
  if (count == 1) forms.push_back(reference("number"));
  return {{"anyOf", forms}};
}

json field_schema(const FieldTable& table, const Field& field) {
  using enum FieldKind;
  if (const geometry::ShapeKind* shape =
          &table == &shape_fields() ? geometry::find_shape_kind(field.name) : nullptr)
    return shape_sizes(*shape);
  switch (field.kind) {
    case kNumber: {
      json schema = reference("number");
      add_bounds(schema, field);
      return schema;
    }
    case kInteger: {
      json schema = {{"type", json::array({"integer", "string"})}};
      add_bounds(schema, field);
      return schema;
    }
    case kTimeNumber:
      return reference("time_number");
    case kLaw:
      return {{"anyOf", json::array({reference("number"), reference("law")})}};
    case kBoolean:
      return {{"type", "boolean"}};
    case kText:
      return {{"type", "string"}};
    case kChoice:
      return choice(field.choices);
    case kChoices: {
      json schema = list_of(choice(field.choices), 0, 0);
      schema["uniqueItems"] = true;
      return schema;
    }
    case kVector:
      return reference("vector");
    case kTimeVector:
      return list_of(reference("time_number"), 3, 3);
    case kVectorPair:
      return list_of(reference("vector"), 2, 2);
    case kDirection:
      return reference("direction");
    case kDirectionPair:
      return list_of(reference("direction"), 2, 2);
    case kNumbers:
      if (&table == &time_table_fields() || &table == &law_table_fields())
        return list_of(list_of(reference("number"), 2, 2), 2, 0);
      return list_of(reference("number"), 4, 4);  // A quaternion.
    case kMatrix:
      return list_of(reference("vector"), 3, 3);
    case kBody:
    case kJoint:
    case kLoad:
    case kMaterial:
    case kSolid:
      return reference("name");
    case kBodyPair:
      return list_of(reference("name"), 2, 2);
    case kNames:
      return list_of(reference("name"), 1, 0);
    case kBodyPairs:
      return list_of(list_of(reference("name"), 2, 2), 0, 0);
    case kRows:
      return list_of(list_of(reference("number"), 2, 0), 2, 0);
    case kInertiaTensor:
      return {{"anyOf", json::array({reference("vector"), reference("inertia")})}};
    case kShapes: {
      const json shape = reference("shape");
      return {{"anyOf", json::array({shape, list_of(shape, 1, 0)})}};
    }
    case kSections: {
      const json one = reference(field.table);
      return {{"anyOf", json::array({one, list_of(one, 1, 0)})}};
    }
    case kSelection:
      return reference("selections");
    case kBonds:
      return {{"type", json::array({"object", "null"})},
              {"propertyNames", {{"pattern", "^[A-Za-z0-9_-]+$"}}},
              {"additionalProperties", reference("selections")}};
    case kMatrix6:
      return list_of(list_of(reference("number"), 6, 6), 6, 6);
    case kBeamBonds: {
      const json end = {{"enum", {"start", "end"}}};
      return {{"type", "object"},
              {"propertyNames", {{"pattern", "^[A-Za-z0-9_.-]+$"}}},
              {"additionalProperties", {{"anyOf", json::array({end, list_of(end, 1, 2)})}}}};
    }
    case kAttachments: {
      // [body], [body, point] or [beam, its node].
      const json point = {
          {"anyOf", json::array({reference("vector"), reference("name"), {{"type", "integer"}}})}};
      return list_of({{"type", "array"},
                      {"prefixItems", json::array({reference("name"), point})},
                      {"minItems", 1},
                      {"maxItems", 2}},
                     2, 0);
    }
    case kPoints:
      return list_of(reference("vector"), 1, 0);
    case kIndices:
      return indices();
    case kIndexLists:
      return list_of(indices(), 1, 0);
    case kIndexSets:
      return {{"type", "object"},
              {"propertyNames", reference("new_name")},
              {"additionalProperties", indices()}};
    case kNumberList:
      return {{"anyOf", json::array({reference("number"), list_of(reference("number"), 1, 0)})}};
    case kLevel:
      return {{"anyOf", json::array({{{"enum", {"min", "max"}}}, reference("number")})}};
    case kCoordinates:
      return {{"anyOf", json::array({reference("number"),
                                     {{"type", "object"},
                                      {"propertyNames", {{"pattern", "^r?[xyz]$"}}},
                                      {"additionalProperties", reference("number")}}})}};
    case kStep:
      return {{"anyOf", json::array({{{"const", "auto"}}, reference("number")})}};
    case kVariables: {
      json value = reference("number");
      if (field.name == "start")  // Joints of an import may have several coordinates.
        value = {
            {"anyOf", json::array({value, {{"type", "array"}, {"items", reference("number")}}})}};
      return {{"type", json::array({"object", "null"})},
              {"propertyNames", {{"pattern", "^[A-Za-z_][A-Za-z0-9_]*$"}}},
              {"additionalProperties", value}};
    }
    case kNamed:
      return {{"type", json::array({"object", "null"})},
              {"propertyNames", reference("new_name")},
              {"additionalProperties", reference(definition_name(field.table))}};
    case kSection:
      break;
  }
  if (field.table == "mesh")
    return {{"anyOf", json::array({{{"type", "string"}}, reference("mesh")})}};
  if (field.table == model_fields().title) return {{"$ref", "#"}};
  return reference(definition_name(field.table));
}

std::string description(const Field& field) {
  std::string text = field.meaning;
  const std::string unit = field.dimension.si_unit();
  if (!unit.empty()) text += " SI unit: " + unit + ".";
  if (!field.standard.empty()) text += " Default: " + field.standard + ".";
  return text;
}

json table_schema(const FieldTable& table) {
  json properties = json::object(), required = json::array();
  for (const Field& field : table.fields) {
    json schema = field_schema(table, field);
    schema["description"] = description(field);
    properties[field.name] = std::move(schema);
    if (field.required) required.push_back(field.name);
  }
  json schema = {{"type", "object"},
                 {"description", table.meaning},
                 {"properties", properties},
                 {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = required;
  return schema;
}

json kinds_schema(const std::vector<KindTable>& kinds) {
  json forms = json::array();
  for (const KindTable& kind : kinds) forms.push_back(reference(definition_name(kind.table.title)));
  return {{"oneOf", forms}};
}

json definitions() {
  json defs = json::object();
  defs["number"] = {
      {"description", "A number, a number with its unit, or an expression of the variables."},
      {"type", json::array({"number", "string"})}};
  defs["time_number"] = {
      {"description",
       "A number, an expression (the time is t), a table over time, or the output of a "
       "controller."},
      {"anyOf", json::array({reference("number"), reference("table"),
                             reference(definition_name(controlled_value_fields().title))})}};
  defs["vector"] = list_of(reference("number"), 3, 3);
  defs["direction"] = {
      {"description", "x, y, z, -x, -y, -z, or three numbers of any length but zero."},
      {"anyOf", json::array({{{"enum", {"x", "y", "z", "-x", "-y", "-z"}}}, reference("vector")})}};
  defs["name"] = {{"type", "string"}, {"pattern", "^[A-Za-z0-9_.-]+$"}};
  defs["new_name"] = {{"pattern", "^[A-Za-z0-9_-]+$"}, {"not", {{"const", "ground"}}}};
  for (const FieldTable* table : all_field_tables())
    if (table != &model_fields()) defs[definition_name(table->title)] = table_schema(*table);
  defs["joint"] = kinds_schema(joint_tables());
  defs["load"] = kinds_schema(load_tables());
  defs["material"] = kinds_schema(material_tables());
  defs["section"] = kinds_schema(section_tables());
  defs["fibre"] = kinds_schema(fibre_tables());
  const json selection = {{"anyOf", json::array({{{"type", "string"}}, reference("selection")})}};
  defs["selections"] = {{"anyOf", json::array({selection, list_of(selection, 1, 0)})}};
  return defs;
}

}  // namespace

std::string json_schema() {
  json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"title", "Polhode model file"}};
  const json root = table_schema(model_fields());
  for (const auto& [key, value] : root.items()) schema[key] = value;
  schema["$defs"] = definitions();
  return schema.dump(2) + "\n";
}

}  // namespace polhode::io
