// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/csv_probes.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::io {

namespace {

/// Longest time for which rows are buffered [s].
constexpr double kHold = 0.05;

void write_all(const std::string& path, int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw FileError::from_errno(path, "cannot be written");
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

std::string joined(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) line += (line.empty() ? "" : ",") + cell;
  return line + "\n";
}

/// Complete rows of a table up to a time; later text is dropped.
std::string kept_rows(const std::string& text, std::size_t begin, double t,
                      std::optional<double>& last) {
  std::size_t end = begin;
  for (std::size_t line = begin; line < text.size();) {
    const std::size_t next = text.find('\n', line);
    if (next == std::string::npos) break;
    const double time = std::strtod(text.c_str() + line, nullptr);
    if (time > t * (1.0 + 1e-14)) break;
    last = time;
    end = line = next + 1;
  }
  return text.substr(begin, end - begin);
}

}  // namespace

CsvTable::CsvTable(std::string path, const std::vector<std::string>& header,
                   std::optional<double> keep)
    : path_(std::move(path)) {
  std::string text = joined(header);
  if (keep && std::filesystem::exists(path_)) {
    const std::string old = read_file(path_);
    if (old.compare(0, text.size(), text) != 0)
      throw InputError(path_, "has other columns than this probe",
                       "Name another folder for the results with -o");
    text += kept_rows(old, text.size(), *keep, last_time_);
  }
  write_file_atomically(path_, text, false);
  file_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file_ < 0) throw FileError::from_errno(path_, "cannot be written");
}

CsvTable::CsvTable(CsvTable&& other) noexcept
    : path_(std::move(other.path_)),
      held_(std::move(other.held_)),
      file_(std::exchange(other.file_, -1)),
      last_time_(other.last_time_),
      last_write_(other.last_write_) {}

CsvTable::~CsvTable() {
  if (file_ < 0) return;
  try {
    flush();
  } catch (const FileError&) {  // flush() reports it.
  }
  ::close(file_);
}

void CsvTable::append(const std::vector<double>& row) {
  const char* separator = "";
  for (double x : row) {
    held_ += format("{}{}", separator, x);  // Shortest text that is read back as the same number.
    separator = ",";
  }
  held_ += '\n';
  last_time_ = row.front();
  const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - last_write_;
  if (waited.count() > kHold || held_.size() > 65536) flush();
}

void CsvTable::flush() {
  write_all(path_, file_, held_);
  held_.clear();
  last_write_ = std::chrono::steady_clock::now();
}

void CsvTable::sync() {
  flush();
  if (::fsync(file_) != 0) throw FileError::from_errno(path_, "cannot be written to the disk");
}

CsvProbes::CsvProbes(const Simulation& simulation, const std::string& folder,
                     std::optional<double> keep) {
  const Model& model = simulation.model();
  if (model.output.probes.empty()) return;
  make_folder(folder);
  for (const ProbeSpec& spec : model.output.probes) {
    ProbeTarget target = probe_target(simulation, spec);
    CsvTable table(format("{}/{}.csv", folder, spec.name), target.header, keep);
    const ProbeClock clock(spec, model.output, table.last_time());
    probes_.push_back({std::move(target), clock, std::move(table)});
  }
}

void CsvProbes::record(const Simulation& simulation) {
  for (Probe& probe : probes_)
    if (probe.clock.strikes(simulation.time(), simulation.stopped()))
      probe.table.append(probe_row(probe.target, simulation));
}

void CsvProbes::flush() {
  for (Probe& probe : probes_) probe.table.flush();
}

void CsvProbes::sync() {
  for (Probe& probe : probes_) probe.table.sync();
}

}  // namespace polhode::io
