// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include <Eigen/Sparse>

#include <polhode/core/assert.hpp>
#include <polhode/core/clock.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/gradient/differentiable.hpp>
#include <polhode/gradient/gradient.hpp>
#include <polhode/gradient/located_run.hpp>
#include <polhode/gradient/parameter_shift.hpp>
#include <polhode/gradient/run_tape.hpp>
#include <polhode/gradient/whole_step_derivative.hpp>
#include <polhode/newton/rank_report.hpp>
#include <polhode/simulation/order_choice.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode {

namespace {

/// Remainder of a linear system of a step above which it has no solution: geometry that breaks a
/// loop leaves 1e-2 or more, all else 1e-14.
constexpr double kUnsolved = 1e-8;
/// Remainder for ρ∞ < 1, where forces of redundant rows move the bodies a little, which leaves 1e-8
/// to 1e-7 at long steps.
constexpr double kUnsolvedDamped = 1e-5;
/// Change of an outcome by a thousandth of the parameters, over the size of such outcomes, that is
/// rounding.
constexpr double kNoEffect = 1e-12;
/// Difference of times, as a part of the step, within which they are equal.
constexpr double kSameInstant = 1e-6;

/// A place of an outcome on the tape, with its weight.
struct Place {
  std::size_t state = 0;
  double weight = 1.0;
};

/// Ends of a tape at which an outcome is read.
std::vector<Place> places_of(const Outcome& outcome, const OutcomeReader& reader,
                             const Simulation& simulation, const RunTape& tape) {
  const auto t = [&](std::size_t end) { return tape.ends[end].t; };
  const std::size_t last = tape.ends.size() - 1;
  switch (outcome.at) {
    case Outcome::At::end:
      return {{last, 1.0}};
    case Outcome::At::time: {
      const auto above =
          std::upper_bound(tape.ends.begin(), tape.ends.end(), outcome.time,
                           [](double time, const State& state) { return time < state.t; });
      const auto next = static_cast<std::size_t>(above - tape.ends.begin());
      for (const std::size_t k : {next, next - 1})
        if (k <= last && !tape.moves(k) &&
            std::abs(t(k) - outcome.time) <= kSameInstant * tape.sequence[k > 0 ? k - 1 : 0].length)
          return {{k, 1.0}};
      throw InputError(
          "the outcome",
          format("'{}' is at {:.9g} s, where no step ends", outcome.text, outcome.time),
          simulation.model().analysis.step ? "Name a multiple of analysis.step within the run"
                                           : "Name a time within the run");
    }
    case Outcome::At::mean:
    case Outcome::At::integral: {
      const char* kind = outcome.at == Outcome::At::mean ? "a mean" : "an integral";
      if (reader.of_velocity() && tape.located())
        throw InputError("the outcome",
                         format("'{}' is {} of velocities, which jump", outcome.text, kind),
                         "Use the position at the end, which is the mean times the duration");
      const double unit = outcome.at == Outcome::At::mean ? t(last) - t(0) : 1.0;
      std::vector<Place> list;
      for (std::size_t k = 0; k <= last; ++k) {
        const double before = k > 0 ? t(k) - t(k - 1) : 0.0;
        const double after = k < last ? t(k + 1) - t(k) : 0.0;
        list.push_back({k, 0.5 * (before + after) / unit});
      }
      return list;
    }
    case Outcome::At::maximum:
    case Outcome::At::minimum:
    case Outcome::At::misfit:
      break;
  }
  // At the maximum the derivative by its time is zero.
  const double sign = outcome.at == Outcome::At::minimum ? -1.0 : 1.0;
  std::size_t at = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k <= last; ++k) {
    const double value = sign * reader.value(simulation.system(), tape.ends[k]);
    if (value <= most) continue;
    most = value;
    at = k;
  }
  return {{at, 1.0}};
}

