// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/newton/rank_report.hpp>
#include <polhode/statics/static_branches.hpp>
#include <polhode/statics/static_row_steps.hpp>
#include <polhode/statics/statics.hpp>
#include <polhode/stepping/start.hpp>
#include <polhode/system/time_breaks.hpp>

namespace polhode {

namespace {

/// Number of iterations up to which the next load increment doubles, and from which on it is
/// halved.
constexpr int kEasy = 6, kHard = 12;
/// Factor on the increment after a failure, and its smallest value.
constexpr double kCut = 0.25, kMinIncrement = 1e-4;
/// Difference of load factors, or of times over that of the history, below which they are equal.
constexpr double kSame = 1e-12;
/// Number of steps of a history without load_steps, at least.
constexpr double kHistorySteps = 10.0;
/// Part of an increment by which it is lengthened to end at a given load factor or time.
constexpr double kReachesLimit = 0.01;
/// Distance of a load step, relative to the expected one, above which it may have left its branch,
/// as after many iterations; and distance below which this is not checked [-].
constexpr double kFar = 3.0, kNear = 0.02;
/// Kind of interactions that are loads, whose potential is no strain energy.
constexpr const char* kForceKind = "force";
constexpr const char* kCableKind = "cable";
/// Number of joints and drives that a message names.
constexpr std::size_t kMostNames = 12;

void stop_moving(const System& system, State& state) {
  for (int b = 0; b < system.body_count(); ++b) {
    BodyMotion m = system.motion(state, b);
    m.v = m.W = m.a = m.A = m.h_dot = Vec3::Zero();
    state.set_motion(system.slot(b), m);
  }
  std::fill(state.node_v.begin(), state.node_v.end(), 0.0);
  std::fill(state.node_a.begin(), state.node_a.end(), 0.0);
}

}  // namespace

struct LoadStepper::Impl {
  const System* system;
  StaticOptions options;
  StaticNewton newton;
  StaticReport report;
  State before;  ///< The previous equilibrium.
  double factor_before = 0.0;
  double increment = 1.0;
  int equilibria = 0, unstable = -1;
  bool relaxed = false, no_start = false;
  std::string jumps;  ///< Reason why nothing is sought beyond the last equilibrium; empty: none.
  std::optional<TimeBreaks> breaks;  ///< Of a history.

  Impl(const System& s, const StaticOptions& o) : system(&s), options(o), newton(s, o) {
    if (follows()) breaks.emplace(s, options.history);
    report.history = options.history;
    increment = longest();
  }

  [[nodiscard]] bool follows() const { return options.history > 0.0; }
  /// Whether there are unilateral rows: then an equilibrium has no branch to follow, as it leaves
  /// one wherever a row closes or opens.
  [[nodiscard]] bool unilateral() const { return newton.rows() != nullptr; }
  [[nodiscard]] double end() const { return follows() ? options.history : 1.0; }
  /// Largest increment, and the first one.
  [[nodiscard]] double longest() const {
    if (options.load_steps > 0) return end() / options.load_steps;
    return follows() ? end() / kHistorySteps : 1.0;
  }
  /// Size of the load factor or time: the loads at the start of a history grow from −1 to 0.
  [[nodiscard]] double size(double from) const { return from < 0.0 ? 1.0 : end(); }
  /// The nearer of a limit and the end of the present one of the given load steps, where shorter
  /// ones precede.
  [[nodiscard]] double next_multiple(double from, double limit) const {
    if (options.load_steps == 0 || from < 0.0) return limit;
    const double multiple = longest() * (std::floor(from / longest() + kSame * 1e3) + 1.0);
    return multiple < from + increment - kSame * end() ? std::min(limit, multiple) : limit;
  }
  /// End of the next step with this increment.
  double next_factor(double from, double limit) {
    limit = next_multiple(from, limit);
    if (!follows()) {
      const double factor = std::min(from + increment, limit);
      return limit - factor < kSame ? limit : factor;
    }
    double way = increment;
    if (from >= 0.0) {
      way = std::min(way, longest());
      if (const TimeBreak next = breaks->next(from); next.exists()) limit = std::min(limit, next.t);
      way = breaks->sampled_length(from, way, 1.0);
    }
    return from + (1.0 + kReachesLimit) * way >= limit ? limit : from + way;
  }

