// SPDX-License-Identifier: Apache-2.0
// Gradients of automatic and extrapolated steps, and differences of runs with the same steps.
#pragma once

#include <optional>

#include <gradient/gradient_models.hpp>
#include <polhode/gradient/run_tape.hpp>

namespace polhode::test {

/// A model text with settings of the analysis, and what is differentiated by what.
struct FrozenCase {
  std::string text;
  double duration = 1.0;
  std::vector<std::string> parameters;
  std::string outcome;
  std::optional<double> step{};       ///< Absent: automatic.
  std::optional<double> tolerance{};  ///< Of automatic steps.
  std::optional<int> order{};
  std::string method = "automatic";
  std::string solver = "automatic";
  double rho_inf = 1.0;

  [[nodiscard]] Model set(Model model) const {
    AnalysisSpec& a = model.analysis;
    a.duration = duration;
    a.step = step;
    a.tolerance = tolerance;
    a.order = order;
    a.method = method;
    a.solver = solver;
    a.rho_inf = rho_inf;
    return model;
  }
  [[nodiscard]] Model model() const { return set(io::read_model_text(text, "model.yaml")); }
  [[nodiscard]] GradientRequest request() const {
    GradientRequest r;
    const io::ModelText source{text, "model.yaml", "model.yaml", {}};
    for (const std::string& path : parameters) {
      GradientParameter p = io::gradient_parameter(source, path);
      p.at = [own = *this, of = p.at](double value) { return own.set(of(value)); };
      r.parameters.push_back(std::move(p));
    }
    r.outcomes.push_back(parse_outcome(outcome));
    return r;
  }
};

/// State at the end of a run with given steps, without any derivative.
inline State frozen_end(const Simulation& simulation, const StepSequence& sequence) {
  TapeRecorder steps(simulation);
  State state = simulation.state();
  for (const TakenStep& step : sequence) steps.take(state, step);
  return state;
}

inline double frozen_value(const Model& model, const StepSequence& sequence,
                           const std::string& channel) {
  const Simulation simulation(model);
  SystemMap map;
  const System system = build_system(model, &map);
  return OutcomeReader(model, map, channel)
      .value(simulation.system(), frozen_end(simulation, sequence));
}

/// Relative difference of a gradient from central differences of order six between runs with the
/// steps of its run; parameters whose effect is below a thousandth of the largest are compared with
/// that.
/// @param part  Of each parameter's value. @param check  Largest difference of tangent and adjoint.
inline double difference_from_frozen_runs(const FrozenCase& c, double part = 3e-3,
                                          double check = 1e-11, RunGradient* of = nullptr) {
  const GradientRequest request = c.request();
  const RunGradient run = differentiate(c.model(), request);
  if (of) *of = run;
  const OutcomeGradient& g = run.outcomes.front();
  EXPECT_LT(g.spot_check, check);
  const std::string& channel = request.outcomes.front().channel;
  std::vector<double> of_runs;
  for (const GradientParameter& p : request.parameters)
    of_runs.push_back(sixth_order_difference(
        [&](double x) { return frozen_value(p.at(x), run.sequence, channel); }, p.value,
        part * size_of(p)));
  return largest_difference(g, request.parameters, of_runs);
}

}  // namespace polhode::test
