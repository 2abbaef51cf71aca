// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/io/read/time_function.hpp>

namespace polhode::io {
namespace {

constexpr std::size_t kMaxSuggestions = 1000;

std::string expected(const Field& field) {
  std::string unit = field.dimension.si_unit();
  return field.dimension.name() + (unit.empty() ? "" : " (" + unit + ")");
}

/// Position of a part of a text value, if the file contains it literally.
SourceLocation place_within(const ReadContext& context, const SourceNode& node,
                            std::size_t offset) {
  SourceLocation place = context.tree.place_of(node);
  if (place.line == 0) return place;
  const std::string_view line = context.tree.source().line(node.line);
  std::size_t at = static_cast<std::size_t>(node.column) - 1;
  if (at < line.size() && (line[at] == '"' || line[at] == '\'')) ++at;
  if (at <= line.size() && line.substr(at).starts_with(node.text))
    place.column = static_cast<int>(at + offset) + 1;
  return place;
}

bool check_range(ReadContext& context, const SourceNode& node, const std::string& path,
                 const Field& field, double value) {
  const Range& r = field.range;
  const bool low = value < r.least || (r.above_least && value <= r.least);
  if (!low && !(value > r.most || (r.below_most && value >= r.most))) return true;
  const std::string unit = field.dimension.si_unit();
  const std::string with = unit.empty() ? "" : " " + unit;
  std::string must;
  if (std::isfinite(r.least) && std::isfinite(r.most)) {
    must = r.least == r.most ? "must be " + shown(r.least)
                             : format("must lie in {}{}, {}{}", r.above_least ? "(" : "[",
                                      shown(r.least), shown(r.most), r.below_most ? ")" : "]") +
                                   with;
  } else if (std::isfinite(r.least)) {
    must = r.least == 0.0 ? (r.above_least ? "must be positive" : "must not be negative")
                          : format("must be {} {}{}", r.above_least ? "above" : "at least",
                                   shown(r.least), with);
  } else {
    must = format("must be at most {}{}", shown(r.most), with);
  }
  std::string hint = field.meaning;
  if (r.least == 0.0 && !std::isfinite(r.most))
    hint = r.above_least ? "Give a value above 0." : "Give 0 or more.";
  context.fault(node, path, format("{}, but is {}{}", must, shown(value), with), hint);
  return false;
}

/// Whether a text ends in the word t, behind a unit: the tonne, where the time may be meant.
bool ends_in_tonne(const std::string& text, const Expression& expression) {
  const auto last = text.find_last_not_of(' ');
  if (!expression.written_unit() || last == std::string::npos || last == 0 || text[last] != 't')
    return false;
  const char before = text[last - 1];
  return before == '*' || before == ' ';
}

/// Reports the dimension of the value and the expected one.
void wrong_dimension(ReadContext& context, const SourceNode& node, const std::string& path,
                     const Field& field, const Expression& expression) {
  std::string hint = "Give it in a unit of that dimension.";
  if (field.dimension.matches(dimensions::kAcceleration) &&
      expression.dimension().matches(dimensions::kMass))
    hint = "The unit g is the gram; standard gravity is g0.";
  if (field.dimension.is_none()) hint = "Give it without a unit.";
  if (ends_in_tonne(node.text, expression))
    hint = "Behind a unit t is the tonne: the unit is last in an expression of the time t, 5*t kN.";
  context.fault(node, path,
                format("expects {}, but {} is {}", expected(field), quote(node.text),
                       expression.dimension().name()),
                hint);
}

/// Factor to SI, or an error.
std::optional<double> si_factor(ReadContext& context, const SourceNode& node,
                                const std::string& path, const Field& field,
                                const Expression& expression) {
  const auto& unit = expression.written_unit();
  if (unit && unit->has_hertz && std::abs(field.dimension.angle) > 0.5) {
    context.fault(node, path, "Hz is ambiguous for " + field.dimension.name(),
                  "Write rad/s, deg/s, rpm or rev/s.");
    return std::nullopt;
  }
  const std::optional<double> factor = expression.factor_to_si(field.dimension, context.units);
  if (!factor) wrong_dimension(context, node, path, field, expression);
  return factor;
}

bool check_list(ReadContext& context, const SourceNode& node, const std::string& path,
                std::size_t count, const std::string& wanted, const std::string& hint) {
  if (node.is_list() && (count == 0 || node.children.size() == count)) return true;
  const std::string found = node.is_list() && !node.children.empty()
                                ? format("a list of {}", node.children.size())
                                : node.description();
  context.fault(node, path, format("expects {}, but is {}", wanted, found), hint);
  return false;
}

}  // namespace

std::string shown(double value) { return format("{:.6g}", value); }

void ReadContext::fault(const SourceNode& node, const std::string& path, std::string what,
                        std::string hint) {
  diagnostics.add(tree.place_of(node), path, std::move(what), std::move(hint));
}

std::vector<std::string> ReadContext::body_names() const {
  std::vector<std::string> names = {"ground"};
  for (const BodySpec& body : model.bodies)  // nodes of beams: their ends represent them
    if (body.node_of.empty()) names.push_back(body.name);
  for (const BeamSpec& beam : model.beams)
    for (const char* end : {".start", ".end"}) names.push_back(beam.name + end);
  return names;
}

std::vector<std::string> ReadContext::joint_names() const {
  std::vector<std::string> names;
  for (const JointSpec& joint : model.joints) names.push_back(joint.name);
  return names;
}

std::vector<std::string> ReadContext::load_names() const {
  std::vector<std::string> names;
  for (const LoadSpec& load : model.loads) names.push_back(load.name);
  return names;
}

std::vector<std::string> ReadContext::material_names() const {
  std::vector<std::string> names;
  for (const MaterialSpec& material : model.materials) names.push_back(material.name);
  return names;
}

std::vector<std::string> ReadContext::solid_names() const {
  std::vector<std::string> names;
  for (const SolidSpec& solid : model.solids) names.push_back(solid.name);
  return names;
}

std::shared_ptr<const Expression> read_expression(ReadContext& context, const SourceNode& node,
                                                  const std::string& path, bool allow_time) {
  if (!node.is_text()) {
    context.fault(node, path, "expects a number, but is " + node.description(),
                  "Write one number.");
    return nullptr;
  }
  std::string lower = node.text;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* word : {".inf", "-.inf", "+.inf", ".nan", "inf", "-inf", "nan", "infinity"}) {
    if (lower != word) continue;
    context.fault(node, path, quote(node.text) + " is no finite number", "Give a finite number.");
    return nullptr;
  }
  ExpressionFault fault;
  auto expression =
      Expression::parse(node.text, context.variables, context.units, allow_time, fault);
  if (!expression) {
    context.diagnostics.add(place_within(context, node, fault.offset), path, fault.what, fault.hint,
                            static_cast<int>(fault.length));
    return nullptr;
  }
  if (!expression->depends_on_time() && !std::isfinite((*expression)(0.0))) {
    context.fault(node, path, quote(node.text) + " is no finite number",
                  "Look for a division by zero or a root of a negative number.");
    return nullptr;
  }
  return expression;
}

