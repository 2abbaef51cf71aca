// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/simulation/simulation_details.hpp>

namespace polhode {

/// The steps of a run: the states between them, stages of compositions included.
struct RunTape {
  std::vector<State> states;
  std::vector<double> lengths;    ///< Of the steps between the states [s].
  std::vector<std::size_t> ends;  ///< Indices of the start and of the states that end whole steps.
};

/// Runs a simulation from its start to its end.
/// @throws SolveError if a step is not accepted; InputError if the states need too much memory.
[[nodiscard]] RunTape run_onto_tape(Simulation& simulation);

}  // namespace polhode
