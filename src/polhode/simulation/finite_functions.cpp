// SPDX-License-Identifier: Apache-2.0
#include <polhode/simulation/finite_functions.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <polhode/core/format.hpp>
#include <polhode/math/exp_map.hpp>

namespace polhode {

namespace {

/// Samples of a step; what a step evaluates are its start, its end and times between.
constexpr int kSamples = 64;
/// Halvings after which two times are neighbours.
constexpr int kHalvings = 60;
/// Samples of a run, between which largest values are looked for.
constexpr int kPoleSamples = 512;
/// Distances from a pole, as parts of the run, each a 1024th of the one before. A function whose
/// integral does not exist grows by 1024 or more from each to the next; if its integral exists, as
/// that of 1/sqrt(t), by less, and if it is finite, however narrow, it ceases to grow.
constexpr double kFar = 0x1p-20, kNear = 0x1p-30, kNearest = 0x1p-40, kGrowth = 512.0;

/// Growth of a mean rate from one of these distances to the next, above which a rate is infinite:
/// those of powers of t below t^0.8 grow by more, finite ones do not grow.
constexpr double kRateGrowth = 4.0;

/// First time in [from, to] found at which something is not finite.
template <class Finite>
std::optional<double> gap_in(double from, double to, const Finite& finite) {
  double good = from;
  for (int k = 0; k <= kSamples; ++k) {
    double bad = from + (to - from) * k / kSamples;
    if (finite(bad)) {
      good = bad;
      continue;
    }
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (good + bad);
      (finite(middle) ? good : bad) = middle;
    }
    return bad;
  }
  return std::nullopt;
}

std::string sentence(const std::string& kind, const std::string& name, double t) {
  return format("the {} '{}' is not a finite number at t = {:.9g} s. Correct its function.", kind,
                name, t);
}

/// Calls `look(function, kind, name, place)` for each function of time of a model that is not set
/// by a controller.
template <class Look>
void for_each_function(const Model& model, const Look& look) {
  const auto each = [&](const TimeFunctionPtr& f, const char* kind, const std::string& name,
                        const std::string& place) {
    if (f && f->controller() < 0) look(*f, kind, name, place);
  };
  for (const LoadSpec& load : model.loads) {
    const std::string place = "loads." + load.name;
    each(load.value, "load", load.name, place);
    if (load.vector)
      for (const TimeFunctionPtr& f : *load.vector) each(f, "load", load.name, place);
  }
  for (const JointSpec& joint : model.joints) {
    if (!joint.motion) continue;
    const std::string place = "joints." + joint.name;
    for (const TimeFunctionPtr& f : joint.motion->displacement)
      each(f, "motion of the joint", joint.name, place);
    for (const TimeFunctionPtr& f : joint.motion->parameters)
      each(f, "motion of the joint", joint.name, place);
  }
  for (const SolidSpec& solid : model.solids)
    for (const PrescribedSpec& p : solid.prescribed)
      for (const TimeFunctionPtr& f : p.displacement)
        each(f, "prescribed displacement", p.name, "solids." + solid.name);
  for (const CableLineSpec& cable : model.cables)
    each(cable.tension, "tension of the cable", cable.name, "cables." + cable.name);
  for (const ControllerSpec& controller : model.controllers)
    each(controller.setpoint, "setpoint of the controller", controller.name,
         "controllers." + controller.name);
}

/// First pole of a function in [from, to] over which its integral does not exist.
std::optional<double> pole_in(const TimeFunction& f, double from, double to) {
  const double whole = to - from, h = whole / kPoleSamples;
  const auto size = [&](double t) {
    const double value = std::abs(f(std::clamp(t, from, to)));
    return std::isnan(value) ? -1.0 : value;
  };
  double before = -1.0, now = size(from), after = 0.0;
  for (int k = 0; k <= kPoleSamples; ++k, before = now, now = after) {
    after = k < kPoleSamples ? size(from + (k + 1) * h) : -1.0;
    if (now < before || now < after || now == 0.0 || (now == before && now == after)) continue;
    // The largest value lies within a sample of this one: halve the way to it.
    double at = from + k * h, most = now;
    for (double way = 0.5 * h; way > 0.25 * kNearest * whole; way *= 0.5)
      for (const double beside : {at - way, at + way})
        if (const double there = size(beside); there > most) {
          most = there;
          at = std::clamp(beside, from, to);
        }
    for (const double side : {-1.0, 1.0}) {
      const double far = at + side * kFar * whole;
      if (far < from || far > to) continue;
      const double a = size(far), b = size(at + side * kNear * whole);
      if (a > 0.0 && b > kGrowth * a && size(at + side * kNearest * whole) > kGrowth * b) return at;
    }
  }
  return std::nullopt;
}

/// A body that goes on with its present acceleration for a time.
BodyStep ahead(const System& system, const State& state, const InstantSolution& now, int body,
               double dt) {
  if (body == kGround) return BodyStep::ground(1.0);
  const BodyMotion m = system.motion(state, body);
  const auto b = static_cast<std::size_t>(body);
  Vec3 a = Vec3::Zero(), alpha = Vec3::Zero();
  if (b < now.r_ddot.size() && now.r_ddot[b].allFinite() && now.alpha[b].allFinite()) {
    a = now.r_ddot[b];
    alpha = now.alpha[b];
  }
  const Mat3 Lambda = m.Lambda();
  const Vec3 w = Lambda * m.W, turn = dt * (w + 0.5 * dt * alpha);
  const Mat3 turned = exp_map(turn) * Lambda;
  return BodyStep::at_instant(m.r + dt * (m.v + 0.5 * dt * a), turned, m.v + dt * a,
                              turned.transpose() * (w + dt * alpha));
}

}  // namespace

