// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/compile/build_system.hpp>

namespace polhode {

class Simulation;

/// One number that a simulation reports, found by the name of its column in a probe.
class ChannelReader {
 public:
  ChannelReader() = default;  ///< Reads nothing.
  /// @param where  Path of the channel, for messages.
  /// @throws InputError if there is no such channel.
  ChannelReader(const Model& model, const SystemMap& map, const System& system,
                const ChannelSpec& spec, const std::string& where);

  /// At the instant, in SI.
  [[nodiscard]] double value(const Simulation& simulation) const;
  /// The channel that is its derivative by time: of a coordinate its rate, of positions of a body
  /// velocities, of these accelerations. @throws InputError if it has none.
  [[nodiscard]] ChannelReader rate(const std::string& where) const;

 private:
  ChannelSpec spec_;
  const SystemMap* map_ = nullptr;
  const System* system_ = nullptr;
  int index_ = -1;             ///< Into the model's bodies, joints or loads.
  int component_ = -1;         ///< Of the report.
  int rate_step_ = 0;          ///< From a component to its derivative.
  int with_rate_ = 0;          ///< Components that have one: the first ones.
  bool of_positions_ = false;  ///< Needs no velocities and forces.
};

}  // namespace polhode
