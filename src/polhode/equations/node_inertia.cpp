// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>

#include <polhode/equations/node_inertia.hpp>

namespace polhode {

NodeInertia::NodeInertia(const System& system) : system_(&system), condensation_(system) {
  const Nodes& nodes = system.nodes();
  mass_.assign(9 * nodes.column().size(), 0.0);
  for (std::size_t b = 0; b < nodes.column().size(); ++b)
    for (int c = 0; c < 3; ++c) mass_[9 * b + 4 * c] = nodes.mass()[b];
  trial_.context.ga = GeneralizedAlpha::from_spectral_radius(0.0);  // α_f = 1: the instant itself
  trial_.context.conserving = false;
  trial_.element_scratch.resize(nodes.scratch_size());
}

bool NodeInertia::take(const State& state) {
  const Nodes& nodes = system_->nodes();
  trial_.context.t_n = state.t;
  trial_.context.dt = 0.0;
  start_trial(*system_, state, trial_);
  residual_.assign(state.node_x.size(), 0.0);
  tangent_.resize(mass_.size());
  const NodeStep instant = node_instant(*system_, state, trial_.context);
  for (int g = 0; g < nodes.group_count(); ++g) {
    const double* history = state.element_history.data() + nodes.first_history(g);
    double* scratch = trial_.element_scratch.data() + nodes.first_scratch(g);
    nodes.group(g).begin_step(history, scratch);
    // With tangents, so that elements condense their internal unknowns at the present positions.
    nodes.group(g).evaluate(instant, history, scratch, Mat3::Identity(),
                            {residual_.data(), nodes.slots(g).empty() ? nullptr : tangent_.data(),
                             nodes.slots(g).data()});
  }
  gamma_.assign(state.node_x.size(), 0.0);
  for (int i = 0; i < nodes.count(); ++i) {
    if (nodes[i].body < 0) continue;
    const BodyMotion m = system_->motion(state, nodes[i].body);
    const Vec3 omega = m.omega();
    Eigen::Map<Vec3>(gamma_.data() + 3 * i) = omega.cross(omega.cross(m.q * nodes[i].Z));
  }
  for (const PrescribedComponent& p : nodes.prescribed())
    gamma_[3 * p.node + p.component] = p.displacement->rates(state.t, TimeSide::kAfter).second;
  for (int i = 0; i < nodes.count(); ++i) {
    Eigen::Map<Vec3> R(residual_.data() + 3 * i);
    R = M_gamma(i) - R - nodes.node_mass(i) * system_->gravity();
  }
  return condense();
}

Vec3 NodeInertia::M_gamma(int node) const {
  const Nodes& nodes = system_->nodes();
  Vec3 sum = Vec3::Zero();
  for (int b = nodes.row_start()[node]; b < nodes.row_start()[node + 1]; ++b)
    sum += nodes.mass()[b] * Eigen::Map<const Vec3>(gamma_.data() + 3 * nodes.column()[b]);
  return sum;
}

bool NodeInertia::take_masses(const State& state, std::span<const double> given) {
  trial_.context.t_n = state.t;
  trial_.context.dt = 0.0;
  start_trial(*system_, state, trial_);
  residual_.assign(state.node_x.size(), 0.0);
  gamma_.assign(state.node_x.size(), 0.0);
  if (!given.empty()) {
    std::copy(given.begin(), given.end(), gamma_.begin());
    for (int i = 0; i < system_->nodes().count(); ++i)
      Eigen::Map<Vec3>(residual_.data() + 3 * i) = M_gamma(i);
  }
  return condense();
}

bool NodeInertia::condense() {
  return condensation_.factor(mass_, residual_, trial_,
                              {.arms_turn = false, .same_matrix = condensation_.factored()});
}

void NodeInertia::put(double scale, std::vector<Vec6>& force, std::vector<Mat6>& diagonal,
                      std::span<linear::KktValues::Pair> pairs) {
  std::vector<Vec6> share(force.size(), Vec6::Zero());
  condensation_.condense(residual_, scale, share, diagonal, pairs);
  for (std::size_t b = 0; b < force.size(); ++b) force[b] -= share[b];
}

void NodeInertia::press(std::span<const double> impulses, double scale, std::vector<Vec6>& force) {
  std::vector<Vec6> share(force.size(), Vec6::Zero());
  std::transform(impulses.begin(), impulses.end(), residual_.begin(), std::negate<>());
  condensation_.press(residual_, scale, share);
  for (std::size_t b = 0; b < force.size(); ++b) force[b] -= share[b];
}

const std::vector<double>& NodeInertia::accelerations(const double* bodies) {
  condensation_.expand(bodies, a_);
  for (std::size_t k = 0; k < a_.size(); ++k) a_[k] += gamma_[k];
  return a_;
}

std::vector<double> NodeInertia::reactions() const {
  const Nodes& nodes = system_->nodes();
  std::vector<double> F = residual_;  // M γ − f − M g
  for (int i = 0; i < nodes.count(); ++i)
    for (int b = nodes.row_start()[i]; b < nodes.row_start()[i + 1]; ++b) {
      const int j = nodes.column()[b];
      for (int c = 0; c < 3; ++c)
        F[3 * i + c] += nodes.mass()[b] * (a_[3 * j + c] - gamma_[3 * j + c]);
    }
  return F;
}

}  // namespace polhode
