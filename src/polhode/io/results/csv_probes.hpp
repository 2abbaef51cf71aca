// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <polhode/simulation/probe.hpp>

namespace polhode::io {

/// A table of numbers that grows row by row and contains complete lines only, even after a kill.
class CsvTable {
 public:
  /// @param header  Names with units, e.g. "x [m]".
  /// @param keep    Continue an existing file: rows up to that time (first column) stay.
  /// @throws FileError; InputError if the file that is to be continued has another header.
  CsvTable(std::string path, const std::vector<std::string>& header,
           std::optional<double> keep = std::nullopt);
  ~CsvTable();
  CsvTable(CsvTable&& other) noexcept;

  void append(const std::vector<double>& row);  ///< @throws FileError
  /// Time of the last row; nothing if there is none.
  [[nodiscard]] std::optional<double> last_time() const { return last_time_; }
  void flush();  ///< @throws FileError
  void sync();   ///< Waits until the disk has all rows. @throws FileError

 private:
  std::string path_, held_;
  int file_ = -1;
  std::optional<double> last_time_;
  std::chrono::steady_clock::time_point last_write_{};
};

/// Probes of a model (output.probes), each in its own file <name>.csv with its own rate: a row at
/// the first step end at or after each multiple of the interval.
class CsvProbes {
 public:
  /// @param folder  Of the files; created if missing.
  /// @param keep  Continue existing files, see CsvTable.
  /// @throws FileError, InputError
  CsvProbes(const Simulation& simulation, const std::string& folder,
            std::optional<double> keep = std::nullopt);
  /// Records after every step, and once at the start. @throws FileError
  void record(const Simulation& simulation);
  void flush();
  void sync();  ///< Waits until the disk has all rows. @throws FileError
  [[nodiscard]] bool empty() const { return probes_.empty(); }

 private:
  struct Probe {
    ProbeTarget target;
    ProbeClock clock;
    CsvTable table;
  };

  std::vector<Probe> probes_;
};

}  // namespace polhode::io
