// SPDX-License-Identifier: Apache-2.0
// The state of an engine: stored, restored, set, returned to the start.
#include <cstring>

#include <polhode/contact/contact_set.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/simulation/method.hpp>
#include <polhode/simulation/separate_overlaps.hpp>
#include <polhode/stepping/start.hpp>
#include <polhode/system/state_archive.hpp>

#include "engine.hpp"

namespace polhode::python {

namespace {

/// Difference of times, as a part of the way, below which they are equal.
constexpr double kSameTime = 1e-9;

/// Rejects a position of a joint beyond its stops by more than they yield.
void refuse_outside_limits(const Coordinates& of, const std::vector<double>& positions) {
  const CoordinateLimits& limits = of.limits();
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const IndependentCoordinate& c = of.space().coordinates()[k];
    const double play = of.play(k);
    if (positions[k] >= limits.lower[k] - play && positions[k] <= limits.upper[k] + play) continue;
    throw InputError(c.name, format("is outside its limits at {:.6g}", positions[k]),
                     format("Give a number from {:g} to {:g}", limits.lower[k], limits.upper[k]));
  }
}

/// Copies what events have done in a simulation to another state of its system.
void keep_events(const Simulation& simulation, State& to) {
  const System& system = simulation.system();
  const State& from = simulation.state();
  for (const InteractionRef& ref : system.interactions()) {
    const int off = system.traits(ref).off;
    if (off < 0) continue;
    const auto k = static_cast<std::size_t>(ref.first_history + off);
    to.history[k] = from.history[k];
  }
  const int events = static_cast<int>(simulation.summary().events.size());
  for (int e = 0; e < events; ++e)
    for (const EventMemory::Entry entry :
         {EventMemory::kCount, EventMemory::kTime, EventMemory::kSpent}) {
      const auto k = static_cast<std::size_t>(system.memory() + EventMemory::kSize * e + entry);
      to.history[k] = from.history[k];
    }
}

}  // namespace

std::string advance(Simulation& simulation, double until) {
  const double same = kSameTime * (until - simulation.time());
  while (simulation.time() < until - same && !simulation.stopped()) {
    const StepReport report = simulation.step(until);
    if (!report.accepted) return report.message.empty() ? "a step was refused" : report.message;
  }
  return {};
}

nb::bytes Engine::state() const {
  std::string bytes = sealed_state(simulation_->system(), simulation_->state());
  if (const auto numbers = held())
    for (const std::vector<double>* list : {&numbers->now, &numbers->used})
      bytes.append(reinterpret_cast<const char*>(list->data()), list->size() * sizeof(double));
  return nb::bytes(bytes.data(), bytes.size());
}

void Engine::restore(const nb::bytes& bytes) {
  const Use used(*this);
  std::string_view text(bytes.c_str(), bytes.size());
  std::string_view tail;
  const auto numbers = held();
  if (numbers) {
    const std::size_t size = 2 * numbers->now.size() * sizeof(double);
    tail = text.substr(text.size() - std::min(size, text.size()));
    text.remove_suffix(tail.size());
  }
  State state = state_from_sealed(simulation_->system(), text, "state");
  simulation_ = std::make_unique<Simulation>(model(), std::move(state));
  if (!numbers) return;
  const auto own = held();
  const std::size_t size = tail.size() / 2;
  std::memcpy(own->now.data(), tail.data(), size);
  std::memcpy(own->used.data(), tail.data() + size, size);
}

