// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/compile/build_system.hpp>
#include <polhode/simulation/probe.hpp>
#include <polhode/simulation/probe_columns.hpp>

namespace polhode {

class Simulation;

/// A number reported by a simulation, identified by the name of its column in a probe.
class ChannelReader {
 public:
  ChannelReader() = default;  ///< Reads nothing.
  /// @param where  Path of the channel's owner, for messages.
  /// @throws InputError if there is no such channel.
  ChannelReader(const Simulation& simulation, const SystemMap& map, const ChannelSpec& spec,
                const std::string& where);

  /// Value at the instant, in SI; an unknown gap, of surfaces far apart, is infinite.
  [[nodiscard]] double value(const Simulation& simulation) const;
  /// Channel of the time derivative: for a coordinate its rate, for positions velocities, for these
  /// accelerations. @throws InputError if it has none.
  [[nodiscard]] ChannelReader rate(const Simulation& simulation, const std::string& where) const;

 private:
  [[nodiscard]] double far_gap(const Simulation& simulation) const;

  ProbeTarget target_;
  ProbeNumber column_;
  const SystemMap* map_ = nullptr;
  std::size_t coordinate_ = 0;  ///< Of a joint.
  bool of_positions_ = false;   ///< Independent of velocities and forces.
};

}  // namespace polhode
