// SPDX-License-Identifier: Apache-2.0
// The stepper's variables and short functions, for its three source files.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include <polhode/dynamics/composition.hpp>
#include <polhode/stepping/drive_kinks.hpp>
#include <polhode/stepping/extrapolation_table.hpp>
#include <polhode/stepping/force_kinks.hpp>
#include <polhode/stepping/single_step.hpp>
#include <polhode/stepping/start.hpp>
#include <polhode/stepping/step_control.hpp>
#include <polhode/stepping/step_error.hpp>
#include <polhode/stepping/step_lengths.hpp>
#include <polhode/stepping/step_reach.hpp>
#include <polhode/stepping/step_verdict.hpp>
#include <polhode/stepping/stepper.hpp>
#include <polhode/system/impulsive_contacts.hpp>
#include <polhode/system/time_breaks.hpp>

namespace polhode {

using namespace step_control;

struct Stepper::Impl {
  const System& system;
  SingleStep single;
  DriveKinks kinks;
  ForceKinks force_kinks;
  GeneralizedAlpha ga;
  StepControl control;
  TimeBreaks breaks;
  std::vector<double> stages{1.0};          ///< Of the order.
  std::vector<double> check2, check4;       ///< Of the companions of orders 2 and 4.
  std::optional<ExtrapolationTable> table;  ///< Instead of a composition.
  State before, companion;                  ///< Copies to return to and to compare with.
  bool by_two = false;  ///< The present step is one of order 2, though there is a table.
  /// Where extrapolated steps first had to be much shorter: time [s] and the body with the largest
  /// error, or −1.
  std::optional<std::pair<double, int>> shortened;
  double give_up_above = 0.0;  ///< Error that ends an extrapolated trial early [-]; 0: none.
  bool to_break = false;       ///< The trial ends at a break of a function of time.
  bool cut_short = false;      ///< A limit made the present step much shorter than planned.
  double tried_from = 0.0;  ///< Length of steps of order 2 that an extrapolated one replaces [s].
  StepReach reach;
  double least_error = kMinError;  ///< Rounding of positions [-].
  double reach_of_bodies = 0.0;    ///< Largest length among their positions and extents [m].

  Impl(const System& s, std::unique_ptr<NewtonEngine> engine, const GeneralizedAlpha& g,
       const StepControl& c, const LaneKernels& kernels)
      : system(s),
        single(s, std::move(engine), g, kernels, c.conserving),
        kinks(s),
        force_kinks(s),
        ga(g),
        control(c),
        breaks(s, c.horizon, c.order == 2 ? kBreaksOfTwo : std::max(kBreaksComposed, c.order - 3)) {
    least_error = std::max(kMinError, kStepRoundOff * extent(s) / s.length_scale()) *
                  (c.order > 2 ? kRoundOffComposed : 1.0);
    reach_of_bodies = std::max(s.length_scale(), extent(s));
    if (c.extrapolated) table.emplace(s, c.order, single, c.threads);
    if (table) return;
    const bool doubled = c.order > 4 && s.rows() > 0;
    stages = composition_stages(c.order, doubled);
    // Companions have doubled stages too: an odd number of single steps would end with the
    // constraint-normal velocity reversed, which would dominate the difference.
    check2 = doubled ? std::vector<double>{0.5, 0.5} : std::vector<double>{1.0};
    check4 = composition_stages(4, doubled);
  }

  [[nodiscard]] bool automatic() const { return !control.step; }
  /// Whether steps are extrapolated now.
  [[nodiscard]] bool extrapolates() const { return table && !by_two; }
  /// Whether a step consists of several single ones.
  [[nodiscard]] bool composed() const { return stages.size() > 1 || extrapolates(); }
  /// Number of members of an extrapolated step from the state.
  [[nodiscard]] int columns(const State& state) const {
    return state.columns > 1 ? state.columns : table->most_columns();
  }
  [[nodiscard]] double least_step() const {
    if (control.min_step > 0.0) return control.min_step;
    return automatic() ? 1e-9 * control.horizon : 1e-6 * *control.step;
  }
  [[nodiscard]] double most_step() const {
    if (!automatic()) return *control.step;
    return control.max_step > 0.0 ? control.max_step : control.horizon;
  }

  /// Shortest length of a step here: of the usual ones, which are those of the run if that is
  /// shorter.
  [[nodiscard]] double shortest_length(const State& state) const {
    const double usual = !automatic()          ? std::min(*control.step, control.horizon)
                         : state.dt_next > 0.0 ? state.dt_next
                                               : first_step(state);
    return shortest_step(state.t, usual);
  }

  /// Initial length of an automatic step: a small part of the run, and of the fastest rotation.
  [[nodiscard]] double first_step(const State& state) const {
    double omega = 0.0;
    for (int b = 0; b < system.body_count(); ++b)
      omega = std::max(omega, system.motion(state, b).W.norm());
    const double turn = composed() ? 0.5 : 0.01;
    return std::min({most_step(), control.horizon / 50.0, turn / std::max(omega, 1e-12)});
  }

  /// Longest step of at most dt for which loads are sampled often enough.
  [[nodiscard]] double sampled(const State& state, double dt) const {
    if (!automatic() || breaks.empty()) return dt;
    return breaks.sampled_length(state.t, dt, composed() ? kSamplesComposed : 1.0);
  }