NotFinite not_finite_in(const Model& model, double from, double to) {
  NotFinite found;
  double earliest = std::numeric_limits<double>::infinity();
  for_each_function(model, [&](const TimeFunction& f, const std::string& kind,
                               const std::string& name, const std::string& place) {
    const auto gap = gap_in(from, to, [&](double t) { return std::isfinite(f(t)); });
    if (!gap || *gap >= earliest) return;
    earliest = *gap;
    found = {place, sentence(kind, name, *gap)};
  });
  return found;
}

NotFinite not_finite_at_start(const Model& model) {
  NotFinite found;
  for_each_function(model, [&](const TimeFunction& f, const std::string&, const std::string&,
                               const std::string& place) {
    if (found.place.empty() && !std::isfinite(f(0.0)))
      found = {place, "is not a finite number at the start, t = 0"};
  });
  return found;
}

NotFinite endless_rate_at_start(const Model& model, const System& system, const State& start,
                                double run) {
  for (const int i : system.drives()) {
    const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(i)];
    PairView view = system.instant(start, ref, start.lambda.data());
    const auto mean_rate = [&](double part, int row) {
      view.context.dt = part * run;
      const Vec6 increment =
          system.group(ref.group).prescribed(ref.item, view.step(), TimeSide::kBefore).increment;
      return std::abs(increment[row]) / view.context.dt;
    };
    for (int row = 0; row < ref.rows; ++row) {
      const double far = mean_rate(kFar, row), near = mean_rate(kNear, row);
      if (!(far > 0.0 && near > kRateGrowth * far && mean_rate(kNearest, row) > kRateGrowth * near))
        continue;
      const std::string& name = system.name(ref);
      const bool load = std::any_of(model.loads.begin(), model.loads.end(),
                                    [&](const LoadSpec& l) { return l.name == name; });
      return {(load ? "loads." : "joints.") + name, "starts with an infinite rate"};
    }
  }
  return {};
}

NotFinite endless_in(const Model& model, double to) {
  NotFinite found;
  double earliest = std::numeric_limits<double>::infinity();
  if (!(to > 0.0)) return found;
  for_each_function(model, [&](const TimeFunction& f, const std::string& kind,
                               const std::string& name, const std::string& place) {
    if (f.is_constant()) return;
    const std::optional<double> pole = pole_in(f, 0.0, to);
    if (!pole || *pole >= earliest) return;
    earliest = *pole;
    found = {place, format("the {} '{}' grows beyond all bounds at t = {:.9g} s. Correct its "
                           "function",
                           kind, name, *pole)};
  });
  return found;
}

NotFinite not_finite_ahead(const Model& model, const System& system, const SystemMap& map,
                           const State& state, const InstantSolution& now, double to) {
  NotFinite found;
  double earliest = std::numeric_limits<double>::infinity();
  const std::vector<double> no_lambda(static_cast<std::size_t>(system.rows()) + 1, 0.0);
  for (std::size_t i = 0; i < model.loads.size(); ++i) {
    const LoadSpec& load = model.loads[i];
    const int interaction = map.load[i];
    const bool by_motion =
        !load.laws.empty() || !std::holds_alternative<std::monostate>(load.of_motion);
    if (interaction < 0 || !by_motion || system.is_off(state, interaction)) continue;
    const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(interaction)];
    const auto finite = [&](double t) {
      StepContext still;
      still.t_n = t;
      still.tangents = false;
      const PairView view{ahead(system, state, now, ref.a, t - state.t),
                          ahead(system, state, now, ref.b, t - state.t), still,
                          no_lambda.data() + ref.first_row,
                          state.history.data() + ref.first_history};
      const PairStep step = view.step();
      PairTerms terms;
      terms.set_zero();
      system.group(ref.group).evaluate({&ref.item, 1}, {&step, 1}, {&terms, 1});
      return terms.wrench_a.allFinite() && terms.wrench_b.allFinite() &&
             std::isfinite(system.group(ref.group).work(ref.item, step).stored);
    };
    try {
      const auto gap = gap_in(state.t, to, finite);
      if (!gap || *gap >= earliest) continue;
      earliest = *gap;
      found = {"loads." + load.name, sentence("load", load.name, *gap)};
    } catch (const std::exception&) {
      continue;  // a function in code that cannot be called there says nothing about the step
    }
  }
  return found;
}

}  // namespace polhode
