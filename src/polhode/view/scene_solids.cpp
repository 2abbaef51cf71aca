// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include <polhode/core/format.hpp>
#include <polhode/io/results/results_format.hpp>
#include <polhode/solids/mesh/mesh.hpp>
#include <polhode/view/scene_parts.hpp>

namespace polhode {

solids::Mesh mesh_of_results(const io::ResultsReader& results, const std::string& group) {
  solids::Mesh mesh;
  const std::vector<std::int64_t> nodes = results.numbers(group + "/elements/connectivity"),
                                  offsets = results.numbers(group + "/elements/offsets"),
                                  types = results.numbers(group + "/elements/vtk_type");
  mesh.nodes.resize(results.vectors(group + "/nodes/reference").size() / 3);
  const auto within = [](std::int64_t x, std::size_t end) {
    return x >= 0 && x < static_cast<std::int64_t>(end);
  };
  const auto is_node = [&](std::int64_t node) { return within(node, mesh.nodes.size()); };
  const auto is_place = [&](std::int64_t place) { return within(place, nodes.size() + 1); };
  if ((!types.empty() && offsets.size() != types.size() + 1) ||
      !std::all_of(nodes.begin(), nodes.end(), is_node) ||
      !std::all_of(offsets.begin(), offsets.end(), is_place))
    results.refuse(format("the elements of '{}' do not fit each other", group));
  for (std::size_t e = 0; e < types.size(); ++e) {
    const auto shape = std::find_if(
        solids::cell_shapes().begin(), solids::cell_shapes().end(),
        [&](const solids::CellShape& s) { return s.vtk == static_cast<int>(types[e]); });
    if (shape == solids::cell_shapes().end()) continue;
    if (offsets[e + 1] - offsets[e] != shape->size())
      results.refuse(format("the elements of '{}' do not fit each other", group));
    if (mesh.blocks.empty() || mesh.blocks.back().type != shape->name)
      mesh.blocks.push_back({shape->name, {}});
    for (std::int64_t k = offsets[e]; k < offsets[e + 1]; ++k)
      mesh.blocks.back().nodes.push_back(static_cast<int>(nodes[static_cast<std::size_t>(k)]));
  }
  return mesh;
}

namespace {

/// Triangles of a face in its own node numbers: between corners, middles of edges and of the face.
std::vector<std::array<int, 3>> triangles_of(const std::string& type) {
  if (type == "tri3") return {{0, 1, 2}};
  if (type == "tri6") return {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
  if (type == "tri7") return {{0, 3, 6}, {3, 1, 6}, {1, 4, 6}, {4, 2, 6}, {2, 5, 6}, {5, 0, 6}};
  if (type == "quad8") return {{0, 4, 7}, {4, 1, 5}, {5, 2, 6}, {6, 3, 7}, {4, 5, 6}, {4, 6, 7}};
  if (type == "quad9")
    return {{0, 4, 8}, {0, 8, 7}, {4, 1, 5}, {4, 5, 8}, {8, 5, 2}, {8, 2, 6}, {7, 8, 6}, {7, 6, 3}};
  return {{0, 1, 2}, {0, 2, 3}};
}

/// Edges of a face in its own node numbers, quadratic ones in two segments.
std::vector<std::array<int, 2>> edges_of(const solids::CellShape& shape) {
  std::vector<std::array<int, 2>> list;
  const int corners = shape.corners;
  for (int k = 0; k < corners; ++k) {
    const int next = (k + 1) % corners;
    if (shape.order == 1) {
      list.push_back({k, next});
    } else {
      list.push_back({k, corners + k});
      list.push_back({corners + k, next});
    }
  }
  return list;
}

/// Visible part of a mesh, in numbers of the visible nodes.
struct Outside {
  std::vector<int> nodes, elements;  ///< Of the mesh, by number here.
  std::vector<std::uint32_t> triangles, edges;
  std::vector<std::uint32_t> owners;  ///< Elements of the triangles, by number here.
};

Outside outside_of(const solids::Mesh& mesh) {
  Outside out;
  std::vector<int> number(mesh.nodes.size(), -1),
      element(static_cast<std::size_t>(mesh.element_count()), -1);
  std::set<std::pair<std::uint32_t, std::uint32_t>> known;
  for (const solids::FaceBlock& block : solids::boundary(mesh).blocks) {
    const solids::CellShape& shape = block.shape();
    const auto size = static_cast<std::size_t>(shape.size());
    const auto triangles = triangles_of(block.type);
    const auto edges = edges_of(shape);
    for (std::size_t f = 0; f < block.owners.size(); ++f) {
      const int* nodes = block.nodes.data() + f * size;
      const auto seen = [&](int local) {
        int& n = number[static_cast<std::size_t>(nodes[local])];
        if (n < 0) {
          n = static_cast<int>(out.nodes.size());
          out.nodes.push_back(nodes[local]);
        }
        return static_cast<std::uint32_t>(n);
      };
      int& owner = element[static_cast<std::size_t>(block.owners[f])];
      if (owner < 0) {
        owner = static_cast<int>(out.elements.size());
        out.elements.push_back(block.owners[f]);
      }
      for (const auto& t : triangles) {
        for (int corner : t) out.triangles.push_back(seen(corner));
        out.owners.push_back(static_cast<std::uint32_t>(owner));
      }
      for (const auto& [i, j] : edges) {
        const std::uint32_t a = seen(i), b = seen(j);
        if (known.insert(std::minmax(a, b)).second) out.edges.insert(out.edges.end(), {a, b});
      }
    }
  }
  return out;
}

/// Rows of the visible nodes or elements, out of those of all of each frame.
std::vector<double> seen_rows(const std::vector<double>& values, std::size_t all,
                              const std::vector<int>& nodes, std::size_t width) {
  std::vector<double> rows;
  const std::size_t frames = all == 0 ? 0 : values.size() / (all * width);
  rows.reserve(frames * nodes.size() * width);
  for (std::size_t f = 0; f < frames; ++f)
    for (int n : nodes) {
      const auto begin = values.begin() + static_cast<std::ptrdiff_t>(
                                              (f * all + static_cast<std::size_t>(n)) * width);
      rows.insert(rows.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
    }
  return rows;
}

}  // namespace

void add_solids(Json& manifest, ChunkList& chunks, const io::ResultsReader& results,
                std::size_t every) {
  Json& solids = manifest["solids"] = Json::array();
  for (const std::string& name : results.groups(io::results::kSolids)) {
    const std::string group = format("{}/{}", io::results::kSolids, name);
    const solids::Mesh mesh = mesh_of_results(results, group);
    const Outside outside = outside_of(mesh);
    Json entry = {{"name", name},
                  {"nodes", mesh.nodes.size()},
                  {"elements", mesh.element_count()},
                  {"shown", outside.nodes}};
    entry["reference"] = chunks.floats(
        seen_rows(results.vectors(group + "/nodes/reference"), mesh.nodes.size(), outside.nodes, 3),
        3);
    entry["triangles"] = chunks.integers(outside.triangles, 3);
    entry["edges"] = chunks.integers(outside.edges, 2);
    entry["owners"] = chunks.integers(outside.owners, 1);
    Json fields = Json::array();
    for (const auto& [part, all, seen] :
         {std::tuple<const char*, std::size_t, const std::vector<int>&>{"nodes", mesh.nodes.size(),
                                                                        outside.nodes},
          {"elements", static_cast<std::size_t>(mesh.element_count()), outside.elements}}) {
      const std::string prefix = format("{}/{}/", group, part);
      for (const io::ResultsReader::DataSet& set : results.data_sets()) {
        if (set.path.rfind(prefix, 0) != 0 || set.dims.empty()) continue;
        const std::size_t width = set.size() / std::max<std::size_t>(1, all);
        if (width == 0) results.refuse(format("'{}' is too short", set.path));
        const bool later = part[0] == 'e';
        if (later) chunks.later();
        fields.push_back(
            {{"name", set.path.substr(prefix.size())},
             {"of", part},
             {"unit", set.unit},
             {"size", width},
             {"data", chunks.floats(seen_rows(results.read(set.path, every), all, seen, width),
                                    seen.size() * width)}});
      }
    }
    entry["fields"] = fields;
    solids.push_back(std::move(entry));
  }
}

}  // namespace polhode
