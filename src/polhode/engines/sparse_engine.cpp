// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/beams/running_cable.hpp>
#include <polhode/core/format.hpp>
#include <polhode/engines/sparse_engine.hpp>
#include <polhode/equations/line_search.hpp>

namespace polhode {

namespace {

/// Increment below which no element is inverted: no iterate is stored.
constexpr double kHarmless = 1e-3;
/// Largest number of renewals of the contact pairs in one iteration.
constexpr int kMaxPairChanges = 4;
/// Applied part of an increment that cannot be the last.
constexpr double kNotTheLast = 0.5;
/// Scaled residual that is round-off, as a part of ℓ.
constexpr double kRoundOff = 1e-14;

/// Whether surfaces of solids have barriers. Cables alone, whose nodes have no unknowns besides
/// those of bodies, converge as well without a line search.
bool meshes_meet(const Nodes& nodes) {
  if (nodes.unknowns() == 0) return false;
  for (int g = 0; g < nodes.group_count(); ++g)
    if (nodes.group(g).barrier_constraint()) return true;
  return false;
}

/// Moves bodies and multipliers by a part of the solution x of a NewtonSystem; `worst` is the body
/// with the largest increment. @eq{eq:ga-Newton-iterations}
void apply_increments(const System& system, const State& state, Trial& trial, const Vec& x,
                      double part, Iteration& done, int& worst) {
  const double per_length = 1.0 / system.length_scale();
  worst = -1;
  for (int b = 0; b < system.body_count(); ++b) {
    const Vec3 D_r = x.segment<3>(6 * b), D_theta = x.segment<3>(6 * b + 3);
    const double size =
        std::max(per_length * D_r.lpNorm<Eigen::Infinity>(), D_theta.lpNorm<Eigen::Infinity>());
    if (worst < 0 || size > done.increment) {
      done.increment = size;
      worst = b;
    }
    const int slot = system.slot(b), lane = slot % kLanes;
    const TrialBlock& t = trial.blocks[slot / kLanes];
    const Vec3 u(t.u[0][lane], t.u[1][lane], t.u[2][lane]);
    const Vec3 theta(t.theta[0][lane], t.theta[1][lane], t.theta[2][lane]);
    const Vec3 turned = compose_cayley(part * D_theta, theta);
    done.rotation = std::max(done.rotation, turned.norm());
    move_body(state, trial, slot, u + part * D_r, turned);
  }
  const double per_scale = part / trial.scale(system);
  const int first = 6 * system.body_count();
  for (int row = 0; row < system.rows(); ++row) trial.lambda[row] += per_scale * x[first + row];
}

}  // namespace

SparseEngine::SparseEngine(const System& system, const std::string& solver, MomentumRate form,
                           NodeFactor policy)
    : system_(&system), newton_(system, form), solver_(linear::make_linear_solver(solver)) {
  if (!system.nodes().empty()) nodes_.emplace(system, policy);
  if (UnilateralRows::of(system))
    rows_.emplace(system);
  else if (system.contacts())
    contacts_.emplace(system);
  searches_ = contacts_ || meshes_meet(system.nodes());
  set_up();
}

std::unique_ptr<NewtonEngine> SparseEngine::another() const {
  if (nodes_ || contacts_ || rows_) return nullptr;
  return std::make_unique<SparseEngine>(*system_, solver_->name(), newton_.form());
}

std::string SparseEngine::name() const {
  return std::string(rows_       ? "rows + "
                     : contacts_ ? "contact + "
                                 : "") +
         (nodes_ ? "mumps + " : "") + solver_->name();
}

/// Sets up the matrix: interactions, then solids, then pairs of bodies that may be in contact.
void SparseEngine::set_up() {
  std::vector<linear::KktPair> more;
  if (nodes_) more = nodes_->pairs();
  if (contacts_) more.insert(more.end(), contacts_->pairs().begin(), contacts_->pairs().end());
  if (nodes_ || contacts_) newton_.couple(more);
  if (nodes_) pair_changes_ = nodes_->pair_changes();
  solver_->analyse(newton_.topology());
  factored_ = false;
}

/// Limits the prediction like every increment.
void SparseEngine::begin_step(const State& state, Trial& trial) {
  resume(state, trial);
  if (rows_) rows_->begin_step(state, trial);
  if (!contacts_) return;
  if (!contacts_->begin_step(state, trial)) set_up();
  if (const double part = contacts_->free_part(); part < 1.0)
    shorten_motion(*system_, state, part, trial);
}

void SparseEngine::resume(const State&, Trial&) {
  if (nodes_) nodes_->begin();
  before_.forget();
}

bool SparseEngine::prepare_nodes(const State& state, Trial& trial, bool factor, Iteration& done) {
  ElementReport elements = nodes_->evaluate(state, trial, factor);
  if (!(elements.least_volume > 0.0)) {
    const auto apply = [&](double part) {
      retreat(state, trial, part, done);
      return nodes_->last_increment();
    };
    const auto merit = [&] {
      elements = nodes_->evaluate(state, trial, factor);
      return elements.least_volume > 0.0 ? kAdmissible : kInadmissible;
    };
    if (!before_.kept() || !search_along(kUntilAdmissible, 1.0, 0.5 * part_, apply, merit)) {
      const std::string element = nodes_->element_name(elements.worst_element);
      done.reason =
          elements.least_volume == RunningCable::kNoLine
              ? format("{} has a point inside of an obstacle, or comes to its other side", element)
              : format("{} is inverted (det F = {:.2g})", element, elements.least_volume);
      return false;
    }
  }
  if (!factor) return true;
  const bool regular = nodes_->factor(trial);
  if (nodes_->pair_changes() != pair_changes_) set_up();
  if (!regular) done.reason = "the tangent matrix of the solids is singular";
  return regular;
}

/// Residual and, if `tangent`, matrix of bodies and rows; of solids the matrix only.
void SparseEngine::assemble(const State& state, const Trial& trial, bool tangent) {
  newton_.assemble(state, trial, tangent);
  rhs_ = newton_.right_hand_side();
  if (!nodes_ && !contacts_) return;
  const double s = trial.scale(*system_);
  if (contacts_) {
    contacts_->evaluate(state, trial, tangent);
    contacts_->add_wrenches(s, rhs_);
  }
  if (!tangent) return;
  const auto couplings = newton_.cleared_couplings();
  const std::size_t of_solids = nodes_ ? nodes_->pairs().size() : 0;
  if (nodes_) nodes_->condense(s, newton_.values(), couplings.first(of_solids));
  if (contacts_) contacts_->add_tangents(s, newton_.values(), couplings.subspan(of_solids));
}

bool SparseEngine::solve(const State& state, const Trial& trial, bool refactor) {
  for (int again = 0; again < kMaxPairChanges; ++again) {
    const bool tangent = refactor || !factored_ || nodes_;
    assemble(state, trial, tangent);
    x_ = rhs_;
    if (nodes_) nodes_->reduce(x_);
    if (x_.size() > 0) {
      if (tangent) factored_ = solver_->factor(newton_.values());
      if (!factored_) return false;
      solver_->solve(x_);
      if (!x_.allFinite()) return false;
      if (rows_ && !rows_->solve(state, trial, trial.scale(*system_), *solver_, x_)) return false;
    }
    if (!contacts_ || contacts_->cover(trial, x_)) {
      if (nodes_) nodes_->expand(x_);
      return true;
    }
    set_up();
  }
  return false;
}

/// @eq{eq:ga-Newton-scheme}
Iteration SparseEngine::iterate(const State& state, Trial& trial, bool refactor, double damping) {
  Iteration done;
  const bool factor = nodes_ && nodes_->must_factor(trial, refactor);
  if (nodes_ && !prepare_nodes(state, trial, factor, done)) return done;
  if (!solve(state, trial, refactor)) {
    if (rows_ && !rows_->solved()) done.reason = rows_->unsolved();
    return done;
  }
  done.solved = true;
  part_ = contacts_ ? std::min(damping, contacts_->filter()) : damping;
  const double last = nodes_ ? nodes_->last_increment() : 0.0;
  if (searches_ || (nodes_ && (last == 0.0 || last > kHarmless)))
    before_.keep(*system_, trial);
  else
    before_.forget();
  if (searches_)
    search(state, trial, done);
  else
    move(state, trial, done);
  if (!std::isfinite(done.increment)) done.solved = false;
  if (rows_ && !rows_->solved()) done.applied = std::min(done.applied, kNotTheLast);
  if (nodes_) nodes_->finish(done.increment, factor);
  return done;
}

void SparseEngine::move(const State& state, Trial& trial, Iteration& done) {
  done.rotation = 0.0;  // not that of an iterate that was left again
  apply_increments(*system_, state, trial, x_, part_, done, worst_body_);
  if (nodes_) nodes_->move(state, trial, part_, done);
}

/// Application of part_ of the increment, or less, until the merit decreases. Inverted elements
/// have no residual.
void SparseEngine::search(const State& state, Trial& trial, Iteration& done) {
  const auto merit = [&] {
    const double of_nodes = nodes_ ? nodes_->merit(trial.scale(*system_), rhs_) : 0.0;
    return merit_of_bodies(*system_, rhs_) + of_nodes;
  };
  const double before = merit();
  move(state, trial, done);
  if (!std::isfinite(done.increment)) return;
  const auto apply = [&](double part) {
    if (part != part_) retreat(state, trial, part, done);
    return done.increment;
  };
  const auto reduced = [&] {
    if (nodes_ && !(nodes_->evaluate(state, trial, false).least_volume > 0.0)) return kInadmissible;
    assemble(state, trial, false);
    const double after = merit();
    double size = rhs_.size() > 0 ? rhs_.lpNorm<Eigen::Infinity>() : 0.0;
    if (nodes_) size = std::max(size, nodes_->largest_residual(trial.scale(*system_)));
    return std::isfinite(after) && size < kRoundOff * system_->length_scale() ? -1.0 : after;
  };
  search_along(kReduceMerit, before, part_, apply, reduced);
  done.applied = part_;
}

void SparseEngine::retreat(const State& state, Trial& trial, double part, Iteration& done) {
  const std::vector<double> inside =
      part_way(before_.unknowns(), element_unknowns(*system_, trial), part / part_);
  before_.restore(*system_, trial);
  part_ = part;
  Iteration again;
  apply_increments(*system_, state, trial, x_, part_, again, worst_body_);
  done.rotation = again.rotation;
  if (nodes_) nodes_->move_again(state, trial, part_);
  set_element_unknowns(*system_, inside, trial);
}

ConstraintCheck SparseEngine::check(const State& state, Trial& trial) {
  ConstraintCheck check = newton_.check(state, trial);
  if (rows_) rows_->add_to(check, state, trial);
  return check;
}

std::string SparseEngine::worst_other() const {
  if (rows_ && !rows_->solved()) return rows_->unsolved();
  const std::string node = nodes_ ? nodes_->worst_node() : std::string{};
  return node.empty() && contacts_ ? contacts_->contacts()->tightest() : node;
}

void SparseEngine::end_step(const State& state, Trial& trial) {
  if (contacts_) contacts_->end_step(state, trial);
}

void SparseEngine::add_ground_wrench(double* force, double* moment) const {
  if (contacts_) contacts_->add_ground_wrench(force, moment);
  if (rows_) rows_->add_ground_wrench(force, moment);
}

double SparseEngine::stored(const State& state) const {
  return contacts_ ? contacts_->stored(state) : 0.0;
}

Work SparseEngine::commit(State& state, const Trial& trial) {
  if (rows_) return rows_->commit(state, trial);
  return contacts_ ? contacts_->commit(state, trial) : Work{};
}

}  // namespace polhode