std::optional<double> read_number(ReadContext& context, const SourceNode& node,
                                  const std::string& path, const Field& field) {
  const auto expression = read_expression(context, node, path, false);
  if (!expression) return std::nullopt;
  const std::optional<double> factor = si_factor(context, node, path, field, *expression);
  if (!factor) return std::nullopt;
  const double value = *factor * (*expression)(0.0);
  if (!std::isfinite(value)) {
    context.fault(node, path, quote(node.text) + " is too large", "Check its unit.");
    return std::nullopt;
  }
  if (!check_range(context, node, path, field, value)) return std::nullopt;
  return value;
}

namespace {

TimeFunctionPtr read_table(ReadContext& context, const SourceNode& node, const std::string& path,
                           const Field& field) {
  Section section(context, node, context.tree.place_of(node), path, time_table_fields());
  const std::string way = section.choice("interpolation").value_or("linear");
  const bool periodic = section.boolean("periodic").value_or(false);
  const SourceNode* points = section.find("table");
  if (!points) return nullptr;
  const std::string wanted = "a list [[t, value], ...] of at least two points";
  const char* example = "Write table: [[0, 1], [2, 5]].";
  if (!check_list(context, *points, section.path("table"), 0, wanted, example)) return nullptr;
  const Field time{.name = "t", .dimension = dimensions::kTime, .meaning = "Time."};
  std::vector<double> times, values;
  for (const SourceNode& point : points->children) {
    if (!check_list(context, point, section.path("table"), 2, "points [t, value]", example))
      return nullptr;
    const auto t = read_number(context, point.children[0], section.path("table"), time);
    const auto v = read_number(context, point.children[1], section.path("table"), field);
    if (!t || !v) return nullptr;
    if (!times.empty() && !(*t > times.back())) {
      context.fault(
          point.children[0], section.path("table"),
          format("the times must increase, but {} s follows {} s", shown(*t), shown(times.back())),
          "Sort the points, and give each time once.");
      return nullptr;
    }
    times.push_back(*t);
    values.push_back(*v);
  }
  if (times.size() < 2) {
    context.fault(*points, section.path("table"), "expects " + wanted, example);
    return nullptr;
  }
  const auto interpolation = way == "cubic"  ? Interpolation::kCubic
                             : way == "step" ? Interpolation::kStep
                                             : Interpolation::kLinear;
  const double size = std::max(std::abs(values.front()), std::abs(values.back()));
  if (periodic && interpolation != Interpolation::kStep &&
      std::abs(values.front() - values.back()) > 1e-9 * size) {
    context.fault(
        points->children.back().children[1], section.path("table"),
        format("a periodic table must end at the value it starts with, {}, but ends at {}",
               shown(values.front()), shown(values.back())),
        "Add the first value once more at the end of the period.");
    return nullptr;
  }
  return std::make_shared<TableFunction>(std::move(times), std::move(values), interpolation,
                                         periodic);
}

}  // namespace

