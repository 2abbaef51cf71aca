// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/mesh/face_index.hpp>
#include <polhode/solids/mesh/mesh_builder.hpp>

namespace polhode::solids {
namespace {

void make_unique(std::vector<int>& set) {
  std::sort(set.begin(), set.end());
  set.erase(std::unique(set.begin(), set.end()), set.end());
}

std::size_t hash_of(std::vector<int> nodes) {
  std::sort(nodes.begin(), nodes.end());
  std::size_t hash = nodes.size();
  for (int node : nodes) {
    hash = (hash ^ static_cast<std::size_t>(node)) * 0x9E3779B97F4A7C15ULL;
    hash ^= hash >> 29;
  }
  return hash;
}

}  // namespace

void MeshBuilder::refuse(std::size_t at, const std::string& what, const std::string& hint) const {
  throw InputError(binary_ ? cursor_.binary_place(at) : cursor_.text_place(at), what, hint);
}

void MeshBuilder::add_node(std::int64_t label, const Vec3& X, std::size_t at) {
  if (!X.allFinite() || X.cwiseAbs().maxCoeff() > kLargestCoordinate)
    refuse(at,
           format("node {} has the coordinates ({:.3g}, {:.3g}, {:.3g})", label, X[0], X[1], X[2]),
           kExportMeshAgain);
  if (!index_.try_emplace(label, static_cast<int>(nodes_.size())).second)
    refuse(at, format("node {} is given twice", label), "Give each node a number of its own");
  nodes_.push_back(X);
  labels_.push_back(label);
}

int MeshBuilder::add_cell(const CellShape& shape, std::int64_t label,
                          std::span<const std::int64_t> nodes, std::size_t at) {
  cells_.push_back({&shape, label, at, cell_nodes_.size()});
  cell_nodes_.insert(cell_nodes_.end(), nodes.begin(), nodes.end());
  return static_cast<int>(cells_.size()) - 1;
}

void MeshBuilder::put(int cell, std::string_view set) {
  const auto found = cell_sets_.find(set);
  (found != cell_sets_.end() ? found->second : cell_sets_[std::string(set)]).push_back(cell);
}

void MeshBuilder::put_node(std::int64_t node, std::string_view set, std::size_t at) {
  const int index = node_index(node, at, format("set '{}'", set));
  const auto found = node_sets_.find(set);
  (found != node_sets_.end() ? found->second : node_sets_[std::string(set)]).push_back(index);
}

void MeshBuilder::put_face(int cell, std::span<const int> local_corners, std::string_view surface) {
  face_sets_[std::string(surface)].push_back({cell, {local_corners.begin(), local_corners.end()}});
}

void MeshBuilder::put_free_faces(const std::vector<int>& cells, std::string_view surface) {
  std::vector<int>& all = free_face_sets_[std::string(surface)];
  all.insert(all.end(), cells.begin(), cells.end());
}

const Vec3& MeshBuilder::position(int cell, int node) const {
  const Cell& c = cells_[cell];
  return nodes_[node_index(cell_nodes_[c.first + static_cast<std::size_t>(node)], c.at,
                           format("element {}", c.label))];
}

void MeshBuilder::reorder(int cell, std::span<const int> order) {
  std::int64_t* nodes = &cell_nodes_[cells_[cell].first];
  const std::vector<std::int64_t> old(nodes, nodes + order.size());
  for (std::size_t i = 0; i < order.size(); ++i) nodes[i] = old[static_cast<std::size_t>(order[i])];
}

int MeshBuilder::node_index(std::int64_t label, std::size_t at, std::string_view user) const {
  const auto found = index_.find(label);
  if (found == index_.end())
    refuse(
        at, format("{} names node {}, which does not exist", user, label),
        nodes_.empty() ? "The file has no nodes" : format("The file has {} nodes", nodes_.size()));
  return found->second;
}

std::vector<int> MeshBuilder::resolved(const Cell& cell) const {
  std::vector<int> nodes;
  const std::string user = format("element {}", cell.label);
  for (std::size_t i = 0; i < cell.shape->nodes.size(); ++i)
    nodes.push_back(node_index(cell_nodes_[cell.first + i], cell.at, user));
  std::vector<int> sorted = nodes;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end())
    refuse(cell.at, format("{} ({}) has node {} twice", user, cell.shape->name, labels_[*twice]),
           "Collapsed elements are not supported: use wedges or tetrahedra there");
  return nodes;
}

int MeshBuilder::same_element(const std::vector<int>& nodes, const CellShape& shape) {
  const std::size_t hash = hash_of(nodes);
  const auto [from, to] = known_.equal_range(hash);
  std::vector<int> wanted = nodes;
  std::sort(wanted.begin(), wanted.end());
  for (auto entry = from; entry != to; ++entry) {
    const Cell& other = cells_[cell_of_[entry->second]];
    if (other.shape != &shape) continue;
    std::vector<int> others = resolved(other);
    std::sort(others.begin(), others.end());
    if (others == wanted) return entry->second;
  }
  known_.emplace(hash, static_cast<int>(cell_of_.size()));
  return -1;
}

