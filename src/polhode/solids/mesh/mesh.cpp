// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/solids/mesh/mesh.hpp>

namespace polhode::solids {
namespace {

/// New numbers of the kept elements; −1 for the others.
std::vector<int> kept_only(const std::vector<int>& set, const std::vector<int>& new_number) {
  std::vector<int> kept;
  for (int i : set)
    if (new_number[i] >= 0) kept.push_back(new_number[i]);
  std::sort(kept.begin(), kept.end());
  return kept;
}

std::vector<int> elements_of(const Mesh& mesh, std::string_view name) {
  if (!name.empty()) {
    const auto found = mesh.element_sets.find(name);
    if (found != mesh.element_sets.end()) return found->second;
    std::vector<std::string> names;
    for (const auto& [key, set] : mesh.element_sets) names.push_back(key);
    throw InputError(
        mesh.name, format("there is no group of elements '{}'", name),
        did_you_mean(name, names) + (names.empty() ? "The mesh has no groups; leave the group out"
                                                   : "Groups of elements: " + name_list(names)));
  }
  std::vector<int> solids, all;
  int first = 0;
  for (const ElementBlock& block : mesh.blocks) {
    const CellShape& shape = block.shape();
    const int count = static_cast<int>(block.nodes.size()) / shape.size();
    for (int i = 0; i < count; ++i) {
      all.push_back(first + i);
      if (shape.dimension == 3) solids.push_back(first + i);
    }
    first += count;
  }
  return solids.empty() ? all : solids;
}

Surface part_of_surface(const Surface& surface, const std::vector<int>& new_node,
                        const std::vector<int>& new_element) {
  Surface part;
  std::vector<int> nodes;
  for (const FaceBlock& block : surface.blocks) {
    const int n = block.shape().size();
    for (int f = 0; f < block.size(); ++f) {
      const int owner = block.owners[f] < 0 ? -1 : new_element[block.owners[f]];
      if (block.owners[f] >= 0 && owner < 0) continue;
      nodes.assign(block.nodes.begin() + n * f, block.nodes.begin() + n * (f + 1));
      bool whole = true;
      for (int& node : nodes) {
        node = new_node[node];
        whole = whole && node >= 0;
      }
      if (whole) part.add(block.type, nodes, owner);
    }
  }
  return part;
}

}  // namespace

int Surface::size() const {
  int sum = 0;
  for (const FaceBlock& block : blocks) sum += block.size();
  return sum;
}

std::vector<int> Surface::nodes() const {
  std::vector<int> all;
  for (const FaceBlock& block : blocks)
    all.insert(all.end(), block.nodes.begin(), block.nodes.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void Surface::add(std::string_view type, std::span<const int> nodes, int owner) {
  auto block = std::find_if(blocks.begin(), blocks.end(),
                            [&](const FaceBlock& one) { return one.type == type; });
  if (block == blocks.end())
    block = blocks.insert(blocks.end(), {.type = std::string(type), .nodes = {}, .owners = {}});
  block->nodes.insert(block->nodes.end(), nodes.begin(), nodes.end());
  block->owners.push_back(owner);
}

int Mesh::element_count() const {
  int sum = 0;
  for (const ElementBlock& block : blocks)
    sum += static_cast<int>(block.nodes.size()) / block.shape().size();
  return sum;
}

Mesh::Place Mesh::place(int element) const {
  int rest = element;
  for (int b = 0; b < static_cast<int>(blocks.size()); ++b) {
    const int count = static_cast<int>(blocks[b].nodes.size()) / blocks[b].shape().size();
    if (rest < count) return {b, rest};
    rest -= count;
  }
  throw InputError(name, format("there is no element {} (counted from 0)", element),
                   format("The mesh has {} elements", element_count()));
}

std::span<const int> Mesh::element_nodes(int element) const {
  const auto [b, i] = place(element);
  const std::size_t n = static_cast<std::size_t>(blocks[b].shape().size());
  return std::span<const int>(blocks[b].nodes).subspan(n * static_cast<std::size_t>(i), n);
}

const CellShape& Mesh::element_shape(int element) const {
  return blocks[place(element).block].shape();
}

std::int64_t Mesh::node_label(int node) const {
  return node_labels.empty() ? node + 1 : node_labels[node];
}

std::int64_t Mesh::element_label(int element) const {
  return element_labels.empty() ? element + 1 : element_labels[element];
}

SplitBlocks split_blocks(Mesh& mesh, const std::vector<int>& part) {
  SplitBlocks result;
  std::vector<ElementBlock> blocks;
  std::vector<int> new_number(part.size());
  int first = 0;
  for (const ElementBlock& block : mesh.blocks) {
    const int n = block.shape().size(), count = static_cast<int>(block.nodes.size()) / n;
    std::map<int, std::vector<int>> of_part;
    for (int e = first; e < first + count; ++e) of_part[part[e]].push_back(e);
    for (const auto& [number, elements] : of_part) {
      result.parts.push_back(number);
      blocks.push_back({block.type, {}});
      for (const int e : elements) {
        new_number[e] = static_cast<int>(result.former.size());
        result.former.push_back(e);
        const auto at = block.nodes.begin() + static_cast<std::ptrdiff_t>(n) * (e - first);
        blocks.back().nodes.insert(blocks.back().nodes.end(), at, at + n);
      }
    }
    first += count;
  }
  std::vector<std::int64_t> labels;
  for (const int e : result.former) labels.push_back(mesh.element_label(e));
  mesh.element_labels = std::move(labels);
  mesh.blocks = std::move(blocks);
  for (auto& [name, set] : mesh.element_sets) set = kept_only(set, new_number);
  for (auto& [name, surface] : mesh.surfaces)
    for (FaceBlock& block : surface.blocks)
      for (int& owner : block.owners)
        if (owner >= 0) owner = new_number[owner];
  return result;
}

Mesh part_of(const Mesh& mesh, std::string_view element_set) {
  Mesh part;
  part.name = mesh.name;
  part.notes = mesh.notes;
  std::vector<int> new_element(mesh.element_count(), -1);
  std::vector<int> new_node(mesh.nodes.size(), -1);
  const std::vector<int> elements = elements_of(mesh, element_set);
  for (int e : elements) new_element[e] = 0;
  int next = 0;
  int first = 0;
  for (const ElementBlock& block : mesh.blocks) {
    const int n = block.shape().size();
    const int count = static_cast<int>(block.nodes.size()) / n;
    ElementBlock kept{.type = block.type, .nodes = {}};
    for (int i = 0; i < count; ++i) {
      if (new_element[first + i] < 0) continue;
      new_element[first + i] = next++;
      if (!mesh.element_labels.empty())
        part.element_labels.push_back(mesh.element_labels[first + i]);
      for (int a = n * i; a < n * (i + 1); ++a) {
        kept.nodes.push_back(block.nodes[a]);
        new_node[block.nodes[a]] = 0;
      }
    }
    first += count;
    if (!kept.nodes.empty()) part.blocks.push_back(std::move(kept));
  }
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
    if (new_node[i] < 0) continue;
    new_node[i] = static_cast<int>(part.nodes.size());
    part.nodes.push_back(mesh.nodes[i]);
    part.node_labels.push_back(mesh.node_label(i));
  }
  for (ElementBlock& block : part.blocks)
    for (int& node : block.nodes) node = new_node[node];
  for (const auto& [name, set] : mesh.node_sets)
    if (auto kept = kept_only(set, new_node); !kept.empty()) part.node_sets[name] = kept;
  for (const auto& [name, set] : mesh.element_sets)
    if (auto kept = kept_only(set, new_element); !kept.empty()) part.element_sets[name] = kept;
  for (const auto& [name, surface] : mesh.surfaces)
    if (auto kept = part_of_surface(surface, new_node, new_element); kept.size() > 0)
      part.surfaces[name] = std::move(kept);
  return part;
}

void scale(Mesh& mesh, double factor) {
  for (Vec3& X : mesh.nodes) X *= factor;
}

void move(Mesh& mesh, const Mat3& R, const Vec3& x) {
  for (Vec3& X : mesh.nodes) X = R * X + x;
}

double Extent::size() const { return (most - least).norm(); }

Extent extent(const Mesh& mesh) {
  if (mesh.nodes.empty()) return {};
  Extent box{mesh.nodes[0], mesh.nodes[0]};
  for (const Vec3& X : mesh.nodes) {
    box.least = box.least.cwiseMin(X);
    box.most = box.most.cwiseMax(X);
  }
  return box;
}

double element_volume(const Mesh& mesh, int element) {
  const CellShape& shape = mesh.element_shape(element);
  std::vector<Vec3> X;
  for (int node : mesh.element_nodes(element)) X.push_back(mesh.nodes[node]);
  // det ∂X/∂ξ has at most degree 5 in each variable, including the map onto a tetrahedron.
  static const double kPoint = std::sqrt(0.6);
  const std::array<double, 3> xs{-kPoint, 0.0, kPoint};
  const std::array<double, 3> ws{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  const bool simplex = shape.name.starts_with("tet");
  const bool prism = shape.name.starts_with("wedge");
  double volume = 0.0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) {
        Vec3 xi{xs[i], xs[j], xs[k]};
        double weight = ws[i] * ws[j] * ws[k];
        if (simplex || prism) {  // the cube collapsed onto the triangle or the tetrahedron
          const double u = 0.5 * (1.0 + xi[0]), v = 0.5 * (1.0 + xi[1]), w = 0.5 * (1.0 + xi[2]);
          if (prism) {
            xi = {u, v * (1.0 - u), xi[2]};
            weight *= 0.25 * (1.0 - u);
          } else {
            xi = {u, v * (1.0 - u), w * (1.0 - u) * (1.0 - v)};
            weight *= 0.125 * (1.0 - u) * (1.0 - u) * (1.0 - v);
          }
        }
        volume += weight * jacobian(shape, X.data(), xi);
      }
  return volume;
}

}  // namespace polhode::solids
