// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include <polhode/core/assert.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

int System::add_body(BodyData body, const BodyMotion& start) {
  POLHODE_ASSERT(!finished_);
  bodies_.push_back(std::move(body));
  start_.push_back(start);
  return body_count() - 1;
}

void System::set_switching(std::string_view kind, int item, Switching how) {
  for (const auto& group : groups_) {
    if (group->kind() != kind || item >= group->size()) continue;
    group->set_switching(item, how);
    return;
  }
  throw std::logic_error("System::set_switching: there is no such interaction");
}

bool System::is_off(const State& state, int interaction) const {
  const InteractionRef& ref = refs_[static_cast<std::size_t>(interaction)];
  return groups_[static_cast<std::size_t>(ref.group)]->is_off(
      ref.item, state.history.data() + ref.first_history);
}

void System::finish() {
  POLHODE_ASSERT(!finished_);
  finished_ = true;
  const int n = body_count();
  std::vector<TreeCandidate> candidates;
  std::vector<int> shapes;
  int histories = 0;
  for (int g = 0; g < static_cast<int>(groups_.size()); ++g) {
    groups_[g]->finish();
    for (int i = 0; i < groups_[g]->size(); ++i) {
      const InteractionTraits& traits = groups_[g]->traits(i);
      const auto [a, b] = traits.bodies;
      if (a < kGround || a >= n || b < kGround || b >= n || (a == b))
        throw InputError(
            format("{} '{}'", groups_[g]->kind(), traits.name),
            a == b ? "acts between a body and itself" : "names a body that does not exist",
            "Give two different bodies of this system, or one and the ground");
      const auto basis = groups_[g]->describe(i).motion_basis;
      const int index = static_cast<int>(refs_.size());
      if (traits.has_barrier) barriers_.push_back(index);
      if (traits.unilateral > 0) unilateral_.push_back(index);
      if (traits.prescribes) drives_.push_back(index);
      // Forces of set-valued laws are unknowns of their own, not functions of tiny displacements.
      stiff_ = stiff_ || (traits.rows > 0 && traits.works && !traits.set_valued);
      set_valued_ = set_valued_ || traits.set_valued;
      only_constraints_ = only_constraints_ && traits.rows > 0 && !traits.works &&
                          !traits.dissipates && !traits.compliant && !traits.has_barrier &&
                          traits.unilateral == 0;
      if (basis) candidates.push_back({a, b, index, traits.reversible});
      shapes.push_back(shape_code(basis));
      InteractionRef ref{g, i, a, b, traits.rows, rows_, histories, index};
      ref.last_part = !traits.row_goes_on;
      if (i > 0 && groups_[g]->traits(i - 1).row_goes_on) {
        ref.further_part = true;
        ref.first_row = refs_.back().first_row;
        ref.first_part = refs_.back().first_part;
      } else {
        rows_ += traits.rows;
      }
      refs_.push_back(ref);
      histories += traits.history_size;
      conservative_ = conservative_ && traits.conservative;
      dissipates_ = dissipates_ || traits.dissipates;
    }
  }
  tree_ = build_spanning_tree(n, static_cast<int>(refs_.size()), candidates, shapes);
  for (int index : tree_.reversed) {
    InteractionRef& ref = refs_[index];
    groups_[ref.group]->reverse(ref.item);
    std::swap(ref.a, ref.b);
  }
  if (!tree_.reversed.empty())
    for (const auto& group : groups_) group->finish();

  // Scales: mean mass, and the mean size of a body (joint arms, radius of gyration).
  std::vector<double> reach(n);
  for (int b = 0; b < n; ++b)
    reach[b] = std::sqrt(0.5 * bodies_[b].inertia.trace() / bodies_[b].mass);
  for (const InteractionRef& ref : refs_) {
    const double length = traits(ref).reach;
    if (ref.a != kGround) reach[ref.a] = std::max(reach[ref.a], length);
    if (ref.b != kGround) reach[ref.b] = std::max(reach[ref.b], length);
    if (const auto basis = groups_[ref.group]->describe(ref.item).motion_basis) {
      if (ref.a != kGround) reach[ref.a] = std::max(reach[ref.a], basis->Z_a.norm());
      if (ref.b != kGround) reach[ref.b] = std::max(reach[ref.b], basis->Z_b.norm());
    }
  }
  nodes_.finish(n);
  only_constraints_ = only_constraints_ && nodes_.count() == 0 && contacts_ == nullptr;
  for (int g = 0; g < nodes_.group_count(); ++g)
    stiff_ = stiff_ || nodes_.group(g).barrier_constraint();
  conservative_ = conservative_ && nodes_.conservative();
  dissipates_ = dissipates_ || nodes_.dissipates();
  for (int i = 0; i < nodes_.count(); ++i)
    if (const int b = nodes_[i].body; b >= 0) reach[b] = std::max(reach[b], nodes_[i].Z.norm());
  for (const BodyData& body : bodies_) carried_mass_.push_back(body.mass);
  for (int i = 0; i < nodes_.count(); ++i) {
    if (nodes_[i].body >= 0) carried_mass_[nodes_[i].body] += nodes_.node_mass(i);
    if (nodes_.piece(i) < 0) continue;
    const std::vector<int>& holders = nodes_.pieces()[nodes_.piece(i)].bodies;
    for (int b : holders)
      carried_mass_[b] += nodes_.node_mass(i) / static_cast<double>(holders.size());
  }
  double mass = 0.0, length = 0.0;
  for (int b = 0; b < n; ++b) {
    mass += bodies_[b].mass;
    length += reach[b];
  }
  mean_mass_ = n > 0 ? mass / n : 1.0;
  length_ = n > 0 && length > 0.0 ? length / n : 1.0;
  if (n == 0 && !nodes_.empty()) {  // only solids
    Vec3 low = nodes_[0].position, high = low;
    for (int i = 0; i < nodes_.count(); ++i) {
      low = low.cwiseMin(nodes_[i].position);
      high = high.cwiseMax(nodes_[i].position);
    }
    if (high != low) length_ = (high - low).norm();
  }

  initial_.blocks.resize(tree_.slots / kLanes);
  if (!initial_.blocks.empty())
    std::memset(static_cast<void*>(initial_.blocks.data()), 0,
                initial_.blocks.size() * sizeof(BodyBlock));
  for (int s = 0; s < tree_.slots; ++s)
    initial_.set_motion(s,
                        tree_.body_of_slot[s] < 0 ? BodyMotion{} : start_[tree_.body_of_slot[s]]);
  initial_.lambda.assign(rows_, 0.0);
  initial_.history.assign(static_cast<std::size_t>(histories + memory_size_), 0.0);
  for (const InteractionRef& ref : refs_)
    if (traits(ref).switching == Switching::starts_off)
      groups_[ref.group]->switch_off(ref.item, initial_.history.data() + ref.first_history);
  for (int i = 0; i < nodes_.count(); ++i)
    for (int c = 0; c < 3; ++c) {
      initial_.node_x.push_back(nodes_[i].position[c]);
      initial_.node_v.push_back(nodes_[i].velocity[c]);
    }
  initial_.node_a.assign(initial_.node_x.size(), 0.0);
  initial_.node_past.assign(kPast * initial_.node_x.size(), 0.0);
  initial_.element_history.assign(nodes_.history_size(), 0.0);
  for (int g = 0; g < nodes_.group_count(); ++g)
    nodes_.group(g).initialize(initial_.element_history.data() + nodes_.first_history(g));
}

BodyStep System::instant(const State& state, int body) const {
  if (body == kGround) return BodyStep::ground(1.0);
  const BodyMotion m = motion(state, body);
  return BodyStep::at_instant(m.r, m.Lambda(), m.v, m.W);
}

PairView System::instant(const State& state, const InteractionRef& ref,
                         const double* lambda) const {
  StepContext still;
  still.t_n = state.t;
  return {instant(state, ref.a), instant(state, ref.b), still,
          lambda ? lambda + ref.first_row : nullptr, state.history.data() + ref.first_history};
}

}  // namespace polhode
