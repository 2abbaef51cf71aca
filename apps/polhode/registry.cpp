// SPDX-License-Identifier: Apache-2.0
#include "command.hpp"
#include "console.hpp"

namespace polhode::cli {

const std::vector<Command>& commands() {
  static const std::vector<Command> list{
      {"run", "Run a model and write its results", add_run},
      {"modes", "Natural frequencies and shapes of a model about its equilibrium", add_modes},
      {"check", "Look for faults in a model: mobility, redundant rows, start, tangents", add_check},
      {"info", "Tell what a model holds, or which joints, loads and shapes exist", add_info},
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

}  // namespace polhode::cli
