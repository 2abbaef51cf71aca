// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include <polhode/engines/tree_loops.hpp>
#include <polhode/equations/newton_system.hpp>

namespace polhode {

namespace {

/// Builder of the plan; the maps are needed only while planning.
class Planner {
 public:
  Planner(const System& system, bool coupled)
      : system_(system), tree_(system.tree()), coupled_(coupled) {
    parent_.assign(tree_.slots, -1);
    for (int b = 0; b < system.body_count(); ++b)
      if (tree_.link[b].parent != kGround) parent_[slot(b)] = slot(tree_.link[b].parent);
    depth_.assign(tree_.slots, 0);
    for (int b : tree_.order)
      if (parent_[slot(b)] >= 0) depth_[slot(b)] = depth_[parent_[slot(b)]] + 1;
  }

  TreeLoopPlan plan() {
    plan_.extra_of_slot.assign(tree_.slots, -1);
    plan_.edge_of_slot.assign(tree_.slots, -1);
    opened_.resize(tree_.slots);
    at_common_.resize(tree_.slots);
    const auto& refs = system_.interactions();
    for (int i = 0; i < static_cast<int>(refs.size()); ++i)
      if (!tree_.in_tree[i])
        add(i, refs[i], refs[i].rows);
      else if (acts_beside_rows(system_, i))
        add(i, refs[i], 0);
    trace_loops();
    order_loops();
    write_lists();
    count_flops();
    return std::move(plan_);
  }

 private:
  [[nodiscard]] int slot(int body) const { return body == kGround ? -1 : tree_.slot_of_body[body]; }

  /// @param rows  Of the interaction; 0 if elimination along the tree contains them.
  void add(int interaction, const InteractionRef& ref, int rows) {
    OffTreeInteraction x;
    x.interaction = interaction;
    x.slot_a = slot(ref.a);
    x.slot_b = slot(ref.b);
    x.rows = rows;
    for (int s : {x.slot_a, x.slot_b})
      if (s >= 0 && plan_.extra_of_slot[s] < 0) plan_.extra_of_slot[s] = plan_.extra_count++;
    int unknowns = ref.further_part ? 0 : x.rows;
    x.further_part = ref.further_part;
    const Coupling coupling = coupled_ ? system_.traits(ref).coupling : Coupling::none;
    x.rotations_only = coupling != Coupling::all;
    if (x.slot_a >= 0 && x.slot_b >= 0 && coupling != Coupling::none) {
      const bool b_is_child = parent_[x.slot_b] == x.slot_a;
      if (b_is_child || parent_[x.slot_a] == x.slot_b) {
        const int child = b_is_child ? x.slot_b : x.slot_a;
        if (plan_.edge_of_slot[child] < 0) plan_.edge_of_slot[child] = plan_.edge_count++;
        x.edge = plan_.edge_of_slot[child];
        x.edge_child_is_b = b_is_child;
      } else {
        x.coupling = coupling;
        if (coupling == Coupling::couple) {
          x.translation_rows = x.rows > 3 ? 3 : 0;
          x.couple = plan_.couple_count++;
          unknowns = x.translation_rows + 3;
        } else if (!ref.shares_row()) {
          x.coupling_first = x.rows;
          unknowns += 12;
        }
      }
    }
    if (const auto basis = system_.group(ref.group).describe(ref.item).motion_basis)
      x.in_lanes = basis->coincident && x.edge < 0 && !system_.traits(ref).works;
    if (unknowns > 0) x.loop = add_loop(unknowns);
    if (ref.further_part) x.loop = plan_.extras.back().loop;
    if (x.coupling == Coupling::all) x.coupling_loop = ref.shares_row() ? add_loop(12) : x.loop;
    for (const int loop : {x.loop, x.coupling_loop})
      if (loop >= 0) ends_[loop].insert({x.slot_a, x.slot_b});
    plan_.extras.push_back(x);
  }

