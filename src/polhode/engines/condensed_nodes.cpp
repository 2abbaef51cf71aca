// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/engines/condensed_nodes.hpp>

namespace polhode {

namespace {

/// Number of node unknowns up to which a factorisation costs less than the iterations it saves.
constexpr int kFactorAlways = 3000;
/// Limits of a reused factorisation: it is renewed when an iteration contracts less than this,
/// after this many iterations of a step, or when Δt² differs by this part.
constexpr double kWorstContraction = 0.5;
constexpr int kFactorPatience = 8;
constexpr double kStepChange = 0.2;

}  // namespace

CondensedNodes::CondensedNodes(const System& system, NodeFactor policy)
    : system_(&system), condensation_(system), nodes_(system), shares_(system.body_count()) {
  reuse_ = policy == NodeFactor::reuse ||
           (policy == NodeFactor::automatic && system.nodes().unknowns() > kFactorAlways);
  const Nodes& nodes = system.nodes();
  int free = 0;
  for (int i = 0; i < nodes.count(); ++i) {
    if (nodes.bonded(i)) continue;
    node_mass_ += nodes.node_mass(i);
    ++free;
  }
  node_mass_ /= std::max(free, 1);
}

void CondensedNodes::begin() {
  step_iterations_ = 0;
  last_increment_ = contraction_ = 0.0;
}

bool CondensedNodes::must_factor(const Trial& trial, bool refactor) const {
  if (!condensation_.factored()) return true;
  if (!reuse_) return refactor;
  const double dt = trial.context.dt, ratio = dt * dt / (factored_dt_ * factored_dt_);
  return std::abs(ratio - 1.0) > kStepChange || contraction_ > kWorstContraction ||
         (step_iterations_ > 0 && step_iterations_ % kFactorPatience == 0);
}

ElementReport CondensedNodes::evaluate(const State& state, Trial& trial, bool tangent) {
  return nodes_.assemble(state, trial, tangent, condensation_.turns(trial));
}

bool CondensedNodes::factor(const Trial& trial) {
  if (!condensation_.factor(nodes_, trial)) return false;
  ++factorisations_;
  factored_dt_ = trial.context.dt;
  contraction_ = 0.0;
  return true;
}

void CondensedNodes::condense(double scale, linear::KktValues& values,
                              std::span<linear::KktValues::Pair> pairs) {
  std::fill(shares_.begin(), shares_.end(), Vec6::Zero());
  condensation_.condense(nodes_.residual(), scale, shares_, values.diagonal, pairs);
}

void CondensedNodes::reduce(Vec& rhs) const {
  for (int b = 0; b < system_->body_count(); ++b) rhs.segment<6>(6 * b) -= shares_[b];
}

double CondensedNodes::merit(double scale, Vec& rhs) {
  std::fill(shares_.begin(), shares_.end(), Vec6::Zero());
  condensation_.gather(nodes_.residual(), scale, shares_);
  reduce(rhs);
  const Nodes& nodes = system_->nodes();
  double sum = 0.0;
  for (int i = 0; i < nodes.count(); ++i)
    for (int c = 0; c < 3; ++c) {
      if (nodes.unknown(i, c) < 0) continue;
      const double R = scale * nodes_.residual()[3 * static_cast<std::size_t>(i) + c];
      sum += R * R / nodes.node_mass(i);
    }
  return sum;
}

double CondensedNodes::largest_residual(double scale) const {
  const Nodes& nodes = system_->nodes();
  double largest = 0.0;
  for (int i = 0; i < nodes.count(); ++i)
    for (int c = 0; c < 3; ++c)
      if (nodes.unknown(i, c) >= 0)
        largest =
            std::max(largest, std::abs(nodes_.residual()[3 * static_cast<std::size_t>(i) + c]));
  return node_mass_ > 0.0 ? scale * system_->mean_mass() / node_mass_ * largest : 0.0;
}

void CondensedNodes::move(const State& state, Trial& trial, double part, Iteration& done) {
  const Nodes& nodes = system_->nodes();
  const double per_size = 1.0 / nodes.element_size();
  worst_node_ = -1;
  for (int i = 0; i < nodes.count(); ++i) {
    if (nodes.bonded(i)) continue;
    for (int c = 0; c < 3; ++c) {
      const double size = per_size * std::abs(du_[3 * static_cast<std::size_t>(i) + c]);
      if (!(size <= done.increment)) {
        done.increment = size;
        worst_node_ = i;
      }
    }
  }
  move_again(state, trial, part);
  moved_ = du_;
  for (double& d : moved_) d *= part;
  const double inside = nodes_.advance(moved_.data(), trial, condensation_.turns(trial));
  done.increment = std::max(done.increment, per_size / part * inside);
}

/// Bonded nodes follow their bodies.
void CondensedNodes::move_again(const State& state, Trial& trial, double part) const {
  const Nodes& nodes = system_->nodes();
  for (int i = 0; i < nodes.count(); ++i) {
    if (nodes.bonded(i)) continue;
    for (std::size_t k = 3 * static_cast<std::size_t>(i), end = k + 3; k < end; ++k) {
      trial.node_u[k] += part * du_[k];
      trial.node_x[k] = state.node_x[k] + trial.node_u[k];
    }
  }
  follow_bodies(*system_, state, trial);
  update_node_velocities(*system_, state, trial);
}

void CondensedNodes::finish(double increment, bool factored) {
  ++step_iterations_;
  if (last_increment_ > 0.0 && !factored) contraction_ = increment / last_increment_;
  last_increment_ = increment;
}

std::string CondensedNodes::element_name(int element) const {
  return system_->nodes().element_name(nodes_.worst_group(), element);
}

std::string CondensedNodes::worst_node() const {
  return worst_node_ < 0 ? std::string{} : system_->nodes().node_name(worst_node_);
}

}  // namespace polhode