  /// The state on the secant through the last two equilibria.
  [[nodiscard]] State secant(const State& state, double factor) const {
    const double more = (factor - state.t) / (state.t - factor_before);
    State next = state;
    for (int b = 0; b < system->body_count(); ++b) {
      const BodyMotion m0 = system->motion(before, b);
      BodyMotion m = system->motion(state, b);
      m.r += more * (m.r - m0.r);
      m.q = quaternion_from_rotation_vector(more * rotation_vector(m.q * m0.q.conjugate())) * m.q;
      m.q.normalize();
      next.set_motion(system->slot(b), m);
    }
    for (std::size_t k = 0; k < state.node_x.size(); ++k)
      next.node_x[k] += more * (state.node_x[k] - before.node_x[k]);
    for (std::size_t k = 0; k < state.lambda.size(); ++k)
      next.lambda[k] += more * (state.lambda[k] - before.lambda[k]);
    return next;
  }

  void take(StaticStep step) {
    report.iterations += step.iterations;
    if (step.converged) {
      report.residual = step.residual;
      report.force = step.force;
      report.unstable = step.unstable;
      report.free_motions = step.free_motions;
    }
    report.steps.push_back(std::move(step));
  }

  /// Whether a load step may have left its branch.
  [[nodiscard]] bool suspicious(const State& old, const State& state, const StaticStep& step,
                                double expected) const {
    const double way = state_distance(*system, old, state);
    return !step.relaxed && way > kNear && (step.iterations > kEasy || way > kFar * expected);
  }

  /// Reports changes between the last equilibrium and this one: of stability, or of the branch. An
  /// equilibrium on another branch is replaced by a nearer one on the branch from below, if that
  /// continues.
  void look_between(const State& old, double from, State& state, StaticStep& step,
                    double expected) {
    const bool changes = unstable >= 0 && step.unstable >= 0 && step.unstable != unstable;
    if (!changes && !suspicious(old, state, step, expected)) return;
    BranchCheck check = follow_branch(*system, options, {old, state, from, step.load_factor},
                                      unstable, step.unstable);
    switch (check.relation) {
      case BranchRelation::same:
        break;
      case BranchRelation::changes:
      case BranchRelation::ends:
        report.limit_points.push_back(check.point);
        break;
      case BranchRelation::continues: {
        // Tangent and reactions are those of the last search.
        StaticStep again = newton.solve(check.state, check.further.load_factor);
        if (!again.converged) break;
        state = std::move(check.state);
        step = again;
        increment = std::max(0.5 * (state.t - from), kMinIncrement * size(from));
        take(std::move(again));
        break;
      }
    }
  }

  /// Cables with segments without tension and without stiffness.
  [[nodiscard]] std::vector<std::string> slack_cables(const State& state) const {
    std::map<std::string, std::pair<int, int>> pieces;  // slack segments, all segments
    StepContext still;
    still.t_n = state.t;
    still.conserving = false;
    for (const InteractionRef& ref : system->interactions()) {
      const InteractionGroup& group = system->group(ref.group);
      if (ref.rows > 0 || group.kind() != kCableKind) continue;
      const BodyStep a = system->instant(state, ref.a), b = system->instant(state, ref.b);
      const PairStep step{a, b, still, nullptr, state.history.data() + ref.first_history};
      PairTerms terms;
      terms.set_zero();
      const int item = ref.item;
      group.evaluate({&item, 1}, {&step, 1}, {&terms, 1});
      auto& [slack, all] = pieces[system->name(ref)];
      ++all;
      if (terms.D_aa.isZero(0.0) && terms.D_bb.isZero(0.0)) ++slack;
    }
    std::vector<std::string> list;
    for (const auto& [name, count] : pieces)
      if (count.first > 0)
        list.push_back(count.first == count.second
                           ? format("cable '{}' is slack", name)
                           : format("{} of {} pieces of cable '{}' are slack", count.first,
                                    count.second, name));
    return list;
  }

