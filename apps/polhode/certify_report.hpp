// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include <polhode/study/certify.hpp>

namespace polhode::cli {

/// Options of `certify` and `run --certify` beside the model.
struct CertifyRequest {
  std::string folder;                ///< Where certificate.svg, certificate.json and tables go.
  std::optional<double> within;      ///< Largest bar that will do, over the quantity's size [-].
  std::optional<double> wall_limit;  ///< Of all three runs [s].
  bool quiet = false;
  /// Looks at the finest run, see CertifyHooks; may be empty.
  std::function<void(Simulation&)> begin{}, frame{}, step{}, end{};
};

/// A certificate with what the command makes of it.
struct CertifyOutcome {
  Certificate certificate;
  int exit_code = 0;
  nlohmann::ordered_json json;
};

/// Runs the three runs, writes their files and says on stderr what was found.
/// @throws InputError, FileError
[[nodiscard]] CertifyOutcome certify_model(const Model& model, const CertifyRequest& request);

/// The figures of a run, as summary_json() gives them, with those of its certificate.
[[nodiscard]] std::string with_certificate(const std::string& summary,
                                           const CertifyOutcome& outcome);

/// The certificate for people: a line for each quantity.
[[nodiscard]] std::string certificate_table(const Certificate& certificate);

}  // namespace polhode::cli
