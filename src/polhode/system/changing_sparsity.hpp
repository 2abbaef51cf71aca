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

/// A group of elements whose nodes meet others from time to time: surfaces of solids that touch one
/// another. Its tangent goes to blocks of its own behind those of the graph of nodes, which stand
/// one after the other where its sink points; slots it has none.
class ChangingSparsity {
 public:
  virtual ~ChangingSparsity() = default;
  /// All nodes that it may ever act on, ascending.
  [[nodiscard]] virtual const std::vector<int>& reach() const = 0;
  /// The blocks it may fill during a step. They follow from the group's history alone, so that a
  /// run that goes on from a saved state factors the same matrix.
  [[nodiscard]] virtual const NodeBlocks& blocks(const double* history) const = 0;
  /// Looks anew for what may meet, if nodes have gone far since that was done: beside at the end of
  /// a step, in statics after every iteration.
  /// @param step  From where nodes were before the last move to where they are.
  virtual void renew(const NodeStep& step, double* history) const = 0;
};

}  // namespace polhode
