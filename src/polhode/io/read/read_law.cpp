// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/io/read/time_function.hpp>

namespace polhode::io {
namespace {

/// Force as a function of a coordinate, given by points.
TimeFunctionPtr read_law_table(ReadContext& context, const SourceNode& node,
                               const std::string& path, const Field& field) {
  Section section(context, node, context.tree.place_of(node), path, law_table_fields());
  const bool cubic = section.choice("interpolation").value_or("linear") == "cubic";
  const SourceNode* points = section.find("table");
  if (!points) return nullptr;
  const std::string here = section.path("table");
  const std::string wanted =
      format("expects a list [[{}, value], ...] of at least two points", field.variable);
  const char* example = "Write table: [[0, 0], [0.1, 50]].";
  if (!points->is_list() || points->children.size() < 2) {
    context.fault(*points, here, wanted, example);
    return nullptr;
  }
  const Field abscissa{.name = field.variable, .dimension = field.of, .meaning = "Abscissa."};
  std::vector<double> at, values;
  for (const SourceNode& point : points->children) {
    if (!point.is_list() || point.children.size() != 2) {
      context.fault(point, here, wanted, example);
      return nullptr;
    }
    const auto x = read_number(context, point.children[0], here, abscissa);
    const auto y = read_number(context, point.children[1], here, field);
    if (!x || !y) return nullptr;
    if (!at.empty() && !(*x > at.back())) {
      context.fault(point.children[0], here,
                    format("{} must increase, but {} follows {}", field.variable, shown(*x),
                           shown(at.back())),
                    "Sort the points, and give each one once.");
      return nullptr;
    }
    at.push_back(*x);
    values.push_back(*y);
  }
  return std::make_shared<TableFunction>(std::move(at), std::move(values),
                                         cubic ? Interpolation::kCubic : Interpolation::kLinear,
                                         false);
}

}  // namespace

TimeFunctionPtr read_law(ReadContext& context, const SourceNode& node, const std::string& path,
                         const Field& field) {
  if (node.is_map()) return read_law_table(context, node, path, field);
  if (!node.is_text()) {
    context.fault(node, path, "expects an expression or a table, but is " + node.description(),
                  format("Write an expression of {}, or table: [[{}, value], ...].", field.variable,
                         field.variable));
    return nullptr;
  }
  ExpressionFault fault;
  const auto expression = Expression::parse(node.text, context.variables, context.units,
                                            field.variable, context.units.factor(field.of), fault);
  if (!expression) {
    context.fault(node, path, fault.what, fault.hint);
    return nullptr;
  }
  const std::optional<double> factor = expression->factor_to_si(field.dimension, context.units);
  if (!factor) {
    context.fault(node, path,
                  format("expects {}, but {} is {}", field.dimension.name(), quote(node.text),
                         expression->dimension().name()),
                  "Give it in a unit of that dimension.");
    return nullptr;
  }
  const double somewhere = field.variable == "l" ? 1.0 : 0.0;  // distances are positive
  if (!std::isfinite((*expression)(somewhere))) {
    context.fault(node, path, format("is no finite number at {} = {}", field.variable, somewhere),
                  "Look for a division by zero or a root of a negative number.");
    return nullptr;
  }
  return std::make_shared<ExpressionFunction>(expression, *factor);
}

}  // namespace polhode::io
