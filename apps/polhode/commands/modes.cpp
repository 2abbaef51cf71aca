// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <vector>

#include <nlohmann/json.hpp>

#include <polhode/core/format.hpp>
#include <polhode/core/version.hpp>
#include <polhode/io/read/read_import.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/io/results/write_campbell.hpp>
#include <polhode/io/results/write_modes.hpp>
#include <polhode/io/text/file_error.hpp>

#include "command.hpp"
#include "console.hpp"
#include "modes_report.hpp"
#include "stop_signal.hpp"

namespace polhode::cli {

namespace {

struct ModesOptions {
  ModelArguments model;
  std::string folder, about;
  io::SpinText spin;
  int count = 0;
  std::optional<double> wall_limit;
  bool json = false, quiet = false;
};

/// Texts of the command line as values of a model file.
io::SpinText quoted(io::SpinText text) {
  for (std::string* value : {&text.spin, &text.axis, &text.through, &text.ground})
    if (!value->empty() && value->front() != '[') *value = nlohmann::json(*value).dump();
  return text;
}

int modes(const ModesOptions& options) {
  Model model = load_model(options.model);
  if (options.count > 0) model.analysis.count = options.count;
  if (!options.about.empty()) model.analysis.about = options.about;
  io::set_spin(quoted(options.spin), model.analysis);
  if (options.wall_limit) stop_after(*options.wall_limit);
  return run_modes(std::move(model), options.model, options.folder, options.json, options.quiet);
}

nlohmann::ordered_json vector_json(const Vec3& v) { return {v[0], v[1], v[2]}; }

/// @param spins  Adds what belongs to modes about a spin.
nlohmann::ordered_json mode_json(const Mode& m, bool spins) {
  nlohmann::ordered_json json = {{"frequency", m.frequency},
                                 {"damping_ratio", m.damping},
                                 {"kind", kind_name(m.kind)},
                                 {"eigenvalue", {m.eigenvalue.real(), m.eigenvalue.imag()}},
                                 {"omega_squared", m.omega_squared},
                                 {"rigid", m.rigid},
                                 {"motion", m.motion},
                                 {"participation", vector_json(m.participation)},
                                 {"effective_mass", vector_json(m.effective_mass)},
                                 {"residual", m.residual}};
  if (!spins) return json;
  json["whirl"] = whirl_name(m.whirl);
  json["world_frequency"] = m.world_frequency ? nlohmann::ordered_json(*m.world_frequency)
                                              : nlohmann::ordered_json(nullptr);
  return json;
}

std::string modes_json(const ModalAnalysis& analysis, int code, const std::string& folder) {
  const ModesReport& r = analysis.report();
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Mode& m : r.modes) list.push_back(mode_json(m, false));
  const nlohmann::ordered_json complete =
      r.counted ? nlohmann::ordered_json(r.complete) : nlohmann::ordered_json(nullptr);
  const nlohmann::ordered_json freedoms =
      r.freedoms >= 0 ? nlohmann::ordered_json(r.freedoms) : nlohmann::ordered_json(nullptr);
  const nlohmann::ordered_json json = {{"exit_code", code},
                                       {"message", analysis.message()},
                                       {"modes", list},
                                       {"total_mass", r.total_mass},
                                       {"freedoms", freedoms},
                                       {"symmetric", r.symmetric},
                                       {"complete", complete},
                                       {"unbalanced", r.unbalanced},
                                       {"held", r.held},
                                       {"wall_time_s", analysis.wall_time()},
                                       {"cpu_time_s", analysis.cpu_time()},
                                       {"warnings", r.warnings},
                                       {"results", folder}};
  return json.dump(2);
}

io::Provenance provenance_of(const ModelArguments& arguments) {
  io::ExpandedModel source = io::expanded_model(arguments.file, arguments.overrides);
  return {.version = version(),
          .solver = "mumps",
          .model_file = std::filesystem::path(arguments.file).filename().string(),
          .model_text = std::move(source.text),
          .overrides = std::move(source.overrides)};
}

std::string remark(const Mode& m) {
  if (m.kind == ModeKind::free) return m.motion.empty() ? "free" : "free: " + m.motion;
  if (m.kind == ModeKind::divergence) return "divergence: grows as exp(2 pi f t)";
  if (m.kind == ModeKind::overdamped) return "overdamped: decays as exp(-2 pi f t)";
  if (m.kind == ModeKind::flutter)
    return format("flutter: grows by exp({:.3g} t)", m.eigenvalue.real());
  return {};
}

std::string modes_table(const ModesReport& r) {
  std::vector<std::vector<std::string>> rows{
      {"mode", "Hz", "damping", "mass x", "mass y", "mass z", "residual", ""}};
  if (r.symmetric) rows[0].erase(rows[0].begin() + 2);
  const auto part = [](double x) { return format("{:.4f}", x); };
  for (std::size_t i = 0; i < r.modes.size(); ++i) {
    const Mode& m = r.modes[i];
    const bool swings = m.kind == ModeKind::oscillation || m.kind == ModeKind::flutter;
    rows.push_back({format("{}", i + 1), format("{:.6g}", m.frequency)});
    if (!r.symmetric) rows.back().push_back(swings ? format("{:.3g}", m.damping) : "");
    rows.back().insert(rows.back().end(),
                       {part(m.effective_mass[0]), part(m.effective_mass[1]),
                        part(m.effective_mass[2]), format("{:.0e}", m.residual), remark(m)});
  }
  std::string text = table(rows);
  if (r.freedoms == static_cast<int>(r.modes.size()))
    text +=
        format("  The model has {}: these are all its modes.\n",
               r.freedoms == 1 ? std::string("one freedom") : format("{} freedoms", r.freedoms));
  return text;
}

/// Contacts and stops that hold like joints in these modes.
void say_held(const ModalAnalysis& analysis) {
  for (const std::string& row : analysis.report().held) say("held like a joint: " + row);
}

std::string spin_json(const std::vector<ModalAnalysis>& analyses, int code,
                      const std::string& folder) {
  nlohmann::ordered_json speeds = nlohmann::ordered_json::array();
  for (const ModalAnalysis& analysis : analyses) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Mode& m : analysis.report().modes) list.push_back(mode_json(m, true));
    speeds.push_back({{"spin", analysis.spin()},
                      {"message", analysis.message()},
                      {"modes", list},
                      {"held", analysis.report().held},
                      {"warnings", analysis.report().warnings}});
  }
  return nlohmann::ordered_json{{"exit_code", code}, {"speeds", speeds}, {"results", folder}}.dump(
      2);
}

