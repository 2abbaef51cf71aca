// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <polhode/equations/node_motion.hpp>
#include <polhode/stepping/drive_kinks.hpp>
#include <polhode/stepping/velocity_jump.hpp>

namespace polhode {

void DriveKinks::pass(State& state, EnergyLedger& ledger) {
  if (!find(state)) return;
  const BodySums sums = ledger.sums(state);
  settle(state);  // its work is the change of energy, with that of nodes
  ledger.add_driven_jump(state, sums);
}

bool DriveKinks::find(const State& state) {
  given_.clear();
  rows_.clear();
  for (const PrescribedComponent& p : system_->nodes().prescribed()) {
    if (p.displacement->is_constant()) continue;
    const TimeRates before = p.displacement->rates(state.t, TimeSide::kBefore),
                    after = p.displacement->rates(state.t, TimeSide::kAfter);
    const double jump =
        jump_at(state.t, before.rate, after.rate, std::abs(before.second) + std::abs(after.second));
    if (jump == 0.0) continue;
    given_.resize(state.node_x.size(), 0.0);
    const std::size_t k = 3 * static_cast<std::size_t>(p.node) + p.component;
    given_[k] = after.rate - state.node_v[k];
  }
  for (const int i : system_->drives()) {
    const InteractionRef& ref = system_->interactions()[i];
    const InteractionGroup& group = system_->group(ref.group);
    const PairView view = system_->instant(state, ref, state.lambda.data());
    const PrescribedRows before = group.prescribed(ref.item, view.step(), TimeSide::kBefore),
                         after = group.prescribed(ref.item, view.step(), TimeSide::kAfter);
    for (int k = 0; k < ref.rows; ++k) {
      const double jump = jump_at(state.t, before.rate[k], after.rate[k],
                                  std::abs(before.second[k]) + std::abs(after.second[k]));
      if (jump == 0.0) continue;
      rows_.resize(static_cast<std::size_t>(system_->rows()), 0.0);
      rows_[static_cast<std::size_t>(ref.first_row + k)] = jump;
    }
  }
  return !given_.empty() || !rows_.empty();
}

void DriveKinks::settle(State& state) {
  if (!solver_) solver_ = std::make_unique<InstantSolver>(*system_);
  std::vector<Vec6> bodies;
  std::vector<double> nodes;
  VelocityJump jump{.rows = {}, .more = {}, .rate = VelocityJump::Rate::mean};
  if (!solver_->jumps_by_kinks(state, given_, rows_, bodies, nodes, jump.rows)) return;
  add_jumps(*system_, bodies, nodes, state);
  take_jump(*system_, state, jump);
  for (const PrescribedComponent& p : system_->nodes().prescribed())
    state.node_a[3 * static_cast<std::size_t>(p.node) + p.component] =
        p.displacement->rates(state.t, TimeSide::kAfter).second;
  state.past_count = 0;  // steps then start best from the velocities at t_n
}

}  // namespace polhode
