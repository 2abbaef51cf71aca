// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/io/results/results_reader.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// Writes results as one VTKHDF file (Kitware, VTK file formats, "VTKHDF", version 2.3) over time:
/// a collection of unstructured grids with the names of bodies, solids, beams and cables, with
/// points at their positions in each frame. Fields of nodes are point data, of elements cell data,
/// with the names and units of the results file; surfaces of bodies have point data "velocity"
/// [m/s] and cell data "body", the body's index in the results. For more than 200 bodies the
/// surfaces are one grid, "bodies". Nodes of beams and cables are no bodies here.
/// @param model  From model_of_results(); null: bodies are left out, as their shapes are not known.
/// @throws FileError if the file cannot be written; InputError if there is nothing to show.
void write_vtkhdf(const io::ResultsReader& results, const Model* model, const std::string& path);

}  // namespace polhode
