// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include <polhode/io/results/recorder.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::test {

/// Runs a simulation to its end and writes the results of the command line into a folder.
inline RunSummary recorded_run(Simulation& simulation, const std::string& folder,
                               bool restarted = false) {
  io::Recorder recorder(simulation, folder, {}, restarted);
  recorder.step(simulation);
  RunSummary summary = simulation.run([&](Simulation& s) { recorder.frame(s); },
                                      [&](Simulation& s) { recorder.step(s); });
  recorder.frame(simulation);
  recorder.close();
  return summary;
}

/// Numbers of a probe's file, without its header; other entries are read as zero.
inline std::vector<std::vector<double>> csv_rows(const std::string& path) {
  std::istringstream lines(io::read_file(path));
  std::vector<std::vector<double>> all;
  std::string line, cell;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    all.emplace_back();
    while (std::getline(cells, cell, ',')) all.back().push_back(std::strtod(cell.c_str(), nullptr));
  }
  return all;
}

}  // namespace polhode::test
