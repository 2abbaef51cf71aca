// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/io/results/results_reader.hpp>
#include <polhode/view/probe_tables.hpp>

namespace polhode {

/// Columns of a channel by its name: bodies.crank.position, joints.A.force.z, loads.spring.length,
/// contacts.a+b.gap, energy, energy.kinetic, and any other data set by its path with dots. A group
/// means all of its channels, a channel all of its components; joints.A.force.size is the length of
/// a vector.
/// @throws InputError that names the nearest channel.
[[nodiscard]] std::vector<ChannelColumn> channel_columns(const io::ResultsReader& results,
                                                         const std::string& name);

/// Columns of the channels of the frames, all of them.
[[nodiscard]] std::vector<ChannelColumn> all_columns(const io::ResultsReader& results);

/// Columns of channels in order, with their times; of all channels of the frames if none is named.
/// Names are those of channel_columns(), and probes.NAME.COLUMN or probes.NAME of a probe.
/// @throws InputError for an unknown name, and for probes that have other times than the rest.
[[nodiscard]] ReportTable table_of(const io::ResultsReader& results, const ProbeTables& probes,
                                   const std::vector<std::string>& names);

/// Names of all channels in the results: motion, joints, loads, contacts, energy, momentum, solver,
/// and the columns of probes.
[[nodiscard]] std::vector<std::string> channel_names(const io::ResultsReader& results,
                                                     const ProbeTables& probes = {});

/// Table of channels with the time first. Numbers are exact when read back.
[[nodiscard]] std::string channels_csv(const io::ResultsReader& results, const ProbeTables& probes,
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
[[nodiscard]] std::string channels_svg(const io::ResultsReader& results, const ProbeTables& probes,
                                       const std::vector<std::string>& names,
                                       const std::string& time_label);

}  // namespace polhode