  /// Replaces an unstable equilibrium that no branch leads to by a stable one, downhill from the
  /// start: bodies that move freely without loads, as pendulums, have no equilibrium of their own
  /// there.
  void prefer_stable(const State& start, State& state, StaticStep& step) {
    if (!(step.unstable > 0) || state_distance(*system, start, state) < kNear) return;
    State down = start;
    StaticStep stable = newton.relax(down, step.load_factor, false);
    if (!stable.converged || stable.unstable > 0) return;
    ++report.relaxations;
    state = std::move(down);
    step = stable;
    take(std::move(stable));
  }

  [[nodiscard]] bool stopped() const { return options.stop && options.stop->load(); }

  void accept(State old, double from, State& state, StaticStep& step, double expected) {
    bool known = equilibria > 0;
    if (!known && !unilateral() && (step.unstable > 0 || suspicious(old, state, step, expected))) {
      State unloaded = old;
      const StaticStep none = StaticNewton(*system, options).solve(unloaded, from);
      known = none.converged && none.free_motions.empty();
      if (known) {  // which unloaded parts are stable?
        unstable = none.unstable;
        old = unloaded;
      } else {
        prefer_stable(old, state, step);
      }
    }
    if (known && !unilateral()) look_between(old, from, state, step, expected);
    report.slack = slack_cables(state);
    if (step.unstable >= 0) unstable = step.unstable;
    before = std::move(old);
    factor_before = from;
    ++equilibria;
    report.load_factor = step.load_factor;
    report.converged = step.load_factor >= end() * (1.0 - kSame);
    if (step.relaxed) return;
    if (step.iterations <= kEasy) increment = std::min(2.0 * increment, longest());
    if (step.iterations >= kHard && options.load_steps == 0) increment *= 0.5;
  }

  /// Goes downhill to an equilibrium where Newton's method finds none near the start: that is no
  /// equilibrium whatever the load, or has no stiffness, as a toggle at its dead centre or a spring
  /// with free play. There is no branch that would be left: none yet, or it ends in a free motion,
  /// or in a limit point, beyond which the model jumps.
  bool goes_down(State& state, double factor, bool free, std::optional<LimitPoint> end) {
    if ((equilibria > 0 && !free && !end) || relaxed || unilateral()) return false;
    const State old = state;
    StaticStep step = newton.relax(state, factor, false);
    take(step);
    if (!step.converged) return false;
    ++report.relaxations;
    if (end) {
      end->jump = true;
      end->distance = state_distance(*system, old, state);
      report.limit_points.push_back(std::move(*end));
    }
    increment = factor - old.t;
    accept(old, old.t, state, step, 0.0);
    return true;
  }

  /// Shortens a load step to where a contact closes, or to where bodies jump, beyond which nothing
  /// is sought. @returns whether it ends in an equilibrium.
  void check_rows(const State& old, State& state, StaticStep& step) {
    if (newton.closes())
      report.iterations += end_where_it_closes(*system, newton, old, size(old.t), state, step);
    int iterations = 0;
    const std::optional<FrictionJump> jump =
        find_friction_jump(*system, newton, old, state, step, iterations);
    report.iterations += iterations;
    if (iterations == 0) return;
    // Reports of contacts are those of the last search.
    const double end = jump ? jump->load_factor : step.load_factor;
    if (jump) jumps = jump->reason;
    state = old;
    if (end > old.t) step = newton.solve(state, end);
    if (end <= old.t || (jump && !step.converged)) {
      step.converged = false;
      step.reason = jumps;
      step.worst.clear();
      step.force = 0.0;
    }
  }