std::string spin_table(const std::vector<ModalAnalysis>& analyses) {
  std::vector<std::vector<std::string>> rows{
      {"spin rad/s", "mode", "Hz turning", "Hz in world", "whirl", "damping", ""}};
  bool damped = false;
  for (const ModalAnalysis& analysis : analyses)
    for (std::size_t i = 0; i < analysis.report().modes.size(); ++i) {
      const Mode& m = analysis.report().modes[i];
      damped = damped || m.damping != 0.0;
      const bool whirls = m.whirl == Whirl::forward || m.whirl == Whirl::backward;
      rows.push_back({i == 0 ? format("{:g}", analysis.spin()) : std::string(), format("{}", i + 1),
                      format("{:.6g}", m.frequency),
                      m.world_frequency ? format("{:.6g}", *m.world_frequency) : std::string("-"),
                      whirls ? whirl_name(m.whirl) : "-", format("{:.3g}", m.damping), remark(m)});
    }
  if (!damped)
    for (std::vector<std::string>& row : rows) row.erase(row.begin() + 5);
  return table(rows);
}

int code_of(const ModalAnalysis& analysis) {
  if (analysis.converged()) return kOk;
  if (wall_limit_reached) return kLimit;
  return stop_wanted ? kInterrupted : kNotConverged;
}

