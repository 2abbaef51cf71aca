// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/base/format.hpp>
#include <polhode/solve/drive_kinks.hpp>
#include <polhode/solve/local_error.hpp>
#include <polhode/solve/single_step.hpp>
#include <polhode/solve/stepper.hpp>
#include <polhode/time/composition.hpp>

namespace polhode {

namespace {

/// Two times closer than this part of a step are the same.
constexpr double kSameTime = 1e-9;
/// How much longer a step may be if it ends at a wanted time then [-].
constexpr double kStretch = 1e-3;
constexpr double kSafety = 0.9, kSafetyComposed = 0.8, kLeastFactor = 0.3, kMostFactor = 1.6;
/// What the companions' errors say of the error at order 6 and at order 8, measured.
constexpr double kErrorOfSix = 1.0, kErrorOfEight = 2.5;
/// Round-off of an error estimate: nothing below can be asked of a step.
constexpr double kLeastError = 1e-15;
/// Steps in a row with few iterations after which a halved step grows again.
constexpr int kEasySteps = 3, kFewIterations = 4;

}  // namespace

struct Stepper::Impl {
  const System& system;
  SingleStep single;
  DriveKinks kinks;
  StepControl control;
  std::vector<double> stages;          ///< Of the order.
  std::vector<double> check2, check4;  ///< Of the companions of orders 2 and 4.
  State before, companion;             ///< Copies to return to and to compare with.

  Impl(const System& s, std::unique_ptr<NewtonEngine> engine, const GeneralizedAlpha& ga,
       const StepControl& c, const LaneKernels& kernels)
      : system(s), single(s, std::move(engine), ga, kernels, c.conserving), kinks(s), control(c) {
    const bool doubled = c.order > 4 && s.rows() > 0;
    stages = composition_stages(c.order, doubled);
    // Companions have their stages doubled too: an odd number of single steps would end with the
    // constraint-normal velocity turned round, and the difference would tell of that alone.
    check2 = doubled ? std::vector<double>{0.5, 0.5} : std::vector<double>{1.0};
    check4 = composition_stages(4, doubled);
  }

  [[nodiscard]] bool automatic() const { return !control.step; }
  [[nodiscard]] double least_step() const {
    if (control.min_step > 0.0) return control.min_step;
    return automatic() ? 1e-9 * control.horizon : 1e-6 * *control.step;
  }
  [[nodiscard]] double most_step() const {
    if (!automatic()) return *control.step;
    return control.max_step > 0.0 ? control.max_step : control.horizon;
  }

  /// A first guess of an automatic step: a small part of the run, and of the fastest turn.
  [[nodiscard]] double first_step(const State& state) const {
    double omega = 0.0;
    for (int b = 0; b < system.body_count(); ++b)
      omega = std::max(omega, system.motion(state, b).W.norm());
    const double turn = control.order == 2 ? 0.01 : 0.5;
    return std::min({most_step(), control.horizon / 50.0, turn / std::max(omega, 1e-12)});
  }

  /// The step to try from t: not beyond the limit; a halved fixed step returns to its grid.
  [[nodiscard]] double next_length(const State& state, double t_limit) const {
    double dt = state.dt_next > 0.0 ? std::min(state.dt_next, most_step()) : most_step();
    if (!automatic()) {
      const double H = *control.step;
      const double steps_done = std::floor(state.t / H + kSameTime);
      dt = part_of((steps_done + 1.0) * H - state.t, dt);
    }
    return part_of(t_limit - state.t, dt);
  }

  /// A length of at most dt, or a thousandth more, equal parts of which make up the way to a time
  /// that is near: what is left is never a tiny step, in which multipliers, of the size of
  /// round-off/Δt², would leak energy.
  static double part_of(double way, double dt) {
    if (way > 2.0 * dt || std::abs(way - dt) <= kSameTime * dt) return dt;
    const double parts = std::ceil(way / dt - kStretch);
    const double part = parts > 1.0 ? way / parts : way;
    return std::abs(part - dt) <= kSameTime * dt ? dt : part;  // to the last bit, wherever it ends
  }

