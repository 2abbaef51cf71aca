// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>

#include <polhode/core/assert.hpp>
#include <polhode/core/disjoint_sets.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/system/changing_sparsity.hpp>
#include <polhode/system/nodes.hpp>

namespace polhode {

namespace {

bool has_mass(const ElementGroup& g) {
  if (g.size() == 0) return false;
  const auto n = static_cast<std::size_t>(g.nodes_per_element());
  std::vector<double> M(n * n);
  return g.mass(0, M.data());
}

}  // namespace

int Nodes::add(const NodeData& node) {
  POLHODE_ASSERT(first_history_.empty());  // before finish()
  data_.push_back(node);
  return count() - 1;
}

void Nodes::prescribe(int node, int component, TimeFunctionPtr displacement) {
  POLHODE_ASSERT(first_history_.empty());
  prescribed_.push_back({node, component, std::move(displacement)});
}

int Nodes::add_elements(std::unique_ptr<ElementGroup> elements) {
  POLHODE_ASSERT(first_history_.empty() && elements);
  groups_.push_back(std::move(elements));
  return group_count() - 1;
}

std::string Nodes::element_name(int group, int element) const {
  return format("element {} of '{}' ({})", element, groups_[group]->name(), groups_[group]->kind());
}

NodePlace Nodes::place_of(int node) const {
  NodePlace place;
  for (int g = 0; g < group_count() && place.group < 0; ++g)
    for (int e = 0; e < group(g).size() && place.group < 0; ++e)
      for (const int i : group(g).nodes(e))
        if (i == node) place = {g, e, node};
  if (place.group < 0) return place;
  int first = node;
  for (int g = 0; g < group_count(); ++g)
    if (group(g).name() == group(place.group).name())
      for (int e = 0; e < group(g).size(); ++e)
        for (const int i : group(g).nodes(e)) first = std::min(first, i);
  place.number -= first;
  return place;
}

std::string Nodes::node_name(int node) const {
  const NodePlace place = place_of(node);
  if (place.group < 0) return format("node {}", node);
  return format("node {}, {}", place.number, element_name(place.group, place.element));
}

bool Nodes::conservative() const {
  return prescribed_.empty() && std::all_of(groups_.begin(), groups_.end(),
                                            [](const auto& g) { return g->conservative(); });
}

bool Nodes::dissipates() const {
  return std::any_of(groups_.begin(), groups_.end(), [](const auto& g) { return g->dissipates(); });
}

void Nodes::finish(int body_count) {
  for (const NodeData& node : data_)
    if (node.body >= body_count)
      throw InputError("a node", format("is bonded to body {}, which does not exist", node.body),
                       "Give a body of this system");
  no_displacement_.assign(3 * data_.size(), 0.0);
  check();
  number();
  build_graph();
  add_masses();
  find_pieces();
}

void Nodes::check() const {
  for (int g = 0; g < group_count(); ++g)
    for (int e = 0; e < groups_[g]->size(); ++e)
      for (int node : groups_[g]->nodes(e))
        if (node < 0 || node >= count())
          throw InputError(element_name(g, e), format("names node {}, which does not exist", node),
                           format("Nodes are numbered from 0 to {}", count() - 1));
}

void Nodes::number() {
  unknown_.assign(data_.size() * 3, 0);
  for (int i = 0; i < count(); ++i)
    if (bonded(i))
      for (int c = 0; c < 3; ++c) unknown_[3 * i + c] = -1;
  for (const PrescribedComponent& p : prescribed_) {
    if (p.node < 0 || p.node >= count() || p.component < 0 || p.component > 2)
      throw InputError("a prescribed motion", "names a node or component that does not exist",
                       "Give a node of a solid and a component x, y or z");
    int& u = unknown_[3 * p.node + p.component];
    if (u < 0)
      throw InputError("a prescribed motion",
                       format("moves node {}, whose motion is given already", p.node),
                       "Prescribe each component once, and only of nodes that are not bonded");
    u = -1;
  }
  for (int& u : unknown_)
    if (u == 0) u = unknowns_++;
  first_history_.assign(1, 0);
  first_scratch_.assign(1, 0);
  for (const auto& g : groups_) {
    first_history_.push_back(first_history_.back() + g->history_size());
    first_scratch_.push_back(first_scratch_.back() + g->scratch_size());
  }
}

void Nodes::build_graph() {
  std::vector<std::vector<int>> neighbours(data_.size());
  for (int i = 0; i < count(); ++i) neighbours[i].push_back(i);
  double extents = 0.0;
  int elements = 0;
  for (const auto& g : groups_) {
    const bool massive = has_mass(*g);
    if (!g->has_tangent() && !massive) continue;
    for (int e = 0; e < g->size(); ++e) {
      const auto nodes = g->nodes(e);
      Vec3 low = data_[nodes[0]].position, high = low;
      for (int i : nodes) {
        low = low.cwiseMin(data_[i].position);
        high = high.cwiseMax(data_[i].position);
        for (int j : nodes) neighbours[i].push_back(j);
      }
      if (massive && nodes.size() > 3) extents += (high - low).mean(), ++elements;
    }
  }
  element_size_ = elements > 0 && extents > 0.0 ? extents / elements : 1.0;
  row_start_.assign(1, 0);
  column_.clear();
  for (auto& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    column_.insert(column_.end(), list.begin(), list.end());
    row_start_.push_back(static_cast<int>(column_.size()));
  }
  slots_.assign(groups_.size(), {});
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    const ElementGroup& g = *groups_[k];
    if (!g.has_tangent() && !has_mass(g)) continue;
    for (int e = 0; e < g.size(); ++e)
      for (int i : g.nodes(e))
        for (int j : g.nodes(e)) {
          const auto first = column_.begin() + row_start_[i],
                     last = column_.begin() + row_start_[i + 1];
          const auto slot = std::lower_bound(first, last, j);
          POLHODE_ASSERT(slot != last && *slot == j);
          slots_[k].push_back(static_cast<int>(slot - column_.begin()));
        }
  }
}

