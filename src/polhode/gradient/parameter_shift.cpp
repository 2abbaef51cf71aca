// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/gradient/parameter_shift.hpp>
#include <polhode/gradient/step_derivative.hpp>
#include <polhode/system/time_breaks.hpp>

namespace polhode {

namespace {

/// Relative step of the differences by a parameter: at order four the truncation error and the
/// round-off error are both 1e-12 of the value.
constexpr double kParameterStep = 1e-3;
/// Step by a parameter that is zero, in its unit: small beside a size of 0.1, such as a length.
constexpr double kStepFromZero = 1e-4;
/// Difference of the times of a break, as a part of the run, that is round-off.
constexpr double kSameBreakTime = 1e-12;
/// Largest number of breaks that are compared.
constexpr int kComparedBreaks = 1000;

/// Name of a difference of topology between two systems; empty if there is none.
std::string difference_of_systems(const System& a, const System& b) {
  if (a.body_count() != b.body_count()) return "the number of bodies";
  if (a.interactions().size() != b.interactions().size()) return "the number of joints and loads";
  if (a.rows() != b.rows()) return "the number of constraints";
  for (int i = 0; i < a.body_count(); ++i)
    if (a.slot(i) != b.slot(i) || a.bodies()[static_cast<std::size_t>(i)].name !=
                                      b.bodies()[static_cast<std::size_t>(i)].name)
      return "the order of the bodies";
  for (std::size_t i = 0; i < a.interactions().size(); ++i) {
    const InteractionRef &x = a.interactions()[i], &y = b.interactions()[i];
    if (x.group != y.group || x.item != y.item || x.a != y.a || x.b != y.b || x.rows != y.rows ||
        x.first_row != y.first_row || x.first_history != y.first_history || a.name(x) != b.name(y))
      return format("the {} '{}'", a.group(x.group).kind(), a.name(x));
  }
  if (a.initial_state().history.size() != b.initial_state().history.size())
    return "the memory of a joint or load";
  return {};
}

/// First time of a break that one function has and the other has not [s]; negative: none.
double moved_break(const System& a, const System& b, double end) {
  TimeBreaks of_a(a, end), of_b(b, end);
  double t = 0.0;
  for (int k = 0; k < kComparedBreaks; ++k) {
    const TimeBreak x = of_a.next(t), y = of_b.next(t);
    const bool ends = !(x.exists() && x.t <= end), other_ends = !(y.exists() && y.t <= end);
    if (ends && other_ends) return -1.0;
    if (ends != other_ends || std::abs(x.t - y.t) > kSameBreakTime * end) return ends ? y.t : x.t;
    t = x.t;
  }
  return -1.0;
}

}  // namespace

ParameterShift::ParameterShift(const GradientParameter& parameter, const Simulation& base,
                               const SystemMap& map, const std::vector<Outcome>& outcomes)
    : system_(&base.system()),
      path_(parameter.path),
      step_(parameter.step > 0.0     ? parameter.step
            : parameter.value != 0.0 ? kParameterStep * std::abs(parameter.value)
                                     : kStepFromZero),
      stores_(base.model().analysis.rho_inf < 1.0) {
  if (path_.starts_with("analysis."))
    throw InputError(path_, "is a setting of the run, by which there is no derivative",
                     "Name a number of the mechanism");
  ChangedItems changed;
  constexpr std::array<int, 4> kPlaces = {1, -1, 2, -2};
  for (std::size_t k = 0; k < at_.size(); ++k) {
    const double value = parameter.value + kPlaces[k] * step_;
    Neighbour& n = at_[k];
    try {
      Model model = parameter.at(value);
      model.analysis.step = base.model().analysis.step;
      n.simulation = std::make_unique<Simulation>(std::move(model));
    } catch (const std::exception& error) {
      const std::string why = error.what();
      throw InputError(path_,
                       format("has no derivative, as the model cannot start at {:.10g}: {}", value,
                              why.substr(0, why.find('\n'))),  // without the excerpt of the file
                       "Choose a parameter that can change in both directions, such as all lengths "
                       "of a loop together by a variable");
    }
    const System& system = n.simulation->system();
    if (const std::string what = difference_of_systems(base.system(), system); !what.empty())
      throw InputError(path_, format("changes {} of the compiled model", what),
                       "Choose a parameter that changes numbers only");
    const double end = base.model().analysis.duration;
    if (const double t = moved_break(base.system(), system, end); t >= 0.0)
      throw InputError(path_,
                       format("moves the time of a break of a function, t = {:.6g} s, at which a "
                              "step ends",
                              t),
                       "Use a function that is smooth there, or another parameter");
    if (n.simulation->model().analysis.duration != end)
      throw InputError(path_, "changes the duration of the run",
                       "Take the outcome at a time, and differences by that time");
    const ChangedItems items =
        changed_items(base.model(), base.system(), n.simulation->model(), system, map);
    if (k == 0) changed = items;
    const auto join = [](std::vector<char>& all, const std::vector<char>& more) {
      std::transform(all.begin(), all.end(), more.begin(), all.begin(), std::bit_or<>());
    };
    join(changed.bodies, items.bodies);
    join(changed.interactions, items.interactions);
    n.readers = readers_of(n.simulation->model(), map, outcomes);
    n.margins = event_margins(n.simulation->model(), map);
    for (std::size_t e = 0; e < n.margins.size(); ++e)
      if (n.simulation->model().events[e].at != base.model().events[e].at)
        throw InputError(path_, "moves the time of an event, which has no derivative yet",
                         "Let the event occur by a condition");
  }
  set_items(base.system(), changed);
}

void ParameterShift::set_items(const System& system, const ChangedItems& changed) {
  bodies_.clear();
  interactions_.clear();
  places_.clear();
  of_body_.assign(static_cast<std::size_t>(system.body_count()), -1);
  of_row_.assign(static_cast<std::size_t>(system.rows()), -1);
  const auto touch = [&](int body) {
    if (body == kGround || of_body_[static_cast<std::size_t>(body)] >= 0) return;
    of_body_[static_cast<std::size_t>(body)] = static_cast<int>(places_.size());
    for (int i = 0; i < 6; ++i) places_.push_back(6 * body + i);
  };
  for (int b = 0; b < system.body_count(); ++b)
    if (changed.bodies[static_cast<std::size_t>(b)]) {
      bodies_.push_back(b);
      touch(b);
    }
  for (std::size_t i = 0; i < system.interactions().size(); ++i) {
    if (!changed.interactions[i]) continue;
    interactions_.push_back(static_cast<int>(i));
    const InteractionRef& ref = system.interactions()[i];
    touch(ref.a);
    touch(ref.b);
    for (int k = 0; k < ref.rows; ++k) {
      of_row_[static_cast<std::size_t>(ref.first_row + k)] = static_cast<int>(places_.size());
      places_.push_back(6 * system.body_count() + ref.first_row + k);
    }
  }
  first_stored_ = places_.size();
  for (const int b : bodies_)
    for (int i = 0; stores_ && i < 3; ++i)
      places_.push_back(6 * system.body_count() + system.rows() + 3 * b + i);
  for (Neighbour& n : at_) {
    n.sweep = std::make_unique<InteractionSweep>(n.simulation->system(), interactions_);
    n.residual.assign(places_.size(), 0.0);
  }
}

Vec ParameterShift::start_derivative(const System& system, const State& start) const {
  return difference([&](const Neighbour& n) -> Vec {
    Vec y = Vec::Zero(state_size(system, stores_ ? 0.0 : 1.0));
    if (stores_)
      put_stored(n.simulation->system(), n.simulation->state(),
                 y.tail(2 * kStoredNumbers * system.body_count()));
    for (int b = 0; b < system.body_count(); ++b) {
      const BodyMotion m = system.motion(start, b);
      const BodyMotion at = n.simulation->system().motion(n.simulation->state(), b);
      const Quat turn = at.q * m.q.conjugate();
      y.segment<3>(kStateNumbers * b) = at.r - m.r;
      y.segment<3>(kStateNumbers * b + 3) = 2.0 / turn.w() * turn.vec();
      y.segment<3>(kStateNumbers * b + 6) = at.v - m.v;
      y.segment<3>(kStateNumbers * b + 9) = at.W - m.W;
    }
    return y;
  });
}

void ParameterShift::begin(const State& start) {
  // Initial values in the history come from the neighbour's own start; all others are functions of
  // the motion, found by a step of zero length at the base's start.
  for (Neighbour& n : at_) {
    n.history = n.simulation->state().history;
    State at = start;
    at.history = n.history;
    const System& system = n.simulation->system();
    for (const InteractionRef& ref : system.interactions()) {
      const InteractionGroup& group = system.group(ref.group);
      if (group.traits(ref.item).history_size == 0) continue;
      const PairView view = system.instant(at, ref, at.lambda.data());
      group.commit(ref.item, view.step(), at.history.data() + ref.first_history);
    }
    n.history = at.history;
  }
  add_items_with_other_memories();
}

/// The start may differ in the memory of an item that is the same, as that of a gear whose bodies
/// the assembly moves along.
void ParameterShift::add_items_with_other_memories() {
  ChangedItems changed;
  changed.bodies.assign(static_cast<std::size_t>(system_->body_count()), 0);
  changed.interactions.assign(system_->interactions().size(), 0);
  for (const int b : bodies_) changed.bodies[static_cast<std::size_t>(b)] = 1;
  for (const int i : interactions_) changed.interactions[static_cast<std::size_t>(i)] = 1;
  bool more = false;
  for (std::size_t i = 0; i < changed.interactions.size(); ++i) {
    const InteractionRef& ref = system_->interactions()[i];
    const int size = system_->group(ref.group).traits(ref.item).history_size;
    const auto first = [&](const Neighbour& n) { return n.history.begin() + ref.first_history; };
    for (const Neighbour& n : at_)
      if (!changed.interactions[i] && !std::equal(first(n), first(n) + size, first(at_[0])))
        changed.interactions[i] = more = true;
  }
  if (more) set_items(*system_, changed);
}

bool ParameterShift::others_are_equal(const Trial& step, std::span<const BodyStep> steps) const {
  std::vector<int> others;
  for (int i = 0; i < static_cast<int>(system_->interactions().size()); ++i)
    if (!std::binary_search(interactions_.begin(), interactions_.end(), i)) others.push_back(i);
  if (others.empty()) return true;
  const auto terms_of = [&](const System& system) {
    std::vector<double> terms;
    InteractionSweep(system, others)
        .run(steps, step.context, step.lambda.data(), at_[0].history.data(),
             [&](int i, const PairStep&, const PairTerms& t) {
               for (const Vec6* v : {&t.wrench_a, &t.wrench_b})
                 terms.insert(terms.end(), v->begin(), v->end());
               const int rows = system.interactions()[static_cast<std::size_t>(i)].rows;
               terms.insert(terms.end(), t.g.data(), t.g.data() + rows);
             });
    return terms;
  };
  return terms_of(*system_) == terms_of(at_[0].simulation->system());
}

void ParameterShift::evaluate(Neighbour& n, const State& from, const Trial& step,
                              std::span<const BodyStep> steps) const {
  const System& system = n.simulation->system();
  std::fill(n.residual.begin(), n.residual.end(), 0.0);
  const auto of = [&](int body) {
    return Eigen::Map<Vec6>(n.residual.data() + of_body_[static_cast<std::size_t>(body)]);
  };
  double* stored = n.residual.data() + first_stored_;
  for (const int b : bodies_) {
    const BodyData& body = system.bodies()[static_cast<std::size_t>(b)];
    const BodyStep& x = steps[static_cast<std::size_t>(b)];
    const MomentumRates m = momentum_rates(body.mass, body.inertia, system.motion(from, b), x,
                                           step.context, MomentumRate::momentum);
    of(b) << m.p_dot - body.mass * system.gravity(), m.h_dot;
    if (!stores_) continue;
    Vec3::Map(stored) = end_motion(body.inertia, system.motion(from, b), x, step.context).h_dot;
    stored += 3;
  }
  n.sweep->run(steps, step.context, step.lambda.data(), n.history.data(),
               [&](int i, const PairStep&, const PairTerms& t) {
                 const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(i)];
                 if (ref.a != kGround) of(ref.a) -= t.wrench_a;
                 if (ref.b != kGround) of(ref.b) -= t.wrench_b;
                 for (int k = 0; k < ref.rows; ++k)
                   n.residual[static_cast<std::size_t>(
                       of_row_[static_cast<std::size_t>(ref.first_row + k)])] = t.g[k];
               });
}

