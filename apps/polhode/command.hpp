// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace polhode::cli {

/// Exit codes of the program, documented in docs/reference/cli.md.
enum ExitCode : int {
  kOk = 0,
  kInternalError = 1,  ///< A fault of Polhode.
  kUsage = 2,          ///< The command line is wrong.
  kModelInvalid = 3,   ///< The model is wrong.
  kNotConverged = 4,   ///< A step did not converge; the last state was written.
  kInputOutput = 5,    ///< A file could not be read or written.
  kCheckFailed = 6,    ///< `check` or `doctor` found an error.
  kLimit = 75,         ///< Stopped at --wall-limit, with a checkpoint.
  kInterrupted = 130,  ///< Stopped by Ctrl-C, with a checkpoint.
};

/// Function that executes a command and returns the exit code.
using Action = std::function<int()>;

/// A command of the program.
struct Command {
  const char* name;
  const char* summary;  ///< One line.
  Action (*add_options)(CLI::App& command);
};

/// All commands, in the order of the help text.
[[nodiscard]] const std::vector<Command>& commands();

struct ModelArguments;
/// Adds --set PATH=VALUE, and options of imports that stand for some of it, to commands that read a
/// model.
void add_set_option(CLI::App& command, ModelArguments& arguments);

/// Adds --isa SET to commands that run a model.
void add_isa_option(CLI::App& command, std::string& isa);
/// Adds --wall-limit SECONDS. @param how  Way in which the command stops, a part of a sentence.
void add_wall_limit(CLI::App& command, std::optional<double>& limit, const char* how);
struct CertifyRequest;
/// Adds --within PART to commands that certify.
void add_within_option(CLI::App& command, CertifyRequest& request);

// Each in one file of commands/.
Action add_run(CLI::App& command);
Action add_certify(CLI::App& command);
Action add_gradient(CLI::App& command);
Action add_modes(CLI::App& command);
Action add_view(CLI::App& command);
Action add_plot(CLI::App& command);
Action add_report(CLI::App& command);
Action add_convert(CLI::App& command);
Action add_import(CLI::App& command);
Action add_export(CLI::App& command);
Action add_check(CLI::App& command);
Action add_info(CLI::App& command);
Action add_schema(CLI::App& command);
Action add_examples(CLI::App& command);
Action add_doctor(CLI::App& command);

}  // namespace polhode::cli
