// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/system/node_step.hpp>

namespace polhode {

/// Blocks of the nodes' tangent by row and column, ascending.
struct NodeBlocks {
  std::vector<int> row, column;
  bool operator==(const NodeBlocks&) const = default;
};

/// Interface of a group of elements whose nodes act on changing other nodes: contact between
/// surfaces of solids. Its tangent has its own blocks behind those of the graph of nodes,
/// consecutive from the pointer of its sink; it has no slots.
class ChangingSparsity {
 public:
  virtual ~ChangingSparsity() = default;
  /// All nodes on which it may ever act, ascending.
  [[nodiscard]] virtual const std::vector<int>& reach() const = 0;
  /// Blocks it may fill during a step. They depend on the group's history alone, so that a
  /// restarted run factors the same matrix.
  [[nodiscard]] virtual const NodeBlocks& blocks(const double* history) const = 0;
  /// Renews the neighbour list if nodes have moved far since the last search: at the end of a step,
  /// in statics after every iteration.
  /// @param step  From the positions before the last displacement to the present ones.
  virtual void renew(const NodeStep& step, double* history) const = 0;
};

}  // namespace polhode
