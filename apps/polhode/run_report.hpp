// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/io/results/write_results.hpp>
#include <polhode/simulation/simulation_details.hpp>

#include "console.hpp"

namespace polhode::cli {

/// Name of an end by the exit code: "finished", "not_converged", "interrupted" or "limit".
[[nodiscard]] std::string end_name(int exit_code);

/// The figures of a run as one JSON object.
[[nodiscard]] std::string summary_json(const RunSummary& summary, int exit_code,
                                       const std::string& folder, std::size_t frames);

/// Summary of a static analysis, and of a run: ledger of energy and momenta, constraints,
/// iterations, time by phase, as text.
[[nodiscard]] std::string statics_table(const RunSummary& summary);
/// @param colour  The energy drift in red above kBadDrift.
[[nodiscard]] std::string summary_table(const RunSummary& summary, bool colour = false);

/// Energy drift above which it is shown in red, here and on pages of the viewer [-].
inline constexpr double kBadDrift = 1e-3;

/// Provenance of the results of a run of this model. @throws FileError
[[nodiscard]] io::Provenance provenance_of(const ModelArguments& model, const RunSummary& summary);

/// A count with its noun: "1 body", "3 bodies".
[[nodiscard]] std::string counted(std::size_t count, const std::string& one,
                                  const std::string& many);

}  // namespace polhode::cli