  /// Runs stages from the state; on failure the state is not restored.
  NewtonReport run_stages(State& state, const std::vector<double>& list, double H, bool fresh) {
    NewtonReport report;
    NewtonOptions newton = control.newton;
    SingleStep::Predictor predictor;
    predictor.degree = list.size() > 1 ? 1 : (automatic() ? 1 : 3);
    predictor.remember = automatic() && control.order == 2 && list.size() == 1;
    int iterations = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (fresh && i == 0) predictor.degree = -1;
      report = single.take(state, list[i] * H, newton, predictor);
      if (fresh && i == 0) predictor.degree = list.size() > 1 ? 1 : 3;
      iterations += report.iterations;
      report.iterations = iterations;
      if (!report.converged) return report;
    }
    return report;
  }

  void land(State& state, double t) const {
    state.t = t;
    if (automatic()) return;
    const double H = *control.step, grid = std::round(t / H) * H;
    if (std::abs(t - grid) < kSameTime * H) state.t = grid;
  }

  /// Largest difference of positions, orientations, and velocities times the step H, between two
  /// states [-]. A step that is too long may end at the right place with velocities that take the
  /// rest of the run elsewhere.
  [[nodiscard]] double difference(const State& x, const State& y, double H) const {
    double most = 0.0;
    const double per_length = 1.0 / system.length_scale();
    for (int b = 0; b < system.body_count(); ++b) {
      const BodyMotion m = system.motion(x, b), n = system.motion(y, b);
      most = std::max({most, per_length * (m.r - n.r).norm(),
                       2.0 * (m.q.conjugate() * n.q).vec().norm(),
                       per_length * H * (m.v - n.v).norm(), H * (m.W - n.W).norm()});
    }
    return most;
  }

  /// Estimate of the error of a composed step from cheap companions of orders 2 and 4: y4 − y and
  /// y2 − y shrink by known powers of H, so their ratio leads from one order to the next.
  std::optional<double> composed_error(const State& from, const State& reached, double H) {
    companion = from;
    single.ledger().forget();
    NewtonReport r = run_stages(companion, check2, H, true);
    single.ledger().forget();
    count_trial(companion, from);
    if (!r.converged) return std::nullopt;
    const double e2 = difference(companion, reached, H);
    companion = from;
    r = run_stages(companion, check4, H, true);
    single.ledger().forget();
    count_trial(companion, from);
    if (!r.converged) return std::nullopt;
    const double e4 = difference(companion, reached, H);
    if (e2 == 0.0) return 0.0;
    const double ratio = e4 / e2;
    return control.order == 6 ? kErrorOfSix * e4 * ratio : kErrorOfEight * e4 * ratio * ratio;
  }

  std::int64_t companion_iterations = 0;
  void count_trial(const State& after, const State& from) {
    companion_iterations += after.ledger.iterations - from.ledger.iterations;
  }

  /// Finds a first automatic step of order 2 whose estimate, known after three steps, is fine.
  void probe(State& state) {
    double dt = first_step(state);
    before = state;
    for (int attempt = 0; attempt < 40 && dt > least_step(); ++attempt) {
      companion = before;
      single.ledger().forget();
      bool fine = true;
      for (int i = 0; i < 3 && fine; ++i)
        fine = single.take(companion, dt, control.newton, {i == 0 ? -1 : 1, i == 2}).converged;
      state.ledger.iterations = companion.ledger.iterations;
      if (!fine) {
        dt *= 0.5;
        continue;
      }
      const double error = single.error_estimate(), allowed = allowed_error(dt);
      if (error <= allowed) break;
      dt *= std::clamp(kSafety * std::sqrt(allowed / error), 0.1, 0.9);
    }
    state.dt_next = dt;
    single.ledger().forget();
  }

  /// Order 2 spreads the tolerance over the run, error per unit of time; the higher orders take
  /// it per step.
  [[nodiscard]] double allowed_error(double dt) const {
    return control.order == 2
               ? std::max(kLeastError, control.tolerance * std::abs(dt) / control.horizon)
               : control.tolerance;
  }

  StepReport advance(State& state, double t_limit);
};

