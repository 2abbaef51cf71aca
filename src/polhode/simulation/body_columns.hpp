// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/simulation/simulation.hpp>

namespace polhode {

/// Names of the columns of a body's probe, without the time.
[[nodiscard]] std::vector<std::string> body_columns(const ProbeSpec& spec);
/// Values of these columns at the present state. @param body  Index into Model::bodies.
[[nodiscard]] std::vector<double> body_numbers(const Simulation& simulation, const ProbeSpec& spec,
                                               int body);

}  // namespace polhode
