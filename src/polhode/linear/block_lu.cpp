// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/assert.hpp>
#include <polhode/linear/block_lu.hpp>
#include <polhode/linear/block_lu_kernels.hpp>
#include <polhode/linear/block_lu_order.hpp>

namespace polhode::linear {

namespace {

BlockPlan make_plan(const NodeGraph& graph, const EliminationOrder& elimination) {
  BlockPlan plan;
  plan.nodes.resize(graph.width.size());
  for (std::size_t k = 0; k < plan.nodes.size(); ++k) {
    BlockPlan::Node& node = plan.nodes[k];
    node.width = graph.width[elimination.order[k]];
    node.stride = (node.width + 3) / 4 * 4;
    node.first = plan.padded_size;
    plan.padded_size += node.stride;
  }
  const auto take = [&](int rows, int stride) {
    const std::size_t first = plan.value_count;
    plan.value_count += static_cast<std::size_t>(rows) * stride;
    return first;
  };
  for (std::size_t k = 0; k < plan.nodes.size(); ++k) {
    BlockPlan::Node& node = plan.nodes[k];
    node.diagonal = take(node.width, node.stride);
    node.first_edge = plan.edges.size();
    for (int later : elimination.later[elimination.order[k]]) {
      const int j = elimination.position[later];
      plan.edges.push_back(
          {j, take(node.width, plan.nodes[j].stride), take(plan.nodes[j].width, node.stride)});
    }
    node.last_edge = plan.edges.size();
  }
  return plan;
}

/// The block of rows i and columns j (nodes in elimination order).
std::size_t block(const BlockPlan& plan, int i, int j) {
  if (i == j) return plan.nodes[i].diagonal;
  const BlockPlan::Node& pivot = plan.nodes[std::min(i, j)];
  const auto first = plan.edges.begin() + static_cast<std::ptrdiff_t>(pivot.first_edge);
  const auto last = plan.edges.begin() + static_cast<std::ptrdiff_t>(pivot.last_edge);
  const auto edge =
      std::lower_bound(first, last, std::max(i, j),
                       [](const BlockPlan::Edge& e, int node) { return e.node < node; });
  return i < j ? edge->upper : edge->lower;
}

/// Lists the blocks that each pivot updates. @returns multiplications and additions.
double list_targets(BlockPlan& plan) {
  double flops = 0.0;
  for (BlockPlan::Node& k : plan.nodes) {
    k.first_target = plan.targets.size();
    const double n = k.width;
    double others = 0.0;
    for (std::size_t r = k.first_edge; r < k.last_edge; ++r) {
      others += plan.nodes[plan.edges[r].node].width;
      for (std::size_t c = k.first_edge; c < k.last_edge; ++c)
        plan.targets.push_back(block(plan, plan.edges[r].node, plan.edges[c].node));
    }
    flops += 2.0 / 3.0 * n * n * n + 2.0 * n * n * others + 2.0 * n * others * others;
  }
  return flops;
}

}  // namespace

void BlockLu::analyse(const KktTopology& topology) {
  fused_ = topology.fused && has_fused_kernels();
  const NodeGraph graph = gather_nodes(topology);
  const EliminationOrder elimination = eliminate_least_degree_first(graph);
  plan_ = make_plan(graph, elimination);
  flops_ = list_targets(plan_);

  const std::vector<int>& position = elimination.position;
  const auto entry = [&](int i, int row, int j, int column) {
    return block(plan_, position[i], position[j]) +
           static_cast<std::size_t>(row) * plan_.nodes[position[j]].stride + column;
  };
  const auto stride = [&](int node) { return plan_.nodes[position[node]].stride; };

  padded_of_unknown_.resize(6 * static_cast<std::size_t>(topology.bodies) + topology.rows);
  body_place_.resize(topology.bodies);
  body_stride_.resize(topology.bodies);
  for (int b = 0; b < topology.bodies; ++b) {
    body_place_[b] = entry(b, 0, b, 0);
    body_stride_[b] = stride(b);
    for (int i = 0; i < 6; ++i) padded_of_unknown_[6 * b + i] = plan_.nodes[position[b]].first + i;
  }
  pair_place_.assign(topology.pairs.size(), {});
  for (std::size_t p = 0; p < topology.pairs.size(); ++p) {
    const KktPair& pair = topology.pairs[p];
    PairPlace& place = pair_place_[p];
    place.rows = pair.rows;
    place.has_a = pair.a != kGround;
    place.has_b = pair.b != kGround;
    if (place.has_a) place.stride_a = stride(pair.a);
    if (place.has_b) place.stride_b = stride(pair.b);
    if (place.has_a && place.has_b) {
      place.K_ab = entry(pair.a, 0, pair.b, 0);
      place.K_ba = entry(pair.b, 0, pair.a, 0);
    }
    if (pair.rows == 0) continue;
    const int node = graph.row_node[p], offset = graph.row_offset[p];
    place.stride_rows = stride(node);
    place.C = entry(node, offset, node, offset);
    if (place.has_a) {
      place.B_a = entry(pair.a, 0, node, offset);
      place.G_a = entry(node, offset, pair.a, 0);
    }
    if (place.has_b) {
      place.B_b = entry(pair.b, 0, node, offset);
      place.G_b = entry(node, offset, pair.b, 0);
    }
    for (int k = 0; k < pair.rows; ++k)
      padded_of_unknown_[6 * topology.bodies + pair.first_row + k] =
          plan_.nodes[position[node]].first + offset + k;
  }
  values_.assign(plan_.value_count, 0.0);
  pivots_.assign(plan_.padded_size, 0);
  work_.assign(plan_.padded_size, 0.0);
}

void BlockLu::put(const KktValues& values) {
  POLHODE_ASSERT(values.diagonal.size() == body_place_.size());
  POLHODE_ASSERT(values.pairs.size() == pair_place_.size());
  std::fill(values_.begin(), values_.end(), 0.0);
  double* const x = values_.data();
  const auto add_6x6 = [](double* to, int stride, const Mat6& K) {
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) to[i * stride + j] += K(i, j);
  };
  for (std::size_t b = 0; b < body_place_.size(); ++b)
    add_6x6(x + body_place_[b], body_stride_[b], values.diagonal[b]);
  for (std::size_t p = 0; p < pair_place_.size(); ++p) {
    const PairPlace& place = pair_place_[p];
    const KktValues::Pair& v = values.pairs[p];
    if (place.has_a && place.has_b) {
      add_6x6(x + place.K_ab, place.stride_b, v.K_ab);
      add_6x6(x + place.K_ba, place.stride_a, v.K_ba);
    }
    for (int k = 0; k < place.rows; ++k) {
      x[place.C + k * (place.stride_rows + 1)] += v.C[k];
      for (int i = 0; i < 6; ++i) {
        if (place.has_a) {
          x[place.B_a + i * place.stride_rows + k] -= v.B_a(i, k);
          x[place.G_a + k * place.stride_a + i] += v.G_a(k, i);
        }
        if (place.has_b) {
          x[place.B_b + i * place.stride_rows + k] -= v.B_b(i, k);
          x[place.G_b + k * place.stride_b + i] += v.G_b(k, i);
        }
      }
    }
  }
}

