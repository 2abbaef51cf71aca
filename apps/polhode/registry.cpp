// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <filesystem>

#include <nlohmann/json.hpp>

#include <polhode/core/format.hpp>
#include <polhode/io/schema/field_table.hpp>

#include "command.hpp"
#include "console.hpp"

namespace polhode::cli {

const std::vector<Command>& commands() {
  static const std::vector<Command> list{
      {"run", "Run a model and write its results", add_run},
      {"certify", "Run a model at three step sizes and report error bars of its results",
       add_certify},
      {"gradient", "Derivatives of outcomes of a run by parameters of its model, with error bars",
       add_gradient},
      {"modes", "Natural frequencies and shapes of a model about its equilibrium", add_modes},
      {"view", "Show results, or a model before it runs, as an animation in a browser", add_view},
      {"plot", "Draw channels of results over time, as an SVG picture", add_plot},
      {"report", "Write a report of results: extremes, plots, ledger, model", add_report},
      {"convert",
       "Write results as a table, a scene for other programs, or a film; a robot's file as a model",
       add_convert},
      {"import", "Report what is read from a robot's file, and what is not", add_import},
      {"export", "Write a model whose bodies form a tree as a robot's file", add_export},
      {"check", "Check a model: mobility, redundant rows, start, tangents", add_check},
      {"info", "List what a model contains, or the kinds of joints, loads and shapes", add_info},
      {"schema", "Write the JSON Schema or the reference page of the model file", add_schema},
      {"examples", "List the example models, or write one", add_examples},
      {"doctor", "Test this installation", add_doctor},
  };
  return list;
}

void add_set_option(CLI::App& command, ModelArguments& arguments) {
  command
      .add_option("--set", arguments.overrides,
                  "A variable (L=1.2) or any entry (analysis.step=1 ms) of the model")
      ->take_all()
      ->expected(1)
      ->type_name("NAME=VALUE");
  const char* group = "Import of a robot's file";
  const auto set = [&arguments](const std::string& text) { arguments.overrides.push_back(text); };
  command
      .add_flag_callback(
          "--allow-partial", [set] { set("import.allow_partial=true"); },
          "Leave out what cannot be represented, and report it")
      ->group(group);
  command
      .add_flag_callback(
          "--floating", [set] { set("import.base=floating"); }, "Let the first link move freely")
      ->group(group);
  command
      .add_option_function<std::string>(
          "--overlay", [set](const std::string& file) { set("import.overlay=" + file); },
          "Model file that adds to it; left out: that of its name with .overlay.yaml, if there is "
          "one")
      ->type_name("FILE")
      ->group(group);
  command
      .add_option_function<std::vector<std::string>>(
          "--package-path",
          [set](const std::vector<std::string>& folders) {
            std::string list;
            for (const std::string& folder : folders)
              list += (list.empty() ? "" : ", ") +
                      nlohmann::json(std::filesystem::absolute(folder).string()).dump();
            set("import.package_paths=[" + list + "]");
          },
          "Folder that contains the packages of package:// names; may be repeated")
      ->take_all()
      ->expected(1)
      ->type_name("FOLDER")
      ->group(group);
}

void add_isa_option(CLI::App& command, std::string& isa) {
  command
      .add_option("--isa", isa,
                  "Instruction set: results are equal bit for bit within one; left out: the "
                  "model's analysis.isa, or the best of this machine")
      ->type_name("SET")
      ->check(CLI::IsMember(io::analysis_fields().at("isa").choices));
}

void add_wall_limit(CLI::App& command, std::optional<double>& limit, const char* how) {
  const auto not_negative = [](const std::string& text) {
    return std::strtod(text.c_str(), nullptr) >= 0.0 ? std::string()
                                                     : "must not be below 0, but is " + text;
  };
  command.add_option("--wall-limit", limit, format("Stop after this wall time, {}", how))
      ->type_name("SECONDS")
      ->check(CLI::Validator(not_negative, ""));
}

}  // namespace polhode::cli
