// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <polhode/core/format.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/view/channels.hpp>

#include "command.hpp"
#include "console.hpp"
#include "view_pages.hpp"

namespace polhode::cli {

namespace {

struct PlotOptions {
  std::string results, output;
  std::vector<std::string> channels;
};

}  // namespace

Action add_plot(CLI::App& command) {
  const auto options = std::make_shared<PlotOptions>();
  command.add_option("RESULTS", options->results, "Results (results.h5 or their folder)")
      ->required();
  command.add_option(
      "CHANNEL", options->channels,
      "energy, bodies.NAME.position.x, joints.NAME.force.size, probes.NAME.COLUMN, ...; left out: "
      "lists them");
  command.add_option("-o,--output", options->output, "SVG file; left out: plot.svg")
      ->type_name("FILE");
  return [options] {
    const std::string path = results_path(options->results);
    const io::ResultsReader results = open_results(path);
    const ProbeTables probes(path);
    if (options->channels.empty()) {
      for (const std::string& name : channel_names(results, probes)) print(name + "\n");
      return static_cast<int>(kOk);
    }
    const std::string file = options->output.empty() ? "plot.svg" : options->output;
    io::write_file_atomically(
        file, channels_svg(results, probes, options->channels, time_label(results, path)), false);
    say(format("{}: {} frames.", file, results.frames()));
    return static_cast<int>(kOk);
  };
}

}  // namespace polhode::cli