  /// Length of the next trial from t: not beyond the limit and the next break; a fixed step that
  /// was cut returns to its grid.
  [[nodiscard]] double next_length(const State& state, double t_limit, double at_break) const {
    double dt = state.dt_next > 0.0 ? std::min(state.dt_next, most_step()) : most_step();
    if (automatic()) {
      dt = part_of(std::min(t_limit, at_break) - state.t, sampled(state, dt));
    } else {
      const double H = *control.step;
      const double steps_done = std::floor((state.t + shortest_length(state)) / H);
      dt = part_of((steps_done + 1.0) * H - state.t, dt);
      dt = part_of(t_limit - state.t, dt);
    }
    const double way = at_break - state.t;
    if (way > (1.0 + kStretch) * dt || at_break > t_limit) return dt;
    return std::abs(way - dt) <= kSameTime * dt && !looks_at_end() ? dt : way;
  }

  /// Next break of a function of time; one that falls on the grid is over there.
  [[nodiscard]] TimeBreak next_break(const State& state) {
    if (breaks.empty()) return {};
    return breaks.next(automatic() ? state.t : state.t + kSameTime * *control.step);
  }
  [[nodiscard]] bool looks_at_end() const { return ga.alpha_f > kLooksAtEnd; }
  /// End of the step before a break: a method that evaluates the end of a step must not use values
  /// beyond the break.
  [[nodiscard]] double landing(const TimeBreak& at) const {
    return looks_at_end() ? at.t * (1.0 - kJustBeside) : at.t;
  }

  /// Whether the error of a step is judged that contains a jump of velocities. Contacts by forces
  /// handle these themselves, without an estimate.
  [[nodiscard]] bool watches_jumps() const {
    return !system.contacts() || are_rows(system.contacts().get());
  }

  /// Drops the past steps: after a jump of accelerations or velocities.
  void begin_anew(State& state) const {
    state.past_count = 0;
    state.error_last = 0.0;
    if (automatic()) state.easy_steps = kFindAnew;
  }
  [[nodiscard]] bool stands_at(const TimeBreak& at, double t) const {
    const double same = automatic() ? kSameBreak * at.t : kSameTime * *control.step;
    return at.exists() && at.t - t <= same;
  }
  void pass_break(State& state, const TimeBreak& at) const {
    if (at.derivative > 2) return;
    begin_anew(state);
    if (!system.contacts())
      restart_accelerations(system, state, ga, std::max(at.t, state.t) * (1.0 + kJustBeside));
  }

  /// Passes a break at the time reached, if there is one.
  void pass(State& state, const TimeBreak& ahead) {
    const bool stands = stands_at(ahead, state.t);
    const double t = state.t;
    if (stands) state.t = ahead.t;  // where a function jumps, though the step ended beside it
    kinks.pass(state, single.ledger());
    state.t = t;
    if (stands) pass_break(state, ahead);
  }

  std::int64_t companion_iterations = 0;

  /// Smallest attainable error of a step, as found: State::error_last stores it at order 2, and if
  /// it is above the tolerance at the others, which otherwise store their last estimate there.
  [[nodiscard]] double noise(const State& state) const {
    return !composed() || state.error_last > control.tolerance ? state.error_last : 0.0;
  }
  /// Requested error of a step. Order 2 spreads the tolerance over the run, error per unit of time;
  /// the higher orders apply it per step.
  [[nodiscard]] double requested_error(double dt) const {
    return composed() ? control.tolerance : control.tolerance * std::abs(dt) / control.horizon;
  }
  /// Requested error, but not below the noise.
  [[nodiscard]] double allowed_error(const State& state, double dt) const {
    return std::max({least_error, requested_error(dt), kNoiseAllowed * noise(state)});
  }

  NewtonReport run_stages(State& state, const std::vector<double>& list, double H, bool fresh);
  bool skip(State& state, double t_limit);

  std::optional<double> difference_of(const std::vector<double>& list, const State& from,
                                      const State& reached, double H, double of_velocities);
  std::optional<double> composed_error(const State& from, const State& reached, double H);
  [[nodiscard]] double extrapolated_error(const State& from, const State& reached, double H,
                                          double allowed) const;
  std::optional<double> error_by_halves(const State& from, const State& reached, double H);
  std::optional<double> error_of_two(const State& from, double dt);
  void find_length(State& state, double way);
  void record(State& state, double H, double verdict);

  using Verdict = StepVerdict;
  using Refused = RefusedStep;
  Verdict judge(const State& from, State& reached, double H, bool fresh, Refused& refused);
  [[nodiscard]] std::optional<double> to_kink(const State& from, const State& reached, double H,
                                              double planned, const ForceKinks::Ends& ends) const;
  void prepare_short_step(State& state, double H);
  std::optional<Verdict> judge_passage(const State& from, State& reached, double H, double planned,
                                       const ForceKinks::Ends& ends);
  [[nodiscard]] Verdict judge_stop(const State& from, const State& reached, double H) const;

  void choose_scheme(State& state, double room);
  void take_order_two(State& state, double dt, int steps) const;
  bool suits_order_two(State& state, double H, int columns);
  bool gives_way(State& state, double H, int refusals);
  void count_scheme(State& state, double H, int used);
  [[nodiscard]] std::vector<std::string> vibration_warning() const;

  void accept(State& state, double H, const Verdict& verdict, int iterations, double kept);
  StepReport advance(State& state, double t_limit);
};

}  // namespace polhode
