// SPDX-License-Identifier: Apache-2.0
#include <polhode/engines/contact_engine.hpp>
#include <polhode/engines/sparse_engine.hpp>
#include <polhode/equations/line_search.hpp>
#include <polhode/equations/node_motion.hpp>

namespace polhode {

namespace {

/// Scaled residual that is round-off, as a part of ℓ.
constexpr double kRoundOff = 1e-14;

}  // namespace

ContactEngine::ContactEngine(const System& system, const std::string& solver, MomentumRate form)
    : system_(&system),
      touching_(system),
      solver_(linear::make_linear_solver(solver)),
      newton_(system, form) {
  set_up();
}

/// Sets up the matrix: pairs of moving bodies in contact follow the pairs of interactions.
void ContactEngine::set_up() {
  newton_.couple(touching_.pairs());
  solver_->analyse(newton_.topology());
  factored_ = false;
  ++analyses_;
}

/// Limits the prediction like every increment.
void ContactEngine::begin_step(const State& state, Trial& trial) {
  if (!touching_.begin_step(state, trial)) set_up();
  if (const double part = touching_.free_part(); part < 1.0)
    shorten_motion(*system_, state, part, trial);
}

void ContactEngine::assemble(const State& state, const Trial& trial, bool tangent) {
  newton_.assemble(state, trial, tangent);
  touching_.evaluate(state, trial, tangent);
  const double s = trial.scale(*system_);
  rhs_ = newton_.right_hand_side();
  touching_.add_wrenches(s, rhs_);
  if (tangent) touching_.add_tangents(s, newton_.values(), newton_.cleared_couplings());
}

bool ContactEngine::solve(const State& state, const Trial& trial, bool refactor) {
  refactor = refactor || !factored_;
  assemble(state, trial, refactor);
  if (refactor) {
    factored_ = solver_->factor(newton_.values());
    if (!factored_) return false;
  }
  x_ = rhs_;
  solver_->solve(x_);
  return x_.allFinite();
}

Iteration ContactEngine::iterate(const State& state, Trial& trial, bool refactor, double damping) {
  Iteration done;
  for (int again = 0;; ++again) {
    if (!solve(state, trial, refactor)) return done;
    if (touching_.cover(trial, x_)) break;
    set_up();
    if (again == 3) return done;
  }
  done.solved = true;
  const Trial start = trial;
  const auto apply = [&](double part) {
    trial.blocks = start.blocks;
    trial.lambda = start.lambda;
    done.increment = done.rotation = 0.0;
    done.applied = part;
    apply_increments(*system_, state, trial, x_, part, done, worst_body_);
    return done.increment;
  };
  const auto merit = [&] {
    assemble(state, trial, false);
    const double after = merit_of_bodies(*system_, rhs_);
    const double size = rhs_.lpNorm<Eigen::Infinity>();
    return std::isfinite(after) && size < kRoundOff * system_->length_scale() ? -1.0 : after;
  };
  search_along(kReduceMerit, merit_of_bodies(*system_, rhs_), std::min(damping, touching_.filter()),
               apply, merit);
  return done;
}

ConstraintCheck ContactEngine::check(const State& state, Trial& trial) {
  return newton_.check(state, trial);
}

}  // namespace polhode