  int add_loop(int unknowns) {
    TreeLoop loop;
    loop.unknowns = unknowns;
    loop.panels = (unknowns + 7) / 8;
    loop.nu = plan_.nu_size;
    plan_.nu_size += 8 * loop.panels;
    loop.U = plan_.U_rows;
    plan_.U_rows += unknowns;
    plan_.loops.push_back(loop);
    ends_.emplace_back();
    return static_cast<int>(plan_.loops.size()) - 1;
  }

  int pair_of(int at_slot, int loop) {
    const auto [entry, fresh] = pairs_.try_emplace({at_slot, loop}, plan_.pair_rows);
    if (fresh) plan_.pair_rows += 12 * plan_.loops[loop].panels;
    return entry->second;
  }

  int block_of(int row_loop, int column_loop) {
    const auto [entry, fresh] = blocks_.try_emplace({row_loop, column_loop}, plan_.S_size);
    if (fresh) plan_.S_size += 8 * plan_.loops[row_loop].unknowns * plan_.loops[column_loop].panels;
    return entry->second;
  }

  /// Marks the bodies on the paths between a loop's ends and their lowest common ancestor.
  void trace_loops() {
    std::set<int> taken;  // pairs that an interaction writes
    for (OffTreeInteraction& x : plan_.extras) {
      const auto place = [&](int at_slot, int loop, int& pair, bool& first) {
        if (at_slot < 0 || loop < 0) return;
        pair = pair_of(at_slot, loop);
        first = taken.insert(pair).second;
      };
      place(x.slot_a, x.loop, x.pair_a, x.first_at_a);
      place(x.slot_b, x.loop, x.pair_b, x.first_at_b);
      if (x.coupling_loop < 0) continue;
      x.coupling_pair_a = pair_of(x.slot_a, x.coupling_loop);
      x.coupling_pair_b = pair_of(x.slot_b, x.coupling_loop);
    }
    const auto deeper = [&](int p, int q) { return p < 0 || (q >= 0 && depth_[p] < depth_[q]); };
    for (int l = 0; l < static_cast<int>(plan_.loops.size()); ++l) {
      std::set<int> open = ends_[l];
      while (open.size() > 1) {
        const auto lowest = std::max_element(open.begin(), open.end(), deeper);
        const int at = *lowest;
        opened_[at].push_back(l);
        open.erase(lowest);
        open.insert(parent_[at]);
      }
      const int p = *open.begin();
      TreeLoop& loop = plan_.loops[l];
      loop.common = p;
      if (p >= 0) {
        loop.common_pair = pair_of(p, l);
        at_common_[p].push_back(l);
      } else {
        plan_.ground_loops.push_back(l);
      }
      loop.S = block_of(l, l);
    }
  }

  /// Chooses the order of elimination and the fill between loops.
  void order_loops() {
    const int n = static_cast<int>(plan_.loops.size());
    std::vector<int> order;
    std::vector<std::set<int>> neighbours(n);
    for (auto b = tree_.order.rbegin(); b != tree_.order.rend(); ++b) {
      const int s = slot(*b);
      order.insert(order.end(), at_common_[s].begin(), at_common_[s].end());
      for (int l : opened_[s])
        for (int k : opened_[s])
          if (k != l) neighbours[l].insert(k);
    }
    order.insert(order.end(), plan_.ground_loops.begin(), plan_.ground_loops.end());
    std::vector<int> position(n);
    for (int i = 0; i < n; ++i) position[order[i]] = i;
    for (int l : order) {
      std::vector<int> after;
      for (int k : neighbours[l])
        if (position[k] > position[l]) after.push_back(k);
      for (int a : after)
        for (int b : after)
          if (a != b) neighbours[a].insert(b);
      TreeLoop& loop = plan_.loops[l];
      loop.first_later = static_cast<int>(plan_.later.size());
      loop.first_product = static_cast<int>(plan_.product.size());
      for (int a : after)
        plan_.later.push_back(
            {a, block_of(l, a), block_of(a, l), loop.common >= 0 ? pair_of(loop.common, a) : -1});
      loop.last_later = static_cast<int>(plan_.later.size());
      for (int b : after)
        for (int a : after) plan_.product.push_back(block_of(b, a));
    }
  }