void Engine::put(const std::vector<BodyMotion>& moving, const std::string& where,
                 const std::vector<double>& positions) {
  const Model& m = model();
  if (m.analysis.type != "dynamics" || !m.solids.empty() ||
      !simulation_->contact_map().surfaces.empty())
    throw InputError(where,
                     "cannot be set in a model of statics, with solids or with contacts of cables",
                     "Change the model and start a new simulation");
  const System& system = simulation_->system();
  State state = system.initial_state();
  keep_events(*simulation_, state);
  for (std::size_t i = 0; i < moving.size(); ++i)
    state.set_motion(system.slot(static_cast<int>(i)), moving[i]);
  state.t = simulation_->time();
  Method method = choose_method(system, m);
  StartOptions options;
  options.smooth_multipliers =
      m.analysis.smooth_multipliers && m.analysis.step && method.control.order == 2;
  const StartReport report =
      start(system, state, method.ga, m.analysis.step.value_or(0.0), options);
  if (!report.assembled)
    throw InputError(where, "cannot be set: the joints cannot be assembled there",
                     "Give a position closer to the present one");
  if (simulation_->contact_set()) {
    auto& contacts = static_cast<contact::ContactSet&>(*system.contacts());
    const std::vector<std::string> overlaps = overlaps_at(system, contacts, state);
    if (!overlaps.empty())
      throw InputError(where, "cannot be set: shapes overlap there: " + name_list(overlaps, 12),
                       "Give a position at which they are apart");
    if (m.analysis.step) state.dt_next = *m.analysis.step;  // the stiffness depends on it
  }
  if (!positions.empty()) coordinates_->set_turns(system, state, positions);
  Stepper stepper(system, std::move(method.engine), method.ga, method.control, *method.kernels);
  stepper.begin(state);
  simulation_ = std::make_unique<Simulation>(m, std::move(state));
  if (const auto numbers = held()) numbers->used = numbers->now;
}

void Engine::set_motions(const std::map<int, BodyMotion>& motions) {
  if (motions.empty()) return;
  const Use used(*this);
  const Model& m = model();
  for (const auto& [body, motion] : motions)
    if (m.bodies.at(body).fixed)
      throw InputError(format("bodies.{}", m.bodies[body].name), "is fixed", "Set another body");
  std::vector<BodyMotion> moving;
  for (int i = 0; i < static_cast<int>(m.bodies.size()); ++i)
    if (!m.bodies[i].fixed) {
      const auto given = motions.find(i);
      moving.push_back(given != motions.end() ? given->second : simulation_->body(i));
    }
  put(moving, format("bodies.{}", m.bodies[motions.begin()->first].name));
}

const Coordinates& Engine::coordinates() {
  const System& system = simulation_->system();
  if (!coordinates_ || !coordinates_->are_of(system, simulation_->state()))
    coordinates_ =
        std::make_shared<const Coordinates>(model(), system, simulation_->state(), preferred_);
  return *coordinates_;
}

JointSpace::Motions Engine::motions() {
  return coordinates().motions(simulation_->system(), simulation_->state());
}

void Engine::set_coordinates(const std::optional<std::vector<double>>& positions,
                             const std::optional<std::vector<double>>& rates) {
  const Coordinates& of = coordinates();
  const Use used(*this);
  const JointSpace::Motions now = motions();
  const std::vector<double> q =
      positions ? *positions : of.positions(simulation_->system(), simulation_->state(), now);
  if (positions) refuse_outside_limits(of, q);
  const JointSpace::Motions placed =
      of.space().place(now, q, rates ? *rates : of.space().rates(now));
  std::vector<BodyMotion> moving;
  for (std::size_t i = 0; i < placed.size(); ++i)
    if (!model().bodies[i].fixed) moving.push_back(placed[i]);
  put(moving, positions ? "q" : "qd", q);
}

void Engine::reset() {
  const Use used(*this);
  const auto numbers = held();
  if (numbers) {
    std::fill(numbers->now.begin(), numbers->now.end(), 0.0);
    numbers->used = numbers->now;
  }
  if (start_) {
    simulation_ = std::make_unique<Simulation>(model(), *start_);
  } else {
    simulation_ = std::make_unique<Simulation>(model());
    start_ = std::make_shared<const State>(simulation_->state());
  }
}

}  // namespace polhode::python