/// Computes, writes and prints the modes at all speeds of a spin. @returns the exit code.
int run_spin(const Model& model, const ModelArguments& arguments, const std::string& folder,
             bool json, bool quiet) {
  std::vector<ModalAnalysis> analyses = spin_analyses(model, &stop_wanted);
  const int code = code_of(analyses.back());  // The first that fails is the last.
  for (const ModalAnalysis& analysis : analyses) {
    if (!quiet) say_held(analysis);
    for (const std::string& warning : analysis.report().warnings)
      say(format("warning: at {:g} rad/s: {}", analysis.spin(), warning));
    if (!analysis.converged())
      say(format("At {:g} rad/s: {}", analysis.spin(), analysis.message()));
  }
  if (json) print(spin_json(analyses, code, folder) + "\n");
  if (!analyses.back().converged()) analyses.pop_back();
  if (analyses.empty()) return code;
  const io::Provenance provenance = provenance_of(arguments);
  for (std::size_t i = 0; i < analyses.size(); ++i)
    io::write_modes(analyses[i],
                    analyses.size() == 1 ? folder : format("{}/speed_{}", folder, i + 1),
                    provenance);
  io::write_campbell(analyses, folder);
  if (!json && !quiet) print(spin_table(analyses));
  return code;
}

}  // namespace

int run_modes(Model model, const ModelArguments& arguments, std::string folder, bool json,
              bool quiet) {
  if (folder.empty())
    folder = std::filesystem::path(arguments.file).replace_extension(".results").string();
  if (!model.analysis.spin.empty()) return run_spin(model, arguments, folder, json, quiet);
  const ModalAnalysis analysis(std::move(model), &stop_wanted);
  const int code = code_of(analysis);
  if (analysis.converged())
    io::write_modes(analysis, folder, provenance_of(arguments));
  else
    say(analysis.message());
  for (const std::string& warning : analysis.report().warnings) say("warning: " + warning);
  if (!quiet) say_held(analysis);
  if (json)
    print(modes_json(analysis, code, folder) + "\n");
  else if (!quiet && analysis.converged())
    print(modes_table(analysis.report()));
  return code;
}

Action add_modes(CLI::App& command) {
  const auto options = std::make_shared<ModesOptions>();
  command.add_option("MODEL", options->model.file, "Model file (YAML or JSON)")->required();
  command
      .add_option("-o,--output", options->folder,
                  "Folder for the results; left out: the model's name with .results")
      ->type_name("DIR");
  add_set_option(command, options->model);
  command.add_option("-n,--count", options->count, "How many modes; left out: analysis.count")
      ->check(CLI::PositiveNumber);
  command
      .add_option("--about", options->about,
                  "The equilibrium found from the start, or the start itself")
      ->check(CLI::IsMember({"equilibrium", "start"}));
  command
      .add_option("--spin", options->spin.spin,
                  "Modes about a steady spin, seen from the turning frame: a speed, [a, b, ...] or "
                  "first:last:step, rad/s or with a unit; left out: analysis.spin")
      ->type_name("SPEEDS");
  command
      .add_option(
          "--axis", options->spin.axis,
          "Axis of the spin: x, y, z or [x, y, z]; left out: analysis.spin_axis, or that of "
          "the velocities")
      ->type_name("AXIS");
  command
      .add_option("--through", options->spin.through,
                  "A point [x, y, z] of the axis; left out: analysis.spin_through")
      ->type_name("POINT");
  command
      .add_option("--ground", options->spin.ground,
                  "Whether the ground stands, or turns with the model; left out: "
                  "analysis.spin_ground")
      ->check(CLI::IsMember({"stands", "turns"}));
  add_wall_limit(command, options->wall_limit, "with exit code 75");
  command.add_flag("--json", options->json, "Print frequencies as one JSON object");
  command.add_flag("--quiet", options->quiet, "Print errors only");
  return [options] { return modes(*options); };
}

}  // namespace polhode::cli