/// A value of a channel that an outcome consists of.
struct Part {
  Outcome outcome;
  std::size_t of = 0;                ///< The outcome of the request.
  std::optional<double> measured{};  ///< Of a misfit.
};

/// Unit of an outcome of one part.
std::string unit_of(const Outcome& outcome, const OutcomeReader& reader) {
  const std::string& unit = reader.unit();
  if (outcome.at != Outcome::At::integral) return unit;
  return unit.ends_with("/s") ? unit.substr(0, unit.size() - 2) : unit + " s";
}

/// Parts of all outcomes, several of a misfit.
std::vector<Part> parts_of(const std::vector<Outcome>& outcomes) {
  std::vector<Part> parts;
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    if (outcomes[k].at != Outcome::At::misfit) parts.push_back({outcomes[k], k});
    for (const Measured& m : outcomes[k].measured)
      parts.push_back({{.text = format("{}@{:.9g}", m.channel, m.time),
                        .channel = m.channel,
                        .at = Outcome::At::time,
                        .time = m.time},
                       k,
                       m.value});
  }
  return parts;
}

/// Factors that give the numbers of a state comparable sizes.
Vec state_scales(const System& system, double duration, int size) {
  // Stored accelerations do not count: what grows in them grows in velocities.
  Vec scale = Vec::Zero(size);
  for (int b = 0; b < system.body_count(); ++b)
    for (int i = 0; i < kStateNumbers; ++i)
      scale[kStateNumbers * b + i] =
          (i % 6 < 3 ? system.length_scale() : 1.0) / (i < 6 ? 1.0 : duration);
  return scale;
}

/// Differentiation of a run that lies on a tape.
class Differentiation {
 public:
  Differentiation(const Simulation& simulation, const RunTape& tape, const SystemMap& map,
                  const GradientRequest& request)
      : system_(simulation.system()),
        model_(simulation.model()),
        tape_(tape),
        request_(request),
        parts_(parts_of(request.outcomes)),
        derivative_(simulation, tape),
        scales_(state_scales(system_, model_.analysis.duration, derivative_.state_size())) {
    std::vector<Outcome> outcomes;
    for (const Part& part : parts_) outcomes.push_back(part.outcome);
    readers_ = readers_of(model_, map, outcomes);
    for (std::size_t k = 0; k < readers_.size(); ++k)
      places_.push_back(places_of(outcomes[k], readers_[k], simulation, tape));
    for (const GradientParameter& parameter : request.parameters)
      shifts_.emplace_back(parameter, simulation, map, outcomes);
  }

  std::vector<OutcomeGradient> compute() {
    const std::size_t n = shifts_.size();
    const bool added_up = !request_.weights.empty();
    gradients_.resize(added_up ? 1 : request_.outcomes.size());
    weights_.resize(gradients_.size());
    for (std::size_t k = 0; k < readers_.size(); ++k)
      if (added_up)
        find_weights(k, 0, request_.weights[parts_[k].of]);
      else
        find_weights(k, parts_[k].of, 1.0);
    for (std::vector<Weight>& list : weights_) merge(list);
    start_ = Mat::Zero(derivative_.state_size(), static_cast<Eigen::Index>(n));
    for (std::size_t j = 0; j < n; ++j) {
      const Vec start = shifts_[j].start_derivative(system_, tape_.ends.front());
      start_.col(static_cast<Eigen::Index>(j)).head(start.size()) = start;
      shifts_[j].begin(tape_.ends.front());
    }
    go_forward();
    go_backward();
    return gradients_;
  }

 private:
  struct Weight {
    std::size_t state;
    Vec by_state;
  };

