// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include <polhode/study/certify.hpp>

namespace polhode::cli {

/// Options of `certify` and `run --certify` in addition to the model.
struct CertifyRequest {
  std::string folder;                ///< Folder of certificate.svg, certificate.json and tables.
  std::optional<double> within;      ///< Largest acceptable bar, over the quantity's size [-].
  std::optional<double> wall_limit;  ///< Of all three runs [s].
  bool quiet = false;
  /// Observers of the finest run, see CertifyHooks; may be empty.
  std::function<void(Simulation&)> begin{}, frame{}, step{}, end{};
};

/// A certificate with its evaluation by the command.
struct CertifyOutcome {
  Certificate certificate;
  int exit_code = 0;
  nlohmann::ordered_json json;
};

/// Performs the three runs, writes their files and reports the results on stderr.
/// @throws InputError, FileError
[[nodiscard]] CertifyOutcome certify_model(const Model& model, const CertifyRequest& request);

/// Figures of a run, as in summary_json(), with those of its certificate.
[[nodiscard]] std::string with_certificate(const std::string& summary,
                                           const CertifyOutcome& outcome);

/// Certificate as text: a line for each quantity.
[[nodiscard]] std::string certificate_table(const Certificate& certificate);

}  // namespace polhode::cli
