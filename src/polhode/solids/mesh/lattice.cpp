// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include <polhode/core/assert.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/mesh/coincident.hpp>
#include <polhode/solids/mesh/lattice.hpp>

namespace polhode::solids {
namespace {

/// Nodes of one hexahedron of 27 nodes.
using Hex27 = std::array<int, 27>;

/// Points of a hexahedron by their position (0, 1, 2)³, as local numbers of hex27.
int local_number(int i, int j, int k) {
  static const std::array<int, 27> kNumbers = [] {
    std::array<int, 27> numbers{};
    const CellShape& shape = cell_shape("hex27");
    for (int a = 0; a < 27; ++a) {
      const Vec3& xi = shape.nodes[a];
      const int x = static_cast<int>(xi[0]) + 1, y = static_cast<int>(xi[1]) + 1,
                z = static_cast<int>(xi[2]) + 1;
      numbers[x + 3 * (y + 3 * z)] = a;
    }
    return numbers;
  }();
  return kNumbers[i + 3 * (j + 3 * k)];
}

/// Node of a hexahedron midway between two of its corners.
int half_way(int a, int b) {
  const CellShape& shape = cell_shape("hex27");
  const Vec3 sum = shape.nodes[a] + shape.nodes[b];
  const auto index = [&](int k) { return static_cast<int>(std::lround(0.5 * sum[k])) + 1; };
  return local_number(index(0), index(1), index(2));
}

/// End and middle points of the cells.
std::vector<double> with_middles(const std::vector<double>& ends) {
  std::vector<double> all;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (i > 0) all.push_back(0.5 * (ends[i - 1] + ends[i]));
    all.push_back(ends[i]);
  }
  return all;
}

void add_patch(const Patch& patch, std::vector<Vec3>& points, std::vector<Hex27>& cells) {
  const auto us = with_middles(patch.ends[0]), vs = with_middles(patch.ends[1]),
             ws = with_middles(patch.ends[2]);
  POLHODE_ASSERT(is_strictly_ascending(us) && is_strictly_ascending(vs) &&
                 is_strictly_ascending(ws));
  const int first = static_cast<int>(points.size());
  const int nu = static_cast<int>(us.size()), nv = static_cast<int>(vs.size()),
            nw = static_cast<int>(ws.size());
  for (double w : ws)
    for (double v : vs)
      for (double u : us) points.push_back(patch.map({u, v, w}));
  for (int k = 0; k + 2 < nw; k += 2)
    for (int j = 0; j + 2 < nv; j += 2)
      for (int i = 0; i + 2 < nu; i += 2) {
        Hex27 cell{};
        for (int c = 0; c < 3; ++c)
          for (int b = 0; b < 3; ++b)
            for (int a = 0; a < 3; ++a)
              cell[local_number(a, b, c)] = first + (i + a) + nu * ((j + b) + nv * (k + c));
        cells.push_back(cell);
      }
}

/// Cell of the requested type, as local numbers of hex27: corners, then middles of edges.
std::vector<int> with_edges(const CellShape& shape, std::vector<int> corners) {
  if (shape.order == 2)
    for (const CellEdge& edge : shape.edges)
      corners.push_back(half_way(corners[edge.begin], corners[edge.end]));
  return corners;
}

using Cells = std::vector<std::vector<int>>;

/// Six tetrahedra: the first node of the cell with the triangles of its three opposite faces, each
/// face being split from its own first node. "First" is by number in the mesh, common to
/// neighbours.
Cells tetrahedra(const CellShape& shape, const Hex27& cell) {
  const CellShape& hex = cell_shape("hex8");
  int apex = 0;
  for (int i = 1; i < 8; ++i)
    if (cell[i] < cell[apex]) apex = i;
  Cells found;
  for (const CellFace& face : hex.faces) {
    if (std::count(face.nodes.begin(), face.nodes.end(), apex) > 0) continue;
    int start = 0;
    for (int i = 1; i < 4; ++i)
      if (cell[face.nodes[i]] < cell[face.nodes[start]]) start = i;
    const auto at = [&](int i) { return face.nodes[(start + i) % 4]; };
    // Seen from outside a face is counterclockwise, so the apex behind it comes last with two
    // corners exchanged.
    found.push_back(with_edges(shape, {at(0), at(2), at(1), apex}));
    found.push_back(with_edges(shape, {at(0), at(3), at(2), apex}));
  }
  return found;
}

Cells split(const CellShape& shape, const Hex27& cell) {
  if (shape.name.starts_with("hex")) {
    std::vector<int> all(shape.nodes.size());
    for (int i = 0; i < shape.size(); ++i) all[i] = i;
    return {all};
  }
  if (shape.name.starts_with("tet")) return tetrahedra(shape, cell);
  return {with_edges(shape, {0, 1, 2, 4, 5, 6}), with_edges(shape, {0, 2, 3, 4, 6, 7})};
}

/// Nodes of tet15 in the middles of the faces and inside, placed by the shape functions of tet10,
/// so that the cells have the same shape.
void add_bubble_nodes(Mesh& mesh) {
  const CellShape &from = cell_shape("tet10"), &to = cell_shape("tet15");
  std::vector<Vec> weights;
  for (int a = from.size(); a < to.size(); ++a)
    weights.push_back(shape_functions(from, to.nodes[static_cast<std::size_t>(a)]));
  std::map<std::array<int, 3>, int> middles;  // by the corners of a face
  std::vector<int> all;
  const auto n = static_cast<std::size_t>(from.size());
  const std::vector<int> old = std::move(mesh.blocks[0].nodes);
  for (std::size_t e = 0; e < old.size(); e += n) {
    const std::span<const int> own = std::span(old).subspan(e, n);
    std::vector<int> cell(own.begin(), own.end());
    cell.resize(to.nodes.size());
    const auto add = [&](int local) {
      const Vec& N = weights[static_cast<std::size_t>(local) - n];
      Vec3 x = Vec3::Zero();
      for (std::size_t a = 0; a < n; ++a)
        x += N[static_cast<Eigen::Index>(a)] * mesh.nodes[static_cast<std::size_t>(own[a])];
      mesh.nodes.push_back(x);
      return static_cast<int>(mesh.nodes.size()) - 1;
    };
    for (const CellFace& face : to.faces) {
      std::array<int, 3> key{};
      for (std::size_t k = 0; k < 3; ++k) key[k] = own[static_cast<std::size_t>(face.nodes[k])];
      std::sort(key.begin(), key.end());
      const auto [place, fresh] = middles.try_emplace(key, 0);
      if (fresh) place->second = add(face.nodes.back());
      cell[static_cast<std::size_t>(face.nodes.back())] = place->second;
    }
    cell.back() = add(to.size() - 1);
    all.insert(all.end(), cell.begin(), cell.end());
  }
  mesh.blocks[0] = {.type = to.name, .nodes = std::move(all)};
}

void name_sides(Mesh& mesh, const std::vector<NamedSide>& sides) {
  const Surface all = boundary(mesh);
  for (const NamedSide& side : sides) {
    Surface surface;
    for (const FaceBlock& block : all.blocks) {
      const std::size_t n = block.shape().nodes.size();
      for (std::size_t f = 0; f < block.owners.size(); ++f) {
        const std::span<const int> nodes = std::span<const int>(block.nodes).subspan(n * f, n);
        // Middles of faces are between the nodes of the edges, not all on a curved side.
        const std::size_t edges = block.shape().corners + block.shape().edges.size();
        const std::span<const int> rim = nodes.first(std::min(n, edges));
        const bool on_side = std::all_of(rim.begin(), rim.end(),
                                         [&](int node) { return side.holds(mesh.nodes[node]); });
        if (on_side) surface.add(block.type, nodes, block.owners[f]);
      }
    }
    if (surface.size() > 0) mesh.surfaces[side.name] = std::move(surface);
  }
}

}  // namespace

