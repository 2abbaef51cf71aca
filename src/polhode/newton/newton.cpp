// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <polhode/core/format.hpp>
#include <polhode/newton/globalization.hpp>
#include <polhode/newton/newton.hpp>

namespace polhode {

namespace {

/// Increment below which the quadratic remainder is below round-off. No extra iteration is needed
/// then, unless friction depends on multipliers, whose increments are not checked.
constexpr double kNoExtraIterationBelow = 1e-10;
/// Tolerance on the sum of further increments, the distance of the motion from the solution of its
/// equations, which determines the errors of momenta and energy [-].
constexpr double kLeft = 1e-13;
/// Tolerance on that sum with stiff bristles and stops, which turn tiny displacements into forces.
constexpr double kLeftStiff = 1e-18;
/// Bound of the curvature of exact constraints [1/ℓ]: with complete tangents an increment e after
/// one of e' leaves at most kCurvature·e·e'.
constexpr double kCurvature = 1e3;
/// Ratio to the smallest increment. Small increments are round-off when none has been below that
/// for several iterations.
constexpr double kGains = 0.7;
constexpr int kStalled = 3;
/// Growth factor of increments that leave a barrier. Deep in a barrier, which behaves like 1/s,
/// increments double: this is not round-off.
constexpr double kLeaves = 1.5;
/// Part of the tolerance above which increments are not round-off [-].
constexpr double kRoundOffBelow = 1e-2;
/// Contraction rate above which reused factors are renewed.
constexpr double kSlowContraction = 0.05;

/// Increment of a step, below which the next one is rounding if it is not smaller: with complete
/// tangents it would be its square.
constexpr double kRoundingOfIncrements = 1e-10;

/// Factor on the iteration limit once an increment was below the tolerance: near a singular
/// position multipliers of redundant rows converge slowly by proximal iterations.
constexpr int kMoreWhenClose = 3;
/// Initially reserved number of increments.
constexpr std::size_t kUsualIterations = 8;
/// Increment above which the iteration has diverged.
constexpr double kNewtonDiverged = 1e3;
/// Tolerance on the sum of further increments with a reused factorisation, as a part of the
/// tolerance.
constexpr double kLeftByKeptFactor = 1e-4;
/// Tolerated leak of the multipliers, Σ|λ g|, as a part of the energy.
constexpr double kEnergyLeak = 1e-14;
constexpr double kNewtonRoundOff = 4.4e-16;
/// Largest leak of rows that no contradiction keeps open, as a part of the energy: at a distance d
/// from a singular position, in sizes of bodies, a row is open by d²/2 while d² < ε and its
/// multiplier has done work over d, which leaves d/2 < 2e-6. And multiple of its rounding.
constexpr double kLeakAtSingularPosition = 1e-3, kLeakRoundings = 16.0;

/// Angle of a rotation from the length of its Cayley vector [deg].
double degrees_of(double length) { return 360.0 / std::numbers::pi * std::atan(0.5 * length); }

}  // namespace

NewtonReport solve_newton(const System& system, const State& state, Trial& trial,
                          NewtonEngine& engine, const NewtonOptions& options) {
  NewtonReport report;
  report.t = trial.context.t_n;
  report.dt = trial.context.dt;
  report.increments.reserve(kUsualIterations);
  Globalization globalization(system, state, trial, engine, options.line_search);
  globalization.limit_prediction();
  engine.begin_step(state, trial);
  std::fill(trial.lambda_centre.begin(), trial.lambda_centre.end(), 0.0);
  LeastReactions* const reactions = options.reactions;
  bool finite = !reactions || reactions->begin_step(state, trial, engine);

  bool close = false;           // an increment was below the tolerance
  bool iterated_again = false;  // an extra iteration followed
  int slow = 0;                 // consecutive iterations that hardly contracted
  int stalled = 0;              // iterations without progress, once close
  double least = std::numeric_limits<double>::infinity();  // smallest increment since then
  bool slowly_contracting = false;                         // the reused factors contract too slowly
  double defect_before = 0.0;
  const auto fail = [&](std::string reason) {
    report.reason = std::move(reason);
    const int worst = engine.worst_body();
    report.worst = engine.worst_other();
    if (report.worst == report.reason) report.worst.clear();
    if (report.worst.empty() && worst >= 0)
      report.worst = format("body '{}'", system.bodies()[worst].name);
  };
  const auto accept = [&] {
    const ConstraintCheck& c = report.constraints;
    report.leaks = c.work_defect > kLeakAtSingularPosition * options.energy_scale +
                                       kLeakRoundings * kNewtonRoundOff * c.work_scale;
    engine.end_step(state, trial);
    report.converged = true;
  };
  const bool kept = engine.keeps_factor();
  const bool may_grow = engine.may_grow() || system.set_valued();
  const bool quadratic = !kept && !may_grow && !system.stiff();
  const double left = system.stiff() ? kLeftStiff : kLeft;
  const auto most_iterations = [&] {
    return (iterated_again && !kept ? kMoreWhenClose : 1) * options.max_iterations;
  };
  for (int it = 0; it < most_iterations(); ++it) {
    const double last = report.increments.empty() ? 0.0 : report.increments.back();
    const bool refactor = options.jacobian == JacobianPolicy::every_iteration ||
                          (options.jacobian == JacobianPolicy::automatic
                               ? !close || slowly_contracting || system.set_valued()
                               : (options.jacobian == JacobianPolicy::every_step && it == 0));
    if (reactions) finite = finite && reactions->apply(state, trial, engine);
    if (!finite)
      return fail("the redundant part of the reactions cannot be found, as a value is not finite"),
             report;
    const Iteration done = globalization.iterate(last, refactor);
    ++report.iterations;
    if (!done.solved) {
      fail(done.reason.empty() ? "the linear system is singular, or a value is not finite"
                               : done.reason);
      if (done.worst_body >= 0)
        report.worst = format("body '{}'", system.bodies()[done.worst_body].name);
      return report;
    }
    const double e = done.increment;
    if (globalization.undone()) continue;
    report.increments.push_back(e);
    report.rotation = done.rotation;
    if (done.applied < 1.0) {  // limited by barriers or contacts: no measure of convergence
      close = false;
      slow = 0;
      continue;
    }
    if (e > kNewtonDiverged) return fail("diverges"), report;
    slow = last > 0.0 && !close && !may_grow && !globalization.near() && e > 0.9 * last &&
                   e > options.tolerance
               ? slow + 1
               : 0;
    const bool rounded = slow >= 2 && quadratic && e < kRoundingOfIncrements;
    if (slow >= 2 && !rounded) return fail("converges too slowly"), report;

    iterated_again = close || rounded;
    close = e < options.tolerance || rounded;  // the increment has to stay below
    if (!close) continue;
    if (kept) {  // linear convergence: the remainder is a geometric series
      const double rate = last > 0.0 ? std::min(e / last, 0.9) : 0.1;
      if (e * rate / (1.0 - rate) > kLeftByKeptFactor * options.tolerance &&
          it + 1 < options.max_iterations)
        continue;
    }
    trial.lambda_centre = trial.lambda;  // rows of loops: tree joints need no centre
    if (!iterated_again && (e > kNoExtraIterationBelow || system.stiff()) && !kept) continue;
    // Quadratic convergence leaves e (e/last)² or less. Redundant rows, whose multipliers converge
    // by proximal iterations, contract by a constant factor: these need further iterations. With
    // constraints alone such a remainder is g ≠ 0, balanced by momentum, which the check bounds.
    const double contraction = last > 0.0 ? e / last : 1.0;
    double remainder = e * contraction * contraction;
    if (system.only_constraints()) remainder = std::min(remainder, kCurvature * e * last);
    slowly_contracting = iterated_again && contraction > kSlowContraction;
    const bool leaves = globalization.near() && e > kLeaves * last;
    if (rounded)
      stalled = kStalled;
    else if (!leaves)
      stalled = iterated_again && !kept && e > kGains * least ? stalled + 1 : 0;
    if (stalled == 0) least = e;
    if (iterated_again && !kept && remainder > left && stalled < kStalled) continue;
    if (stalled >= kStalled && e > kRoundOffBelow * options.tolerance) {
      if (!quadratic || e > kRoundingOfIncrements) return fail("converges too slowly"), report;
      report.rounding = std::max(report.rounding, e);
    }
    if (done.rotation > options.max_rotation) {
      fail(
          format("a body rotates by |Θ| = {:.3g} ({:.0f} deg) in one step, more than "
                 "max_step_rotation = {:.3g} ({:.0f} deg)",
                 done.rotation, degrees_of(done.rotation), options.max_rotation,
                 degrees_of(options.max_rotation)));
      return report;
    }
    report.constraints = engine.check(state, trial);
    const ConstraintCheck& c = report.constraints;
    if (!std::isfinite(c.residual)) return fail("a value is not finite"), report;
    if (!c.broken.empty()) return fail(c.broken), report;
    // The last increment may have left the equation of a set-valued law for another one, which is
    // open however small the increment was.
    if (system.set_valued() && c.residual > left * system.length_scale() && stalled < kStalled &&
        it + 1 < options.max_iterations)
      continue;
    const double allowed = kEnergyLeak * options.energy_scale + kNewtonRoundOff * c.work_scale;
    const bool stagnates = iterated_again && it > 2 && c.work_defect > 0.5 * defect_before;
    defect_before = c.work_defect;
    const bool exact = c.work_defect <= allowed || system.rows() == 0;
    if (exact || stagnates) {
      accept();
      report.hard = !exact && report.iterations > options.max_iterations;
      return report;
    }
  }
  // Increments are small: the remainder is round-off of the multipliers.
  if (close &&
      (kept || (iterated_again && report.increments.back() < kRoundOffBelow * options.tolerance))) {
    report.constraints = engine.check(state, trial);  // multipliers have grown since the last one
    if (!report.constraints.broken.empty()) return fail(report.constraints.broken), report;
    accept();
    report.hard = true;
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
