// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/engines/sparse_engine.hpp>

namespace polhode {

/// @eq{eq:ga-Newton-iterations}
void apply_increments(const System& system, const State& state, Trial& trial, const Vec& x,
                      double damping, Iteration& done, int& worst) {
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
    const Vec3 turned = compose_cayley(damping * D_theta, theta);
    done.rotation = std::max(done.rotation, turned.norm());
    move_body(state, trial, slot, u + damping * D_r, turned);
  }
  const double per_scale = damping / trial.scale(system);
  const int first = 6 * system.body_count();
  for (int row = 0; row < system.rows(); ++row) trial.lambda[row] += per_scale * x[first + row];
}

SparseEngine::SparseEngine(const System& system, const std::string& solver, MomentumRate form)
    : newton_(system, form), solver_(linear::make_linear_solver(solver)) {
  solver_->analyse(newton_.topology());
  x_ = Vec::Zero(newton_.right_hand_side().size());
}

void SparseEngine::begin_step(const State&, Trial&) {}

/// @eq{eq:ga-Newton-scheme}
Iteration SparseEngine::iterate(const State& state, Trial& trial, bool refactor, double damping) {
  Iteration done;
  refactor = refactor || !factored_;
  newton_.assemble(state, trial, refactor);
  if (refactor) {
    factored_ = solver_->factor(newton_.values());
    if (!factored_) return done;
  }
  x_ = newton_.right_hand_side();
  solver_->solve(x_);
  if (!x_.allFinite()) return done;
  done.solved = true;
  apply_increments(newton_.system(), state, trial, x_, damping, done, worst_body_);
  return done;
}

ConstraintCheck SparseEngine::check(const State& state, Trial& trial) {
  return newton_.check(state, trial);
}

void SparseEngine::end_step(const State&, Trial&) {}

}  // namespace polhode