  void write_lists() {
    std::set<int> written;
    for (const OffTreeInteraction& x : plan_.extras)
      for (const int pair : {x.pair_a, x.pair_b, x.coupling_pair_a, x.coupling_pair_b})
        if (pair >= 0) written.insert(pair);
    std::vector<std::vector<LoopAtBody>> open(tree_.slots);
    for (auto b = tree_.order.rbegin(); b != tree_.order.rend(); ++b) {
      const int s = slot(*b);
      const int free = free_directions(*b);
      for (int l : opened_[s]) {
        LoopAtBody here{.loop = l,
                        .pair = pair_of(s, l),
                        .parent_pair = -1,
                        .first_at_parent = 0,
                        .kept = plan_.kept_rows};
        plan_.kept_rows += 2 * free * plan_.loops[l].panels;
        if (parent_[s] >= 0) {
          here.parent_pair = pair_of(parent_[s], l);
          here.first_at_parent = written.insert(here.parent_pair).second ? 1 : 0;
        }
        open[s].push_back(here);
      }
    }
    plan_.first_open.push_back(0);
    plan_.first_update.push_back(0);
    plan_.first_common.push_back(0);
    for (int s = 0; s < tree_.slots; ++s) {
      const int count = static_cast<int>(open[s].size());
      plan_.most_open = std::max(plan_.most_open, count);
      plan_.open.insert(plan_.open.end(), open[s].begin(), open[s].end());
      for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j)
          plan_.update.push_back({i, j, block_of(open[s][i].loop, open[s][j].loop)});
      plan_.common.insert(plan_.common.end(), at_common_[s].begin(), at_common_[s].end());
      plan_.first_open.push_back(static_cast<int>(plan_.open.size()));
      plan_.first_update.push_back(static_cast<int>(plan_.update.size()));
      plan_.first_common.push_back(static_cast<int>(plan_.common.size()));
    }
  }

  [[nodiscard]] int free_directions(int body) const {
    const int joint = tree_.link[body].interaction;
    if (joint < 0) return 6;
    const InteractionRef& ref = system_.interactions()[joint];
    return 6 - ref.rows;
  }

  /// Counts the cost in units of the measured cost of plain elimination, 1400 flops a body.
  void count_flops() {
    double flops = 1400.0 * system_.body_count();
    for (int b : tree_.order) {
      const int s = slot(b);
      const double free = free_directions(b);
      flops += 150.0 * free * free;
      for (int i = plan_.first_open[s]; i < plan_.first_open[s + 1]; ++i)
        flops += 8.0 * plan_.loops[plan_.open[i].loop].panels * (100.0 + 50.0 * free);
      for (int i = plan_.first_update[s]; i < plan_.first_update[s + 1]; ++i) {
        const TreeLoop& row =
            plan_.loops[plan_.open[plan_.first_open[s] + plan_.update[i].row_loop].loop];
        const TreeLoop& column =
            plan_.loops[plan_.open[plan_.first_open[s] + plan_.update[i].column_loop].loop];
        flops += 16.0 * free * row.unknowns * column.panels;
      }
    }
    for (const TreeLoop& l : plan_.loops) {
      const double n = l.unknowns;
      double width = 8.0;
      for (int a = l.first_later; a < l.last_later; ++a)
        width += 8.0 * plan_.loops[plan_.later[a].loop].panels;
      flops += 16.0 * n * n * l.panels + 2.0 * n * n * width;
      for (int b = l.first_later; b < l.last_later; ++b)
        flops += 2.0 * n * plan_.loops[plan_.later[b].loop].unknowns * (width + 12.0);
    }
    plan_.flops = flops;
  }

  const System& system_;
  const SpanningTree& tree_;
  bool coupled_;
  TreeLoopPlan plan_;
  std::vector<int> parent_, depth_;
  std::vector<std::set<int>> ends_;                   ///< By loop: slots of its bodies.
  std::vector<std::vector<int>> opened_, at_common_;  ///< By slot: loops.
  std::map<std::pair<int, int>, int> pairs_, blocks_;
};

}  // namespace

TreeLoopPlan plan_tree_loops(const System& system, bool coupled) {
  return Planner(system, coupled).plan();
}

}  // namespace polhode
