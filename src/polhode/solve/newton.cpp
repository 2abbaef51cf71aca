// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/base/format.hpp>
#include <polhode/solve/newton.hpp>

namespace polhode {

namespace {

/// An increment below this leaves a quadratic remainder below round-off: no polish is needed.
constexpr double kNoPolishBelow = 1e-10;
/// An increment above this is no Newton iteration any more.
constexpr double kDiverged = 1e3;
/// With a factorisation kept from earlier steps: what later increments would add up to, as part of
/// the tolerance.
constexpr double kLeftByKeptFactor = 1e-4;
/// Increments above this are watched by the line search.
constexpr double kLarge = 0.05;
/// Leak of the multipliers, Σ|λ g|, that is asked for: part of the energy, and of round-off.
constexpr double kEnergyLeak = 1e-14;
constexpr double kRoundOff = 4.4e-16;

/// Damping: goes back to the iterate before a step that made things worse, and takes less of it.
class LineSearch {
 public:
  LineSearch(bool active, const State& state, Trial& trial, NewtonEngine& engine)
      : active_(active), state_(state), trial_(trial), engine_(engine) {}

  [[nodiscard]] double damping() const { return damping_; }

  /// Before an iteration: remembers the iterate if the last increment was large.
  void before(double last_increment) {
    kept_ = active_ && last_increment > kLarge;
    if (!kept_) return;
    engine_.end_step(state_, trial_);  // brings the multipliers into the trial
    iterate_ = trial_;
  }
  /// After an iteration: true if it was undone.
  bool undid(double increment, double last_increment) {
    if (!kept_ || increment <= 2.0 * last_increment || damping_ < 0.2) {
      damping_ = std::min(1.0, 2.0 * damping_);
      return false;
    }
    std::copy(iterate_.blocks.begin(), iterate_.blocks.end(), trial_.blocks.begin());
    trial_.lambda = iterate_.lambda;
    trial_.node_x = iterate_.node_x;
    trial_.node_u = iterate_.node_u;
    trial_.node_v = iterate_.node_v;
    trial_.element_scratch = iterate_.element_scratch;
    engine_.begin_step(state_, trial_);
    damping_ *= 0.5;
    return true;
  }

 private:
  bool active_, kept_ = false;
  const State& state_;
  Trial& trial_;
  NewtonEngine& engine_;
  Trial iterate_;
  double damping_ = 1.0;
};

}  // namespace

NewtonReport solve_newton(const System& system, const State& state, Trial& trial,
                          NewtonEngine& engine, const NewtonOptions& options) {
  NewtonReport report;
  report.t = trial.context.t_n;
  report.dt = trial.context.dt;
  engine.begin_step(state, trial);
  std::fill(trial.lambda_centre.begin(), trial.lambda_centre.end(), 0.0);

  LineSearch search(options.line_search, state, trial, engine);
  bool close = false;  // an increment was below the tolerance
  int slow = 0;        // iterations in a row that hardly contracted
  double defect_before = 0.0;
  const auto fail = [&](std::string reason) {
    report.reason = std::move(reason);
    const int worst = engine.worst_body();
    report.worst = engine.worst_other();
    if (report.worst.empty() && worst >= 0)
      report.worst = format("body '{}'", system.bodies()[worst].name);
  };
  for (int it = 0; it < options.max_iterations; ++it) {
    const double last = report.increments.empty() ? 0.0 : report.increments.back();
    search.before(last);
    const bool refactor = options.jacobian == JacobianPolicy::every_iteration ||
                          (options.jacobian == JacobianPolicy::automatic
                               ? !close
                               : (options.jacobian == JacobianPolicy::every_step && it == 0));
    const Iteration done = engine.iterate(state, trial, refactor, search.damping());
    ++report.iterations;
    if (!done.solved) {
      fail(done.reason.empty() ? "the linear system is singular, or a value is not finite"
                               : done.reason);
      if (done.worst_body >= 0)
        report.worst = format("body '{}'", system.bodies()[done.worst_body].name);
      return report;
    }
    const double e = done.increment;
    if (search.undid(e, last)) continue;
    report.increments.push_back(e);
    report.rotation = done.rotation;
    if (e > kDiverged) return fail("diverges"), report;
    slow = last > 0.0 && !close && e > 0.9 * last && e > options.tolerance ? slow + 1 : 0;
    if (slow >= 2) return fail("contracts too slowly"), report;

    const bool polished = close;
    if (e < options.tolerance) close = true;
    if (!close) continue;
    if (engine.keeps_factor()) {  // converges linearly: what is left is a geometric series
      const double rate = last > 0.0 ? std::min(e / last, 0.9) : 0.1;
      if (e * rate / (1.0 - rate) > kLeftByKeptFactor * options.tolerance &&
          it + 1 < options.max_iterations)
        continue;
    }
    trial.lambda_centre = trial.lambda;  // rows of loops: tree joints need no centre
    if (!polished && e > kNoPolishBelow && !engine.keeps_factor()) continue;
    if (done.rotation > options.max_rotation) {
      fail(format("turns by |Θ| = {:.3g} in one step, more than max_step_rotation = {:.3g}",
                  done.rotation, options.max_rotation));
      return report;
    }
    report.constraints = engine.check(state, trial);
    const ConstraintCheck& c = report.constraints;
    if (!std::isfinite(c.residual)) return fail("a value is not finite"), report;
    const double allowed = kEnergyLeak * options.energy_scale + kRoundOff * c.work_scale;
    const bool stagnates = polished && it > 2 && c.work_defect > 0.5 * defect_before;
    defect_before = c.work_defect;
    if (c.work_defect <= allowed || system.rows() == 0 || stagnates) {
      engine.end_step(state, trial);
      report.converged = true;
      return report;
    }
  }
  if (close) {  // increments are small: what is left is round-off of the multipliers
    engine.end_step(state, trial);
    report.converged = true;
    return report;
  }
  fail(format("has not converged in {} iterations", options.max_iterations));
  return report;
}

std::string NewtonReport::text() const {
  if (converged) return format("Newton converged in {} iterations at t = {:.9g} s", iterations, t);
  std::string s = format("Newton failed at t = {:.9g} s (step {:.3g} s): {}", t, dt, reason);
  if (!worst.empty()) s += format("; largest increment at {}", worst);
  if (!increments.empty()) s += format(" ({:.2g})", increments.back());
  return s + ".";
}

}  // namespace polhode
