// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <polhode/core/source_location.hpp>
#include <polhode/model/probe_spec.hpp>

namespace polhode {

/// One number that a simulation reports: a column of a probe.
struct ChannelSpec {
  ProbeSpec of;      ///< Its own name, place and rate do not matter.
  std::string name;  ///< Such as z, vx, rz, "rate rz", fx, tension, gap; or a magnitude: force.
};

/// A channel that crosses a value.
struct ConditionSpec {
  ChannelSpec channel;
  double level = 0.0;  ///< In SI.
  bool above = true;   ///< It holds from the level up; else from the level down.
};

/// Something that switches joints, loads and contacts, at a time or when a condition comes to hold.
struct EventSpec {
  std::string name;
  SourceLocation place;
  std::optional<double> at;           ///< [s]; at 0 it tells how the model starts.
  std::optional<ConditionSpec> when;  ///< Instead of a time.
  std::string after;                  ///< Event that must have come before; "" for none.
  std::vector<std::string> on, off;   ///< Joints, loads, pairs of contacts, bodies that touch.
  bool repeat = false;                ///< Comes again each time the condition comes to hold.
  bool stop = false;                  ///< Ends the run.
};

/// Reaction that a joint bears; beyond it it lets go.
struct JointStrengthSpec {
  std::optional<double> force, moment;  ///< Magnitudes [N], [N m].
};

struct Model;

/// A joint or a load that events may switch.
struct SwitchTarget {
  bool joint = false;  ///< Else a load.
  int index = -1;      ///< Into Model::joints or Model::loads.
};
/// @throws InputError if there is none of that name, or two, or it is a load on a solid.
[[nodiscard]] SwitchTarget switch_target(const Model& model, const std::string& name);

/// The events of a model, with those of joints that break behind them.
[[nodiscard]] std::vector<EventSpec> all_events(const Model& model);

}  // namespace polhode
