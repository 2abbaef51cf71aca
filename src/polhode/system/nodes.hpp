// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <polhode/core/time_function.hpp>
#include <polhode/system/element_group.hpp>

namespace polhode {

/// Body index of a node that is not bonded.
inline constexpr int kFreeNode = -2;

/// A node of a deformable solid, at the start.
struct NodeData {
  Vec3 position = Vec3::Zero();  ///< Reference position, and that of the start [m], world.
  Vec3 velocity = Vec3::Zero();  ///< [m/s]; ignored for a bonded node.
  int body = kFreeNode;          ///< Body to which it is bonded; kGround fixes it.
  Vec3 Z = Vec3::Zero();         ///< From the body's centre of mass, body axes [m].
};

/// A component of a node with a given displacement from the start [m].
struct PrescribedComponent {
  int node = 0, component = 0;
  TimeFunctionPtr displacement;
};

/// Free nodes connected by elements, with the bodies bonded to these elements. A body separates:
/// parts bonded to its two ends are two components.
struct ConnectedComponent {
  std::vector<int> nodes;   ///< Free ones; none if all nodes of an element are bonded.
  std::vector<int> bodies;  ///< In ascending order.
  /// Its matrix may be rotated with a body: no single component is fixed.
  bool turns = true;
};

/// Place of a node for messages: an element that has it, and its number among the nodes of the
/// elements of that name. All −1 if no element has it.
struct NodePlace {
  int group = -1, element = -1, number = -1;
};

/// Nodes of all deformable solids: their bonds, their graph and their masses. Nodes have no
/// rotation; a bonded node moves as x = r + Λ Z with its body. @eq{eq:rbm-position}
class Nodes {
 public:
  int add(const NodeData& node);
  void prescribe(int node, int component, TimeFunctionPtr displacement);
  /// @returns the index of the group.
  int add_elements(std::unique_ptr<ElementGroup> elements);
  /// Numbers unknowns, builds the graph, sums masses.
  /// @throws InputError if an element names a nonexistent node, a free node belongs to no element
  /// with mass, or a node is bonded and prescribed.
  void finish(int body_count);

  [[nodiscard]] int count() const { return static_cast<int>(data_.size()); }
  [[nodiscard]] bool empty() const { return data_.empty(); }
  [[nodiscard]] const NodeData& operator[](int node) const { return data_[node]; }
  [[nodiscard]] bool bonded(int node) const { return data_[node].body != kFreeNode; }
  [[nodiscard]] const std::vector<PrescribedComponent>& prescribed() const { return prescribed_; }
  /// Number of an unknown, or -1 if it is bonded or prescribed.
  [[nodiscard]] int unknown(int node, int component) const {
    return unknown_[3 * node + component];
  }
  [[nodiscard]] int unknowns() const { return unknowns_; }

  [[nodiscard]] int group_count() const { return static_cast<int>(groups_.size()); }
  [[nodiscard]] const ElementGroup& group(int i) const { return *groups_[i]; }
  [[nodiscard]] std::size_t first_history(int group) const { return first_history_[group]; }
  [[nodiscard]] std::size_t first_scratch(int group) const { return first_scratch_[group]; }
  [[nodiscard]] std::size_t history_size() const { return first_history_.back(); }
  [[nodiscard]] std::size_t scratch_size() const { return first_scratch_.back(); }

  // Graph of neighbours, row by row; a node is a neighbour of itself.
  [[nodiscard]] const std::vector<int>& row_start() const { return row_start_; }
  [[nodiscard]] const std::vector<int>& column() const { return column_; }
  /// Positions of a group's element matrices in the blocks, see ElementSink.
  [[nodiscard]] const std::vector<int>& slots(int group) const { return slots_[group]; }
  /// Consistent mass by block of the graph, the same for each direction [kg].
  [[nodiscard]] const std::vector<double>& mass() const { return mass_; }
  /// Sum of a node's row of the mass matrix [kg].
  [[nodiscard]] double node_mass(int node) const { return node_mass_[node]; }

  [[nodiscard]] const std::vector<ConnectedComponent>& pieces() const { return pieces_; }
  [[nodiscard]] int piece(int node) const { return piece_[node]; }  ///< Of a free node; else -1.
  /// Connected component of a group of elements.
  [[nodiscard]] int piece_of_group(int group) const { return piece_of_group_[group]; }
  /// Zero displacements, three for each node, for an instant.
  [[nodiscard]] const std::vector<double>& no_displacement() const { return no_displacement_; }
  [[nodiscard]] double element_size() const { return element_size_; }  ///< Mean extent [m].
  [[nodiscard]] bool conservative() const;
  [[nodiscard]] bool dissipates() const;

  /// Name of an element: "element 17 of 'solids.pad' (hex8)".
  [[nodiscard]] std::string element_name(int group, int element) const;
  /// Place of a node, for messages.
  [[nodiscard]] NodePlace place_of(int node) const;
  /// Name of a node with one of its elements: "node 8, element 17 of 'solids.pad' (hex8)".
  [[nodiscard]] std::string node_name(int node) const;

 private:
  void check() const;
  void number();
  void build_graph();
  void add_masses();
  void find_pieces();

  std::vector<NodeData> data_;
  std::vector<PrescribedComponent> prescribed_;
  std::vector<std::unique_ptr<ElementGroup>> groups_;
  std::vector<int> unknown_;
  int unknowns_ = 0;
  std::vector<std::size_t> first_history_, first_scratch_;
  std::vector<int> row_start_, column_;
  std::vector<std::vector<int>> slots_;
  std::vector<double> mass_, node_mass_, no_displacement_;
  std::vector<ConnectedComponent> pieces_;
  std::vector<int> piece_, piece_of_group_;
  double element_size_ = 1.0;
};

}  // namespace polhode
