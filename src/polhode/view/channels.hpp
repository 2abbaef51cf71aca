// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/io/results/results_reader.hpp>

namespace polhode {

/// One number of a channel over all frames.
struct ChannelColumn {
  std::string name;  ///< bodies.crank.position.x
  std::string unit;
  std::vector<double> values;
};

/// Columns of a channel by its name: bodies.crank.position, joints.A.force.z, loads.spring.length,
/// contacts.a+b.gap, energy, energy.kinetic, and any other data set by its path with dots. A group
/// means all of its channels, a channel all of its components.
/// @throws InputError that names the nearest channel.
[[nodiscard]] std::vector<ChannelColumn> channel_columns(const io::ResultsReader& results,
                                                         const std::string& name);

/// Columns of channels in order; of all of them if none is named. @throws InputError
[[nodiscard]] std::vector<ChannelColumn> all_columns(const io::ResultsReader& results,
                                                     const std::vector<std::string>& names);

/// Names of all channels in the results: motion, joints, loads, contacts, energy, momentum, solver.
[[nodiscard]] std::vector<std::string> channel_names(const io::ResultsReader& results);

/// Table of channels with the time first. Numbers are exact when read back.
[[nodiscard]] std::string channels_csv(const io::ResultsReader& results,
                                       const std::vector<std::string>& names);

/// A panel of curves over time.
struct CurvePanel {
  std::string title;
  std::vector<double> t;
  std::vector<ChannelColumn>
      columns;  ///< At most eight; names that begin like the title lose that.
};

/// Diagram of panels below each other. @param time_label  Name of the abscissa.
/// @throws InputError if a panel has more than eight curves.
[[nodiscard]] std::string panels_svg(const std::vector<CurvePanel>& panels,
                                     const std::string& time_label);

/// Diagram of channels over time: a panel for each name, at most eight curves in each.
/// @param time_label  Name of the abscissa.
[[nodiscard]] std::string channels_svg(const io::ResultsReader& results,
                                       const std::vector<std::string>& names,
                                       const std::string& time_label);

}  // namespace polhode