  /// Value, explicit derivative by parameters and weights on states of part k, which is added with
  /// a factor to what is differentiated.
  void find_weights(std::size_t k, std::size_t into, double factor) {
    OutcomeGradient& g = gradients_[into];
    const bool added_up = !request_.weights.empty();
    const Part& part = parts_[k];
    g.outcome = added_up ? "weighted sum" : request_.outcomes[part.of].text;
    g.unit = added_up || part.measured ? "" : unit_of(part.outcome, readers_[k]);
    g.by.resize(shifts_.size(), 0.0);
    if (factor == 0.0) return;
    std::vector<double> values;
    for (const Place& place : places_[k]) {
      const State& state = tape_.ends[place.state];
      values.push_back(readers_[k].value(system_, state));
      double weight = factor * place.weight;
      if (part.measured) {
        const double off = values.back() - *part.measured;
        g.value += weight * off * off;
        weight *= 2.0 * off;
      } else {
        g.value += weight * values.back();
      }
      g.time = std::max(g.time, state.t);
      Vec by_state = Vec::Zero(derivative_.state_size());
      const OutcomeSlope slope = readers_[k].slope(system_, state);
      by_state.head(kStateNumbers * system_.body_count()) = weight * slope.by_state;
      weights_[into].push_back({place.state, std::move(by_state)});
      for (std::size_t j = 0; j < shifts_.size(); ++j)
        g.by[j] += weight * shifts_[j].of_value(k, slope);
    }
    if (tape_.located() &&
        (part.outcome.at == Outcome::At::mean || part.outcome.at == Outcome::At::integral))
      add_weights_of_times(into, factor, part.outcome.at == Outcome::At::mean, values);
  }

  /// Means and integrals depend on the times of impacts and events as well, by the intervals beside
  /// them, and on that of an event that ends the run.
  void add_weights_of_times(std::size_t into, double factor, bool mean,
                            const std::vector<double>& values) {
    std::vector<Weight>& list = weights_[into];
    const std::size_t first = list.size() - values.size(), last = values.size() - 1;
    const auto by_time = [&](std::size_t k) -> double& {
      return list[first + k].by_state[derivative_.state_size() - 1];
    };
    const double T = tape_.ends.back().t - tape_.ends.front().t;
    const double per = mean ? factor / T : factor;
    for (std::size_t k = 1; k < last; ++k) by_time(k) = 0.5 * per * (values[k - 1] - values[k + 1]);
    double of_all = 0.0;
    for (std::size_t k = 0; mean && k <= last; ++k) {
      const double before = k > 0 ? tape_.ends[k].t - tape_.ends[k - 1].t : 0.0;
      const double after = k < last ? tape_.ends[k + 1].t - tape_.ends[k].t : 0.0;
      of_all += 0.5 * (before + after) / T * values[k];
    }
    by_time(last) = per * (0.5 * (values[last - 1] + values[last]) - of_all);
  }

  /// One weight for each state: the sum of those of all parts there.
  static void merge(std::vector<Weight>& list) {
    std::stable_sort(list.begin(), list.end(),
                     [](const Weight& a, const Weight& b) { return a.state < b.state; });
    std::vector<Weight> merged;
    for (Weight& w : list) {
      if (!merged.empty() && merged.back().state == w.state)
        merged.back().by_state += w.by_state;
      else
        merged.push_back(std::move(w));
    }
    list = std::move(merged);
  }

  /// Direction of the parameters in which tangent and adjoint are compared: none is zero, none is
  /// much larger than the others.
  [[nodiscard]] Vec direction() const {
    Vec d(static_cast<Eigen::Index>(shifts_.size()));
    for (Eigen::Index j = 0; j < d.size(); ++j)
      d[j] = shifts_[static_cast<std::size_t>(j)].step() *
             (1.5 + std::cos(1.0 + 2.4 * static_cast<double>(j))) * (j % 2 == 0 ? 1.0 : -1.0);
    return d;
  }

  /// Weight of an outcome on a state, null if it has none there.
  [[nodiscard]] const Weight* weight_at(std::size_t k, std::size_t state) const {
    const std::vector<Weight>& list = weights_[k];  // by rising state
    const auto found =
        std::lower_bound(list.begin(), list.end(), state,
                         [](const Weight& w, std::size_t at) { return w.state < at; });
    return found != list.end() && found->state == state ? &*found : nullptr;
  }

