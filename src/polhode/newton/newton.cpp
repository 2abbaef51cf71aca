// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/core/format.hpp>
#include <polhode/equations/iterate_snapshot.hpp>
#include <polhode/newton/barrier_guard.hpp>
#include <polhode/newton/newton.hpp>

namespace polhode {

namespace {

/// An increment below this leaves a quadratic remainder below round-off: no polish is needed,
/// unless friction depends on multipliers, whose increments are not looked at.
constexpr double kNoExtraIterationBelow = 1e-10;
/// A polish that moves less than this leaves a quadratic remainder far below round-off. What it
/// moved was the softness of redundant rows, given back by the proximal centre: how contraction
/// goes on cannot be told from it, and the leak of the multipliers is measured.
constexpr double kMeasuredBelow = 1e-9;
/// What may be left of the increments to come: the motion of the step is that close to the solution
/// of its equations, which is what momenta and energy of the bodies hang on [-].
constexpr double kLeft = 1e-13;
/// The same where bristles and stops turn tiny ways into forces.
constexpr double kLeftStiff = 1e-18;
/// Close increments are round-off when they have not come below this part of the least one in so
/// many iterations.
constexpr double kGains = 0.7;
constexpr int kStalled = 3;
/// Out of the depth of a barrier, which falls like 1/s, increments double: that is no round-off.
constexpr double kLeaves = 1.5;
/// Increments above this part of the tolerance are no round-off [-].
constexpr double kRoundOffBelow = 1e-2;
/// Kept factors that contract by less than this are renewed.
constexpr double kSlowContraction = 0.05;
/// Iterations that a step may take for one that is allowed to come close: beside a singular
/// position multipliers of redundant rows come by slow, but sure, proximal repeats.
constexpr int kMoreWhenClose = 3;
/// Room made for increments at once.
constexpr std::size_t kUsualIterations = 8;
/// An increment above this is no Newton iteration any more.
constexpr double kNewtonDiverged = 1e3;
/// With a factorisation kept from earlier steps: what later increments would add up to, as part of
/// the tolerance.
constexpr double kLeftByKeptFactor = 1e-4;
/// Increments above this are watched by the line search.
constexpr double kLarge = 0.05;
/// Leak of the multipliers, Σ|λ g|, that is asked for: part of the energy, and of round-off.
constexpr double kEnergyLeak = 1e-14;
constexpr double kNewtonRoundOff = 4.4e-16;

/// Damping: goes back to the iterate before a step that made things worse, and takes less of it.
class LineSearch {
 public:
  LineSearch(bool active, const System& system, const State& state, Trial& trial,
             NewtonEngine& engine)
      : active_(active), system_(system), state_(state), trial_(trial), engine_(engine) {}

  [[nodiscard]] double damping() const { return damping_; }

  /// Before an iteration: remembers the iterate if the last increment was large.
  void before(double last_increment) {
    kept_ = active_ && last_increment > kLarge;
    if (!kept_) return;
    engine_.end_step(state_, trial_);  // brings the multipliers into the trial
    iterate_.keep(system_, trial_);
  }
  /// After an iteration: true if it was undone.
  bool undid(double increment, double last_increment) {
    if (!kept_ || increment <= 2.0 * last_increment || damping_ < 0.2) {
      damping_ = std::min(1.0, 2.0 * damping_);
      return false;
    }
    iterate_.restore(system_, trial_);
    engine_.resume(state_, trial_);
    damping_ *= 0.5;
    return true;
  }

