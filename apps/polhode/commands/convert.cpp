// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <optional>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_import.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/view/channels.hpp>
#include <polhode/view/glb.hpp>
#include <polhode/view/vtkhdf.hpp>

#include "command.hpp"
#include "console.hpp"
#include "film.hpp"
#include "parquet.hpp"
#include "view_pages.hpp"

namespace polhode::cli {

namespace {

struct ConvertOptions {
  FilmRequest film;  ///< Including the names of both files.
  std::vector<std::string> channels;
  std::string size;
  ModelArguments model;  ///< Of a robot's file.
};

void write_table(const ConvertOptions& options, const std::string& ending) {
  const std::string path = results_path(options.film.results);
  const io::ResultsReader results = open_results(path);
  const ProbeTables probes(path);
  if (ending == ".csv")
    io::write_file_atomically(options.film.output, channels_csv(results, probes, options.channels),
                              false);
  else
    write_parquet(results, probes, options.channels, options.film.output);
}

void write_grids(const ConvertOptions& options) {
  const std::string path = results_path(options.film.results);
  const io::ResultsReader results = open_results(path);
  std::optional<Model> model;
  try {
    model = model_of_results(results, std::filesystem::absolute(path).parent_path().string());
  } catch (const std::exception& error) {
    say(format("The model stored in {} cannot be read, so bodies are left out. {}", path,
               error.what()));
  }
  write_vtkhdf(results, model ? &*model : nullptr, options.film.output);
}

/// Reads a size "640x400". @returns whether it is one
bool read_size(const std::string& text, FilmRequest& film) {
  char behind = 0;
  return text.empty() ||
         (std::sscanf(text.c_str(), "%dx%d%c", &film.width, &film.height, &behind) == 2 &&
          film.width >= 16 && film.height >= 16 && film.width <= 8192 && film.height <= 8192);
}

/// Writes a model file without imports. Paths of meshes are relative to its folder.
void write_model(const ConvertOptions& options) {
  const std::string folder = std::filesystem::path(options.film.output).parent_path().string();
  const io::ExpandedModel model =
      io::expanded_model(options.model.file, folder, options.model.overrides);
  if (!model.overrides.empty())
    throw InputError("polhode convert", "--set is for the import only",
                     "Give --set import.base=floating, for example, or change the model file");
  for (const io::ImportNote& n : model.report.notes)
    if (n.kind != io::ImportNote::Kind::ignored)
      say(format("{}:{}: {}: {}.", n.place.file, n.place.line, io::word_of(n.kind), n.what));
  io::write_file_atomically(options.film.output, model.text, false);
}

int convert(ConvertOptions& options) {
  const std::string ending = std::filesystem::path(options.film.output).extension().string();
  options.model.file = options.film.results;
  if (io::is_importable(options.model.file)) {
    if (ending != ".yaml" && ending != ".yml") {
      say(format("polhode convert: a robot's file becomes a model file, not {}. Name a .yaml file.",
                 ending.empty() ? "a folder" : "'" + ending + "'"));
      return kUsage;
    }
    write_model(options);
  } else if (ending == ".csv" || ending == ".parquet") {
    write_table(options, ending);
  } else if (ending == ".vtkhdf") {
    write_grids(options);
  } else if (ending == ".glb") {
    ViewRequest request;
    request.input.file = options.film.results;
    io::write_file_atomically(options.film.output, scene_glb(scene_of(request)), false);
  } else if (ending == ".gif" || ending == ".mp4" || ending.empty()) {
    if (!read_size(options.size, options.film)) {
      say(format("polhode convert: --size is '{}'. Write it as 640x400.", options.size));
      return kUsage;
    }
    write_film(options.film);
  } else {
    say(
        format("polhode convert: cannot write '{}' files. Name a .csv, .parquet, .vtkhdf, .glb, "
               ".gif or .mp4 file, or a folder for pictures.",
               ending));
    return kUsage;
  }
  return kOk;
}

}  // namespace

Action add_convert(CLI::App& command) {
  const auto options = std::make_shared<ConvertOptions>();
  command
      .add_option("RESULTS", options->film.results,
                  "Results (results.h5 or their folder), or a file of another program (.urdf, "
                  ".xacro, .xml, .sdf, .feb)")
      ->required();
  add_set_option(command, options->model);
  command
      .add_option("OUTPUT", options->film.output,
                  "A table (.csv, .parquet), a scene (.vtkhdf for ParaView, .glb), a film (.gif, "
                  ".mp4), a folder for its pictures, or a model file (.yaml) of a robot")
      ->required();
  command
      .add_option("--channels", options->channels,
                  "Columns of a table, named as for 'plot'; left out: all")
      ->type_name("CHANNEL");
  const char* film = "Film";
  command.add_option("--size", options->size, "Pixels; left out: 640x400")
      ->type_name("WIDTHxHEIGHT")
      ->group(film);
  command.add_option("--rate", options->film.rate, "Frames per second; left out: 20")
      ->check(CLI::Range(0.1, 240.0))
      ->group(film);
  command
      .add_option("--speed", options->film.speed,
                  "Seconds of motion per second of film; left out: 1")
      ->check(CLI::PositiveNumber)
      ->group(film);
  command.add_option("--from", options->film.from, "Start time [s]")->group(film);
  command.add_option("--to", options->film.to, "End time [s]")->group(film);
  command.add_option("--turn", options->film.turn, "Angle by which the camera rotates [deg]")
      ->group(film);
  command
      .add_option("--link", options->film.link,
                  "Initial camera, as 'Link' of the page writes it into the address")
      ->type_name("#eye=...")
      ->group(film);
  return [options] { return convert(*options); };
}

}  // namespace polhode::cli
