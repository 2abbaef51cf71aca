// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/simulation/channel_reader.hpp>

namespace polhode {

class Simulation;

/// Controllers that an event switches on or off.
struct SwitchedControllers {
  std::vector<int> on, off;
  [[nodiscard]] bool empty() const { return on.empty() && off.empty(); }
};

/// Events of a running model: which are due, and the margins of the conditions of others. Past
/// events are stored in the State.
class EventWatch {
 public:
  /// @throws InputError if a named channel or event does not exist.
  EventWatch(const Simulation& simulation, const SystemMap& map);

  [[nodiscard]] const std::vector<EventSpec>& events() const { return *events_; }
  /// Interactions that an event switches on, off.
  [[nodiscard]] const std::vector<int>& on(int event) const { return watched_[at(event)].on; }
  [[nodiscard]] const std::vector<int>& off(int event) const { return watched_[at(event)].off; }

  /// Contacts that an event switches on, off: switches of the ContactSet.
  [[nodiscard]] const std::vector<int>& contacts_on(int event) const {
    return watched_[at(event)].contacts_on;
  }
  [[nodiscard]] const std::vector<int>& contacts_off(int event) const {
    return watched_[at(event)].contacts_off;
  }

  [[nodiscard]] const SwitchedControllers& controllers(int event) const {
    return watched_[at(event)].controllers;
  }

  /// Next given time of an event [s]; infinity if there is none.
  [[nodiscard]] double next_time(const State& state) const;
  /// Whether a condition may become true in the next step.
  [[nodiscard]] bool watches(const State& state) const;
  /// Margin of each event's condition beyond its level, negative before it: a function along the
  /// motion, whose zero is the event; NaN of events that cannot occur.
  [[nodiscard]] std::vector<double> margins(const Simulation& simulation) const;
  /// Events at this instant, in the order of the model.
  [[nodiscard]] std::vector<int> due(const Simulation& simulation) const;
  /// Rearms repeated events whose condition no longer holds.
  void rearm(const Simulation& simulation, State& state) const;
  /// Records an event.
  void note(State& state, int event, double lost, double impulse) const;
  [[nodiscard]] double memory(const State& state, int event, EventMemory::Entry entry) const {
    return state.history[place(event, entry)];
  }
  /// First past event that ends the run; −1: none.
  [[nodiscard]] int stopped(const State& state) const;

 private:
  struct Watched {
    std::vector<int> on, off;
    std::vector<int> contacts_on, contacts_off;
    SwitchedControllers controllers;
    ChannelReader channel;
    int after = -1;
  };
  static std::size_t at(int event) { return static_cast<std::size_t>(event); }
  [[nodiscard]] std::size_t place(int event, EventMemory::Entry entry) const {
    return at(system_->memory() + EventMemory::kSize * event + entry);
  }
  [[nodiscard]] bool ready(const State& state, int event) const;
  /// Margin of an event's condition beyond its level.
  [[nodiscard]] double beyond(const Simulation& simulation, int event) const;

  const System* system_;
  const std::vector<EventSpec>* events_;
  std::vector<Watched> watched_;
};

}  // namespace polhode