  void check_solved() const {
    if (derivative_.defect() <= (model_.analysis.rho_inf < 1.0 ? kUnsolvedDamped : kUnsolved))
      return;
    std::string names;
    for (const GradientParameter& p : request_.parameters)
      names += (names.empty() ? "" : ", ") + p.path;
    throw InputError(
        names,
        format("{} no derivative: the joints of a loop could not move along ({:.1g} of the "
               "equations of a step stay open)",
               request_.parameters.size() == 1 ? "has" : "have", derivative_.defect()),
        "Choose parameters that keep the mechanism, or make a joint of the loop "
        "compliant with a bushing");
  }

  void go_forward() {
    const Vec d = direction();
    Mat tangents = request_.forward ? start_ : Mat(start_ * d);
    tangent_.assign(gradients_.size(), Vec::Zero(tangents.cols()));
    const auto look = [&](std::size_t state) {
      for (std::size_t k = 0; k < gradients_.size(); ++k)
        if (const Weight* w = weight_at(k, state))
          tangent_[k] += tangents.transpose() * w->by_state;
    };
    look(0);
    for (std::size_t i = 0; i < tape_.sequence.size(); ++i) {
      inputs_.push_back(derivative_.push(i, shifts_, request_.forward ? nullptr : &d, tangents));
      check_solved();
      look(i + 1);
    }
  }

  void go_backward() {
    const std::size_t outcomes = gradients_.size();
    const std::size_t begin = request_.only_last_adjoint && request_.forward ? outcomes - 1 : 0;
    std::vector<Vec> mu(outcomes, Vec::Zero(derivative_.state_size()));
    std::vector<double> first(outcomes, 0.0), most(outcomes, 0.0);
    std::vector<Vec> by(outcomes, Vec::Zero(start_.cols()));
    const auto look = [&](std::size_t state) {
      for (std::size_t k = begin; k < outcomes; ++k) {
        if (const Weight* w = weight_at(k, state)) {
          mu[k] += w->by_state;
          first[k] += w->by_state.cwiseProduct(scales_).lpNorm<Eigen::Infinity>();
        }
        most[k] = std::max(most[k], mu[k].cwiseProduct(scales_).lpNorm<Eigen::Infinity>());
      }
    };
    look(tape_.sequence.size());
    for (std::size_t i = tape_.sequence.size(); i-- > 0;) {
      derivative_.pull(i, inputs_[i], mu, by);
      look(i);
    }
    check_solved();
    const Vec d = direction();
    for (std::size_t k = 0; k < outcomes; ++k) {
      OutcomeGradient& g = gradients_[k];
      if (k < begin) {
        for (std::size_t j = 0; j < g.by.size(); ++j)
          g.by[j] += tangent_[k][static_cast<Eigen::Index>(j)];
        continue;
      }
      by[k] += start_.transpose() * mu[k];
      g.growth = first[k] > 0.0 ? most[k] / first[k] : 0.0;
      // A derivative that is zero but for rounding has no digits to compare.
      double along = 0.0, size = kNoEffect * first[k], other = 0.0;
      for (Eigen::Index j = 0; j < d.size(); ++j) {
        along += by[k][j] * d[j];
        size += std::abs(by[k][j] * d[j]);
        if (request_.forward) other += tangent_[k][j] * d[j];
        g.by[static_cast<std::size_t>(j)] += request_.forward ? tangent_[k][j] : by[k][j];
      }
      if (!request_.forward) other = tangent_[k][0];
      g.spot_check = size > 0.0 ? std::abs(along - other) / size : 0.0;
    }
  }

