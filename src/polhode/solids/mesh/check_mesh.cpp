// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include <polhode/core/disjoint_sets.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/mesh/check_mesh.hpp>
#include <polhode/solids/mesh/coincident.hpp>

namespace polhode::solids {
namespace {

using FaultKind = MeshFault::Kind;

constexpr double kCoincident = 1e-9;  // of the mesh's extent

/// "a, b, c and 12 more"
std::string numbers(const std::vector<std::int64_t>& all) {
  constexpr std::size_t kMax = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(all.size(), kMax); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(all[i]);
  if (all.size() > kMax) text += format(" and {} more", all.size() - kMax);
  return text;
}

/// Noun in the singular or plural.
std::string counted(std::size_t n, const char* one, const char* many) {
  return format("{} {}", n, n == 1 ? one : many);
}

void find_inverted(const Mesh& mesh, std::vector<MeshFault>& faults) {
  std::vector<std::int64_t> bad;
  std::string worst;
  double least = 0.0;
  std::vector<Vec3> X;
  int e = 0;
  for (const ElementBlock& block : mesh.blocks) {
    const CellShape& shape = block.shape();
    const std::size_t n = shape.nodes.size();
    for (std::size_t at = 0; at + n <= block.nodes.size(); at += n, ++e) {
      if (shape.dimension != 3) continue;
      X.clear();
      for (std::size_t a = 0; a < n; ++a) X.push_back(mesh.nodes[block.nodes[at + a]]);
      const double J = least_jacobian(shape, X.data());
      if (J > 0.0) continue;
      bad.push_back(mesh.element_label(e));
      if (!worst.empty() && !(J < least)) continue;
      least = J;
      worst = format("element {} ({}) has det dX/dxi = {:.3g} m^3", mesh.element_label(e),
                     shape.name, J);
    }
  }
  if (bad.empty()) return;
  const bool all = static_cast<int>(bad.size()) == mesh.element_count();
  faults.push_back(
      {FaultKind::kInverted, true,
       format("{} inverted or collapsed: {}; {}", counted(bad.size(), "element is", "elements are"),
              numbers(bad), worst),
       all ? "The order of nodes is not that of this file format; export the mesh again"
           : "Mesh the part again, with smaller or straighter elements there"});
}

/// Elements of one shape with the same nodes in any order: the same volume twice.
void find_same_elements(const Mesh& mesh, std::vector<MeshFault>& faults) {
  std::vector<std::int64_t> twice;
  std::string example;
  int first = 0;
  for (const ElementBlock& block : mesh.blocks) {
    const std::size_t n = block.shape().nodes.size();
    std::map<std::vector<int>, int> known;
    for (std::size_t at = 0; at + n <= block.nodes.size(); at += n, ++first) {
      const auto from = block.nodes.begin() + static_cast<std::ptrdiff_t>(at);
      std::vector<int> nodes(from, from + static_cast<std::ptrdiff_t>(n));
      std::sort(nodes.begin(), nodes.end());
      const auto [entry, is_new] = known.try_emplace(std::move(nodes), first);
      if (is_new) continue;
      twice.push_back(mesh.element_label(first));
      if (example.empty())
        example = format("element {} has the nodes of element {}", mesh.element_label(first),
                         mesh.element_label(entry->second));
    }
  }
  if (twice.empty()) return;
  faults.push_back(
      {FaultKind::kSameElements, true,
       format("{} given twice: {}; {}", counted(twice.size(), "element is", "elements are"),
              numbers(twice), example),
       "Leave one of them out"});
}

void find_duplicates(const Mesh& mesh, std::vector<MeshFault>& faults) {
  const std::vector<int> first = first_coincident(mesh.nodes, kCoincident * extent(mesh).size());
  std::vector<std::int64_t> twice;
  std::string example;
  for (int i = 0; i < static_cast<int>(first.size()); ++i) {
    if (first[i] == i) continue;
    twice.push_back(mesh.node_label(i));
    if (example.empty())
      example = format("node {} lies on node {}", mesh.node_label(i), mesh.node_label(first[i]));
  }
  if (twice.empty()) return;
  faults.push_back(
      {FaultKind::kDuplicateNodes, false,
       format("{} on others, so that parts may not be connected: {}; {}",
              counted(twice.size(), "node lies", "nodes lie"), numbers(twice), example),
       "Have duplicate nodes merged if the parts are one"});
}

void find_pieces(const Mesh& mesh, std::vector<MeshFault>& faults) {
  DisjointSets sets(mesh.nodes.size());
  std::vector<char> used(mesh.nodes.size(), 0);
  std::vector<int> firsts;  // first node of each element
  for (const ElementBlock& block : mesh.blocks) {
    const std::size_t n = block.shape().nodes.size();
    for (std::size_t at = 0; at + n <= block.nodes.size(); at += n) {
      firsts.push_back(block.nodes[at]);
      for (std::size_t a = 0; a < n; ++a) {
        used[block.nodes[at + a]] = 1;
        sets.join(block.nodes[at + a], block.nodes[at]);
      }
    }
  }
  struct Piece {
    int root;
    int first_element;
    int elements;
  };
  std::vector<Piece> pieces;
  std::vector<int> piece_of(mesh.nodes.size(), -1);
  for (int e = 0; e < static_cast<int>(firsts.size()); ++e) {
    int& piece = piece_of[sets.first_of(firsts[e])];
    if (piece < 0) {
      piece = static_cast<int>(pieces.size());
      pieces.push_back({firsts[e], e, 0});
    }
    ++pieces[piece].elements;
  }
  if (pieces.size() > 1) {
    std::string list;
    for (std::size_t i = 0; i < std::min<std::size_t>(pieces.size(), 5); ++i)
      list += format("{}{} with element {}", i > 0 ? ", " : "",
                     counted(static_cast<std::size_t>(pieces[i].elements), "element", "elements"),
                     mesh.element_label(pieces[i].first_element));
    if (pieces.size() > 5) list += format(" and {} more", pieces.size() - 5);
    faults.push_back({FaultKind::kPieces, false,
                      format("the mesh has {} pieces that share no node: {}", pieces.size(), list),
                      "Merge duplicate nodes if they are one, or constrain every piece"});
  }
  std::vector<std::int64_t> loose;
  for (int i = 0; i < static_cast<int>(used.size()); ++i)
    if (!used[i]) loose.push_back(mesh.node_label(i));
  if (!loose.empty())
    faults.push_back({FaultKind::kLooseNodes, false,
                      format("{} to no element: {}",
                             counted(loose.size(), "node belongs", "nodes belong"), numbers(loose)),
                      "They are ignored; no action is needed"});
}

}  // namespace

std::vector<MeshFault> mesh_faults(const Mesh& mesh) {
  std::vector<MeshFault> faults;
  find_inverted(mesh, faults);
  find_same_elements(mesh, faults);
  find_duplicates(mesh, faults);
  find_pieces(mesh, faults);
  return faults;
}

std::vector<std::string> check_mesh(const Mesh& mesh) {
  std::vector<std::string> notes;
  for (const MeshFault& fault : mesh_faults(mesh)) {
    if (fault.fatal) throw InputError(mesh.name, fault.what, fault.hint);
    notes.push_back(format("{}. {}.", fault.what, fault.hint));
  }
  return notes;
}

int merge_duplicate_nodes(Mesh& mesh, double distance) {
  const double reach = distance > 0.0 ? distance : kCoincident * extent(mesh).size();
  const std::vector<int> first = first_coincident(mesh.nodes, reach);
  std::vector<int> number(mesh.nodes.size(), -1);
  int e = 0;
  for (const ElementBlock& block : mesh.blocks) {
    const std::size_t n = block.shape().nodes.size();
    for (std::size_t at = 0; at + n <= block.nodes.size(); at += n, ++e)
      for (std::size_t a = 0; a < n; ++a) {
        number[first[block.nodes[at + a]]] = 0;
        for (std::size_t b = 0; b < a; ++b)
          if (first[block.nodes[at + a]] == first[block.nodes[at + b]])
            throw InputError(
                mesh.name,
                format("merging nodes within {:.3g} m makes nodes {} and {} of element "
                       "{} one",
                       reach, mesh.node_label(block.nodes[at + b]),
                       mesh.node_label(block.nodes[at + a]), mesh.element_label(e)),
                "Merge within a smaller distance");
      }
  }
  for (const auto& [name, surface] : mesh.surfaces)
    for (int node : surface.nodes()) number[first[node]] = 0;
  std::vector<Vec3> nodes;
  std::vector<std::int64_t> labels;
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
    if (number[i] < 0) continue;
    number[i] = static_cast<int>(nodes.size());
    nodes.push_back(mesh.nodes[i]);
    labels.push_back(mesh.node_label(i));
  }
  for (ElementBlock& block : mesh.blocks)
    for (int& node : block.nodes) node = number[first[node]];
  for (auto& [name, surface] : mesh.surfaces)
    for (FaceBlock& block : surface.blocks)
      for (int& node : block.nodes) node = number[first[node]];
  for (auto& [name, set] : mesh.node_sets) {
    std::vector<int> kept;
    for (int node : set)
      if (number[first[node]] >= 0) kept.push_back(number[first[node]]);
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    set = std::move(kept);
  }
  const int gone = static_cast<int>(mesh.nodes.size() - nodes.size());
  mesh.nodes = std::move(nodes);
  mesh.node_labels = std::move(labels);
  return gone;
}

}  // namespace polhode::solids
