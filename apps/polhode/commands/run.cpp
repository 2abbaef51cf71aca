// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include <polhode/compile/build_system.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/results/checkpoint.hpp>
#include <polhode/io/results/recorder.hpp>
#include <polhode/io/schema/field_table.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/model/endless.hpp>

#include "certify_report.hpp"
#include "command.hpp"
#include "console.hpp"
#include "model_counts.hpp"
#include "modes_report.hpp"
#include "run_report.hpp"
#include "stop_signal.hpp"
#include "view_pages.hpp"

namespace polhode::cli {

namespace {

constexpr const char* kCheckpointName = "checkpoint.pst";
constexpr const char* kPageName = "view.html";

struct RunOptions {
  ModelArguments model;
  std::string folder, restart, isa, duration;
  std::optional<double> wall_limit;
  int threads = 0;
  bool json = false, quiet = false, certify = false, view = false, strict = false;
  CertifyRequest certificate;
};

std::string results_folder(const RunOptions& options) {
  if (!options.folder.empty()) return options.folder;
  return std::filesystem::path(options.model.file).replace_extension(".results").string();
}

/// @param note  Set to what the user should know of a restart.
Simulation make_simulation(const RunOptions& options, Model model, std::string& note) {
  if (options.restart.empty()) return Simulation(std::move(model));
  State state = io::read_checkpoint(options.restart, model, build_system(model), &note);
  const double end = model.analysis.duration;
  if (model.analysis.type == "dynamics" && state.t - state.dt_last > end)
    throw InputError(
        "--restart",
        format("the checkpoint is at t = {:.6g} s, and the run ends at {:.6g} s", state.t, end),
        "Give a longer --duration");
  return {std::move(model), std::move(state)};
}

void narrate_start(const Simulation& simulation, const std::string& folder) {
  const Model& model = simulation.model();
  const std::string title = model.title.empty() ? "Model" : model.title;
  say(format("{}: {}, {}, {}.", title, counted(model.bodies.size(), "body", "bodies"),
             counted(model.joints.size(), "joint", "joints"),
             counted(model.loads.size(), "load", "loads")));
  for (std::size_t i = 0; i < model.solids.size(); ++i)
    say(format("Solid {}: {}, {} {}.", model.solids[i].name,
               counted(simulation.solids()[i].plan.start.size(), "node", "nodes"),
               simulation.solids()[i].plan.mesh.element_count(),
               name_list(element_kinds_of(simulation.solids()[i].plan))));
  const StartReport& start = simulation.start_report();
  if (start.largest_move > 1e-9)
    say(format("The start was assembled: body '{}' moved most, by {:.2g} of the mechanism's size.",
               start.moved_body, start.largest_move));
  const std::string narration = simulation.summary().narration;
  if (!narration.empty()) say(narration);
  say(format("Results go to {}.", folder));
}

int exit_code(const RunSummary& summary, bool limit_reached) {
  switch (summary.end) {
    case RunEnd::finished:
      return kOk;
    case RunEnd::not_converged:
      return kNotConverged;
    case RunEnd::limit:
      return kLimit;
    case RunEnd::interrupted:
      break;
  }
  return limit_reached ? kLimit : kInterrupted;
}

/// Options without which a run that is continued would be another one.
std::string same_run(const RunOptions& options) {
  std::string text;
  for (const std::string& set : options.model.overrides) text += format(" --set '{}'", set);
  if (!options.folder.empty()) text += format(" -o {}", options.folder);
  return text;
}

/// Writes the page of the results into their folder, and opens it on a desktop.
void show_results(const std::string& folder, bool quiet) {
  ViewRequest request;
  request.input.file = folder;
  const std::string page = folder + "/" + kPageName;
  write_view(request, page, quiet);
  open_browser(std::filesystem::absolute(page).string());
}

int run(const RunOptions& options) {
  const double start = wall_clock();
  Model model = load_model(options.model);
  require_end(model.analysis);
  if (options.certify) check_certifiable(model);
  // A load step or the search for modes may take long; steps in time end soon.
  if (options.wall_limit && model.analysis.type != "dynamics") stop_after(*options.wall_limit);
  if (model.analysis.type == "modes") {
    catch_stop_signals();
    return run_modes(std::move(model), options.model, options.folder, options.json, options.quiet);
  }
  const std::optional<Model> original = options.certify ? std::optional(model) : std::nullopt;
  std::string note;
  Simulation simulation = make_simulation(options, std::move(model), note);
  const std::string folder = results_folder(options);
  const std::string checkpoint = folder + "/" + kCheckpointName;
  io::Recorder recorder(simulation, folder, provenance_of(options.model, simulation.summary()),
                        !options.restart.empty());
  if (!options.quiet) narrate_start(simulation, folder);

  const auto save = [&] {
    recorder.sync();
    io::write_checkpoint(checkpoint, simulation.model(), simulation.system(), simulation.state());
  };
  catch_stop_signals();
  bool limit_reached = false;
  const double every = simulation.model().analysis.checkpoint_every;
  double next_save = every > 0.0 ? wall_clock() + every : 0.0;
  Progress progress(!options.quiet, simulation.model().analysis.duration);
  recorder.step(simulation);
  RunSummary summary =
      simulation.run([&](Simulation& s) { recorder.frame(s); },
                     [&](Simulation& s) {
                       recorder.step(s);
                       progress.show(s);
                       if (!options.wall_limit && every <= 0.0) return;
                       const double now = wall_clock();
                       if (options.wall_limit && now - start >= *options.wall_limit) {
                         limit_reached = true;
                         stop_wanted = true;
                       }
                       if (every > 0.0 && now >= next_save) {
                         save();
                         next_save = wall_clock() + every;
                       }
                     },
                     &stop_wanted);
  progress.clear();
  if (!note.empty()) summary.warnings.push_back(note);

  // The last state is part of the results of a finished or failed run.
  if (summary.end == RunEnd::finished || summary.end == RunEnd::not_converged)
    recorder.frame(simulation);
  recorder.conclude(summary);
  save();
  recorder.close();

  int code = exit_code(summary, limit_reached || wall_limit_reached);
  if (options.strict && code == kOk && !summary.trusted()) code = kCheckFailed;
  if (!summary.message.empty() && (code == kNotConverged || code == 0)) say(summary.message);
  for (const std::string& warning : summary.warnings) say("warning: " + warning);
  if (code == kInterrupted || code == kLimit)
    say(format("Stopped at t = {:.6g} s{}. Continue with:  polhode run {}{} --restart {}",
               summary.t, code == kLimit ? " at the wall-time limit" : "", options.model.file,
               same_run(options), checkpoint));
  if (!options.json && !options.quiet)
    print(summary.statics ? statics_table(summary) : summary_table(summary, shows_colours()));
  std::string json = options.json ? summary_json(summary, code, folder, recorder.frames()) : "";
  if (options.certify && code == kOk) {
    CertifyRequest request = options.certificate;
    request.folder = folder;
    request.quiet = options.quiet;
    if (options.wall_limit)
      request.wall_limit = std::max(0.0, *options.wall_limit - (wall_clock() - start));
    const CertifyOutcome outcome = certify_model(*original, request);
    code = outcome.exit_code;
    if (options.json) json = with_certificate(json, outcome);
    if (!options.json && !options.quiet) print(certificate_table(outcome.certificate));
  }
  if (options.view) show_results(folder, options.quiet || options.json);
  if (options.json) print(json + "\n");
  return code;
}

}  // namespace

Action add_run(CLI::App& command) {
  const auto options = std::make_shared<RunOptions>();
  command.add_option("MODEL", options->model.file, "Model file (YAML or JSON)")->required();
  command
      .add_option("-o,--output", options->folder,
                  "Folder for the results; left out: the model's name with .results")
      ->type_name("DIR");
  add_set_option(command, options->model);
  command
      .add_option("--duration", options->duration,
                  "Length of the motion, such as 10 s, instead of the model's")
      ->type_name("TIME");
  add_isa_option(command, options->isa);
  command
      .add_option(
          "--threads", options->threads,
          "Threads for the members of extrapolated steps, instead of the model's; results have the "
          "same bits")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  command.add_option("--restart", options->restart, "Continue from a checkpoint of this model")
      ->type_name("FILE");
  add_wall_limit(command, options->wall_limit, "with a checkpoint and exit code 75");
  CLI::Option* certify =
      command.add_flag("--certify", options->certify,
                       "Also run with finer steps and report error bars, see 'certify'");
  add_within_option(command, options->certificate);
  command.get_option("--within")->needs(certify);
  certify->excludes(command.get_option("--restart"));
  command.add_flag("--view", options->view, "Write view.html into the results folder, and open it");
  command.add_flag("--strict", options->strict,
                   "Exit with 6 if a balance does not close or a constraint does not hold");
  command.add_flag("--json", options->json, "Print the summary of the run as one JSON object");
  command.add_flag("--quiet", options->quiet, "Print errors only");
  return [options] {
    if (!options->duration.empty())
      options->model.overrides.push_back("analysis.duration=" + options->duration);
    if (options->threads > 0)
      options->model.overrides.push_back(format("analysis.threads={}", options->threads));
    if (!options->isa.empty()) options->model.overrides.push_back("analysis.isa=" + options->isa);
    return run(*options);
  };
}

}  // namespace polhode::cli
