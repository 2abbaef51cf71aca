// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/model/model.hpp>

namespace polhode {

/// Names of the columns of a probe with units, without the time.
/// @throws InputError if the model has no such object.
[[nodiscard]] std::vector<std::string> probe_columns(const Model& model, const ProbeSpec& spec);

/// A number available to channels: a column of a probe, or the magnitude of three.
struct ProbeNumber {
  std::string name, unit;
  int column = 0;  ///< The first one, not counting the time.
  int size = 1;    ///< 3: the magnitude of a vector.
};
/// Columns, followed by the magnitudes speed, force and moment of vectors.
[[nodiscard]] std::vector<ProbeNumber> channel_columns(const Model& model, const ProbeSpec& spec);
/// @param where  Path of its name, for messages.
/// @throws InputError if the model has no such object, or it has no such channel.
[[nodiscard]] ProbeNumber find_channel(const Model& model, const ChannelSpec& channel,
                                       const std::string& where);
/// Whether the number is a mean over the last step, as contact forces are, instead of an
/// instantaneous value.
[[nodiscard]] bool is_mean_of_step(const ChannelSpec& channel);

}  // namespace polhode
