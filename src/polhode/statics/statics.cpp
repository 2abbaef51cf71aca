// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <polhode/core/format.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/statics/static_branches.hpp>
#include <polhode/statics/statics.hpp>
#include <polhode/stepping/start.hpp>

namespace polhode {

namespace {

/// Number of iterations up to which the next load increment doubles, and from which on it is
/// halved.
constexpr int kEasy = 6, kHard = 12;
/// Factor on the increment after a failure, and its smallest value.
constexpr double kCut = 0.25, kMinIncrement = 1e-4;
/// Difference of load factors below which they are equal.
constexpr double kSame = 1e-12;
/// Distance of a load step, relative to the expected one, above which it may have left its branch,
/// as after many iterations; and distance below which this is not checked [-].
constexpr double kFar = 3.0, kNear = 0.02;
/// Kind of interactions that are loads, whose potential is no strain energy.
constexpr const char* kForceKind = "force";
constexpr const char* kCableKind = "cable";

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
  bool relaxed = false;

  Impl(const System& s, const StaticOptions& o) : system(&s), options(o), newton(s, o) {}

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

  /// Reports changes between the last equilibrium and this one: of stability, or of the branch.
  void look_between(const State& old, double from, const State& state, const StaticStep& step,
                    double expected) {
    const LoadInterval interval{old, state, from, step.load_factor};
    // First a jump: on another branch stability may change too, at a different load.
    std::optional<LimitPoint> point;
    if (suspicious(old, state, step, expected)) {
      point = locate_jump(*system, options, interval);
      if (point) point->unstable = step.unstable;
    }
    if (!point && unstable >= 0 && step.unstable >= 0 && step.unstable != unstable)
      point = locate_stability_change(*system, options, interval, unstable, step.unstable);
    if (point) report.limit_points.push_back(*point);
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

  bool advance(State& state, double limit) {
    const double from = state.t;
    for (;;) {
      double factor = std::min(from + increment, limit);
      if (limit - factor < kSame) factor = limit;
      StaticStep step;
      const bool predict = equilibria > 1 && from - factor_before > kSame;
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
          step = newton.relax(state, factor);
          if (step.converged) ++report.relaxations;
        }
        if (!step.increments.empty()) expected = std::max(expected, step.increments.front());
      }
      take(step);
      if (step.converged) {
        bool known = equilibria > 0;
        if (!known && (step.unstable > 0 || suspicious(old, state, step, expected))) {
          State unloaded = old;
          const StaticStep none = StaticNewton(*system, options).solve(unloaded, from);
          known = none.converged;
          if (known) {  // which unloaded parts are stable?
            unstable = none.unstable;
            old = unloaded;
          }
        }
        if (known) look_between(old, from, state, step, expected);
        report.slack = slack_cables(state);
        if (step.unstable >= 0) unstable = step.unstable;
        before = std::move(old);
        factor_before = from;
        ++equilibria;
        report.load_factor = factor;
        report.converged = factor >= 1.0;
        if (options.load_steps == 0) {
          if (step.iterations <= kEasy) increment *= 2.0;
          if (step.iterations >= kHard) increment *= 0.5;
        }
        return true;
      }
      increment = kCut * (factor - from);
      if (increment < kMinIncrement) {
        std::string soft;
        if (equilibria > 0) {
          newton.assemble_at(state, from);
          soft = newton.softest().text;
        }
        explain(step, soft);
        return false;
      }
    }
  }

  /// Adds an explanation. @param soft  Motion with the smallest stiffness at the last equilibrium.
  void explain(const StaticStep& step, const std::string& soft) {
    std::string& s = report.message;
    s = format("No equilibrium was found beyond load factor {:.6g}: {}", report.load_factor,
               step.reason);
    if (!step.worst.empty()) s += format("; worst at {}", step.worst);
    if (step.force > 0.0)
      s += format(" (unbalanced {:.2g} N of {:.2g} N)", step.residual, step.force);
    s += ".";
    if (!step.free_motions.empty()) {
      s += " Free motion: ";
      for (std::size_t i = 0; i < step.free_motions.size(); ++i)
        s += (i > 0 ? "; " : "") + step.free_motions[i];
      s += ". Constrain it by a joint or a spring.";
    } else if (relaxed) {
      s += " Cables are slack: shorten their free_length, load them, or follow the motion with "
           "type: "
           "dynamics and damping.";
    } else if (equilibria > 0) {
      s += " It may be a limit point, where the model buckles";
      if (!soft.empty()) s += format("; the stiffness is smallest where {}", soft);
      s += ": look at the last equilibrium, or follow the motion with type: dynamics.";
    } else {
      s += " Try load_steps, or check that the model is constrained.";
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
  state.t = 0.0;
  s.report = StaticReport{};
  s.increment = s.options.load_steps > 0 ? 1.0 / s.options.load_steps : 1.0;
  s.equilibria = 0;
  s.unstable = -1;
  s.relaxed = false;
}

bool LoadStepper::advance(State& state, double limit) { return impl_->advance(state, limit); }
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
