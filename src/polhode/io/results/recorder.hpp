// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <polhode/io/results/write_results.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::io {

/// Recorder of a model's `output` into one folder: results.h5, probes/<name>.csv,
/// paraview/results.pvd and, for deformable solids, paraview/solids.pvd, for beams and cables
/// paraview/lines.pvd.
class Recorder {
 public:
  /// @param simulation  Must outlive the recorder.
  /// @param restarted  The simulation continues from its present time: files of the earlier run in
  /// the folder are kept up to that time and continued. Otherwise they are removed, see
  /// clear_earlier_results().
  /// @throws FileError; InputError if another run is writing into the folder, see FolderLock.
  Recorder(const Simulation& simulation, const std::string& folder, const Provenance& provenance,
           bool restarted = false);
  ~Recorder();

  /// Writes a frame: results and pictures. Called at output times; an existing frame is not written
  /// twice. @throws FileError
  void frame(const Simulation& simulation);
  /// Writes probes. Called after every step. @throws FileError
  void step(const Simulation& simulation);
  /// Waits until the disk has all that was recorded: before a checkpoint, which must not be newer
  /// than the files that are continued from it. @throws FileError
  void sync();
  /// Stores with the results whether the run is trusted, see RunSummary::distrust. @throws
  /// FileError
  void conclude(const RunSummary& summary);
  /// Writes all buffered data and closes the files. @throws FileError
  void close();

  /// Number of frames in the results.
  [[nodiscard]] std::size_t frames() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polhode::io
