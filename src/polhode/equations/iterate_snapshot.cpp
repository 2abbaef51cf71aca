// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/equations/iterate_snapshot.hpp>
#include <polhode/system/internal_unknowns.hpp>

namespace polhode {

namespace {

/// Calls visit(group, its scratch, offset of its unknowns) for groups that have any. @returns the
/// number of unknowns.
template <class Visit>
std::size_t each_group(const System& system, const Visit& visit) {
  const Nodes& nodes = system.nodes();
  std::size_t at = 0;
  for (int g = 0; g < nodes.group_count(); ++g)
    if (const InternalUnknowns* group = nodes.group(g).internal_unknowns()) {
      visit(*group, nodes.first_scratch(g), at);
      at += group->unknowns_size();
    }
  return at;
}

}  // namespace

std::vector<double> element_unknowns(const System& system, const Trial& trial) {
  std::vector<double> unknowns(each_group(system, [](const auto&, std::size_t, std::size_t) {}));
  each_group(system, [&](const InternalUnknowns& group, std::size_t scratch, std::size_t at) {
    group.get_unknowns(trial.element_scratch.data() + scratch, unknowns.data() + at);
  });
  return unknowns;
}

void set_element_unknowns(const System& system, const std::vector<double>& unknowns, Trial& trial) {
  each_group(system, [&](const InternalUnknowns& group, std::size_t scratch, std::size_t at) {
    group.set_unknowns(unknowns.data() + at, trial.element_scratch.data() + scratch);
  });
}

std::vector<double> part_way(const std::vector<double>& a, const std::vector<double>& b,
                             double part) {
  std::vector<double> x(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) x[k] = a[k] + part * (b[k] - a[k]);
  return x;
}

void IterateSnapshot::keep(const System& system, const Trial& trial) {
  blocks_ = trial.blocks;
  lambda_ = trial.lambda;
  node_x_ = trial.node_x;
  node_u_ = trial.node_u;
  node_v_ = trial.node_v;
  unknowns_ = element_unknowns(system, trial);
  kept_ = true;
}

void IterateSnapshot::restore(const System& system, Trial& trial) const {
  std::copy(blocks_.begin(), blocks_.end(), trial.blocks.begin());
  trial.lambda = lambda_;
  trial.node_x = node_x_;
  trial.node_u = node_u_;
  trial.node_v = node_v_;
  set_element_unknowns(system, unknowns_, trial);
}

}  // namespace polhode
