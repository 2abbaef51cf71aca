// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/engines/coupled_engine.hpp>
#include <polhode/engines/sparse_engine.hpp>
#include <polhode/equations/line_search.hpp>

namespace polhode {

namespace {

/// Number of node unknowns up to which a factorisation costs less than the iterations it saves.
constexpr int kFactorAlways = 3000;
/// Limits of a reused factorisation: it is renewed when an iteration contracts less than this,
/// after this many iterations of a step, or when Δt² differs by this part.
constexpr double kWorstContraction = 0.5;
constexpr int kCoupledPatience = 8;
constexpr double kStepChange = 0.2;
/// Increment below which no element is inverted: no iterate is stored.
constexpr double kHarmless = 1e-3;
/// Largest number of renewals of the contact pairs in one iteration.
constexpr int kMaxPairChanges = 4;
/// Round-off of a merit, as a part of ℓ² m.
constexpr double kNoForce = 1e-28;

/// Whether surfaces of solids have barriers. Cables alone, whose few nodes bounce on what they
/// contact, converge as well without a line search.
bool meshes_meet(const Nodes& nodes) {
  if (nodes.unknowns() == 0) return false;
  for (int g = 0; g < nodes.group_count(); ++g)
    if (nodes.group(g).barrier_constraint()) return true;
  return false;
}

}  // namespace

CoupledEngine::CoupledEngine(const System& system, const std::string& solver, MomentumRate form,
                             NodeFactor policy)
    : system_(&system),
      condensation_(system),
      nodes_(system),
      newton_(system, form),
      solver_(linear::make_linear_solver(solver)) {
  if (system.contacts()) touching_.emplace(system);
  searches_ = touching_ || meshes_meet(system.nodes());
  set_up();
  reuse_ = policy == NodeFactor::reuse ||
           (policy == NodeFactor::automatic && system.nodes().unknowns() > kFactorAlways);
  shares_.resize(system.body_count());
}

/// Sets up the matrix of bodies: interactions, then solids, then pairs that may be in contact.
void CoupledEngine::set_up() {
  std::vector<linear::KktPair> more = condensation_.pairs();
  if (touching_) more.insert(more.end(), touching_->pairs().begin(), touching_->pairs().end());
  newton_.couple(more);
  solver_->analyse(newton_.topology());
  ++analyses_;
}

void CoupledEngine::begin_step(const State& state, Trial& trial) {
  resume(state, trial);
  if (!touching_) return;
  if (!touching_->begin_step(state, trial)) set_up();
  if (const double part = touching_->free_part(); part < 1.0)
    shorten_motion(*system_, state, part, trial);
}

void CoupledEngine::resume(const State&, Trial&) {
  step_iterations_ = 0;
  last_increment_ = contraction_ = 0.0;
  before_.forget();
}

bool CoupledEngine::must_factor(const Trial& trial, bool refactor) const {
  if (!condensation_.factored()) return true;
  if (!reuse_) return refactor;
  const double dt = trial.context.dt, ratio = dt * dt / (factored_dt_ * factored_dt_);
  return std::abs(ratio - 1.0) > kStepChange || contraction_ > kWorstContraction ||
         (step_iterations_ > 0 && step_iterations_ % kCoupledPatience == 0);
}

bool CoupledEngine::take_elements(const State& state, Trial& trial, bool factor, Iteration& done) {
  ElementReport elements = nodes_.assemble(state, trial, factor, condensation_.turns(trial));
  if (elements.least_volume > 0.0) return true;
  if (before_.kept()) {
    const auto apply = [&](double part) {
      retreat(state, trial, part / part_);
      return last_increment_;
    };
    const auto merit = [&] {
      elements = nodes_.assemble(state, trial, factor, condensation_.turns(trial));
      return elements.least_volume > 0.0 ? kAdmissible : kInadmissible;
    };
    if (search_along(kUntilAdmissible, 1.0, 0.5 * part_, apply, merit)) return true;
  }
  done.reason = format("{} is inverted (det F = {:.2g})",
                       system_->nodes().element_name(nodes_.worst_group(), elements.worst_element),
                       elements.least_volume);
  return false;
}

bool CoupledEngine::solve(const State& state, const Trial& trial) {
  for (int again = 0; again < kMaxPairChanges; ++again) {
    newton_.assemble(state, trial, true);
    linear::KktValues& values = newton_.values();
    const auto couplings = newton_.cleared_couplings();
    const std::size_t cliques = condensation_.pairs().size();
    std::fill(shares_.begin(), shares_.end(), Vec6::Zero());
    const double s = trial.scale(*system_);
    condensation_.condense(nodes_.residual(), s, shares_, values.diagonal,
                           couplings.first(cliques));
    x_ = newton_.right_hand_side();
    for (int b = 0; b < system_->body_count(); ++b) x_.segment<6>(6 * b) -= shares_[b];
    if (touching_) {
      touching_->evaluate(state, trial, true);
      touching_->add_wrenches(s, x_);
      touching_->add_tangents(s, values, couplings.subspan(cliques));
    }
    if (x_.size() > 0) {
      if (!solver_->factor(values)) return false;
      solver_->solve(x_);
      if (!x_.allFinite()) return false;
    }
    if (!touching_ || touching_->cover(trial, x_)) {
      condensation_.expand(x_.data(), du_);
      return true;
    }
    set_up();
  }
  return false;
}

double CoupledEngine::merit(const State& state, const Trial& trial) {
  newton_.assemble(state, trial, false);
  const double s = trial.scale(*system_);
  rhs_ = newton_.right_hand_side();
  if (touching_) {
    touching_->evaluate(state, trial, false);
    touching_->add_wrenches(s, rhs_);
  }
  std::fill(shares_.begin(), shares_.end(), Vec6::Zero());
  condensation_.gather(nodes_.residual(), s, shares_);
  for (int b = 0; b < system_->body_count(); ++b) rhs_.segment<6>(6 * b) -= shares_[b];
  double sum = merit_of_bodies(*system_, rhs_);
  const Nodes& nodes = system_->nodes();
  for (int i = 0; i < nodes.count(); ++i)
    for (int c = 0; c < 3; ++c) {
      if (nodes.unknown(i, c) < 0) continue;
      const double R = s * nodes_.residual()[3 * static_cast<std::size_t>(i) + c];
      sum += R * R / nodes.node_mass(i);
    }
  return sum;
}

/// @eq{eq:ga-Newton-scheme}
Iteration CoupledEngine::iterate(const State& state, Trial& trial, bool refactor, double damping) {
  Iteration done;
  const bool factor = must_factor(trial, refactor);
  if (!take_elements(state, trial, factor, done)) return done;
  if (factor) {
    const int known = condensation_.meetings();
    if (!condensation_.factor(nodes_, trial)) {
      done.reason = "the matrix of the solids is singular";
      return done;
    }
    if (condensation_.meetings() != known) set_up();
    ++factorisations_;
    factored_dt_ = trial.context.dt;
    contraction_ = 0.0;
  }
  if (!solve(state, trial)) return done;
  done.solved = true;
  if (searches_ || last_increment_ == 0.0 || last_increment_ > kHarmless)
    before_.keep(*system_, trial);
  else
    before_.forget();
  part_ = touching_ ? std::min(damping, touching_->filter()) : damping;
  apply(state, trial, done);
  ++step_iterations_;
  if (last_increment_ > 0.0 && !factor) contraction_ = done.increment / last_increment_;
  last_increment_ = done.increment;
  return done;
}

/// Application of part_ of the increment; with contacts of less, until the merit decreases.
/// Inverted elements have no residual.
void CoupledEngine::apply(const State& state, Trial& trial, Iteration& done) {
  const double before = searches_ ? merit(state, trial) : 0.0;
  move(state, trial, part_, done);
  move_nodes(state, trial, part_, done);
  if (!std::isfinite(done.increment)) done.solved = false;
  if (!searches_ || !done.solved) return;
  const double round_off = kNoForce * std::pow(system_->length_scale(), 2) * system_->mean_mass();
  const auto shorten = [&](double part) {
    if (part != part_) retreat(state, trial, part / part_);
    return done.increment;
  };
  const auto reduced = [&] {
    const ElementReport elements = nodes_.assemble(state, trial, false, condensation_.turns(trial));
    if (!(elements.least_volume > 0.0)) return kInadmissible;
    const double after = merit(state, trial);
    return after < round_off ? -1.0 : after;
  };
  search_along(kReduceMerit, before, part_, shorten, reduced);
  done.applied = part_;
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

/// Moves free nodes by du_, bonded nodes with their bodies.
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

/// Returns to this fraction of the increment from the previous iterate.
void CoupledEngine::retreat(const State& state, Trial& trial, double part) {
  const System& system = newton_.system();
  const std::vector<double> inside =
      part_way(before_.unknowns(), element_unknowns(system, trial), part);
  before_.restore(system, trial);
  part_ *= part;
  for (double& d : du_) d *= part;
  Iteration again;
  apply_increments(system, state, trial, x_, part_, again, worst_body_);
  shift_nodes(state, trial);
  set_element_unknowns(system, inside, trial);
}

std::string CoupledEngine::worst_other() const {
  if (worst_node_ < 0) return touching_ ? touching_->contacts()->tightest() : std::string{};
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

void CoupledEngine::end_step(const State& state, Trial& trial) {
  if (touching_) touching_->end_step(state, trial);
}

void CoupledEngine::add_ground_wrench(double* force, double* moment) const {
  if (touching_) touching_->add_ground_wrench(force, moment);
}

double CoupledEngine::stored(const State& state) const {
  return touching_ ? touching_->stored(state) : 0.0;
}

Work CoupledEngine::commit(State& state, const Trial& trial) {
  return touching_ ? touching_->commit(state, trial) : Work{};
}

}  // namespace polhode
