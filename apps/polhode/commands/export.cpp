// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/exporters/export_model.hpp>
#include <polhode/io/read/read_import.hpp>
#include <polhode/io/text/file_error.hpp>

#include "command.hpp"
#include "console.hpp"

namespace polhode::cli {

namespace {

struct ExportCommand {
  ModelArguments model;
  std::string output;
  bool partial = false, json = false;
};

nlohmann::ordered_json export_json(const io::Exported& written, const std::string& file) {
  nlohmann::ordered_json notes = nlohmann::ordered_json::array();
  for (const io::ExportNote& n : written.notes)
    notes.push_back({{"kind", io::word_of(n.kind)}, {"path", n.path}, {"what", n.what}});
  return {{"format", written.format}, {"file", file}, {"notes", std::move(notes)}};
}

int export_to_file(ExportCommand& options) {
  if (!io::is_exportable(options.output)) {
    say(format("polhode export: {} is not the name of a URDF or MJCF. Name a .urdf or .xml file.",
               quote(options.output)));
    return kUsage;
  }
  std::error_code ignored;
  if (std::filesystem::equivalent(options.model.file, options.output, ignored)) {
    say("polhode export: the output is the model itself. Name another file.");
    return kUsage;
  }
  if (options.partial && io::is_importable(options.model.file))
    options.model.overrides.emplace_back("import.allow_partial=true");
  const Simulation simulation(load_model(options.model));
  const io::Exported written = io::export_model(simulation, {options.output, options.partial});
  io::write_file_atomically(options.output, written.text, false);
  if (options.json)
    print(export_json(written, options.output).dump(2) + "\n");
  else
    for (const io::ExportNote& n : written.notes)
      say(format("{}: {}: {}.", io::word_of(n.kind), n.path, n.what));
  return kOk;
}

}  // namespace

Action add_export(CLI::App& command) {
  const auto options = std::make_shared<ExportCommand>();
  command.add_option("MODEL", options->model.file, "Model file, or a file of another program")
      ->required();
  command
      .add_option("FILE", options->output,
                  "File to write: a URDF (.urdf), or an MJCF of MuJoCo (.xml)")
      ->required();
  command.add_flag("--allow-partial", options->partial,
                   "Leave out what the format cannot represent, and report it");
  command.add_flag("--json", options->json, "Print the report as one JSON object");
  command
      .add_option("--set", options->model.overrides,
                  "A variable (L=1.2) or any entry (import.base=floating) of the model")
      ->take_all()
      ->expected(1)
      ->type_name("NAME=VALUE");
  return [options] { return export_to_file(*options); };
}

}  // namespace polhode::cli
