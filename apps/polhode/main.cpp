// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/version.hpp>
#include <polhode/io/text/diagnostics.hpp>
#include <polhode/io/text/file_error.hpp>

#include "command.hpp"
#include "console.hpp"

namespace polhode::cli {
namespace {

/// Suggestions for a misspelt word: commands, or the options of a command.
std::string suggestion(const CLI::App& app, const std::string& word) {
  std::vector<std::string> options;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  return did_you_mean(word, options);
}

int usage(const std::string& program, const std::string& what) {
  say(format("{}: {} Run '{} --help' for its options.", program, what, program));
  return kUsage;
}

int unknown_command(const std::string& word) {
  std::vector<std::string> names;
  for (const Command& command : commands()) names.emplace_back(command.name);
  return usage("polhode", format("there is no command '{}'. {}Commands: {}.", word,
                                 did_you_mean(word, names), name_list(names)));
}

/// Message of CLI11 as a sentence.
std::string sentence(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
  return text + ".";
}

int main_program(int argc, char** argv) {
  CLI::App app("Polhode: dynamics of mechanisms, exact where physics is exact.", "polhode");
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("polhode ") + version());
  app.footer("Start with:  polhode examples n_four_bar > model.yaml && polhode run model.yaml");
  std::vector<std::pair<CLI::App*, Action>> actions;
  for (const Command& command : commands()) {
    CLI::App* sub = app.add_subcommand(command.name, command.summary);
    actions.emplace_back(sub, command.add_options(*sub));
  }

  const std::string first = argc > 1 ? argv[1] : "-";
  const auto known = [&](const Command& c) { return first == c.name; };
  if (first.substr(0, 1) != "-" && std::none_of(commands().begin(), commands().end(), known))
    return unknown_command(first);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& request) {
    return app.exit(request);
  } catch (const CLI::CallForVersion& request) {
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    for (const auto& [sub, action] : actions) {
      if (!sub->parsed()) continue;
      const std::string program = "polhode " + sub->get_name();
      const std::vector<std::string> rest = app.remaining(true);
      if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr && !rest.empty())
        return usage(program, format("does not take '{}'. {}", rest[0], suggestion(*sub, rest[0])));
      return usage(program, sentence(error.what()));
    }
    return usage("polhode", sentence(error.what()));
  }
  for (const auto& [sub, action] : actions)
    if (sub->parsed()) return action();
  return kUsage;
}

}  // namespace
}  // namespace polhode::cli

int main(int argc, char** argv) {
  using namespace polhode;
  cli::open_standard_files();
  // A file that reaches the limit of its length is an error of writing, with its message.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return cli::main_program(argc, argv);
  } catch (const io::ModelErrors& errors) {
    cli::say(errors.text());
    return cli::kModelInvalid;
  } catch (const InputError& error) {
    cli::say(cli::located_text(error));
    return cli::kModelInvalid;
  } catch (const io::FileError& error) {
    cli::say(error.what());
    return cli::kInputOutput;
  } catch (const SolveError& error) {
    cli::say(cli::located_text(error));
    return cli::kNotConverged;
  } catch (const std::bad_alloc&) {
    cli::say("polhode: the memory is exhausted. Run a smaller model, or on a larger machine.");
    return cli::kInternalError;
  } catch (const std::exception& error) {
    cli::say(
        format("polhode: internal error: {}. This is a fault of Polhode; report it with the "
               "model.",
               error.what()));
    return cli::kInternalError;
  }
}
