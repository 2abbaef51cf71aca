// SPDX-License-Identifier: Apache-2.0
// Impulses of joints and drives in the impacts of ImpactResolver.
#include <polhode/stepping/impact_rows.hpp>
#include <polhode/stepping/velocity_jump.hpp>

namespace polhode {

/// @eq{jump-work}
void ImpactResolver::record(State& state, std::span<const Vec6> bodies,
                            std::span<const double> nodes) {
  VelocityJump jump;
  if (pulls_ && system_->rows() > 0) {
    std::vector<Vec6> jumps;
    for (int b = 0; b < system_->body_count(); ++b)
      jumps.emplace_back(velocity(state, b) - bodies[static_cast<std::size_t>(b)]);
    solver_->press_nodes(pressed_nodes_);
    jump.rows = solver_->row_impulses(pressed_, jumps);
    solver_->press_nodes({});
  }
  for (std::size_t k = 0; k < of_joints_; ++k) {
    const double p = settled_[k].normal;
    const Impact& impact = rows_[k].impact;
    if (p != 0.0) jump.more.push_back({stops_[k], p * impact.on_a, p * impact.on_b});
  }
  drive_work_ = take_jump(*system_, state, jump) + work_of_nodes(state, nodes);
}

double ImpactResolver::work_of_nodes(const State& state, std::span<const double> before) const {
  const Nodes& nodes = system_->nodes();
  double work = 0.0;
  for (const PrescribedComponent& p : nodes.prescribed()) {
    if (p.displacement->is_constant()) continue;
    const auto k = static_cast<std::size_t>(p.component);
    const auto at = [k](int node) { return 3 * static_cast<std::size_t>(node) + k; };
    double impulse = pressed_nodes_.empty() ? 0.0 : -pressed_nodes_[at(p.node)];
    for (int b = nodes.row_start()[p.node]; b < nodes.row_start()[p.node + 1]; ++b) {
      const std::size_t j = at(nodes.column()[b]);
      impulse += nodes.mass()[b] * (state.node_v[j] - before[j]);
    }
    work += impulse * p.displacement->rates(state.t, TimeSide::kBefore).rate;
  }
  return work;
}

}  // namespace polhode
