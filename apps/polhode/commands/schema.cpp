// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <polhode/io/schema/schema.hpp>
#include <polhode/io/text/file_error.hpp>

#include "command.hpp"
#include "console.hpp"

namespace polhode::cli {

Action add_schema(CLI::App& command) {
  struct Options {
    bool markdown = false;
    std::string output;
  };
  const auto options = std::make_shared<Options>();
  command.add_flag("--markdown", options->markdown, "The reference page instead of the schema");
  command.add_option("-o,--output", options->output, "File to write; left out: stdout")
      ->type_name("FILE");
  command.footer("An editor that knows JSON Schema completes and checks model files with it.");
  return [options] {
    const std::string text = options->markdown ? io::reference_markdown() : io::json_schema();
    if (options->output.empty())
      print(text);
    else
      io::write_file_atomically(options->output, text);
    return kOk;
  };
}

}  // namespace polhode::cli
