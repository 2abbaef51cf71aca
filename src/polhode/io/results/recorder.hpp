// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <polhode/io/results/write_results.hpp>
#include <polhode/simulation/simulation.hpp>

namespace polhode {

/// Writes what a model's `output` asks for into one folder: results.h5, probes/<name>.csv,
/// paraview/results.pvd and, of deformable solids, paraview/solids.pvd, of beams and cables
/// paraview/lines.pvd.
class Recorder {
 public:
  /// @param simulation  Outlives the recorder.
  /// @param restarted  The simulation continues from its present time: files of the earlier run
  ///                   in the folder are kept up to that time and continued. Else they are
  ///                   removed, see clear_earlier_results().
  /// @throws FileError, InputError
  Recorder(const Simulation& simulation, const std::string& folder, const Provenance& provenance,
           bool restarted = false);
  ~Recorder();

  /// A frame: results and pictures. Called at output times; a frame that stands already is not
  /// written twice. @throws FileError
  void frame(const Simulation& simulation);
  /// Probes. Called after every step. @throws FileError
  void step(const Simulation& simulation);
  /// Writes everything that is held back and closes the files. @throws FileError
  void close();

  /// Frames in the results.
  [[nodiscard]] std::size_t frames() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polhode
