// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <sstream>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/read/gradient_parameter.hpp>
#include <polhode/io/read/read_context.hpp>

namespace polhode::io {

namespace {

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  std::stringstream stream(path);
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  return parts;
}

/// The path with its unknown keys replaced by the closest ones, or "" if there is none for one.
std::string nearest_path(const SourceNode& root, const std::string& path) {
  const std::vector<std::string> parts = parts_of(path);
  const auto names_of = [](const SourceNode& node) {
    std::vector<std::string> names;
    for (const SourceNode::Key& key : node.keys) names.push_back(key.name);
    return names;
  };
  if (parts.size() == 1) {
    const SourceNode* variables = root.find("variables");
    return variables ? closest(path, names_of(*variables)) : std::string();
  }
  const SourceNode* node = &root;
  std::string near;
  for (std::string part : parts) {
    if (node->is_map()) {
      if (!node->find(part)) part = closest(part, names_of(*node));
      node = node->find(part);
    } else if (node->is_list()) {
      const bool counts = part.size() == 1 && part[0] >= '0' && part[0] <= '9';
      const std::size_t index = counts ? static_cast<std::size_t>(part[0] - '0') : std::size_t{10};
      node = index < node->children.size() ? &node->children[index] : nullptr;
    } else {
      node = nullptr;
    }
    if (!node) return {};
    near += (near.empty() ? "" : ".") + part;
  }
  return near;
}

const SourceNode* node_at(const SourceNode& root, const std::string& path) {
  const std::vector<std::string> parts = parts_of(path);
  const SourceNode* variables = root.find("variables");
  if (parts.size() == 1 && variables && variables->find(parts[0])) return variables->find(parts[0]);
  const SourceNode* node = &root;
  for (const std::string& part : parts) {
    if (node->is_list()) {
      const bool counts = !part.empty() && part.size() < 9 &&
                          part.find_first_not_of("0123456789") == std::string::npos;
      const std::size_t index = counts ? std::stoul(part) : node->children.size();
      node = index < node->children.size() ? &node->children[index] : nullptr;
    } else {
      node = node->is_map() ? node->find(part) : nullptr;
    }
    if (!node) return nullptr;
  }
  return node;
}

}  // namespace

GradientParameter gradient_parameter(const ModelText& source, const std::string& path) {
  SourceTree tree = SourceTree::parse(source.text, source.shown);
  Diagnostics diagnostics(tree.source());
  const std::string folder = std::filesystem::path(source.file).parent_path().string();
  Overrides overrides = source.overrides;
  static_cast<void>(expand_import(tree, folder, folder, overrides, diagnostics));
  for (const std::string& text : overrides) {
    const std::size_t equals = text.find('=');
    if (equals != std::string::npos)
      tree.apply_override(text.substr(0, equals), text.substr(equals + 1), diagnostics);
  }
  ReadContext context{.tree = tree, .diagnostics = diagnostics};
  if (const SourceNode* node = tree.root().find("units")) read_units(context, *node);
  if (const SourceNode* node = tree.root().find("variables")) read_variables(context, *node);
  diagnostics.throw_if_any();
  const SourceNode* node = node_at(tree.root(), path);
  if (!node) {
    const std::string near = nearest_path(tree.root(), path);
    throw InputError(
        path, "is not in the model",
        (near.empty() ? std::string() : format("Did you mean '{}'? ", near)) +
            "Name a variable, or keys and list indices joined by dots, of a number that "
            "the file gives");
  }
  if (!node->is_text())
    throw InputError(path, format("is {}, no number", node->description()),
                     "Name one of its numbers, such as its first one by .0");
  ExpressionFault fault;
  const auto expression =
      Expression::parse(node->text, context.variables, context.units, true, fault);
  if (!expression)
    throw InputError(path, format("is the text '{}', no number", node->text),
                     "Name a number of the model");
  if (expression->depends_on_time())
    throw InputError(path, format("is a function of time, '{}'", node->text),
                     "Give its numbers names among the variables, and name one of these");
  GradientParameter parameter{.path = path, .value = (*expression)(0.0)};
  if (expression->certainty() == Certainty::kKnown) {
    parameter.unit = expression->dimension().si_unit();
    if (parameter.unit.empty()) parameter.unit = "-";
  }
  const std::string unit =
      parameter.unit.empty() || parameter.unit == "-" ? std::string() : " " + parameter.unit;
  parameter.at = [source, path, unit](double value) {
    ModelText other = source;
    other.overrides.push_back(format("{}={:.17g}{}", path, value, unit));
    return read_model_text(other.text, other.file, other.overrides);
  };
  return parameter;
}

}  // namespace polhode::io