void ParameterShift::add_residual(const State& from, const Trial& step,
                                  std::span<const BodyStep> steps, int column,
                                  std::vector<Eigen::Triplet<double>>& entries) {
  if (!checked_ && !others_are_equal(step, steps)) {
    ChangedItems all;
    all.bodies.assign(static_cast<std::size_t>(system_->body_count()), 1);
    all.interactions.assign(system_->interactions().size(), 1);
    set_items(*system_, all);
  }
  checked_ = true;
  for (Neighbour& n : at_) evaluate(n, from, step, steps);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const double by = difference([&](const Neighbour& n) { return n.residual[i]; });
    if (by != 0.0) entries.emplace_back(places_[i], column, by);
  }
}

void ParameterShift::commit(const Trial& step, std::span<const BodyStep> steps) {
  const auto body = [&](int b) -> const BodyStep& {
    return b == kGround ? steps.back() : steps[static_cast<std::size_t>(b)];
  };
  for (Neighbour& n : at_) {
    const System& system = n.simulation->system();
    for (const int i : interactions_) {
      const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(i)];
      const InteractionGroup& group = system.group(ref.group);
      if (group.traits(ref.item).history_size == 0) continue;
      double* history = n.history.data() + ref.first_history;
      group.commit(
          ref.item,
          {body(ref.a), body(ref.b), step.context, step.lambda.data() + ref.first_row, history},
          history);
    }
  }
}

double ParameterShift::of_value(std::size_t outcome, const OutcomeSlope& slope) {
  return of_projection(slope) + difference([&](const Neighbour& n) {
           return n.readers[outcome].value_there(n.simulation->system(), slope.at);
         });
}

}  // namespace polhode
