// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/geometry/shapes.hpp>
#include <polhode/io/read/read_context.hpp>

namespace polhode::io {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> shape_names() {
  std::vector<std::string> names;
  for (const geometry::ShapeKind& kind : geometry::shape_kinds()) names.push_back(kind.name);
  for (const char* name : {"mesh", "hull", "height_field", "plane"}) names.emplace_back(name);
  return names;
}

/// Sizes as a list in order, as a map by name, or, if there is only one, as a number.
std::optional<std::vector<double>> read_sizes(ReadContext& context, const SourceNode& node,
                                              const std::string& path,
                                              const geometry::ShapeKind& kind) {
  const Field& field = shape_fields().at(kind.name);
  std::string order;
  for (const geometry::ShapeSize& size : kind.sizes)
    order += (order.empty() ? "" : ", ") + size.name;
  std::vector<double> sizes;
  if (node.is_map()) {
    FieldTable table{"shape " + kind.name, kind.meaning, {}};
    for (const geometry::ShapeSize& size : kind.sizes) {
      table.fields.push_back({.name = size.name,
                              .kind = FieldKind::kNumber,
                              .dimension = dimensions::kLength,
                              .meaning = sentence(size.meaning),
                              .required = true,
                              .range = kPositive});
    }
    Section section(context, node, context.tree.place_of(node), path, table);
    for (const geometry::ShapeSize& size : kind.sizes)
      if (const auto value = section.number(size.name)) sizes.push_back(*value);
  } else if (node.is_text() && kind.sizes.size() == 1) {
    if (const auto value = read_number(context, node, path, field)) sizes.push_back(*value);
  } else if (!node.is_list() || node.children.size() != kind.sizes.size()) {
    const std::string found =
        node.is_list() ? format("has {}", node.children.size()) : "is " + node.description();
    context.fault(node, path,
                  format("expects {} size{}, but {}", kind.sizes.size(),
                         kind.sizes.size() == 1 ? "" : "s", found),
                  format("Write [{}]; all are full lengths.", order));
    return std::nullopt;
  } else {
    for (const SourceNode& child : node.children)
      if (const auto value = read_number(context, child, path, field)) sizes.push_back(*value);
  }
  if (sizes.size() != kind.sizes.size()) return std::nullopt;
  try {
    geometry::check_shape_sizes(path, kind, sizes);
  } catch (const InputError& error) {
    context.fault(node, path, error.what_is_wrong(), error.hint());
    return std::nullopt;
  }
  return sizes;
}

bool read_mesh(ReadContext& context, const SourceNode& node, const std::string& path,
               ShapeSpec& shape) {
  const SourceNode* file = &node;
  if (!node.is_text()) {
    Section section(context, node, context.tree.place_of(node), path, mesh_fields());
    shape.scale = section.number("scale").value_or(context.units.length);
    file = section.find("file");
    if (!file || !section.text("file")) return false;
  } else {
    shape.scale = context.units.length;
  }
  const auto full = read_file_name(context, *file, path);
  if (!full) return false;
  shape.file = *full;
  return true;
}

bool read_hull(ReadContext& context, const SourceNode& node, const std::string& path,
               ShapeSpec& shape) {
  Section section(context, node, context.tree.place_of(node), path, hull_fields());
  if (!node.is_map()) return false;
  if (section.refuse_both("points", "file", "Give one of them.")) return false;
  if (section.has("scale") && section.misses("file"))
    section.fault("scale", "requires 'file'", "Leave it out; points carry their own units.");
  shape.scale = section.number("scale").value_or(context.units.length);
  if (const SourceNode* file = section.find("file")) {
    const auto full = read_file_name(context, *file, section.path("file"));
    if (full) shape.file = *full;
    return full.has_value();
  }
  const SourceNode* points = section.find("points");
  if (!points) {
    if (!section.has_unknown_key())
      section.fault("has no points", "Give 'points', or 'file' with a surface.");
    return false;
  }
  if (!points->is_list()) {
    context.fault(*points, section.path("points"),
                  "expects a list of points, but is " + points->description(),
                  "Write [[0, 0, 0], [1, 0, 0], ...].");
    return false;
  }
  bool sound = true;
  for (const SourceNode& child : points->children) {
    const auto X = read_vector(context, child, section.path("points"), hull_fields().at("points"));
    sound = sound && X;
    if (X) shape.points.push_back(*X);
  }
  return sound;
}

bool read_height_field(ReadContext& context, const SourceNode& node, const std::string& path,
                       ShapeSpec& shape) {
  Section section(context, node, context.tree.place_of(node), path, height_field_fields());
  if (!node.is_map()) return false;
  const auto spacing = section.number("spacing");
  const SourceNode* rows = section.find("heights");
  if (!rows) return false;
  const std::string where = section.path("heights");
  const char* hint = "Write [[0, 0.1, 0], [0, 0.2, 0]], for example.";
  if (!rows->is_list() || rows->children.size() < 2) {
    context.fault(*rows, where,
                  "expects a list of at least two rows, but is " + rows->description(), hint);
    return false;
  }
  for (const SourceNode& row : rows->children) {
    if (!row.is_list() || row.children.size() < 2) {
      context.fault(row, where,
                    "expects rows of at least two heights, but has " + row.description(), hint);
      return false;
    }
    if (row.children.size() != rows->children.front().children.size()) {
      context.fault(row, where,
                    format("the first row has {} heights, but this one {}",
                           rows->children.front().children.size(), row.children.size()),
                    "Give all rows the same length.");
      return false;
    }
    for (const SourceNode& height : row.children) {
      const auto z = read_number(context, height, where, height_field_fields().at("heights"));
      if (!z) return false;
      shape.heights.push_back(*z);
    }
  }
  if (!spacing) return false;
  shape.columns = static_cast<int>(rows->children.front().children.size());
  shape.spacing = *spacing;
  return true;
}

std::optional<ShapeSpec> read_shape(ReadContext& context, const SourceNode& node,
                                    const std::string& path) {
  const FieldTable& table = shape_fields();
  const std::vector<std::string> names = shape_names();
  ShapeSpec shape;
  shape.place = context.tree.place_of(node);
  Section section(context, node, shape.place, path, table);
  if (!node.is_map()) return std::nullopt;
  const SourceNode* sizes = nullptr;
  for (const std::string& name : names) {
    const SourceNode* value = section.find(name);
    if (!value) continue;
    if (sizes) {
      section.fault(name, format("cannot be combined with '{}'", shape.type),
                    "Give one kind to a shape; several shapes form a list.");
      return std::nullopt;
    }
    sizes = value;
    shape.type = name;
  }
  if (!sizes && section.has_unknown_key()) return std::nullopt;  // Already reported.
  if (!sizes) {
    section.fault("has no kind", "Use one of: " + name_list(names) + ".");
    return std::nullopt;
  }
  if (const auto p = section.vector("position")) shape.position = *p;
  if (const SourceNode* value = section.find("orientation"))
    if (const auto q = read_orientation(context, *value, section.path("orientation")))
      shape.orientation = *q;
  shape.density = section.number("density");
  if (const SourceNode* value = section.find("contact"))
    shape.contact = read_contact_side(context, *value, section.path("contact"));
  if (shape.type == "mesh") {
    if (!read_mesh(context, *sizes, section.path("mesh"), shape)) return std::nullopt;
  } else if (shape.type == "hull") {
    if (!read_hull(context, *sizes, section.path("hull"), shape)) return std::nullopt;
  } else if (shape.type == "height_field") {
    if (!read_height_field(context, *sizes, section.path("height_field"), shape))
      return std::nullopt;
  } else if (shape.type == "plane") {
    const auto normal = read_direction(context, *sizes, section.path("plane"));
    if (!normal) return std::nullopt;
    shape.sizes = {normal->x(), normal->y(), normal->z()};
  } else {
    auto values = read_sizes(context, *sizes, section.path(shape.type),
                             *geometry::find_shape_kind(shape.type));
    if (!values) return std::nullopt;
    shape.sizes = std::move(*values);
  }
  return shape;
}

}  // namespace

std::optional<std::string> read_file_name(ReadContext& context, const SourceNode& node,
                                          const std::string& path) {
  const auto name = read_text(context, node, path);
  if (!name) return std::nullopt;
  std::error_code ignored;
  const fs::path full = fs::path(context.folder) / fs::path(*name);
  if (!name->empty() && fs::is_regular_file(full, ignored)) return full.lexically_normal().string();
  context.fault(node, path, "there is no file " + quote(*name),
                "Give the path as seen from the model file's folder.");
  return std::nullopt;
}

std::vector<ShapeSpec> read_shapes(ReadContext& context, const SourceNode& node,
                                   const std::string& path) {
  std::vector<ShapeSpec> shapes;
  if (!node.is_list()) {
    if (auto shape = read_shape(context, node, path)) shapes.push_back(std::move(*shape));
    return shapes;
  }
  if (node.children.empty())
    context.fault(node, path, "is an empty list", "Leave it out, or list a shape.");
  for (std::size_t k = 0; k < node.children.size(); ++k)
    if (auto shape = read_shape(context, node.children[k], format("{}.{}", path, k)))
      shapes.push_back(std::move(*shape));
  return shapes;
}

}  // namespace polhode::io
