// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

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
      {"modes", "Natural frequencies and shapes of a model about its equilibrium", add_modes},
      {"view", "Show results, or a model before it runs, as an animation in a browser", add_view},
      {"plot", "Draw channels of results over time, as an SVG picture", add_plot},
      {"convert", "Write results as a table, a scene for other programs, or a film", add_convert},
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
