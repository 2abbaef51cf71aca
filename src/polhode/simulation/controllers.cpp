// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/simulation/controllers.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode {

namespace {

/// Difference of times, as a part of a step, below which they are equal.
constexpr double kSameSampleTime = 1e-9;

/// Control error on one side of an instant.
struct Error {
  double value = 0.0, rate = 0.0;
};

}  // namespace

ControllerOutputs own_outputs(Model& model) {
  ControllerOutputs outputs;
  for (std::size_t k = 0; k < model.controllers.size(); ++k)
    outputs.push_back(std::make_shared<ControllerOutput>());
  const auto own = [&](TimeFunctionPtr& f) {
    if (const int k = f ? f->controller() : -1; k >= 0)
      f = std::make_shared<ControlledValue>(k, outputs.at(static_cast<std::size_t>(k)));
  };
  for (LoadSpec& load : model.loads) {
    own(load.value);
    if (load.vector)
      for (TimeFunctionPtr& f : *load.vector) own(f);
    for (auto& [key, law] : load.laws) own(law);
  }
  for (CableLineSpec& cable : model.cables) {
    own(cable.tension);
    if (cable.muscle) own(cable.muscle->activation);
  }
  for (ControllerSpec& controller : model.controllers) own(controller.setpoint);
  return outputs;
}

Controllers::Controllers(const Simulation& simulation, const SystemMap& map,
                         ControllerOutputs outputs, int order) {
  const Model& model = simulation.model();
  int memory =
      simulation.system().memory() + EventMemory::kSize * static_cast<int>(map.events.size());
  for (std::size_t k = 0; k < model.controllers.size(); ++k) {
    const ControllerSpec& spec = model.controllers[k];
    const std::string where = format("controllers.{}", spec.name);
    if (!spec.sample && order > 2)
      throw InputError(where, format("is continuous, which requires order 2, not {}", order),
                       "Give it a sample time, or order: 2");
    if (!spec.sample && is_mean_of_step(spec.channel))
      throw InputError(
          where,
          format("is continuous, but '{}' of a contact is a mean over the step", spec.channel.name),
          "Give it a sample time");
    Item item{&spec,        ChannelReader(simulation, map, spec.channel, where),
              std::nullopt, state_space(spec),
              outputs[k],   memory};
    if (spec.derivative != 0.0) item.rate = item.channel.rate(simulation, where + ".derivative");
    item.output->least = spec.least;
    item.output->most = spec.most;
    items_.push_back(std::move(item));
    memory += ControllerMemory::size(spec);
  }
}

Controllers::StateSpace Controllers::state_space(const ControllerSpec& spec) {
  StateSpace s;
  if (spec.denominator.empty()) return s;
  const auto n = static_cast<Eigen::Index>(spec.denominator.size()) - 1;
  const double first = spec.denominator.front();
  const auto a = [&](Eigen::Index i) {
    return spec.denominator[static_cast<std::size_t>(i)] / first;
  };
  Vec b = Vec::Zero(n + 1);
  const auto missing = n + 1 - static_cast<Eigen::Index>(spec.numerator.size());
  for (std::size_t i = 0; i < spec.numerator.size(); ++i)
    b[missing + static_cast<Eigen::Index>(i)] = spec.numerator[i] / first;
  s.D = b[0];
  s.A = Mat::Zero(n, n);
  s.B = Vec::Zero(n);
  s.C = Vec::Zero(n);
  if (n > 0) s.B[0] = 1.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    s.A(0, i) = -a(i + 1);
    if (i > 0) s.A(i, i - 1) = 1.0;
    s.C[i] = b[i + 1] - s.D * a(i + 1);
  }
  return s;
}

double Controllers::next_time(const State& state, double until) const {
  double next = std::numeric_limits<double>::infinity();
  for (const Item& item : items_) {
    const ControllerSpec& spec = *item.spec;
    if (spec.sample)
      next = std::min(next, state.history[static_cast<std::size_t>(item.memory)] * *spec.sample);
    else if (spec.setpoint)
      next = std::min(next, spec.setpoint->next_break(state.t, until).t);
  }
  return next;
}