TimeFunctionPtr read_time_number(ReadContext& context, const SourceNode& node,
                                 const std::string& path, const Field& field) {
  if (node.is_map() && node.find("controller")) return read_controlled_value(context, node, path);
  if (node.is_map()) return read_table(context, node, path, field);
  const auto expression = read_expression(context, node, path, true);
  if (!expression) return nullptr;
  const std::optional<double> factor = si_factor(context, node, path, field, *expression);
  if (!factor) return nullptr;
  if (expression->depends_on_time())
    return std::make_shared<ExpressionFunction>(expression, *factor);
  const double value = *factor * (*expression)(0.0);
  if (!check_range(context, node, path, field, value)) return nullptr;
  return std::make_shared<ConstantFunction>(value);
}

std::optional<std::vector<double>> read_numbers(ReadContext& context, const SourceNode& node,
                                                const std::string& path, const Field& field,
                                                std::size_t count) {
  if (!check_list(context, node, path, count, format("a list of {} numbers", count),
                  count == 3 ? "Write [x, y, z]." : "Write [w, x, y, z]."))
    return std::nullopt;
  std::vector<double> values;
  for (const SourceNode& child : node.children)
    if (const auto value = read_number(context, child, path, field)) values.push_back(*value);
  if (values.size() != node.children.size()) return std::nullopt;
  return values;
}

std::optional<std::vector<double>> read_number_list(ReadContext& context, const SourceNode& node,
                                                    const std::string& path, const Field& field) {
  std::vector<double> values;
  if (!node.is_list()) {
    if (const auto value = read_number(context, node, path, field)) values.push_back(*value);
    if (values.empty()) return std::nullopt;
    return values;
  }
  if (!check_list(context, node, path, node.children.empty() ? 1 : 0, "a list of numbers",
                  "Write at least one number."))
    return std::nullopt;
  for (const SourceNode& child : node.children)
    if (const auto value = read_number(context, child, path, field)) values.push_back(*value);
  if (values.size() != node.children.size()) return std::nullopt;
  return values;
}

std::optional<Vec3> read_vector(ReadContext& context, const SourceNode& node,
                                const std::string& path, const Field& field) {
  const auto values = read_numbers(context, node, path, field, 3);
  if (!values) return std::nullopt;
  return Vec3((*values)[0], (*values)[1], (*values)[2]);
}

std::optional<TimeVector> read_time_vector(ReadContext& context, const SourceNode& node,
                                           const std::string& path, const Field& field) {
  if (!check_list(context, node, path, 3, "a list of 3 numbers", "Write [x, y, z]."))
    return std::nullopt;
  TimeVector functions;
  bool sound = true;
  for (std::size_t k = 0; k < 3; ++k) {
    functions[k] = read_time_number(context, node.children[k], path, field);
    sound = sound && functions[k];
  }
  if (!sound) return std::nullopt;
  return functions;
}

std::optional<std::array<Vec3, 2>> read_vector_pair(ReadContext& context, const SourceNode& node,
                                                    const std::string& path, const Field& field) {
  const bool is_pair = node.is_list() && node.children.size() == 2;
  if (!is_pair) {
    check_list(context, node, path, 2, "two vectors, on a and on b",
               "Write [[x, y, z], [x, y, z]].");
    return std::nullopt;
  }
  const auto a = read_vector(context, node.children[0], path, field);
  const auto b = read_vector(context, node.children[1], path, field);
  if (!a || !b) return std::nullopt;
  return std::array<Vec3, 2>{*a, *b};
}

std::optional<Vec3> read_direction(ReadContext& context, const SourceNode& node,
                                   const std::string& path) {
  if (node.is_text()) {
    const bool minus = node.text.starts_with('-');
    const std::string letter = minus ? node.text.substr(1) : node.text;
    if (letter == "x" || letter == "y" || letter == "z")
      return Vec3((minus ? -1.0 : 1.0) * Vec3::Unit(letter[0] - 'x'));
    context.fault(node, path, quote(node.text) + " is no direction",
                  "Use x, y, z, -x, -y, -z or three numbers.");
    return std::nullopt;
  }
  if (!check_list(context, node, path, 3, "a direction",
                  "Use x, y, z, -x, -y, -z or three numbers."))
    return std::nullopt;
  // The unit of a direction is irrelevant.
  Vec3 direction;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto component = read_expression(context, node.children[k], path, false);
    if (!component) return std::nullopt;
    direction[static_cast<int>(k)] = (*component)(0.0);
  }
  const double largest = direction.cwiseAbs().maxCoeff();
  if (!(largest > 0.0)) {
    context.fault(node, path, "has length 0",
                  "Give any vector that is not zero; its length has no effect.");
    return std::nullopt;
  }
  return Vec3((direction / largest).normalized());
}

