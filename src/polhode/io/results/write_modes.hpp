// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/io/results/write_results.hpp>
#include <polhode/simulation/modal.hpp>

namespace polhode::io {

/// Writes frequencies and shapes into a folder: modes.h5, see docs/reference/results_file.md, and,
/// if the model's output requests ParaView, paraview/modes.pvd and modes_solids.pvd with one
/// picture per mode. There the largest displacement is a tenth of the model's size; "velocity" is
/// the displacement.
/// @throws FileError
void write_modes(const ModalAnalysis& analysis, const std::string& folder,
                 const Provenance& provenance);

}  // namespace polhode::io
