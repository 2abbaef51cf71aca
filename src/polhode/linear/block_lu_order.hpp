// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/linear/kkt.hpp>

namespace polhode {

/// Unknowns gathered into nodes before elimination.
struct NodeGraph {
  std::vector<int> width;                    ///< By node; nodes [0, bodies) hold the bodies.
  std::vector<std::vector<int>> neighbours;  ///< Sorted.
  std::vector<std::vector<int>> after;       ///< Nodes that must be eliminated before.
  std::vector<int> row_node, row_offset;     ///< By pair: where its multiplier rows are.
};

/// A body with the rows that hold it to its parent in a breadth-first forest, begun at the
/// ground; each other pair with rows is a node that waits for both its bodies.
[[nodiscard]] NodeGraph gather_nodes(const KktTopology& topology);

/// A node's later neighbours at the moment when it is eliminated.
struct EliminationOrder {
  std::vector<int> order;               ///< Nodes, first eliminated first.
  std::vector<int> position;            ///< By node: place in the order.
  std::vector<std::vector<int>> later;  ///< By node: sorted by position.
};

/// Least degree first (degree counts unknowns), waiting nodes held back.
[[nodiscard]] EliminationOrder eliminate_least_degree_first(NodeGraph graph);

}  // namespace polhode
