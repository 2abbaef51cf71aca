// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/io/results/write_results.hpp>
#include <polhode/simulation/simulation.hpp>

#include "console.hpp"

namespace polhode::cli {

/// "finished", "not_converged", "interrupted" or "limit", by the exit code.
[[nodiscard]] std::string end_name(int exit_code);

/// The figures of a run as one JSON object.
[[nodiscard]] std::string summary_json(const RunSummary& summary, int exit_code,
                                       const std::string& folder, std::size_t frames);

/// The ledger for people: energy, momenta, constraints, iterations, time by phase.
/// The same of a static analysis.
[[nodiscard]] std::string statics_table(const RunSummary& summary);
[[nodiscard]] std::string summary_table(const RunSummary& summary);

/// Provenance of the results of a run of this model. @throws FileError
[[nodiscard]] Provenance provenance_of(const ModelArguments& model, const RunSummary& summary);

/// "1 body", "3 bodies".
[[nodiscard]] std::string counted(std::size_t count, const std::string& one,
                                  const std::string& many);

}  // namespace polhode::cli
