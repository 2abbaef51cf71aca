// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/text/diagnostics.hpp>
#include <polhode/io/text/example_models.hpp>
#include <polhode/io/text/file_error.hpp>

#include "command.hpp"
#include "console.hpp"
#include "example_texts.hpp"

namespace polhode::cli {

namespace {

struct ExamplesOptions {
  std::string name, output;
  std::vector<std::string> sets;
};

/// Title in a model's text, or "".
std::string title_of(const std::string& text) {
  constexpr std::string_view kKey = "\ntitle:";
  const std::size_t at = ("\n" + text).find(kKey);
  if (at == std::string::npos) return "";
  const std::size_t begin = text.find_first_not_of(' ', at + kKey.size() - 1);
  if (begin == std::string::npos) return "";
  const bool quoted = text[begin] == '"' || text[begin] == '\'';
  const std::size_t end = quoted ? text.find(text[begin], begin + 1) : text.find('\n', begin);
  return text.substr(begin + quoted, end - begin - quoted);
}

/// Whether an example is generated; a generator takes precedence over a folder of its name, which
/// contains one of its sizes.
bool is_generated(const std::string& name) {
  const auto& generators = io::model_generators();
  return std::any_of(generators.begin(), generators.end(),
                     [&](const io::ModelGenerator& g) { return g.name == name; });
}

std::string listing() {
  std::vector<std::vector<std::string>> examples, generators;
  for (const ExampleText& example : example_texts())
    if (!is_generated(example.name)) examples.push_back({example.name, title_of(example.text)});
  for (const io::ModelGenerator& generator : io::model_generators()) {
    std::string values;
    for (const io::GeneratorParameter& p : generator.parameters)
      values += format(" --set {}={}", p.name, p.standard);
    generators.push_back({generator.name + values, generator.meaning});
  }
  std::string text;
  if (!examples.empty()) text += "Examples:\n" + table(examples) + "\n";
  return text + "Models of any size:\n" + table(generators) +
         "\nWrite one with:  polhode examples NAME > model.yaml\n";
}

std::map<std::string, std::string> values_of(const std::vector<std::string>& sets) {
  std::map<std::string, std::string> values;
  for (const std::string& set : sets) {
    const std::size_t equals = set.find('=');
    if (equals == std::string::npos || equals == 0)
      throw InputError("--set", format("'{}' is not of the form name=value", set),
                       "Write for instance --set N=40");
    values[set.substr(0, equals)] = set.substr(equals + 1);
  }
  return values;
}

std::string text_of(const ExamplesOptions& options) {
  std::vector<std::string> names;
  for (const io::ModelGenerator& generator : io::model_generators()) {
    if (generator.name == options.name)
      return io::generate_model(generator, values_of(options.sets));
    names.push_back(generator.name);
  }
  for (const ExampleText& example : example_texts()) {
    if (example.name != options.name) {
      names.push_back(example.name);
      continue;
    }
    if (!options.sets.empty())
      throw InputError("--set", format("the example '{}' takes no values", example.name),
                       "Set them when it is run: polhode run model.yaml --set ...");
    return example.text;
  }
  throw InputError("examples", format("there is no example '{}'", options.name),
                   format("{}Examples: {}", did_you_mean(options.name, names), name_list(names)));
}

/// Writes the files that the model of an example names, into the folder of the model. A file that
/// exists with another content is not replaced.
void write_files(const ExamplesOptions& options) {
  if (is_generated(options.name)) return;
  for (const ExampleText& example : example_texts()) {
    if (example.name != options.name) continue;
    for (const ExampleFile& file : example.files) {
      const std::filesystem::path folder = std::filesystem::path(options.output).parent_path();
      const std::string path = (folder / file.name).string();
      if (std::filesystem::exists(path) && io::read_file(path) != file.text)
        throw io::FileError(path, "exists with another content, and the example needs this name",
                            "Write the example into another folder");
      io::write_file_atomically(path, file.text);
      say(format("The model needs {}, which was written, too.", path));
    }
  }
}

}  // namespace

Action add_examples(CLI::App& command) {
  const auto options = std::make_shared<ExamplesOptions>();
  command.add_option("NAME", options->name, "Example to write; left out: list them");
  command.add_option("--set", options->sets, "A value of a generated model, e.g. N=40")
      ->take_all()
      ->expected(1)
      ->type_name("NAME=VALUE");
  command
      .add_option("-o,--output", options->output,
                  "File to write, with its meshes beside it; left out: stdout")
      ->type_name("FILE");
  return [options] {
    try {
      const std::string text = options->name.empty() ? listing() : text_of(*options);
      write_files(*options);
      if (options->output.empty())
        print(text);
      else
        io::write_file_atomically(options->output, text);
      return kOk;
    } catch (const InputError& error) {  // Wrong arguments, not a wrong model.
      say(error.what());
      return kUsage;
    }
  };
}

}  // namespace polhode::cli