Controllers::Acted Controllers::act(const Simulation& simulation, State& state) const {
  Acted acted;
  for (const Item& item : items_) {
    const double* memory = state.history.data() + item.memory;
    const double count = memory[ControllerMemory::kCount];
    const double same = kSameSampleTime * state.dt_last;
    const bool due = item.spec->sample ? state.t + same >= count * *item.spec->sample
                                       : count == 0.0 || state.t > memory[ControllerMemory::kTime];
    if (!due) continue;
    acted.any = true;
    const double y = item.channel.value(simulation);
    if (!std::isfinite(y)) {
      acted.blind = format(
          "controllers.{}: '{}' is not available at t = {:.6g} s, as the bodies are too far apart. "
          "Use a channel that is always available",
          item.spec->name, item.spec->channel.name, state.t);
      continue;
    }
    acted.jumps = act(item, y, simulation, state) || acted.jumps;
  }
  return acted;
}

/// @eq{controller} @eq{controller-steps}
bool Controllers::act(const Item& item, double y, const Simulation& simulation, State& state) {
  const ControllerSpec& spec = *item.spec;
  const StateSpace& filter = item.filter;
  const double y_rate = item.rate ? item.rate->value(simulation) : 0.0;
  const auto target = [&](TimeSide side) {  // a step ends at a break up to rounding
    return spec.setpoint ? spec.setpoint->rates(beside(state.t, side), side) : TimeRates{};
  };
  const auto error = [&](const TimeRates& r) {
    return Error{r.value - y, item.rate ? r.rate - y_rate : 0.0};
  };
  const TimeRates r_before = target(TimeSide::kBefore), r_after = target(TimeSide::kAfter);
  const Error before = error(r_before), after = error(r_after);
  double* memory = state.history.data() + item.memory;
  double& integral = memory[ControllerMemory::kIntegral];
  double& lag = memory[ControllerMemory::kLag];
  Eigen::Map<Vec> x(memory + ControllerMemory::kSize, filter.B.size());
  const auto made_of = [&](const Error& e) {
    if (!spec.denominator.empty()) return filter.C.dot(x) + filter.D * e.value;
    return spec.proportional * e.value + spec.integral * integral +
           spec.derivative * (spec.filter > 0.0 ? lag : e.rate);
  };
  double slope = 0.0;
  const bool first = memory[ControllerMemory::kCount] == 0.0;
  if (first) {
    lag = after.rate;
  } else {
    const double h = state.t - memory[ControllerMemory::kTime];
    const Error last{memory[ControllerMemory::kError], memory[ControllerMemory::kRate]};
    if (spec.filter > 0.0)
      lag =
          ((2.0 * spec.filter - h) * lag + h * (last.rate + before.rate)) / (2.0 * spec.filter + h);
    const double way = 0.5 * h * (last.value + before.value), kept = integral;
    integral += way;
    const double made = made_of(before), onward = spec.integral * way;
    // At a limit the integral is held, unless it moves back into the range (anti-windup).
    if ((made > spec.most && onward > 0.0) || (made < spec.least && onward < 0.0)) integral = kept;
    if (x.size() > 0) {
      const Mat half = 0.5 * h * filter.A, one = Mat::Identity(x.size(), x.size());
      const Vec right = x + half * x + way * filter.B;
      x = (one - half).partialPivLu().solve(right);
    }
    if (!spec.sample) slope = (made_of(before) - memory[ControllerMemory::kValue]) / h;
  }
  memory[ControllerMemory::kCount] += 1.0;
  memory[ControllerMemory::kTime] = state.t;
  memory[ControllerMemory::kValue] = made_of(after);
  memory[ControllerMemory::kSlope] = slope;
  memory[ControllerMemory::kError] = after.value;
  memory[ControllerMemory::kRate] = after.rate;
  set_output(item, memory);
  const auto sum = [](double a, double b) { return std::abs(a) + std::abs(b); };
  return first || spec.sample ||
         jump_at(state.t, r_before.value, r_after.value, sum(r_before.rate, r_after.rate)) != 0.0 ||
         jump_at(state.t, r_before.rate, r_after.rate, sum(r_before.second, r_after.second)) != 0.0;
}

void Controllers::set_output(const Item& item, const double* memory) {
  item.output->t = memory[ControllerMemory::kTime];
  item.output->value = memory[ControllerMemory::kValue];
  item.output->slope = memory[ControllerMemory::kSlope];
}

std::array<double, 3> Controllers::report(int controller, const Simulation& simulation) const {
  const Item& item = items_.at(static_cast<std::size_t>(controller));
  const double t = simulation.time();
  const TimeFunctionPtr& setpoint = item.spec->setpoint;
  return {setpoint ? setpoint->rates(t, TimeSide::kAfter).value : 0.0,
          item.channel.value(simulation), ControlledValue(controller, item.output)(t)};
}

void Controllers::resume(const State& state) const {
  for (const Item& item : items_) set_output(item, state.history.data() + item.memory);
}

}  // namespace polhode
