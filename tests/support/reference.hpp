// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <polhode/simulation/simulation_details.hpp>
#include <support/paths.hpp>

namespace polhode::test {

/// Samples of a known motion: a time and values per row.
struct Reference {
  std::vector<double> t;
  std::vector<Vec> values;

  /// Reads tests/validation/data/<name>.csv; lines that begin with # name its source.
  static Reference read(const std::string& name) {
    std::ifstream file(test_data_dir() + "/" + name + ".csv");
    if (!file) throw std::runtime_error("no reference data '" + name + "'");
    Reference r;
    std::string line;
    while (std::getline(file, line)) {
      if (line.empty() || line[0] == '#') continue;
      std::vector<double> row;
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
      r.t.push_back(row.front());
      r.values.push_back(
          Eigen::Map<const Vec>(row.data() + 1, static_cast<Eigen::Index>(row.size()) - 1));
    }
    return r;
  }
};

/// Values compared with the samples, the first columns of a row.
using Observation = std::function<Vec(const Simulation&)>;

/// Deviation of a run from the samples at its times.
struct Deviation {
  double largest = 0.0;  ///< Largest difference of a value, over all samples.
  double at_end = 0.0;   ///< At the last sample.
  int samples = 0;
  RunSummary summary;
};

/// Runs a model for `duration` and compares it with the samples at its times: those on the grid of
/// a fixed step; automatic steps end at every sample.
inline Deviation deviation_from(const Reference& reference, Model model, double duration,
                                const Observation& observe) {
  const bool automatic = !model.analysis.step;
  model.analysis.duration = duration;
  Simulation simulation(std::move(model));
  Deviation d;
  const double same = 1e-9 * duration;
  std::size_t next = 0;
  const auto compare = [&] {
    const Vec value = observe(simulation);
    const Vec& expected = reference.values[next];
    d.at_end = (value - expected.head(value.size())).lpNorm<Eigen::Infinity>();
    d.largest = std::max(d.largest, d.at_end);
    ++d.samples;
  };
  while (next < reference.t.size()) {
    const double sample = reference.t[next];
    if (sample > duration + same) break;
    while (simulation.time() < sample - same) {
      const StepReport report = simulation.step(automatic ? sample : duration);
      if (!report.accepted) throw std::runtime_error(report.message);
    }
    if (std::abs(simulation.time() - sample) < same) compare();
    ++next;
  }
  d.summary = simulation.summary();
  return d;
}

}  // namespace polhode::test
