// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <sstream>

#include <nlohmann/json.hpp>

#include <polhode/core/format.hpp>
#include <polhode/core/version.hpp>
#include <polhode/gradient/gradient.hpp>
#include <polhode/io/read/gradient_parameter.hpp>
#include <polhode/io/read/read_outcome.hpp>

#include "command.hpp"
#include "console.hpp"

namespace polhode::cli {

namespace {

using GradientJson = nlohmann::ordered_json;

struct GradientOptions {
  ModelArguments model;
  std::vector<std::string> of, with;
  std::string isa;
  bool forward = false, no_bars = false, json = false;
};

/// Paths of a list with commas.
std::vector<std::string> split_paths(const std::vector<std::string>& lists) {
  std::vector<std::string> paths;
  for (const std::string& list : lists) {
    std::stringstream stream(list);
    for (std::string path; std::getline(stream, path, ',');)
      if (!path.empty()) paths.push_back(path);
  }
  return paths;
}

/// p/J dJ/dp, the relative change of the outcome by that of the parameter; none where one is zero.
std::optional<double> elasticity(const GradientParameter& p, const OutcomeGradient& g,
                                 std::size_t j) {
  if (p.value == 0.0 || g.value == 0.0) return std::nullopt;
  return p.value / g.value * g.by[j];
}

std::string gradient_table(const GradientRequest& request, const OutcomeGradient& g,
                           const std::vector<double>& bars) {
  std::vector<std::vector<std::string>> rows{
      {"parameter", "value", "unit", "gradient", "elasticity", "error bar"}};
  for (std::size_t j = 0; j < request.parameters.size(); ++j) {
    const GradientParameter& p = request.parameters[j];
    const std::optional<double> e = elasticity(p, g, j);
    rows.push_back({p.path, format("{:.6g}", p.value), p.unit, format("{:.10g}", g.by[j]),
                    e ? format("{:.4g}", *e) : "-",
                    bars.empty() ? "-" : format("{:.1e}", bars[j])});
  }
  return format("{} = {:.10g} {} at {:.6g} s\n", g.outcome, g.value, g.unit, g.time) + table(rows) +
         format("  growth {:.3g}, tangent against adjoint {:.0e}\n", g.growth, g.spot_check);
}

/// Lengths and orders of the steps of a run.
struct StepRange {
  double shortest = 0.0, longest = 0.0;  ///< [s]
  int highest_order = 2;
  explicit StepRange(const RunGradient& run) : highest_order(run.order) {
    for (const TakenStep& step : run.sequence) {
      shortest = shortest > 0.0 ? std::min(shortest, step.length) : step.length;
      longest = std::max(longest, step.length);
      highest_order = std::max(highest_order, 2 * step.members);
    }
  }
};

/// Description of the steps whose sequence a gradient keeps.
std::string steps_text(const RunGradient& run) {
  const StepRange range(run);
  const auto whole = static_cast<std::int64_t>(run.sequence.size());
  const std::string single = run.steps > whole ? format(" ({} single ones)", run.steps) : "";
  if (run.impacts + run.events > 0)
    return format("{} steps of at most {}, {} of which end at an {} that was located", whole,
                  seconds(run.step), run.impacts + run.events,
                  run.impacts > 0 ? "impact" : "event");
  if (run.step > 0.0)
    return format("{} steps of {}{}, kept as they are", whole, seconds(run.step), single);
  const std::string orders = range.highest_order > run.order
                                 ? format("orders {} to {}", run.order, range.highest_order)
                                 : format("order {}", run.order);
  return format(
      "{} automatic steps of {} to {}{}, {}: the sequence of their lengths and orders is "
      "frozen",
      whole, seconds(range.shortest), seconds(range.longest), single, orders);
}

GradientJson gradient_json(const GradientRequest& request, const RunGradient& run,
                           const std::vector<std::vector<double>>& bars,
                           const std::vector<std::string>& doubts) {
  GradientJson outcomes = GradientJson::array();
  for (std::size_t k = 0; k < run.outcomes.size(); ++k) {
    const OutcomeGradient& g = run.outcomes[k];
    GradientJson list = GradientJson::array();
    for (std::size_t j = 0; j < request.parameters.size(); ++j) {
      const GradientParameter& p = request.parameters[j];
      const std::optional<double> e = elasticity(p, g, j);
      list.push_back(
          {{"parameter", p.path},
           {"value", p.value},
           {"unit", p.unit},
           {"gradient", g.by[j]},
           {"elasticity", e ? GradientJson(*e) : GradientJson(nullptr)},
           {"error_bar", bars.empty() ? GradientJson(nullptr) : GradientJson(bars[k][j])}});
    }
    outcomes.push_back({{"outcome", g.outcome},
                        {"value", g.value},
                        {"unit", g.unit},
                        {"t", g.time},
                        {"growth", g.growth},
                        {"tangent_against_adjoint", g.spot_check},
                        {"by", list}});
  }
  const StepRange range(run);
  return {{"step", run.step > 0.0 ? GradientJson(run.step) : GradientJson(nullptr)},
          {"shortest_step", range.shortest},
          {"longest_step", range.longest},
          {"order", run.order},
          {"highest_order", range.highest_order},
          {"steps", run.steps},
          {"whole_steps", run.sequence.size()},
          {"impacts", run.impacts},
          {"events", run.events},
          {"run_time_s", run.run_seconds},
          {"gradient_time_s", run.gradient_seconds},
          {"warnings", doubts},
          {"outcomes", outcomes},
          {"version", version()}};
}

int show_gradient(GradientOptions& options) {
  const io::ModelText source = io::model_text_of(options.model.file, options.model.overrides);
  const Model model = load_model(options.model);
  GradientRequest request{.parameters = {}, .outcomes = {}, .forward = options.forward};
  for (const std::string& path : split_paths(options.with))
    request.parameters.push_back(io::gradient_parameter(source, path));
  for (const std::string& outcome : options.of)
    request.outcomes.push_back(io::read_outcome(outcome));
  const RunGradient run = differentiate(model, request);
  std::vector<std::vector<double>> bars;
  if (!options.no_bars) bars = error_bars(run, differentiate_halves(model, request, run));
  std::vector<std::string> doubts;
  for (std::size_t k = 0; k < run.outcomes.size(); ++k)
    for (std::string& doubt :
         gradient_doubts(run, k, request, bars.empty() ? std::vector<double>{} : bars[k]))
      doubts.push_back(std::move(doubt));
  if (options.json) {
    print(gradient_json(request, run, bars, doubts).dump(2) + "\n");
  } else {
    for (std::size_t k = 0; k < run.outcomes.size(); ++k)
      print((k > 0 ? "\n" : "") + gradient_table(request, run.outcomes[k],
                                                 bars.empty() ? std::vector<double>{} : bars[k]));
    print(format("  {}: run {}, gradient {}\n", steps_text(run), seconds(run.run_seconds),
                 seconds(run.gradient_seconds)));
  }
  for (const std::string& doubt : doubts) say("warning: " + doubt);
  return kOk;
}

}  // namespace

Action add_gradient(CLI::App& command) {
  const auto options = std::make_shared<GradientOptions>();
  command.add_option("MODEL", options->model.file, "Model file (YAML or JSON)")->required();
  command
      .add_option("--of", options->of,
                  "Outcome: CHANNEL@end, @mean, @integral, @max, @min or @TIME, such as "
                  "bodies.rod.position.x@end, or misfit:TABLE; may be repeated")
      ->required()
      ->take_all()
      ->expected(1)
      ->type_name("CHANNEL@WHEN");
  command
      .add_option("--with", options->with,
                  "Parameters by their paths, with commas between them: bodies.rod.mass,L")
      ->required()
      ->take_all()
      ->expected(1)
      ->type_name("PATH,PATH");
  add_set_option(command, options->model);
  add_isa_option(command, options->isa);
  command.add_flag("--forward", options->forward,
                   "Tangents of the parameters instead of the adjoint of each outcome");
  command.add_flag("--no-bars", options->no_bars,
                   "Leave out the run with half the step, and with it the error bars");
  command.add_flag("--json", options->json, "Print the gradients as one JSON object");
  return [options] {
    if (!options->isa.empty()) options->model.overrides.push_back("analysis.isa=" + options->isa);
    return show_gradient(*options);
  };
}

}  // namespace polhode::cli
