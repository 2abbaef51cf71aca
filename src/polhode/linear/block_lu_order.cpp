// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <iterator>
#include <queue>
#include <utility>

#include <polhode/linear/block_lu_order.hpp>

namespace polhode::linear {

namespace {

/// Smallest number of rows of a joint that is combined with its body into one node.
constexpr int kMinTreeRows = 3;

void insert_sorted(std::vector<int>& list, int x) {
  const auto at = std::lower_bound(list.begin(), list.end(), x);
  if (at == list.end() || *at != x) list.insert(at, x);
}

void connect(NodeGraph& graph, int i, int j) {
  if (i == j) return;
  insert_sorted(graph.neighbours[i], j);
  insert_sorted(graph.neighbours[j], i);
}

}  // namespace

NodeGraph gather_nodes(const KktTopology& topology) {
  const int pairs = static_cast<int>(topology.pairs.size());
  NodeGraph graph;
  graph.width.assign(topology.bodies, 6);
  graph.neighbours.resize(topology.bodies);
  graph.after.resize(topology.bodies);
  graph.row_node.assign(pairs, -1);
  graph.row_offset.assign(pairs, 0);

  std::vector<std::vector<int>> pairs_of(topology.bodies);
  std::vector<int> grounded;
  for (int p = 0; p < pairs; ++p) {
    const KktPair& pair = topology.pairs[p];
    if (pair.rows < kMinTreeRows) continue;
    if (pair.a == kGround || pair.b == kGround) {
      grounded.push_back(p);
    } else {
      pairs_of[pair.a].push_back(p);
      pairs_of[pair.b].push_back(p);
    }
  }

  std::vector<char> reached(topology.bodies, 0);
  std::vector<int> queue;
  queue.reserve(topology.bodies);
  const auto hold = [&](int body, int p) {
    if (reached[body]) return;
    reached[body] = 1;
    queue.push_back(body);
    graph.row_node[p] = body;
    graph.row_offset[p] = 6;
    graph.width[body] += topology.pairs[p].rows;
  };
  std::size_t next = 0;
  const auto flood = [&] {
    for (; next < queue.size(); ++next)
      for (int p : pairs_of[queue[next]]) {
        const KktPair& pair = topology.pairs[p];
        hold(pair.a == queue[next] ? pair.b : pair.a, p);
      }
  };
  for (int p : grounded) hold(std::max(topology.pairs[p].a, topology.pairs[p].b), p);
  flood();
  for (int b = 0; b < topology.bodies; ++b) {
    if (reached[b]) continue;
    reached[b] = 1;
    queue.push_back(b);  // a free root
    flood();
  }

  std::vector<int> node_of_row(topology.rows, -1);
  for (int p = 0; p < pairs; ++p) {
    const KktPair& pair = topology.pairs[p];
    if (pair.a != kGround && pair.b != kGround) connect(graph, pair.a, pair.b);
    if (pair.rows == 0 || graph.row_node[p] >= 0) continue;
    int& node = node_of_row[pair.first_row];
    if (node < 0) {
      node = static_cast<int>(graph.width.size());
      graph.width.push_back(pair.rows);
      graph.neighbours.emplace_back();
      graph.after.emplace_back();
    }
    graph.row_node[p] = node;
    for (int body : {pair.a, pair.b}) {
      if (body == kGround) continue;
      connect(graph, node, body);
      insert_sorted(graph.after[node], body);
    }
  }
  return graph;
}

EliminationOrder eliminate_least_degree_first(NodeGraph graph) {
  const int nodes = static_cast<int>(graph.width.size());
  EliminationOrder result;
  result.position.assign(nodes, -1);
  result.later.resize(nodes);
  result.order.reserve(nodes);

  std::vector<int> waits_for(nodes, 0);
  std::vector<std::vector<int>> released_by(nodes);
  for (int i = 0; i < nodes; ++i) {
    waits_for[i] = static_cast<int>(graph.after[i].size());
    for (int body : graph.after[i]) released_by[body].push_back(i);
  }
  using Candidate = std::pair<long, int>;  // (degree, node); outdated ones are skipped
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue;
  const auto degree = [&](int i) {
    long d = 0;
    for (int j : graph.neighbours[i]) d += graph.width[j];
    return d;
  };
  for (int i = 0; i < nodes; ++i)
    if (waits_for[i] == 0) queue.push({degree(i), i});

  std::vector<int> merged;
  while (!queue.empty()) {
    const auto [d, k] = queue.top();
    queue.pop();
    if (result.position[k] >= 0) continue;
    if (const long now = degree(k); now != d) {
      queue.push({now, k});
      continue;
    }
    result.position[k] = static_cast<int>(result.order.size());
    result.order.push_back(k);
    result.later[k] = std::move(graph.neighbours[k]);
    for (int i : result.later[k]) {
      merged.clear();
      std::set_union(graph.neighbours[i].begin(), graph.neighbours[i].end(),
                     result.later[k].begin(), result.later[k].end(), std::back_inserter(merged));
      std::erase_if(merged, [i, k = k](int j) { return j == i || j == k; });
      graph.neighbours[i] = merged;
    }
    for (int i : result.later[k])
      if (waits_for[i] == 0) queue.push({degree(i), i});
    for (int i : released_by[k])
      if (--waits_for[i] == 0) queue.push({degree(i), i});
  }
  for (auto& later : result.later)
    std::sort(later.begin(), later.end(),
              [&](int i, int j) { return result.position[i] < result.position[j]; });
  return result;
}

}  // namespace polhode::linear
