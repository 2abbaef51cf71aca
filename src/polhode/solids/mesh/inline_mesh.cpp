// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/mesh/generators.hpp>

namespace polhode::solids {
namespace {

/// Sum of the squares of the distances of nodes from the middles of their edges [m²].
double bend_of_edges(const CellShape& shape, const std::vector<Vec3>& nodes,
                     const std::vector<int>& cell) {
  const auto at = [&](int local) {
    return nodes[static_cast<std::size_t>(cell[static_cast<std::size_t>(local)])];
  };
  double sum = 0.0;
  for (const CellEdge& edge : shape.edges)
    sum += (at(edge.middle) - 0.5 * (at(edge.begin) + at(edge.end))).squaredNorm();
  return sum;
}

/// Default type of cells with this number of nodes.
std::string usual_type(std::size_t nodes) {
  for (const char* name : {"hex8", "hex20", "hex27", "tet4", "tet10", "wedge6", "line2", "line3"})
    if (cell_shape(name).nodes.size() == nodes) return name;
  return {};
}

}  // namespace

Mesh inline_mesh(std::string_view where, const std::vector<Vec3>& nodes,
                 const std::vector<std::vector<int>>& elements,
                 const std::map<std::string, std::vector<int>>& sets, std::string_view type) {
  Mesh mesh;
  mesh.name = where;
  mesh.nodes = nodes;
  const int count = static_cast<int>(nodes.size());
  const auto check_node = [&](const std::string& at, int node) {
    if (node < 0 || node >= count)
      throw InputError(
          at, format("node {} does not exist; the first is 0, the last {}", node, count - 1),
          "Name nodes by their place in the list");
  };
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!nodes[i].allFinite())
      throw InputError(format("{}.nodes[{}]", where, i), "a coordinate is no finite number",
                       "Give finite coordinates");
  std::map<std::string, std::vector<std::int64_t>> places;  // in the list, by type
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const std::vector<int>& list = elements[e];
    const std::string at = format("{}.elements[{}]", where, e);
    for (int node : list) check_node(at, node);
    std::string name = type.empty() ? usual_type(list.size()) : std::string(type);
    if (name.empty() && list.size() == cell_shape("tet15").nodes.size()) {
      // Two types have as many nodes: the one that has them in the middles of its edges.
      const CellShape &tetrahedron = cell_shape("tet15"), &wedge = cell_shape("wedge15");
      name = bend_of_edges(tetrahedron, nodes, list) < bend_of_edges(wedge, nodes, list)
                 ? tetrahedron.name
                 : wedge.name;
    }
    if (name.empty())
      throw InputError(at, format("no type of element has {} nodes", list.size()),
                       "Give 4, 6, 8, 10, 15, 20 or 27 nodes, or 2 or 3 of a line");
    const CellShape& shape = cell_shape(name);
    if (list.size() != shape.nodes.size())
      throw InputError(at,
                       format("{} has {} nodes, but {} are given", name, shape.size(), list.size()),
                       "Give each node once");
    for (int node : list)
      if (std::count(list.begin(), list.end(), node) > 1)
        throw InputError(at, format("node {} is given twice", node), "Give each node once");
    auto block = std::find_if(mesh.blocks.begin(), mesh.blocks.end(),
                              [&](const ElementBlock& one) { return one.type == name; });
    if (block == mesh.blocks.end())
      block = mesh.blocks.insert(mesh.blocks.end(), {.type = name, .nodes = {}});
    block->nodes.insert(block->nodes.end(), list.begin(), list.end());
    places[block->type].push_back(static_cast<std::int64_t>(e));
  }
  for (std::size_t i = 0; i < nodes.size(); ++i)
    mesh.node_labels.push_back(static_cast<std::int64_t>(i));
  for (const ElementBlock& block : mesh.blocks)
    for (std::int64_t e : places[block.type]) mesh.element_labels.push_back(e);
  for (const auto& [name, list] : sets) {
    for (int node : list) check_node(format("{}.sets.{}", where, name), node);
    std::vector<int>& set = mesh.node_sets[name];
    set = list;
    std::sort(set.begin(), set.end());
    set.erase(std::unique(set.begin(), set.end()), set.end());
  }
  return mesh;
}

}  // namespace polhode::solids