std::optional<std::array<Vec3, 2>> read_direction_pair(ReadContext& context, const SourceNode& node,
                                                       const std::string& path) {
  if (!check_list(context, node, path, 2, "two directions, on a and on b",
                  "Write [x, y], for example."))
    return std::nullopt;
  const auto a = read_direction(context, node.children[0], path);
  const auto b = read_direction(context, node.children[1], path);
  if (!a || !b) return std::nullopt;
  return std::array<Vec3, 2>{*a, *b};
}

std::optional<bool> read_boolean(ReadContext& context, const SourceNode& node,
                                 const std::string& path) {
  if (node.is_text() && !node.in_quotes) {
    if (node.text == "true") return true;
    if (node.text == "false") return false;
  }
  const std::string with = node.in_quotes ? " in quotes" : "";
  context.fault(node, path, "expects true or false, but is " + node.description() + with,
                with.empty() ? "Write true or false." : "Write it without quotes.");
  return std::nullopt;
}

std::optional<std::string> read_text(ReadContext& context, const SourceNode& node,
                                     const std::string& path) {
  if (node.is_text()) return node.text;
  context.fault(node, path, "expects a text, but is " + node.description(), "Write a text.");
  return std::nullopt;
}

std::optional<std::string> read_choice(ReadContext& context, const SourceNode& node,
                                       const std::string& path,
                                       const std::vector<std::string>& choices) {
  if (!node.is_text()) {
    context.fault(node, path, "expects a word, but is " + node.description(),
                  "Use one of: " + name_list(choices) + ".");
    return std::nullopt;
  }
  if (std::find(choices.begin(), choices.end(), node.text) != choices.end()) return node.text;
  context.fault(node, path, quote(node.text) + " is not known",
                did_you_mean(node.text, choices) + "Use one of: " + name_list(choices) + ".");
  return std::nullopt;
}

std::optional<std::vector<std::string>> read_choices(ReadContext& context, const SourceNode& node,
                                                     const std::string& path, const Field& field) {
  if (!check_list(context, node, path, 0, "a list of: " + name_list(field.choices),
                  format("Write [{}], for example.", field.choices.front())))
    return std::nullopt;
  std::vector<std::string> found;
  for (const SourceNode& child : node.children) {
    const auto word = read_choice(context, child, path, field.choices);
    if (!word) return std::nullopt;
    if (std::find(found.begin(), found.end(), *word) != found.end()) {
      context.fault(child, path, quote(*word) + " stands twice", "Keep one of them.");
      return std::nullopt;
    }
    found.push_back(*word);
  }
  std::vector<std::string> sorted;
  for (const std::string& choice : field.choices)
    if (std::find(found.begin(), found.end(), choice) != found.end()) sorted.push_back(choice);
  return sorted;
}

std::optional<int> read_body(ReadContext& context, const SourceNode& node,
                             const std::string& path) {
  if (!node.is_text()) {
    context.fault(node, path, "expects the name of a body, but is " + node.description(),
                  "Write the name of one body.");
    return std::nullopt;
  }
  if (node.text == "ground") return kGround;
  const auto found = context.bodies.find(node.text);
  if (found != context.bodies.end()) return found->second;
  // With very many errors the search for suggestions would take minutes.
  std::string hint = "Give the name of a body.";
  if (context.diagnostics.size() < kMaxSuggestions) {
    const std::vector<std::string> names = context.body_names();
    hint = did_you_mean(node.text, names) + "Bodies: " + name_list(names) + ".";
  }
  context.fault(node, path, "unknown body " + quote(node.text), hint);
  return std::nullopt;
}

std::optional<std::array<int, 2>> read_body_pair(ReadContext& context, const SourceNode& node,
                                                 const std::string& path) {
  if (!check_list(context, node, path, 2, "two bodies", "Write [a, b].")) return std::nullopt;
  const auto a = read_body(context, node.children[0], path);
  const auto b = read_body(context, node.children[1], path);
  if (!a || !b) return std::nullopt;
  if (*a == *b) {
    context.fault(node, path, "both bodies are " + quote(node.children[0].text),
                  "Name two different bodies; one may be ground.");
    return std::nullopt;
  }
  return std::array<int, 2>{*a, *b};
}

}  // namespace polhode::io
