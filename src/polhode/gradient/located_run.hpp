// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/gradient/run_tape.hpp>

namespace polhode {

/// Runs a model with contacts or stops that are rows of the step, with fixed steps: a step in which
/// a row would close ends where its gap is zero, and the velocity problem of the impact follows
/// there. The next step leads back to the grid. @eq{located-step}
/// @throws InputError for what has no derivative: rows that stay closed, several that close at the
/// same instant, grazing, friction; SolveError if a step is not accepted.
[[nodiscard]] RunTape run_onto_located_tape(Simulation& simulation);

/// Runs a model with events, whose conditions the run locates itself, with fixed steps.
/// @throws InputError for events at the same instant or at the start of a step; SolveError.
[[nodiscard]] RunTape run_onto_event_tape(Simulation& simulation, const SystemMap& map);

}  // namespace polhode