  bool advance(State& state, double limit) {
    const double from = state.t, first = increment;
    if (!jumps.empty()) {
      StaticStep end;
      end.reason = jumps;
      explain(end, {}, state, from);
      return false;
    }
    for (;;) {
      const double factor = next_factor(from, limit);
      StaticStep step;
      const bool predict =
          !unilateral() && equilibria > 1 && from - factor_before > kSame * size(from);
      State old = state;
      double expected = 0.0;
      if (predict) {
        const State start = secant(state, factor);
        expected = state_distance(*system, state, start);
        step = newton.solve(state, factor, &start);
        if (!step.converged) take(step);
      }
      if (!predict || !step.converged) {
        step = newton.solve(state, factor);
        if (!step.converged && !relaxed && !slack_cables(state).empty()) {
          take(step);
          relaxed = true;  // once: slack parts remain slack
          step = newton.relax(state, factor, true);
          if (step.converged) ++report.relaxations;
        }
        if (!step.increments.empty()) expected = std::max(expected, step.increments.front());
      }
      if (step.converged && unilateral()) check_rows(old, state, step);
      take(step);
      if (step.converged) {
        accept(std::move(old), from, state, step, expected);
        return true;
      }
      if (stopped()) return false;
      if (!jumps.empty()) return explain(step, {}, state, factor), false;
      increment = kCut * (factor - from);
      if (increment >= kMinIncrement * size(from)) continue;
      increment = first;
      std::optional<LimitPoint> end;
      if (!unilateral() && equilibria > 1 && from - factor_before > kSame)
        end = extrapolate_limit(*system, options, {before, state, factor_before, from});
      if (goes_down(state, end ? std::min(from + longest(), limit) : next_factor(from, limit),
                    !step.free_motions.empty(), end))
        return true;
      std::string soft;
      if (equilibria > 0) {
        newton.assemble_at(state, from);
        soft = newton.softest().text;
      }
      if (end) report.limit_points.push_back(*end);
      explain(step, soft, state, factor);
      return false;
    }
  }

  /// "load factor 0.5", or a time.
  [[nodiscard]] std::string place_text(double at) const {
    return !follows()  ? format("load factor {:.6g}", at)
           : at >= 0.0 ? format("t = {:.6g} s", at)
                       : format("{:.6g} of the loads at the start of the history", 1.0 + at);
  }

  /// Message about rows that no positions satisfy beyond the last equilibrium; empty: they can.
  /// @param tried  End of the shortest load step that failed.
  [[nodiscard]] std::string gap_message(const State& state, double tried) {
    const RowGap gap = newton.least_gap(state, tried);
    if (gap.names.empty()) return {};
    // As the user sees it: at the end of the load step that was asked for.
    const double whole =
        std::max(tried, std::min(state.t + longest(), state.t < 0.0 ? 0.0 : end()));
    const RowGap there = newton.least_gap(state, whole);
    const bool grows = !there.names.empty();
    return format(
        " these cannot all hold: {}; at {} {} remains at {}. Remove one of them, or change its "
        "motion.",
        name_list(gap.names, kMostNames), place_text(grows ? whole : tried),
        (grows ? there : gap).open.gap_text(),
        interaction_name(*system, (grows ? there : gap).open.interaction));
  }

  static std::string free_motions_text(const StaticStep& step) {
    std::string s = " Free motion: ";
    for (std::size_t i = 0; i < step.free_motions.size(); ++i)
      s += (i > 0 ? "; " : "") + step.free_motions[i];
    return s + ". Constrain it by a joint or a spring.";
  }

