// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/base/format.hpp>
#include <polhode/solve/coupled_engine.hpp>
#include <polhode/solve/sparse_engine.hpp>

namespace polhode {

namespace {

/// Up to this many unknowns of nodes a factorisation costs less than the iterations it saves.
constexpr int kFactorAlways = 3000;
/// A kept factorisation is given up when an iteration contracts worse than this, after this many
/// iterations of a step, or when Δt² is off by this part.
constexpr double kWorstContraction = 0.5;
constexpr int kPatience = 8;
constexpr double kStepChange = 0.2;
/// An iterate that turns elements inside out is gone back from this often, half the way each time.
constexpr int kHalvings = 8;
/// Increments below this do not turn an element inside out: no iterate is kept to go back to.
constexpr double kHarmless = 1e-3;

}  // namespace

CoupledEngine::CoupledEngine(const System& system, const std::string& solver, MomentumRate form,
                             NodeFactor policy)
    : condensation_(system),
      nodes_(system),
      newton_(system, form, condensation_.pairs()),
      solver_(make_linear_solver(solver)) {
  solver_->analyse(newton_.topology());
  reuse_ = policy == NodeFactor::reuse ||
           (policy == NodeFactor::automatic && system.nodes().unknowns() > kFactorAlways);
  shares_.resize(system.body_count());
}

void CoupledEngine::begin_step(const State&, Trial&) {
  step_iterations_ = 0;
  last_increment_ = contraction_ = 0.0;
  before_.forget();
}

bool CoupledEngine::must_factor(const Trial& trial, bool refactor) const {
  if (!condensation_.factored()) return true;
  if (!reuse_) return refactor;
  const double dt = trial.context.dt, ratio = dt * dt / (factored_dt_ * factored_dt_);
  return std::abs(ratio - 1.0) > kStepChange || contraction_ > kWorstContraction ||
         (step_iterations_ > 0 && step_iterations_ % kPatience == 0);
}

/// @eq{eq:ga-Newton-scheme}
Iteration CoupledEngine::iterate(const State& state, Trial& trial, bool refactor, double damping) {
  const System& system = newton_.system();
  Iteration done;
  const bool factor = must_factor(trial, refactor);
  ElementReport elements = nodes_.assemble(state, trial, factor, condensation_.turns(trial));
  for (int i = 0; i < kHalvings && before_.kept() && !(elements.least_volume > 0.0); ++i) {
    retreat(state, trial);
    elements = nodes_.assemble(state, trial, factor, condensation_.turns(trial));
  }
  if (!(elements.least_volume > 0.0)) {
    done.reason = format("{} is turned inside out (det F = {:.2g})",
                         system.nodes().element_name(nodes_.worst_group(), elements.worst_element),
                         elements.least_volume);
    return done;
  }
  if (factor) {
    if (!condensation_.factor(nodes_, trial)) {
      done.reason = "the matrix of the solids is singular";
      return done;
    }
    ++factorisations_;
    factored_dt_ = trial.context.dt;
    contraction_ = 0.0;
  }
  newton_.assemble(state, trial, true);
  KktValues& values = newton_.values();
  const std::size_t own = values.pairs.size() - condensation_.pairs().size();
  const auto cliques = std::span(values.pairs).subspan(own);
  for (KktValues::Pair& v : cliques) {
    v.K_ab.setZero();
    v.K_ba.setZero();
  }
  std::fill(shares_.begin(), shares_.end(), Vec6::Zero());
  condensation_.condense(nodes_.residual(), trial.scale(system), shares_, values.diagonal, cliques);
  x_ = newton_.right_hand_side();
  for (int b = 0; b < system.body_count(); ++b) x_.segment<6>(6 * b) -= shares_[b];
  if (x_.size() > 0) {
    if (!solver_->factor(values)) return done;
    solver_->solve(x_);
    if (!x_.allFinite()) return done;
  }
  condensation_.expand(x_.data(), du_);
  done.solved = true;
  if (last_increment_ == 0.0 || last_increment_ > kHarmless)
    before_.keep(system, trial);
  else
    before_.forget();
  part_ = damping;
  move(state, trial, damping, done);
  move_nodes(state, trial, damping, done);
  if (!std::isfinite(done.increment)) done.solved = false;
  ++step_iterations_;
  if (last_increment_ > 0.0 && !factor) contraction_ = done.increment / last_increment_;
  last_increment_ = done.increment;
  return done;
}

/// @eq{eq:ga-Newton-iterations}
void CoupledEngine::move(const State& state, Trial& trial, double damping, Iteration& done) {
  worst_body_ = worst_node_ = -1;
  apply_increments(newton_.system(), state, trial, x_, damping, done, worst_body_);
}

void CoupledEngine::move_nodes(const State& state, Trial& trial, double damping, Iteration& done) {
  const Nodes& nodes = newton_.system().nodes();
  for (double& d : du_) d *= damping;
  const double per_size = 1.0 / (damping * nodes.element_size());
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
  shift_nodes(state, trial);
  const double inside = nodes_.advance(du_.data(), trial, condensation_.turns(trial));
  done.increment = std::max(done.increment, per_size * inside);
}

/// Moves free nodes by du_, bonded ones with their bodies.
void CoupledEngine::shift_nodes(const State& state, Trial& trial) const {
  const System& system = newton_.system();
  const Nodes& nodes = system.nodes();
  for (int i = 0; i < nodes.count(); ++i) {
    if (nodes.bonded(i)) continue;
    for (std::size_t k = 3 * static_cast<std::size_t>(i), end = k + 3; k < end; ++k) {
      trial.node_u[k] += du_[k];
      trial.node_x[k] = state.node_x[k] + trial.node_u[k];
    }
  }
  follow_bodies(system, state, trial);
  update_node_velocities(system, state, trial);
}

/// Half the way back to the iterate before.
void CoupledEngine::retreat(const State& state, Trial& trial) {
  const System& system = newton_.system();
  const std::vector<double> inside =
      part_way(before_.unknowns(), element_unknowns(system, trial), 0.5);
  before_.restore(system, trial);
  part_ *= 0.5;
  for (double& d : du_) d *= 0.5;
  Iteration again;
  apply_increments(system, state, trial, x_, part_, again, worst_body_);
  shift_nodes(state, trial);
  set_element_unknowns(system, inside, trial);
}

std::string CoupledEngine::worst_other() const {
  if (worst_node_ < 0) return {};
  const Nodes& nodes = newton_.system().nodes();
  for (int g = 0; g < nodes.group_count(); ++g)
    for (int e = 0; e < nodes.group(g).size(); ++e)
      for (int i : nodes.group(g).nodes(e))
        if (i == worst_node_) return format("node {}, {}", i, nodes.element_name(g, e));
  return format("node {}", worst_node_);
}

ConstraintCheck CoupledEngine::check(const State& state, Trial& trial) {
  return newton_.check(state, trial);
}

void CoupledEngine::end_step(const State&, Trial&) {}

}  // namespace polhode
