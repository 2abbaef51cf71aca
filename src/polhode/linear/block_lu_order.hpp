// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/linear/kkt.hpp>

namespace polhode::linear {

/// Unknowns gathered into nodes before elimination.
struct NodeGraph {
  std::vector<int> width;                    ///< By node; nodes [0, bodies) hold the bodies.
  std::vector<std::vector<int>> neighbours;  ///< Sorted.
  std::vector<std::vector<int>> after;       ///< Nodes that must be eliminated before.
  std::vector<int> row_node, row_offset;     ///< By pair: position of its multiplier rows.
};

/// Nodes of the graph: a body with the rows of the joint to its parent in a breadth-first forest,
/// starting at the ground; each other pair with rows is a node that comes after both its bodies.
[[nodiscard]] NodeGraph gather_nodes(const KktTopology& topology);

/// Elimination order, with a node's later neighbours at its elimination.
struct EliminationOrder {
  std::vector<int> order;               ///< Nodes, first eliminated first.
  std::vector<int> position;            ///< By node: position in the order.
  std::vector<std::vector<int>> later;  ///< By node: sorted by position.
};

/// Minimum-degree order (degree counts unknowns), with waiting nodes deferred.
[[nodiscard]] EliminationOrder eliminate_least_degree_first(NodeGraph graph);

}  // namespace polhode::linear