  /// Adds an explanation. @param soft  Motion with the smallest stiffness at the last equilibrium.
  void explain(const StaticStep& step, const std::string& soft, const State& state, double tried) {
    std::string& s = report.message;
    const double at = report.load_factor;
    s = format("No equilibrium was found {} {}:", follows() && at >= 0.0 ? "after" : "beyond",
               place_text(at));
    if (const std::string gap = gap_message(state, tried); !gap.empty()) {
      s += gap;
      if (!step.free_motions.empty()) s += free_motions_text(step);
      return;
    }
    s += " " + step.reason;
    if (!step.worst.empty()) s += format("; worst at {}", step.worst);
    if (step.force > 0.0)
      s += format(" (unbalanced {:.2g} N of {:.2g} N)", step.residual, step.force);
    s += ".";
    if (!step.free_motions.empty()) {
      s += free_motions_text(step);
    } else if (relaxed) {
      s += " Cables are slack: shorten their free_length, load them, or follow the motion with "
           "type: "
           "dynamics and damping.";
    } else if (unilateral()) {
      s += " Hold it by a joint, a spring or more friction, or follow the motion with type: "
           "dynamics.";
    } else if (equilibria > 0) {
      s += " It may be a limit point, where the model buckles";
      if (!soft.empty()) s += format("; the stiffness is smallest where {}", soft);
      s += ": look at the last equilibrium, or follow the motion with type: dynamics.";
    } else {
      s += " Check loads, limits and drives there, or follow the motion with type: dynamics.";
    }
  }
};

LoadStepper::LoadStepper(const System& system, const StaticOptions& options)
    : impl_(std::make_unique<Impl>(system, options)) {}
LoadStepper::~LoadStepper() = default;

void LoadStepper::begin(State& state) {
  Impl& s = *impl_;
  stop_moving(*s.system, state);
  bond_nodes(*s.system, state);
  stop_moving(*s.system, state);
  initialize_histories(*s.system, state);
  std::fill(state.lambda.begin(), state.lambda.end(), 0.0);
  state.t = s.follows() ? -1.0 : 0.0;
  s.report = StaticReport{};
  s.report.history = s.options.history;
  s.report.load_factor = state.t;
  s.increment = s.follows() ? 1.0 : s.longest();
  s.equilibria = 0;
  s.unstable = -1;
  s.relaxed = s.no_start = false;
  s.jumps.clear();
  if (!s.follows()) return;
  while (state.t < 0.0 && s.advance(state, 0.0)) {
  }
  s.no_start = state.t < 0.0;
  state.t = 0.0;
  s.report.load_factor = 0.0;
  s.report.converged = false;
  // No secant leads on from the loads at the start, and without any there is no branch yet.
  s.equilibria = s.report.force > 0.0 ? std::min(s.equilibria, 1) : 0;
  s.increment = s.longest();
}

void LoadStepper::switched(State& state) {
  Impl& s = *impl_;
  stop_moving(*s.system, state);
  s.equilibria = 0;  // another branch, which may be far
  s.relaxed = false;
  s.jumps.clear();
}

bool LoadStepper::advance(State& state, double limit) {
  return !impl_->no_start && impl_->advance(state, limit);
}
double LoadStepper::end() const { return impl_->end(); }
double LoadStepper::strain_energy(const State& state) const {
  const System& system = *impl_->system;
  StepContext still;
  still.t_n = state.t;
  double sum = 0.0;
  for (const InteractionRef& ref : system.interactions()) {
    const InteractionGroup& group = system.group(ref.group);
    if (ref.rows > 0 || group.kind() == kForceKind) continue;
    const BodyStep a = system.instant(state, ref.a), b = system.instant(state, ref.b);
    const PairStep step{a, b, still, nullptr, state.history.data() + ref.first_history};
    sum += group.work(ref.item, step).stored;
  }
  const Nodes& nodes = system.nodes();
  for (int g = 0; g < nodes.group_count(); ++g)
    if (!nodes.group(g).external())
      sum += nodes.group(g)
                 .work(node_instant(system, state, still),
                       state.element_history.data() + nodes.first_history(g), nullptr)
                 .stored;
  return sum;
}

void LoadStepper::set_stop(const std::atomic<bool>* stop) {
  impl_->options.stop = stop;
  impl_->newton.set_stop(stop);
}

const StaticReport& LoadStepper::report() const { return impl_->report; }
StaticNewton& LoadStepper::newton() { return impl_->newton; }

StaticReport solve_statics(const System& system, State& state, const StaticOptions& options,
                           const std::function<void(const State&)>& observe) {
  LoadStepper stepper(system, options);
  stepper.begin(state);
  while (state.t < 1.0 && stepper.advance(state))
    if (observe) observe(state);
  return stepper.report();
}

}  // namespace polhode