bool BlockLu::factor(const KktValues& values) {
  put(values);
  return factor_blocks(plan_, values_.data(), pivots_.data(), fused_);
}

void BlockLu::solve(Vec& x) const {
  POLHODE_ASSERT(x.size() == static_cast<Eigen::Index>(padded_of_unknown_.size()));
  for (std::size_t i = 0; i < padded_of_unknown_.size(); ++i)
    work_[padded_of_unknown_[i]] = x[static_cast<Eigen::Index>(i)];
  solve_blocks(plan_, values_.data(), pivots_.data(), work_.data(), fused_);
  for (std::size_t i = 0; i < padded_of_unknown_.size(); ++i)
    x[static_cast<Eigen::Index>(i)] = work_[padded_of_unknown_[i]];
}

void BlockLu::solve_transposed(Vec& x) const {
  POLHODE_ASSERT(x.size() == static_cast<Eigen::Index>(padded_of_unknown_.size()));
  for (std::size_t i = 0; i < padded_of_unknown_.size(); ++i)
    work_[padded_of_unknown_[i]] = x[static_cast<Eigen::Index>(i)];
  solve_blocks_transposed(plan_, values_.data(), pivots_.data(), work_.data());
  for (std::size_t i = 0; i < padded_of_unknown_.size(); ++i)
    x[static_cast<Eigen::Index>(i)] = work_[padded_of_unknown_[i]];
}

}  // namespace polhode::linear