StepReport Stepper::Impl::advance(State& state, double t_limit) {
  StepReport report;
  if (automatic() && state.dt_next <= 0.0) {
    if (control.order == 2)
      probe(state);
    else
      state.dt_next = first_step(state);
  }
  const bool composed = stages.size() > 1;
  const double planned = state.dt_next;
  double wanted = next_length(state, t_limit);
  bool fresh = false;
  for (;;) {
    const double H = wanted;
    if (composed || automatic()) before = state;
    const bool starting = state.past_count < 2;
    report.newton = run_stages(state, stages, H, fresh);
    bool fine = report.newton.converged;
    double factor = 0.5;
    if (fine && automatic()) {
      double error = 0.0;
      bool known = true;
      if (composed) {
        companion_iterations = 0;
        const auto estimate = composed_error(before, state, H);
        known = estimate.has_value();
        error = known ? std::max(*estimate, 0.1 * before.error_last) : 0.0;
        state.error_last = known ? *estimate : 0.0;
        state.ledger.iterations += companion_iterations;
      } else if (!starting && !fresh) {
        error = single.error_estimate();
      }
      if (known) {
        const double allowed = allowed_error(H);
        const double power = composed ? 1.0 / (control.order + 1.0) : 0.5;
        const double safety = composed ? kSafetyComposed : kSafety;
        factor = error > 0.0 ? std::clamp(safety * std::pow(allowed / error, power), kLeastFactor,
                                          kMostFactor)
                             : kMostFactor;
        fine = error <= allowed;
        if (starting && !composed) factor = 1.0;
      } else {
        fine = false;
      }
    }
    if (fine) {
      report.accepted = true;
      report.t = composed ? before.t + H : state.t;
      land(state, std::abs(report.t - t_limit) < kSameTime * std::abs(H) ? t_limit : report.t);
      report.t = state.t;
      report.dt = H;
      if (automatic()) {
        // A step cut short by the limit does not make the next one short.
        const double next = factor * H;
        state.dt_next =
            std::min(most_step(), H < planned && factor >= 1.0 ? std::max(planned, next) : next);
      } else {
        const int per_stage = report.newton.iterations / static_cast<int>(stages.size());
        state.easy_steps = per_stage <= kFewIterations ? state.easy_steps + 1 : 0;
        if (H < *control.step && state.easy_steps >= kEasySteps) {
          state.dt_next = std::min(*control.step, 2.0 * std::max(H, state.dt_next));
          state.easy_steps = 0;
        }
      }
      if (!composed) {
        if (const auto estimate = error_of_last_step(system, state)) record_error(state, *estimate);
      } else if (automatic()) {
        record_error(state, {state.error_last, -1, -1});
      }
      if (report.newton.hard && state.ledger.errors.hard++ == 0)
        state.ledger.errors.hard_time = state.t;
      if (kinks.find(state)) {
        const BodySums sums = single.ledger().sums(state);
        kinks.settle(state);
        single.ledger().add_driven_jump(state, sums);
      }
      ++state.ledger.steps;
      single.ledger().close_step(state);
      return report;
    }
    // Refused: back to t_n with a shorter step; the past says little about the next trial.
    const std::int64_t iterations = state.ledger.iterations;
    if (composed || automatic()) {
      state = before;
      single.ledger().forget();
    }
    state.ledger.iterations = iterations;
    ++state.ledger.rejected;
    ++report.rejected;
    wanted *= report.newton.converged ? std::min(factor, 0.9) : 0.5;
    state.easy_steps = 0;
    fresh = !report.newton.converged;
    if (H > least_step()) {
      wanted = std::max(wanted, least_step());
    } else {
      report.message = format(
          "{} Steps down to {:.2g} s were tried. Look at what happens there: a body may be "
          "squeezed into a position its joints cannot leave, a load or spring may be far "
          "too stiff, or masses may differ by many orders. 'polhode check --tangents' tells "
          "whether the equations are sound.",
          report.newton.text(), least_step());
      return report;
    }
  }
}

Stepper::Stepper(const System& system, std::unique_ptr<NewtonEngine> engine,
                 const GeneralizedAlpha& ga, const StepControl& control, const LaneKernels& kernels)
    : impl_(std::make_unique<Impl>(system, std::move(engine), ga, control, kernels)) {}

Stepper::~Stepper() = default;

void Stepper::begin(State& state) { impl_->single.ledger().begin(state); }

StepReport Stepper::advance(State& state, double t_limit) { return impl_->advance(state, t_limit); }

const NewtonEngine& Stepper::engine() const { return impl_->single.engine(); }

Balance Stepper::balance(const State& state) const { return impl_->single.ledger().balance(state); }

std::vector<std::pair<std::string, double>> Stepper::phases() const {
  return impl_->single.phases();
}

}  // namespace polhode
