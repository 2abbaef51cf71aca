// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/model/model.hpp>

namespace polhode {

/// Names of the columns of a probe with units, without the time.
/// @throws InputError if the model has no such thing.
[[nodiscard]] std::vector<std::string> probe_columns(const Model& model, const ProbeSpec& spec);

/// A number that a channel may be: a column of a probe, or the magnitude of three.
struct ProbeNumber {
  std::string name, unit;
  int column = 0;  ///< The first one, without the time.
  int size = 1;    ///< 3: the magnitude of a vector.
};
/// Columns, and behind them speed, force and moment of what has such vectors.
[[nodiscard]] std::vector<ProbeNumber> channel_columns(const Model& model, const ProbeSpec& spec);
/// @param where  Path of its name, for messages.
/// @throws InputError if the model has no such thing, or if that has no such channel.
[[nodiscard]] ProbeNumber find_channel(const Model& model, const ChannelSpec& channel,
                                       const std::string& where);
/// Whether its number is a mean over the last step, as forces of contacts are, not one of an
/// instant.
[[nodiscard]] bool is_mean_of_step(const ChannelSpec& channel);

}  // namespace polhode
