// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <polhode/solve/node_motion.hpp>
#include <polhode/solve/prescribed_kinks.hpp>

namespace polhode {

bool PrescribedKinks::find(const State& state) {
  bool any = false;
  for (const PrescribedComponent& p : system_->nodes().prescribed()) {
    if (p.displacement->is_constant()) continue;
    const TimeRates before = p.displacement->rates(state.t, TimeSide::kBefore),
                    after = p.displacement->rates(state.t, TimeSide::kAfter);
    const double jump =
        jump_at(state.t, before.rate, after.rate, std::abs(before.second) + std::abs(after.second));
    if (jump == 0.0) continue;
    if (!any) given_.assign(state.node_x.size(), 0.0);
    any = true;
    const std::size_t k = 3 * static_cast<std::size_t>(p.node) + p.component;
    given_[k] = after.rate - state.node_v[k];
  }
  return any;
}

void PrescribedKinks::settle(State& state) {
  if (!solver_) solver_ = std::make_unique<InstantSolver>(*system_);
  std::vector<Vec6> bodies;
  std::vector<double> nodes;
  if (!solver_->jumps_by_kinks(state, given_, bodies, nodes)) return;
  for (std::size_t k = 0; k < nodes.size(); ++k) state.node_v[k] += nodes[k];
  for (int b = 0; b < system_->body_count(); ++b) {
    const int slot = system_->slot(b), lane = slot % kLanes;
    const Vec6& jump = bodies[static_cast<std::size_t>(b)];
    const Vec3 dW = system_->motion(state, b).q.conjugate() * jump.tail<3>();
    BodyBlock& block = state.blocks[static_cast<std::size_t>(slot / kLanes)];
    for (int c = 0; c < 3; ++c) {  // positions keep what rounding took from them
      block.v[c][lane] += jump[c];
      block.W[c][lane] += dW[c];
    }
  }
  for (const PrescribedComponent& p : system_->nodes().prescribed())
    state.node_a[3 * static_cast<std::size_t>(p.node) + p.component] =
        p.displacement->rates(state.t, TimeSide::kAfter).second;
  state.past_count = 0;  // steps start best from the velocities at t_n then
}

}  // namespace polhode
