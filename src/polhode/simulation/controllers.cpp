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
/// Time of the last evaluation where there was none since a controller began [s].
constexpr double kNever = -1.0;

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
                         ControllerOutputs outputs, int order)
    : system_(&simulation.system()) {
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
  find_users(model, map);
}

void Controllers::find_users(const Model& model, const SystemMap& map) {
  const auto item_of = [&](const TimeFunctionPtr& f) -> Item* {
    const int k = f ? f->controller() : -1;
    return k < 0 ? nullptr : &items_[static_cast<std::size_t>(k)];
  };
  for (std::size_t i = 0; i < model.loads.size(); ++i) {
    const LoadSpec& load = model.loads[i];
    const auto use = [&](const TimeFunctionPtr& f) {
      Item* item = item_of(f);
      if (item && map.load[i] >= 0) item->loads.push_back(map.load[i]);
      if (item && map.load[i] < 0) item->always_used = true;
    };
    use(load.value);
    if (load.vector)
      for (const TimeFunctionPtr& f : *load.vector) use(f);
    for (const auto& [key, law] : load.laws) use(law);
  }
  for (const CableLineSpec& cable : model.cables)
    for (const TimeFunctionPtr& f :
         {cable.tension, cable.muscle ? cable.muscle->activation : nullptr})
      if (Item* item = item_of(f)) item->always_used = true;
  for (std::size_t k = 0; k < model.controllers.size(); ++k)
    if (Item* outer = item_of(model.controllers[k].setpoint))
      outer->inner.push_back(static_cast<int>(k));
}

bool Controllers::idle(const Item& item, const State& state) const {
  if (item.always_used || (item.loads.empty() && item.inner.empty())) return false;
  const auto is_idle = [&](int k) {
    const Item& inner = items_[static_cast<std::size_t>(k)];
    return is_off(inner, state) || idle(inner, state);
  };
  return std::all_of(item.loads.begin(), item.loads.end(),
                     [&](int i) { return system_->is_off(state, i); }) &&
         std::all_of(item.inner.begin(), item.inner.end(), is_idle);
}

bool Controllers::limited(const Item& item, const State& state, double change) const {
  if (item.always_used || !item.loads.empty() || item.inner.empty()) return false;
  return std::all_of(item.inner.begin(), item.inner.end(), [&](int k) {
    const Item& inner = items_[static_cast<std::size_t>(k)];
    const ControllerSpec& spec = *inner.spec;
    const double value =
        state.history[static_cast<std::size_t>(inner.memory + ControllerMemory::kValue)];
    const double gain = spec.denominator.empty()
                            ? spec.proportional + spec.integral
                            : spec.numerator.front() / spec.denominator.front();
    return gain * change > 0.0 ? value > spec.most : value < spec.least;
  });
}

void Controllers::switch_over(State& state, const SwitchedControllers& switched) const {
  const auto begin_anew = [&](int k, bool off) {
    const Item& item = items_[static_cast<std::size_t>(k)];
    double* memory = state.history.data() + item.memory;
    // One that is on keeps its output until it acts again.
    const bool silent = off || is_off(item, state);
    std::fill(memory + (silent ? ControllerMemory::kValue : ControllerMemory::kError),
              memory + ControllerMemory::kOff, 0.0);
    std::fill_n(memory + ControllerMemory::kSize, item.filter.B.size(), 0.0);
    memory[ControllerMemory::kTime] = kNever;
    memory[ControllerMemory::kOff] = off ? 1.0 : 0.0;
    // A sampled one goes on at its next sample.
    if (const auto& sample = item.spec->sample)
      memory[ControllerMemory::kCount] =
          std::max(memory[ControllerMemory::kCount],
                   std::ceil((state.t - kSameSampleTime * state.dt_last) / *sample));
    if (silent) set_output(item, memory);
  };
  for (const int k : switched.off) begin_anew(k, true);
  for (const int k : switched.on) begin_anew(k, false);
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
    if (is_off(item, state)) continue;
    if (spec.sample)
      next = std::min(next, state.history[static_cast<std::size_t>(item.memory)] * *spec.sample);
    else if (spec.setpoint)
      next = std::min(next, spec.setpoint->next_break(state.t, until).t);
  }
  return next;
}

bool Controllers::begin(State& state) const {
  bool begins = false;
  for (const Item& item : items_) {
    double* memory = state.history.data() + item.memory;
    if (memory[ControllerMemory::kCount] != 0.0 || is_off(item, state)) continue;
    begins = true;
    if (!item.spec->sample || state.t == 0.0) continue;
    memory[ControllerMemory::kCount] = std::floor(state.t / *item.spec->sample);
    memory[ControllerMemory::kTime] = kNever;
  }
  return begins;
}

Controllers::Acted Controllers::act(const Simulation& simulation, State& state) const {
  Acted acted;
  for (const Item& item : items_) {
    if (is_off(item, state)) continue;
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
bool Controllers::act(const Item& item, double y, const Simulation& simulation,
                      State& state) const {
  const ControllerSpec& spec = *item.spec;
  const StateSpace& filter = item.filter;
  const double y_rate = item.rate ? item.rate->value(simulation) : 0.0;
  const auto target = [&](TimeSide side) {  // a step ends at a break up to rounding
    if (!spec.setpoint) return TimeRates{};
    TimeRates r = spec.setpoint->rates(beside(state.t, side), side);
    if (side == TimeSide::kBefore && spec.setpoint->controller() >= 0)
      r.value = value_before(items_[static_cast<std::size_t>(spec.setpoint->controller())], state,
                             r.value);
    return r;
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
  const bool first =
      memory[ControllerMemory::kCount] == 0.0 || memory[ControllerMemory::kTime] == kNever;
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
    const bool rests = memory[ControllerMemory::kIdle] != 0.0;
    if (rests || limited(item, state, onward)) integral = kept;
    if (x.size() > 0 && !rests) {
      const Mat half = 0.5 * h * filter.A, one = Mat::Identity(x.size(), x.size());
      const Vec right = x + half * x + way * filter.B;
      x = (one - half).partialPivLu().solve(right);
    }
    // Where no step was taken since, at a break of the setpoint, the slope is the last one.
    const bool moved = h > 0.5 * state.dt_last;
    if (!spec.sample)
      slope = moved ? (made_of(before) - memory[ControllerMemory::kValue]) / h
                    : memory[ControllerMemory::kSlope];
  }
  memory[ControllerMemory::kBefore] = first ? made_of(after) : made_of(before);
  memory[ControllerMemory::kIdle] = idle(item, state) ? 1.0 : 0.0;
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

double Controllers::value_before(const Item& item, const State& state, double otherwise) {
  const double* memory = state.history.data() + item.memory;
  if (memory[ControllerMemory::kTime] != state.t) return otherwise;
  return std::clamp(memory[ControllerMemory::kBefore], item.output->least, item.output->most);
}

void Controllers::set_output(const Item& item, const double* memory) {
  ControllerOutput& output = *item.output;
  const bool off = memory[ControllerMemory::kOff] != 0.0;
  output.t = memory[ControllerMemory::kTime];
  output.value = memory[ControllerMemory::kValue];
  output.slope = memory[ControllerMemory::kSlope];
  output.least = off ? 0.0 : item.spec->least;
  output.most = off ? 0.0 : item.spec->most;
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