void MeshBuilder::make_elements(Mesh& mesh, bool solids) {
  // Elements ordered by type, as blocks are; types in the order of the file.
  std::vector<const CellShape*> types;
  for (const Cell& cell : cells_) {
    const int d = cell.shape->dimension;
    const bool element = d == 3 || d == 1 || (d == 2 && !solids);
    if (element && std::find(types.begin(), types.end(), cell.shape) == types.end())
      types.push_back(cell.shape);
  }
  element_of_.assign(cells_.size(), -1);
  std::unordered_map<std::int64_t, int> labels;
  for (const CellShape* type : types) {
    ElementBlock block{.type = type->name, .nodes = {}};
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const Cell& cell = cells_[c];
      if (cell.shape != type) continue;
      const std::vector<int> nodes = resolved(cell);
      if (const int same = same_element(nodes, *type); same >= 0) {
        if (!repeated_cells_are_one)
          refuse(cell.at,
                 format("element {} has the nodes of element {}", cell.label,
                        cells_[cell_of_[same]].label),
                 "Leave one of them out");
        element_of_[c] = same;
        continue;
      }
      if (!labels.try_emplace(cell.label, 0).second)
        refuse(cell.at, format("element {} is given twice", cell.label),
               "Give each element a number of its own");
      element_of_[c] = static_cast<int>(cell_of_.size());
      cell_of_.push_back(static_cast<int>(c));
      mesh.element_labels.push_back(cell.label);
      block.nodes.insert(block.nodes.end(), nodes.begin(), nodes.end());
    }
    mesh.blocks.push_back(std::move(block));
  }
}

void MeshBuilder::add_oriented(const Mesh& mesh, const FaceIndex& faces,
                               const std::vector<int>& nodes, std::string_view type,
                               Surface& surface, int& stray) const {
  const std::size_t corners = type.starts_with("tri") ? 3 : 4;
  const std::span<const int> face = std::span<const int>(nodes).first(corners);
  const FaceIndex::Entry* entry = faces.find(face);
  if (!entry) {
    ++stray;
    surface.add(type, nodes, -1);
    return;
  }
  // Between two solids the face belongs to the one from which it faces outward.
  int side = 0;
  if (entry->times > 1) {
    const std::vector<int> own = face_nodes(mesh, entry->element[0], entry->face[0]);
    const auto start = std::find(own.begin(), own.end(), face[0]) - own.begin();
    if (own[(static_cast<std::size_t>(start) + 1) % corners] != face[1]) side = 1;
  }
  const int element = entry->element[side];
  surface.add(mesh.element_shape(element).faces[entry->face[side]].type,
              face_nodes(mesh, element, entry->face[side]), element);
}

void MeshBuilder::make_surfaces(Mesh& mesh, bool solids) {
  const bool any_faces = std::any_of(cells_.begin(), cells_.end(),
                                     [](const Cell& c) { return c.shape->dimension == 2; });
  if (!any_faces && face_sets_.empty() && free_face_sets_.empty()) return;
  const FaceIndex faces(mesh);
  for (const auto& [name, cells] : cell_sets_) {
    Surface surface;
    int stray = 0;
    for (int c : cells)
      if (cells_[c].shape->dimension == 2)
        add_oriented(mesh, faces, resolved(cells_[c]), cells_[c].shape->name, surface, stray);
    if (stray > 0 && solids)
      notes_.push_back(format("{} of {} faces of surface '{}' belong to no solid element", stray,
                              surface.size(), name));
    if (surface.size() > 0) mesh.surfaces[name] = std::move(surface);
  }
  for (const auto& [name, list] : face_sets_)
    for (const Face& face : list) {
      const int element = element_of_[face.cell];
      const CellShape& shape = mesh.element_shape(element);
      for (std::size_t f = 0; f < shape.faces.size(); ++f) {
        std::vector<int> corners = shape.faces[f].nodes;
        corners.resize(face.corners.size());
        if (!std::is_permutation(corners.begin(), corners.end(), face.corners.begin())) continue;
        mesh.surfaces[name].add(shape.faces[f].type, face_nodes(mesh, element, static_cast<int>(f)),
                                element);
      }
    }
  for (const auto& [name, cells] : free_face_sets_) {
    std::vector<char> in(cell_of_.size(), 0);
    for (int c : cells)
      if (element_of_[c] >= 0) in[element_of_[c]] = 1;
    for (const FaceIndex::Entry& entry : faces.entries()) {
      const int element = entry.element[0];
      if (entry.times != 1 || !in[element]) continue;
      mesh.surfaces[name].add(mesh.element_shape(element).faces[entry.face[0]].type,
                              face_nodes(mesh, element, entry.face[0]), element);
    }
  }
}

Mesh MeshBuilder::finish() {
  Mesh mesh;
  mesh.name = cursor_.name();
  if (nodes_.empty())
    throw InputError(mesh.name, "the file has no nodes", "Check that it is the mesh you meant");
  if (cells_.empty())
    throw InputError(mesh.name, "the file has no elements", "Check that it is the mesh you meant");
  mesh.nodes = nodes_;
  mesh.node_labels = labels_;
  const bool solids = std::any_of(cells_.begin(), cells_.end(),
                                  [](const Cell& c) { return c.shape->dimension == 3; });
  make_elements(mesh, solids);
  for (const Cell& cell : cells_)
    if (cell.shape->dimension == 2 || cell.shape->dimension == 0) (void)resolved(cell);
  for (const auto& [name, cells] : cell_sets_)
    for (int c : cells) {
      if (element_of_[c] >= 0) mesh.element_sets[name].push_back(element_of_[c]);
      if (cells_[c].shape->dimension == 0) node_sets_[name].push_back(resolved(cells_[c])[0]);
    }
  for (auto& [name, set] : mesh.element_sets) make_unique(set);
  make_surfaces(mesh, solids);
  for (auto& [name, set] : node_sets_) {
    make_unique(set);
    mesh.node_sets[name] = set;
  }
  mesh.notes = notes_;
  return mesh;
}

}  // namespace polhode::solids
