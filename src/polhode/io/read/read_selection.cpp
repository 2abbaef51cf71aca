// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>

namespace polhode::io {
namespace {

using Kind = solids::Selection::Kind;

bool read_plane(ReadContext& context, const SourceNode& node, const std::string& path,
                solids::Selection& selection) {
  Section section(context, node, context.tree.place_of(node), path, plane_fields());
  const auto normal = section.direction("axis");
  const SourceNode* at = section.find("at");
  if (!normal || !at) return false;
  selection.normal = *normal;
  if (at->is_text() && (at->text == "min" || at->text == "max")) {
    selection.level =
        at->text == "min" ? solids::Selection::Level::kMin : solids::Selection::Level::kMax;
    return true;
  }
  if (const std::string guess =
          at->is_text() ? closest(at->text, {"min", "max", "minimum", "maximum"}) : "";
      !guess.empty()) {
    section.fault("at", quote(at->text) + " is not known",
                  format("Did you mean '{}'? Give min, max or a number.", guess.substr(0, 3)));
    return false;
  }
  const auto value = section.number("at");
  selection.value = value.value_or(0.0);
  return value.has_value();
}

bool read_box(ReadContext& context, const SourceNode& node, const std::string& path,
              solids::Selection& selection) {
  Section section(context, node, context.tree.place_of(node), path, box_fields());
  const auto from = section.vector("from"), to = section.vector("to");
  if (!from || !to) return false;
  selection.least = from->cwiseMin(*to);
  selection.most = from->cwiseMax(*to);
  return true;
}

bool read_sphere(ReadContext& context, const SourceNode& node, const std::string& path,
                 solids::Selection& selection) {
  Section section(context, node, context.tree.place_of(node), path, sphere_fields());
  const auto centre = section.vector("centre");
  const auto radius = section.number("radius");
  selection.on_surface = section.boolean("surface").value_or(false);
  if (!centre || !radius) return false;
  selection.centre = *centre;
  selection.radius = *radius;
  return true;
}

std::optional<solids::Selection> read_one(ReadContext& context, const SourceNode& node,
                                          const std::string& path) {
  solids::Selection selection;
  if (node.is_text()) {
    selection.kind = Kind::kSet;
    selection.set = node.text;
    return selection;
  }
  Section section(context, node, context.tree.place_of(node), path, selection_fields());
  if (!node.is_map()) return std::nullopt;
  std::string found;
  for (const char* name : {"set", "plane", "box", "sphere", "nodes"}) {
    if (!section.has(name)) continue;
    if (!found.empty()) {
      section.fault(name, format("cannot be combined with '{}'", found),
                    "Give one of them; several selections form a list.");
      return std::nullopt;
    }
    found = name;
  }
  if (found.empty()) {
    if (!section.has_unknown_key())
      section.fault("selects nothing", "Use one of: set, plane, box, sphere, nodes.");
    return std::nullopt;
  }
  if (section.has("tolerance") && (found == "set" || found == "nodes"))
    section.fault("tolerance", format("cannot be combined with '{}'", found), "Leave it out.");
  selection.tolerance = section.number("tolerance").value_or(0.0);
  const SourceNode& value = *section.find(found);
  bool sound = true;
  if (found == "set") {
    selection.kind = Kind::kSet;
    const auto name = section.text("set");
    sound = name.has_value();
    if (sound) selection.set = *name;
  } else if (found == "nodes") {
    selection.kind = Kind::kNodes;
    const auto indices = read_indices(context, value, section.path("nodes"));
    sound = indices.has_value();
    if (sound) selection.nodes = *indices;
  } else if (found == "plane") {
    selection.kind = Kind::kPlane;
    sound = read_plane(context, value, section.path("plane"), selection);
  } else if (found == "box") {
    selection.kind = Kind::kBox;
    sound = read_box(context, value, section.path("box"), selection);
  } else {
    selection.kind = Kind::kSphere;
    sound = read_sphere(context, value, section.path("sphere"), selection);
  }
  if (!sound) return std::nullopt;
  return selection;
}

}  // namespace

std::optional<int> read_index(ReadContext& context, const SourceNode& node,
                              const std::string& path) {
  static const Field field{.name = "index", .meaning = "Number of a node.", .range = kNotNegative};
  const auto value = read_number(context, node, path, field);
  if (!value) return std::nullopt;
  if (*value == std::floor(*value) && *value < 1e9) return static_cast<int>(*value);
  context.fault(node, path, "must be a whole number, but is " + shown(*value),
                "Nodes are numbered 0, 1, 2, ...");
  return std::nullopt;
}

std::optional<std::vector<int>> read_indices(ReadContext& context, const SourceNode& node,
                                             const std::string& path) {
  if (!node.is_list() || node.children.empty()) {
    context.fault(node, path, "expects a list of whole numbers, but is " + node.description(),
                  "Write [0, 1, 2], for example.");
    return std::nullopt;
  }
  std::vector<int> indices;
  for (const SourceNode& child : node.children) {
    const auto index = read_index(context, child, path);
    if (!index) return std::nullopt;
    indices.push_back(*index);
  }
  return indices;
}

std::optional<std::vector<solids::Selection>> read_selections(ReadContext& context,
                                                              const SourceNode& node,
                                                              const std::string& path) {
  std::vector<solids::Selection> selections;
  if (!node.is_list()) {
    auto one = read_one(context, node, path);
    if (!one) return std::nullopt;
    selections.push_back(std::move(*one));
    return selections;
  }
  if (node.children.empty()) {
    context.fault(node, path, "is an empty list", "Name a set, or give plane, box or sphere.");
    return std::nullopt;
  }
  bool sound = true;
  for (std::size_t k = 0; k < node.children.size(); ++k) {
    auto one = read_one(context, node.children[k], format("{}.{}", path, k));
    sound = sound && one;
    if (one) selections.push_back(std::move(*one));
  }
  if (!sound) return std::nullopt;
  return selections;
}

}  // namespace polhode::io
