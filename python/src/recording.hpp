// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/io/results/results_plan.hpp>
#include <polhode/simulation/probe.hpp>

#include "parts.hpp"

namespace polhode::python {

/// Results of a run in memory: the channels of a results file, one block of numbers each.
class Recording {
 public:
  explicit Recording(const Simulation& simulation);

  /// Adds a frame, once for each time.
  void frame(const Simulation& simulation);
  /// Adds rows of the probes that are due; after every step, and at the start.
  void step(const Simulation& simulation);
  [[nodiscard]] std::size_t frames() const { return frames_; }
  /// Path → (array, unit). The arrays take over the numbers: call once.
  [[nodiscard]] nb::dict channels();
  /// Path → (channel, first, count, squeeze, unit).
  [[nodiscard]] nb::dict views() const;
  /// Name of a probe → (names of its columns, array of its rows). Call once.
  [[nodiscard]] nb::dict probes();
  /// Path → list of names, or array of numbers.
  [[nodiscard]] nb::dict fixed() const;

 private:
  struct ProbeRows {
    ProbeTarget target;
    ProbeClock clock;
    std::vector<double> numbers{};
  };
  io::ResultsLayout layout_;
  io::FilePlan plan_;
  std::vector<std::vector<double>> columns_;
  std::vector<ProbeRows> probes_;
  std::vector<double> numbers_;
  std::size_t frames_ = 0;
  double last_ = 0.0;
};

}  // namespace polhode::python