std::vector<double> graded(int n, double ratio) {
  const double growth = n > 1 ? std::pow(ratio, 1.0 / (n - 1)) : 1.0;
  std::vector<double> ends{0.0};
  double length = 1.0;
  for (int i = 0; i < n; ++i, length *= growth) ends.push_back(ends.back() + length);
  const double sum = ends.back();
  for (double& end : ends) end /= sum;
  ends.back() = 1.0;
  if (growth == 1.0)
    for (int i = 0; i <= n; ++i) ends[i] = static_cast<double>(i) / n;
  return ends;
}

Mesh lattice_mesh(std::string_view name, const std::vector<Patch>& patches, std::string_view type,
                  const std::vector<NamedSide>& sides) {
  const bool bubbles = type == "tet15";
  const CellShape& shape = cell_shape(bubbles ? "tet10" : type);
  if (shape.dimension != 3)
    throw InputError(name, format("cells of type '{}' do not fill a solid", type),
                     "Use hex8, hex20, hex27, tet4, tet10, tet15, wedge6 or wedge15");
  std::vector<Vec3> points;
  std::vector<Hex27> cells;
  for (const Patch& patch : patches) add_patch(patch, points, cells);
  Mesh all;
  all.nodes = points;
  const std::vector<int> first = first_coincident(points, 1e-9 * extent(all).size());
  for (Hex27& cell : cells)
    for (int& node : cell) node = first[node];

  Mesh mesh;
  mesh.name = name;
  mesh.blocks.push_back({.type = shape.name, .nodes = {}});
  std::vector<int>& nodes = mesh.blocks[0].nodes;
  for (const Hex27& cell : cells)
    for (const std::vector<int>& one : split(shape, cell))
      for (int local : one) nodes.push_back(cell[local]);
  // Only nodes in use, in the order of the lattice.
  std::vector<int> number(points.size(), -1);
  for (int node : nodes) number[node] = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (number[i] < 0) continue;
    number[i] = static_cast<int>(mesh.nodes.size());
    mesh.nodes.push_back(points[i]);
  }
  for (int& node : nodes) node = number[node];

  std::vector<Vec3> X(shape.nodes.size());
  for (std::size_t at = 0; at < nodes.size(); at += X.size()) {
    for (std::size_t a = 0; a < X.size(); ++a) X[a] = mesh.nodes[nodes[at + a]];
    if (!(least_jacobian(shape, X.data()) > 0.0))
      throw InputError(name, format("element {} would be inverted", at / X.size() + 1),
                       "Use more cells around, or a grading nearer to 1");
  }
  if (bubbles) add_bubble_nodes(mesh);
  name_sides(mesh, sides);
  return mesh;
}

}  // namespace polhode::solids
