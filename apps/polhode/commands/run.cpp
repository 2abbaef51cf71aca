// SPDX-License-Identifier: Apache-2.0
#include <csignal>

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>

#include <polhode/base/error.hpp>
#include <polhode/base/format.hpp>
#include <polhode/base/names.hpp>
#include <polhode/io/checkpoint.hpp>
#include <polhode/io/field_table.hpp>
#include <polhode/io/file_error.hpp>
#include <polhode/io/recorder.hpp>
#include <polhode/model/build_system.hpp>

#include "command.hpp"
#include "console.hpp"
#include "modes_report.hpp"
#include "run_report.hpp"

namespace polhode::cli {

namespace {

constexpr const char* kCheckpointName = "checkpoint.pst";

struct Options {
  ModelArguments model;
  std::string folder, restart, isa;
  std::optional<double> wall_limit;
  bool json = false, quiet = false;
};

/// Set by Ctrl-C; the run ends after the step it is in. A second Ctrl-C ends the program at once.
std::atomic<bool> stop_wanted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may not lock");

void catch_stop_signals() {
  struct sigaction action = {};
  action.sa_handler = [](int) { stop_wanted = true; };
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  for (int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}

std::string results_folder(const Options& options) {
  if (!options.folder.empty()) return options.folder;
  return std::filesystem::path(options.model.file).replace_extension(".results").string();
}

Simulation make_simulation(const Options& options, Model model) {
  if (options.restart.empty()) return Simulation(std::move(model));
  State state = read_checkpoint(options.restart, model, build_system(model));
  return {std::move(model), std::move(state)};
}

Provenance provenance_of(const Options& options, const RunSummary& summary) {
  return {.version = POLHODE_VERSION,
          .solver = summary.solver,
          .instruction_set = summary.instruction_set,
          .model_file = std::filesystem::path(options.model.file).filename().string(),
          .model_text = read_file(options.model.file),
          .overrides = options.model.overrides};
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
               name_list(simulation.solids()[i].plan.elements)));
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

int run(const Options& options) {
  const double start = wall_clock();
  Model model = load_model(options.model);
  if (model.analysis.type == "modes")
    return run_modes(std::move(model), options.model, options.folder, options.json, options.quiet);
  Simulation simulation = make_simulation(options, std::move(model));
  const std::string folder = results_folder(options);
  const std::string checkpoint = folder + "/" + kCheckpointName;
  Recorder recorder(simulation, folder, provenance_of(options, simulation.summary()),
                    !options.restart.empty());
  if (!options.quiet) narrate_start(simulation, folder);

  const auto save = [&] {
    write_checkpoint(checkpoint, simulation.model(), simulation.system(), simulation.state());
  };
  catch_stop_signals();
  bool limit_reached = false;
  const double every = simulation.model().analysis.checkpoint_every;
  double next_save = every > 0.0 ? wall_clock() + every : 0.0;
  Progress progress(!options.quiet, simulation.model().analysis.duration);
  recorder.step(simulation);
  const RunSummary summary =
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

  // The last state belongs to the results of a run that has come to its end or to a halt.
  if (summary.end == RunEnd::finished || summary.end == RunEnd::not_converged)
    recorder.frame(simulation);
  recorder.close();
  save();

  const int code = exit_code(summary, limit_reached);
  if (code == kNotConverged) say(summary.message);
  for (const std::string& warning : summary.warnings) say("warning: " + warning);
  if (code == kInterrupted || code == kLimit)
    say(format("Stopped at t = {:.6g} s{}. Continue with:  polhode run {} --restart {}", summary.t,
               code == kLimit ? " at the wall-time limit" : "", options.model.file, checkpoint));
  if (options.json)
    print(summary_json(summary, code, folder, recorder.frames()) + "\n");
  else if (!options.quiet)
    print(summary.statics ? statics_table(summary) : summary_table(summary));
  return code;
}

}  // namespace

Action add_run(CLI::App& command) {
  const auto options = std::make_shared<Options>();
  command.add_option("MODEL", options->model.file, "Model file (YAML or JSON)")->required();
  command
      .add_option("-o,--output", options->folder,
                  "Folder for the results; left out: the model's name with .results")
      ->type_name("DIR");
  add_set_option(command, options->model);
  command
      .add_option("--isa", options->isa,
                  "Instruction set: results are equal bit for bit within one; left out: the "
                  "model's analysis.isa, or the best of this machine")
      ->type_name("SET")
      ->check(CLI::IsMember(analysis_fields().at("isa").choices));
  command.add_option("--restart", options->restart, "Continue from a checkpoint of this model")
      ->type_name("FILE");
  command
      .add_option("--wall-limit", options->wall_limit,
                  "Stop after this wall time, with a checkpoint and exit code 75")
      ->type_name("SECONDS")
      ->check(CLI::NonNegativeNumber);
  command.add_flag("--json", options->json, "Print the figures of the run as one JSON object");
  command.add_flag("--quiet", options->quiet, "Say nothing but errors");
  return [options] {
    if (!options->isa.empty()) options->model.overrides.push_back("analysis.isa=" + options->isa);
    return run(*options);
  };
}

}  // namespace polhode::cli