 private:
  bool active_, kept_ = false;
  const System& system_;
  const State& state_;
  Trial& trial_;
  NewtonEngine& engine_;
  IterateSnapshot iterate_;
  double damping_ = 1.0;
};

}  // namespace

NewtonReport solve_newton(const System& system, const State& state, Trial& trial,
                          NewtonEngine& engine, const NewtonOptions& options) {
  NewtonReport report;
  report.t = trial.context.t_n;
  report.dt = trial.context.dt;
  report.increments.reserve(kUsualIterations);
  BarrierGuard guard(system, state, trial, engine);
  guard.hold_prediction();
  engine.begin_step(state, trial);
  std::fill(trial.lambda_centre.begin(), trial.lambda_centre.end(), 0.0);

  LineSearch search(options.line_search, system, state, trial, engine);
  bool close = false;           // an increment was below the tolerance
  bool iterated_again = false;  // and another iteration followed
  int slow = 0;                 // iterations in a row that hardly contracted
  int stalled = 0;              // iterations without gain, once close
  double least = std::numeric_limits<double>::infinity();  // increment since then
  bool slowly_contracting = false;  // the factors that were kept contract too little
  double defect_before = 0.0;
  const auto fail = [&](std::string reason) {
    report.reason = std::move(reason);
    const int worst = engine.worst_body();
    report.worst = engine.worst_other();
    if (report.worst.empty() && worst >= 0)
      report.worst = format("body '{}'", system.bodies()[worst].name);
  };
  const bool kept = engine.keeps_factor();
  const double left = system.stiff() ? kLeftStiff : kLeft;
  const auto most_iterations = [&] {
    return (iterated_again && !kept ? kMoreWhenClose : 1) * options.max_iterations;
  };
  for (int it = 0; it < most_iterations(); ++it) {
    const double last = report.increments.empty() ? 0.0 : report.increments.back();
    search.before(last);
    const bool refactor = options.jacobian == JacobianPolicy::every_iteration ||
                          (options.jacobian == JacobianPolicy::automatic
                               ? !close || slowly_contracting
                               : (options.jacobian == JacobianPolicy::every_step && it == 0));
    guard.before();
    const Iteration done = guard.hold(engine.iterate(state, trial, refactor, search.damping()),
                                      refactor, search.damping());
    ++report.iterations;
    if (!done.solved) {
      fail(done.reason.empty() ? "the linear system is singular, or a value is not finite"
                               : done.reason);
      if (done.worst_body >= 0)
        report.worst = format("body '{}'", system.bodies()[done.worst_body].name);
      return report;
    }
    const double e = done.increment;
    if (!guard.near() && search.undid(e, last)) continue;
    report.increments.push_back(e);
    report.rotation = done.rotation;
    if (done.applied < 1.0) {  // held back by what lies ahead: no measure of convergence
      close = false;
      slow = 0;
      continue;
    }
    if (e > kNewtonDiverged) return fail("diverges"), report;
    slow = last > 0.0 && !close && !engine.may_grow() && !guard.near() && e > 0.9 * last &&
                   e > options.tolerance
               ? slow + 1
               : 0;
    if (slow >= 2) return fail("contracts too slowly"), report;

    iterated_again = close;
    close = e < options.tolerance;  // it was by chance if it does not stay so
    if (!close) continue;
    if (kept) {  // converges linearly: what is left is a geometric series
      const double rate = last > 0.0 ? std::min(e / last, 0.9) : 0.1;
      if (e * rate / (1.0 - rate) > kLeftByKeptFactor * options.tolerance &&
          it + 1 < options.max_iterations)
        continue;
    }
    trial.lambda_centre = trial.lambda;  // rows of loops: tree joints need no centre
    if (!iterated_again && (e > kNoExtraIterationBelow || system.stiff()) && !kept) continue;
    // Quadratic convergence leaves e (e/last)² or less. Redundant rows, whose multipliers come by
    // proximal repeats, contract by a constant factor: these go on.
    const double contraction = last > 0.0 ? e / last : 1.0;
    slowly_contracting = iterated_again && contraction > kSlowContraction;
    const bool leaves = guard.near() && e > kLeaves * last;
    if (!leaves) stalled = iterated_again && !kept && e > kGains * least ? stalled + 1 : 0;
    if (stalled == 0) least = e;
    const bool measured = e < kMeasuredBelow && !system.stiff();  // by check() below
    if (iterated_again && !kept && !measured && e * contraction * contraction > left &&
        stalled < kStalled)
      continue;
    if (stalled >= kStalled && e > kRoundOffBelow * options.tolerance)
      return fail("contracts too slowly"), report;
    if (done.rotation > options.max_rotation) {
      fail(format("turns by |Θ| = {:.3g} in one step, more than max_step_rotation = {:.3g}",
                  done.rotation, options.max_rotation));
      return report;
    }
    report.constraints = engine.check(state, trial);
    const ConstraintCheck& c = report.constraints;
    if (!std::isfinite(c.residual)) return fail("a value is not finite"), report;
    const double allowed = kEnergyLeak * options.energy_scale + kNewtonRoundOff * c.work_scale;
    const bool stagnates = iterated_again && it > 2 && c.work_defect > 0.5 * defect_before;
    defect_before = c.work_defect;
    if (c.work_defect <= allowed || system.rows() == 0 || stagnates) {
      engine.end_step(state, trial);
      report.converged = true;
      report.hard = report.iterations > options.max_iterations;
      return report;
    }
  }
  // Increments are small: what is left is round-off of the multipliers.
  if (close &&
      (kept || (iterated_again && report.increments.back() < kRoundOffBelow * options.tolerance))) {
    engine.end_step(state, trial);
    report.converged = report.hard = true;
    return report;
  }
  fail(format("has not converged in {} iterations", options.max_iterations));
  return report;
}

std::string NewtonReport::text() const {
  if (converged) return format("Newton converged in {} iterations at t = {:.9g} s", iterations, t);
  std::string s = format("Newton failed at t = {:.9g} s (step {:.3g} s): {}", t, dt, reason);
  if (!worst.empty()) s += format("; largest increment at {}", worst);
  if (!worst.empty() && !increments.empty()) s += format(" ({:.2g})", increments.back());
  return s + ".";
}

}  // namespace polhode