  const System& system_;
  const Model& model_;
  const RunTape& tape_;
  const GradientRequest& request_;
  std::vector<Part> parts_;
  WholeStepDerivative derivative_;
  Vec scales_;
  std::vector<OutcomeReader> readers_;
  std::vector<std::vector<Place>> places_;
  std::vector<ParameterShift> shifts_;
  std::vector<std::vector<Weight>> weights_;
  std::vector<WholeStepDerivative::Inputs> inputs_;  ///< By whole step.
  Mat start_;
  std::vector<Vec> tangent_;
  std::vector<OutcomeGradient> gradients_;
};

/// Times at which automatic steps end: those of outcomes, and for means and maxima those of output.
std::vector<double> stops_of(const Model& model, const GradientRequest& request) {
  std::vector<double> stops;
  bool over_run = false;
  for (const Outcome& outcome : request.outcomes) {
    if (outcome.at == Outcome::At::time) stops.push_back(outcome.time);
    for (const Measured& m : outcome.measured) stops.push_back(m.time);
    over_run = over_run || outcome.at == Outcome::At::mean || outcome.at == Outcome::At::integral ||
               outcome.at == Outcome::At::maximum || outcome.at == Outcome::At::minimum;
  }
  if (over_run && model.output.every)
    for (double k = 1.0; k * *model.output.every < model.analysis.duration; ++k)
      stops.push_back(k * *model.output.every);
  std::sort(stops.begin(), stops.end());
  return stops;
}

void check_request(const GradientRequest& request) {
  if (request.outcomes.empty())
    throw InputError("the outcome", "is missing",
                     "Name a channel, such as bodies.rod.position.x@end");
  if (request.parameters.empty())
    throw InputError("the parameters", "are missing",
                     "Name paths of the model, such as bodies.rod.mass");
  POLHODE_ASSERT(request.weights.empty() || request.weights.size() == request.outcomes.size());
}

/// Differentiates the run that a function puts onto a tape.
RunGradient differentiate_run(const Model& model, const GradientRequest& request,
                              const std::function<RunTape(Simulation&)>& run) {
  SystemMap map;
  const System system = build_system(model, &map);
  require_differentiable(model, system);
  require_differentiable_events(model, system, map);
  RunGradient result;
  result.step = model.analysis.step.value_or(0.0);
  double at = wall_clock();
  Simulation simulation(model);
  const RunTape tape = run(simulation);
  result.run_seconds = wall_clock() - at;
  at = wall_clock();
  const OrderChoice choice = choose_order(system, model);
  result.order = choice.order;
  for (const TakenStep& step : tape.sequence)
    if (choice.extrapolated) result.order = std::min(result.order, 2 * step.members);
  result.steps = tape.single_steps();
  result.sequence = tape.sequence;
  for (std::size_t k = 1; k < tape.ends.size(); ++k) {
    if (tape.closing_at(k)) ++result.impacts;
    if (tape.event_at(k) >= 0) ++result.events;
  }
  result.outcomes = Differentiation(simulation, tape, map, request).compute();
  if (model.analysis.rho_inf < 1.0)
    result.redundant = rank_report(simulation.system(), tape.ends.front()).names;
  result.gradient_seconds = wall_clock() - at;
  return result;
}

}  // namespace

RunGradient differentiate(const Model& model, const GradientRequest& request) {
  check_request(request);
  return differentiate_run(model, request, [&](Simulation& simulation) {
    if (InstantRows::of(simulation.system())) return run_onto_located_tape(simulation);
    if (!model.events.empty()) {
      SystemMap map;
      const System system = build_system(model, &map);
      return run_onto_event_tape(simulation, map);
    }
    return run_onto_tape(simulation, stops_of(model, request));
  });
}

RunGradient differentiate_halves(const Model& model, const GradientRequest& request,
                                 const RunGradient& run) {
  check_request(request);
  if (model.analysis.step) {
    Model half = model;
    half.analysis.step = 0.5 * *model.analysis.step;
    return differentiate(half, request);
  }
  return differentiate_run(model, request, [&](Simulation& simulation) {
    return replay(simulation, halved(run.sequence));
  });
}

}  // namespace polhode
