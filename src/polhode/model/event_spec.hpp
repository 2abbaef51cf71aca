// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <polhode/core/source_location.hpp>
#include <polhode/model/probe_spec.hpp>

namespace polhode {

/// A number reported by a simulation: a column of a probe.
struct ChannelSpec {
  ProbeSpec of;      ///< Its own name, file and rate are irrelevant.
  std::string name;  ///< Such as z, vx, rz, "rate rz", fx, tension, gap; or a magnitude: force.
};

/// A condition on a channel and a level.
struct ConditionSpec {
  ChannelSpec channel;
  double level = 0.0;  ///< In SI.
  bool above = true;   ///< True above the level; otherwise below it.
};

/// Description of an event that switches joints, loads and contacts, at a time or when a condition
/// becomes true.
struct EventSpec {
  std::string name;
  SourceLocation place;
  std::optional<double> at;           ///< [s]; at 0 it defines the initial state.
  std::optional<ConditionSpec> when;  ///< Instead of a time.
  std::string after;                  ///< Event that must have occurred before; "" for none.
  std::vector<std::string> on, off;   ///< Joints, loads, pairs of contacts, bodies with contact.
  bool repeat = false;                ///< Occurs each time the condition becomes true.
  bool stop = false;                  ///< Ends the run.
};

/// Reaction beyond which a joint breaks.
struct JointStrengthSpec {
  std::optional<double> force, moment;  ///< Magnitudes [N], [N m].
};

struct Model;

/// A joint or a load that can be switched by events.
struct SwitchTarget {
  bool joint = false;  ///< Otherwise a load.
  int index = -1;      ///< Into Model::joints or Model::loads.
};
/// @throws InputError if there is none of that name, or two, or it is a load on a solid.
[[nodiscard]] SwitchTarget switch_target(const Model& model, const std::string& name);

/// Events of a model, followed by those of joints that break.
[[nodiscard]] std::vector<EventSpec> all_events(const Model& model);

}  // namespace polhode