void Nodes::add_masses() {
  mass_.assign(column_.size(), 0.0);
  node_mass_.assign(data_.size(), 0.0);
  std::vector<double> M;
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    const ElementGroup& g = *groups_[k];
    const std::size_t n2 = static_cast<std::size_t>(g.nodes_per_element()) * g.nodes_per_element();
    M.resize(n2);
    for (int e = 0; e < g.size() && g.mass(e, M.data()); ++e)
      for (std::size_t i = 0; i < n2; ++i) mass_[slots_[k][e * n2 + i]] += M[i];
  }
  for (int i = 0; i < count(); ++i) {
    for (int b = row_start_[i]; b < row_start_[i + 1]; ++b) node_mass_[i] += mass_[b];
    const auto first = column_.begin() + row_start_[i], last = column_.begin() + row_start_[i + 1];
    const auto own = std::lower_bound(first, last, i) - column_.begin();
    if (!bonded(i) && !(mass_[own] > 0.0))
      throw InputError(format("node {}", i), "belongs to no element that has mass",
                       "Leave it out of the mesh, or give the elements around it a density");
  }
}

void Nodes::find_pieces() {
  DisjointSets sets(data_.size());
  for (const auto& g : groups_)
    for (int e = 0; e < g->size() && !slots_.empty(); ++e) {
      int first = -1;
      for (int i : g->nodes(e)) {
        if (bonded(i)) continue;
        if (first < 0) first = i;
        sets.join(first, i);
      }
    }
  // Nodes that may come into contact belong to one component.
  std::vector<const ChangingSparsity*> moving;
  for (const auto& g : groups_)
    if (const ChangingSparsity* pattern = g->changing_sparsity()) moving.push_back(pattern);
  for (const ChangingSparsity* pattern : moving) {
    int first = -1;
    for (int i : pattern->reach()) {
      if (bonded(i)) continue;
      if (first < 0) first = i;
      sets.join(first, i);
    }
  }
  piece_.assign(data_.size(), -1);
  std::vector<int> piece_of_root(data_.size(), -1);
  std::vector<std::set<int>> bodies;
  for (int i = 0; i < count(); ++i) {
    if (bonded(i)) continue;
    int& p = piece_of_root[sets.first_of(i)];
    if (p < 0) {
      p = static_cast<int>(pieces_.size());
      pieces_.emplace_back();
      bodies.emplace_back();
    }
    piece_[i] = p;
    pieces_[p].nodes.push_back(i);
  }
  for (const PrescribedComponent& p : prescribed_) pieces_[piece_[p.node]].turns = false;
  piece_of_group_.assign(groups_.size(), -1);
  for (int k = 0; k < group_count(); ++k)
    for (int e = 0; e < groups_[k]->size(); ++e) {
      int piece = -1;
      std::set<int> touched;
      for (int i : groups_[k]->nodes(e)) {
        if (piece_[i] >= 0) piece = piece_[i];
        if (data_[i].body >= 0) touched.insert(data_[i].body);
        if (data_[i].body == kGround && piece >= 0) pieces_[piece].turns = false;
      }
      if (piece < 0 && !touched.empty() && !slots_[k].empty()) {  // only bodies
        const auto same = std::find(bodies.begin(), bodies.end(), touched);
        piece = static_cast<int>(same - bodies.begin());
        if (same == bodies.end() || !pieces_[piece].nodes.empty()) {
          piece = static_cast<int>(pieces_.size());
          pieces_.emplace_back();
          bodies.emplace_back();
        }
      }
      if (piece < 0) continue;
      bodies[piece].insert(touched.begin(), touched.end());
      piece_of_group_[k] = piece;
    }
  for (const ChangingSparsity* pattern : moving) {
    const auto& reach = pattern->reach();
    const auto free =
        std::find_if(reach.begin(), reach.end(), [&](int i) { return piece_[i] >= 0; });
    if (free == reach.end()) continue;
    pieces_[piece_[*free]].turns = false;  // surfaces in contact do not rotate as one
    for (int i : reach)
      if (data_[i].body >= 0) bodies[piece_[*free]].insert(data_[i].body);
  }
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    pieces_[p].bodies.assign(bodies[p].begin(), bodies[p].end());
    if (pieces_[p].bodies.empty()) pieces_[p].turns = false;
  }
}

}  // namespace polhode
