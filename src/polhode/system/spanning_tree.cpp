// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/assert.hpp>
#include <polhode/system/spanning_tree.hpp>
#include <polhode/system/state.hpp>

namespace polhode {

namespace {

/// Number of bodies above which a depth-first order uses the cache better than a breadth-first one.
constexpr int kDepthFirstFrom = 10000;

struct Edge {
  int candidate;
  int other;        ///< The body at the far end.
  bool as_child_b;  ///< The far end is b, so no reversal is needed.
};

/// Whether every body comes after its parent.
bool has_parents_first(const SpanningTree& tree) {
  std::vector<char> seen(tree.order.size(), 0);
  for (const int body : tree.order) {
    const int parent = tree.link[body].parent;
    if (parent != kGround && !seen[parent]) return false;
    seen[body] = 1;
  }
  return true;
}

}  // namespace

int shape_code(const std::optional<MotionBasis>& basis) {
  return basis ? 4 * basis->translation_rows() + basis->directions : 0;
}

SpanningTree build_spanning_tree(int bodies, int interactions,
                                 std::span<const TreeCandidate> candidates,
                                 std::span<const int> shapes) {
  SpanningTree tree;
  tree.link.resize(bodies);
  tree.in_tree.assign(interactions, 0);

  std::vector<std::vector<Edge>> edges(bodies);
  std::vector<Edge> ground_edges;
  for (int c = 0; c < static_cast<int>(candidates.size()); ++c) {
    const TreeCandidate& j = candidates[c];
    const Edge to_b{c, j.b, true}, to_a{c, j.a, false};
    if (j.b != kGround && (j.a == kGround ? true : j.a != j.b))
      (j.a == kGround ? ground_edges : edges[j.a]).push_back(to_b);
    if (j.a != kGround && j.may_reverse)
      (j.b == kGround ? ground_edges : edges[j.b]).push_back(to_a);
  }

  std::vector<char> reached(bodies, 0);
  std::vector<int> breadth_first;
  breadth_first.reserve(bodies);
  const auto attach = [&](const Edge& e, int parent) {
    if (e.other == kGround || reached[e.other]) return;
    const TreeCandidate& j = candidates[e.candidate];
    reached[e.other] = 1;
    tree.link[e.other] = {parent, j.interaction};
    tree.in_tree[j.interaction] = 1;
    if (!e.as_child_b) tree.reversed.push_back(j.interaction);
    breadth_first.push_back(e.other);
  };
  std::size_t next = 0;
  const auto flood = [&] {
    for (; next < breadth_first.size(); ++next)
      for (const Edge& e : edges[breadth_first[next]]) attach(e, breadth_first[next]);
  };
  for (const Edge& e : ground_edges) attach(e, kGround);
  flood();
  for (int b = 0; b < bodies; ++b) {
    if (reached[b]) continue;
    reached[b] = 1;
    breadth_first.push_back(b);  // a free root
    flood();
  }

  if (bodies < kDepthFirstFrom) {
    tree.order = breadth_first;
  } else {
    std::vector<std::vector<int>> children(bodies);
    std::vector<int> stack;
    for (int b : breadth_first)
      if (tree.link[b].parent != kGround) children[tree.link[b].parent].push_back(b);
    for (auto b = breadth_first.rbegin(); b != breadth_first.rend(); ++b)
      if (tree.link[*b].parent == kGround) stack.push_back(*b);
    while (!stack.empty()) {
      const int b = stack.back();
      stack.pop_back();
      tree.order.push_back(b);
      stack.insert(stack.end(), children[b].rbegin(), children[b].rend());
    }
  }

  const auto shape_of = [&](int body) {
    const int joint = tree.link[body].interaction;
    return joint < 0 ? 0 : shapes[joint];
  };
  tree.slot_of_body.resize(bodies);
  for (int first = 0; first < bodies; first += kChunkBodies) {
    const int last = std::min(bodies, first + kChunkBodies);
    std::vector<int> chunk(tree.order.begin() + first, tree.order.begin() + last);
    std::stable_sort(chunk.begin(), chunk.end(),
                     [&](int x, int y) { return shape_of(x) < shape_of(y); });
    const int first_run = static_cast<int>(tree.runs.size());
    for (std::size_t i = 0; i < chunk.size();) {
      const int shape = shape_of(chunk[i]);
      const int first_slot = static_cast<int>(tree.body_of_slot.size());
      for (; i < chunk.size() && shape_of(chunk[i]) == shape; ++i) {
        tree.slot_of_body[chunk[i]] = static_cast<int>(tree.body_of_slot.size());
        tree.body_of_slot.push_back(chunk[i]);
      }
      while (tree.body_of_slot.size() % kLanes != 0) tree.body_of_slot.push_back(-1);
      const int last_slot = static_cast<int>(tree.body_of_slot.size());
      tree.runs.push_back({first_slot / kLanes, (last_slot - first_slot) / kLanes, shape});
    }
    tree.chunks.push_back({first_run, static_cast<int>(tree.runs.size()), first, last});
  }
  tree.slots = static_cast<int>(tree.body_of_slot.size());
  POLHODE_ASSERT(has_parents_first(tree));
  return tree;
}

}  // namespace polhode
