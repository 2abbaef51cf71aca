// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <polhode/gradient/outcome.hpp>

namespace polhode {

/// Margin of the condition of an event beyond its level, and its derivative by the state.
class EventMargin {
 public:
  /// @throws InputError if its channel is no position or velocity.
  EventMargin(const Model& model, const SystemMap& map, const EventSpec& event);

  [[nodiscard]] double value(const System& system, const State& state) const {
    return sign_ * (reader_.value(system, state) - level_);
  }
  /// Derivative of the value, but for its sign(). @see OutcomeReader::slope()
  [[nodiscard]] OutcomeSlope slope(const System& system, const State& state) const {
    return reader_.slope(system, state);
  }
  [[nodiscard]] double sign() const { return sign_; }
  /// The value without a projection of the velocities.
  [[nodiscard]] double value_there(const System& system, const State& state) const {
    return sign_ * (reader_.value_there(system, state) - level_);
  }

 private:
  OutcomeReader reader_;
  double sign_, level_;
};

/// Margins by event of a model; none for those at given times.
[[nodiscard]] std::vector<std::optional<EventMargin>> event_margins(const Model& model,
                                                                    const SystemMap& map);

/// Number of times that each event has occurred.
[[nodiscard]] std::vector<double> event_counts(const System& system, const State& state,
                                               std::size_t events);

/// Checks that events do no more than switch joints and loads off, or end the run.
/// @throws InputError
void require_differentiable_events(const Model& model, const System& system, const SystemMap& map);

}  // namespace polhode
