// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <polhode/linear/kkt.hpp>

namespace polhode::linear {

/// Pattern of the dense blocks of the factors, and the list of block operations. Nodes are numbered
/// in the order of elimination.
struct BlockPlan {
  /// Positions of the two blocks of one later neighbour of a pivot.
  struct Edge {
    int node = 0;           ///< The neighbour, eliminated later.
    std::size_t upper = 0;  ///< Rows of the pivot, columns of the neighbour.
    std::size_t lower = 0;  ///< Rows of the neighbour, columns of the pivot.
  };
  struct Node {
    int width = 0;   ///< Unknowns, at most 12.
    int stride = 0;  ///< Doubles between two rows of a block of this node's columns.
    int first = 0;   ///< Into a padded vector, and into the pivot choices.
    std::size_t diagonal = 0;
    std::size_t first_edge = 0, last_edge = 0;  ///< Half-open.
    std::size_t first_target = 0;  ///< Updated blocks, (row edge, column edge) in row order.
  };
  std::vector<Node> nodes;
  std::vector<Edge> edges;
  std::vector<std::size_t> targets;
  std::size_t value_count = 0;
  int padded_size = 0;
};

/// Block-sparse LU with partial pivoting inside dense supernodes.
///
/// A body and the rows of the joint to its parent are one node ([A −B; G ε] is regular, as one
/// joint never constrains more than its child can move); other rows are separate nodes that are
/// eliminated after both their bodies (their pivot is then G A⁻¹ B + ε). Order: minimum degree. All
/// blocks are stored in one array in the order of elimination, rows padded to 4 doubles; factor()
/// and solve() allocate nothing. One object serves one thread.
class BlockLu final : public LinearSolver {
 public:
  [[nodiscard]] std::string name() const override { return "block_lu"; }
  void analyse(const KktTopology& topology) override;
  [[nodiscard]] bool factor(const KktValues& values) override;
  void solve(Vec& x) const override;
  void solve_transposed(Vec& x) const override;
  [[nodiscard]] double factor_flops() const override { return flops_; }

 private:
  /// Positions of the values of a pair. Blocks are given by their first entry.
  struct PairPlace {
    int rows = 0;
    int stride_a = 0, stride_b = 0, stride_rows = 0;
    bool has_a = false, has_b = false;
    std::size_t K_ab = 0, K_ba = 0, B_a = 0, B_b = 0, G_a = 0, G_b = 0, C = 0;
  };
  void put(const KktValues& values);

  BlockPlan plan_;
  std::vector<std::size_t> body_place_;
  std::vector<int> body_stride_;
  std::vector<PairPlace> pair_place_;
  std::vector<int> padded_of_unknown_;
  std::vector<double> values_;
  std::vector<int> pivots_;
  mutable std::vector<double> work_;
  double flops_ = 0.0;
  bool fused_ = false;  ///< By AVX2 and fused multiply-add.
};

}  // namespace polhode::linear
