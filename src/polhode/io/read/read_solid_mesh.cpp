// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>

namespace polhode::io {
namespace {

/// Reader of the source of a mesh; errors go to the context.
class SolidMeshReader {
 public:
  SolidMeshReader(ReadContext& context, const SourceNode& node, const std::string& path,
                  MeshSpec& mesh)
      : context_(context),
        node_(node),
        mesh_(mesh),
        section_(context, node, context.tree.place_of(node), path, solid_mesh_fields()) {}

  void read() {
    if (!node_.is_map()) return;
    if (!choose_source()) return;
    for (const auto& [key, source] : {std::pair("group", "file"), std::pair("scale", "file"),
                                      std::pair("elements", "inline"), std::pair("sets", "inline")})
      if (section_.has(key) && mesh_.type != source)
        section_.fault(key, format("cannot be combined with '{}'", key_of(mesh_.type)),
                       "Leave it out.");
    if (mesh_.type == "file") {
      read_file();
    } else if (mesh_.type == "inline") {
      read_inline();
    } else {
      read_generator();
    }
    if (const auto position = section_.vector("position")) mesh_.position = *position;
    if (const SourceNode* value = section_.find("orientation"))
      if (const auto q = read_orientation(context_, *value, section_.path("orientation")))
        mesh_.orientation = *q;
  }

 private:
  static std::string key_of(const std::string& type) { return type == "inline" ? "nodes" : type; }

  bool choose_source() {
    std::vector<std::string> types = {"file"};
    for (const KindTable& kind : mesh_generator_tables()) types.push_back(kind.name);
    types.emplace_back("inline");
    std::vector<std::string> keys;
    for (const std::string& type : types) {
      keys.push_back(key_of(type));
      if (!section_.has(key_of(type))) continue;
      if (!mesh_.type.empty()) {
        section_.fault(key_of(type), format("cannot be combined with '{}'", key_of(mesh_.type)),
                       "Give one source of nodes to a mesh.");
        return false;
      }
      mesh_.type = type;
    }
    if (!mesh_.type.empty()) return true;
    if (!section_.has_unknown_key())
      section_.fault("has no nodes", "Use one of: " + name_list(keys) + ".");
    return false;
  }

  void read_file() {
    const SourceNode& file = *section_.find("file");
    if (const auto name = read_file_name(context_, file, section_.path("file"))) mesh_.file = *name;
    if (const auto group = section_.text("group")) mesh_.group = *group;
    mesh_.scale = section_.number("scale").value_or(context_.units.length);
  }

  void read_inline() {
    const SourceNode& nodes = *section_.find("nodes");
    if (!nodes.is_list()) {
      context_.fault(nodes, section_.path("nodes"),
                     "expects a list of points, but is " + nodes.description(),
                     "Write [[0, 0, 0], [1, 0, 0], ...].");
    } else {
      for (const SourceNode& child : nodes.children)
        if (const auto X = read_vector(context_, child, section_.path("nodes"),
                                       solid_mesh_fields().at("nodes")))
          mesh_.nodes.push_back(*X);
    }
    const SourceNode* elements = section_.find("elements");
    if (!elements) {
      section_.fault("'elements' is missing", "Give the nodes of each element, by number.");
    } else if (!elements->is_list()) {
      context_.fault(*elements, section_.path("elements"),
                     "expects a list of elements, but is " + elements->description(),
                     "Write [[0, 1, 2, 3], ...], each with its nodes.");
    } else {
      for (std::size_t e = 0; e < elements->children.size(); ++e)
        if (auto indices = read_indices(context_, elements->children[e],
                                        format("{}.{}", section_.path("elements"), e)))
          mesh_.elements.push_back(std::move(*indices));
    }
    if (const SourceNode* sets = section_.find("sets")) read_sets(*sets);
  }

  void read_sets(const SourceNode& sets) {
    const std::string path = section_.path("sets");
    if (!sets.is_map()) {
      context_.fault(sets, path, "expects a map from names to nodes, but is " + sets.description(),
                     "Write {left: [0, 1, 2]}, for example.");
      return;
    }
    for (std::size_t k = 0; k < sets.keys.size(); ++k) {
      if (!check_name(context_, sets.keys[k], sets.children[k], path)) continue;
      const std::string& name = sets.keys[k].name;
      if (auto nodes = read_indices(context_, sets.children[k], format("{}.{}", path, name)))
        mesh_.sets[name] = std::move(*nodes);
    }
  }

  void read_generator() {
    const SourceNode& value = *section_.find(mesh_.type);
    for (const KindTable& kind : mesh_generator_tables()) {
      if (kind.name != mesh_.type) continue;
      Section section(context_, value, context_.tree.place_of(value), section_.path(mesh_.type),
                      kind.table);
      if (!value.is_map()) return;
      for (const Field& field : kind.table.fields)
        if (auto values = section.number_list(field.name))
          mesh_.parameters[field.name] = std::move(*values);
    }
  }

  ReadContext& context_;
  const SourceNode& node_;
  MeshSpec& mesh_;
  Section section_;
};

}  // namespace

void read_solid_mesh(ReadContext& context, const SourceNode& node, const std::string& path,
                     MeshSpec& mesh) {
  SolidMeshReader(context, node, path, mesh).read();
}

}  // namespace polhode::io
