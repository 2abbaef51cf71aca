// SPDX-License-Identifier: Apache-2.0
#include "view_pages.hpp"

#include <cstdlib>
#include <filesystem>
#include <optional>

#include <spawn.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/results/recorder.hpp>
#include <polhode/io/results/results_format.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/newton/rank_report.hpp>
#include <polhode/view/shared_player.hpp>
#include <polhode/view/zip_archive.hpp>

#include "command.hpp"
#include "run_report.hpp"
#include "temporary_folder.hpp"

extern char** environ;

namespace polhode::cli {

namespace {

namespace fs = std::filesystem;

/// Adds remarks of `polhode check` that a picture of the start can show.
void add_remarks(const Simulation& simulation, SceneOptions& options) {
  const RankReport rank = rank_report(simulation.system(), simulation.state());
  options.notes.push_back(format("Before the run: mobility {}, {} constraint rows, {} redundant.",
                                 rank.mobility, rank.rows, rank.redundant));
  for (const JointSpec& joint : simulation.model().joints)
    for (const std::string& name : rank.names)
      if (name == format("joint '{}'", joint.name))
        options.marks[joint.name] = "has a part in redundant constraint rows";
  const StartReport& start = simulation.start_report();
  if (start.largest_move > 1e-6)
    options.notes.push_back(
        format("The start is not assembled: body '{}' was moved by {:.2g} of the mechanism's size.",
               start.moved_body, start.largest_move));
  for (const SolidMap& solid : simulation.solids())
    options.notes.insert(options.notes.end(), solid.plan.warnings.begin(),
                         solid.plan.warnings.end());
}

/// Start of a model. Overlaps, which a run rejects, can be shown: they are noted, the bodies are
/// marked, and contact is disabled.
Simulation start_of(Model model, SceneOptions& options) {
  try {
    return Simulation(Model(model));
  } catch (const InputError& error) {
    const std::string what = error.what_is_wrong();
    if (error.where() != "contacts" || what.find(" at the start: ") == std::string::npos) throw;
    options.notes.push_back(error.what());
    for (const BodySpec& body : model.bodies)
      if (what.find(format("'{}'", body.name)) != std::string::npos)
        options.body_marks[body.name] = "overlaps at the start";
    model.contacts = ContactsSpec{};
    return Simulation(std::move(model));
  }
}

SceneData scene_of_model(const ViewRequest& request, SceneOptions options) {
  Model model = load_model(request.input);
  model.output.paraview = model.output.csv = false;
  model.output.hdf5 = true;
  const Simulation simulation = start_of(std::move(model), options);
  const TemporaryFolder folder;
  io::Recorder recorder(simulation, folder.path(),
                        provenance_of(request.input, simulation.summary()));
  recorder.frame(simulation);
  recorder.close();
  add_remarks(simulation, options);
  const io::ResultsReader results(folder.path() + "/" + io::results::kFileName);
  return make_scene(results, &simulation.model(), options);
}

}  // namespace

bool is_results(const std::string& path) {
  std::error_code ignored;  // Names may be longer than the file system allows.
  return fs::is_directory(path, ignored) || fs::path(path).extension() == ".h5";
}

std::string results_path(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored) ? path + "/" + io::results::kFileName : path;
}

io::ResultsReader open_results(const std::string& path) {
  io::ResultsReader results(path);
  if (results.cut_short()) say("warning: " + results.cut_text());
  return results;
}

std::string time_label(const io::ResultsReader& results, const std::string& path) {
  try {
    const auto folder = fs::absolute(path).parent_path().string();
    if (model_of_results(results, folder).analysis.type == "statics") return "load factor [-]";
  } catch (const std::exception&) {  // Without the model only the time is left.
  }
  return "t [s]";
}

SceneData scene_of(const ViewRequest& request) {
  SceneOptions options;
  options.max_frames = request.frames;
  options.name = request.input.file;
  options.compared = request.compared;
  if (!request.compared.empty()) options.max_bytes /= 2;
  if (!is_results(request.input.file)) return scene_of_model(request, options);
  const std::string path = results_path(request.input.file);
  const io::ResultsReader results = open_results(path);
  std::optional<Model> model;
  try {
    model = model_of_results(results, fs::absolute(path).parent_path().string());
  } catch (const std::exception& error) {
    say(format("The model stored in {} cannot be read, so bodies are shown as cubes. {}", path,
               error.what()));
  }
  return make_scene(results, model ? &*model : nullptr, options);
}

SceneData compared_scene_of(const ViewRequest& request) {
  ViewRequest other = request;
  std::swap(other.input.file, other.compared);
  other.input.overrides.clear();
  return scene_of(other);
}

void write_view(const ViewRequest& request, const std::string& file, bool quiet) {
  const SceneData scene = scene_of(request);
  std::optional<SceneData> compared;
  if (!request.compared.empty()) compared = compared_scene_of(request);
  const std::string page = scene_page(viewer_text(), scene, compared ? &*compared : nullptr);
  io::write_file_atomically(file, page, false);
  if (quiet) return;
  const std::string part =
      scene.every > 1 ? format(", 1 in {} of the file", scene.every) : std::string();
  say(format("{}: {}{}, {:.1f} MB. Open it with a browser; it needs no network.", file,
             counted(scene.frames, "frame", "frames"), part,
             static_cast<double>(page.size()) / 1e6));
}

void write_view_zip(const ViewRequest& request, const std::vector<std::string>& inputs,
                    const std::string& file, bool quiet) {
  std::vector<SharedRecording> recordings;
  for (const std::string& input : inputs) {
    ViewRequest one = request;
    one.input.file = input;
    const SceneData scene = scene_of(one);
    fs::path name = fs::path(input).lexically_normal();
    if (!name.has_filename() || name.filename() == io::results::kFileName)
      name = name.parent_path();
    const std::string stem = name.filename().stem().string();
    for (const SharedRecording& other : recordings)
      if (other.name == stem)
        throw InputError("polhode view", format("two recordings are called '{}'", stem),
                         "Rename one of the folders");
    recordings.push_back({stem,
                          format("{}, {}", scene.title, counted(scene.frames, "frame", "frames")),
                          scene_page(viewer_text(), scene)});
  }
  const std::string bytes = zip_archive(shared_pages(recordings));
  io::write_file_atomically(file, bytes, false);
  if (!quiet)
    say(format("{}: {}, {:.1f} MB. Unpack it and open index.html; it needs no network.", file,
               counted(recordings.size(), "recording", "recordings"),
               static_cast<double>(bytes.size()) / 1e6));
}

bool open_browser(const std::string& address) {
#ifdef __APPLE__
  std::string program = "open";
#else
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return false;
  std::string program = "xdg-open";
#endif
  std::string argument = address;
  char* arguments[] = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  return posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ) == 0;
}

}  // namespace polhode::cli
