// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include <polhode/simulation/simulation_details.hpp>

namespace polhode::io {

/// End of a run, as shown to its user, and the location of its results.
struct RunPlace {
  std::string end = "finished";  ///< finished, not_converged, interrupted or limit.
  int exit_code = 0;             ///< Of the command line.
  std::string folder{};          ///< Of the results; may be empty.
  std::size_t frames = 0;        ///< Written or kept.
};

/// The figures of a run as one JSON object, see docs/reference/cli.md.
[[nodiscard]] std::string summary_json(const RunSummary& summary, const RunPlace& place);

}  // namespace polhode::io
