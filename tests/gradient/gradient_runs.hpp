// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <polhode/gradient/gradient.hpp>
#include <polhode/io/read/gradient_parameter.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::test {

/// A model text, the number of its steps, their length, and what is differentiated by what.
struct GradientCase {
  std::string text;
  double step = 0.01;
  int steps = 50;
  std::vector<std::string> parameters;
  std::vector<std::string> outcomes;
  int order = 2;

  [[nodiscard]] io::ModelText source() const {
    return {text,
            "model.yaml",
            "model.yaml",
            {"analysis.step=" + std::to_string(step), "analysis.order=" + std::to_string(order),
             "analysis.duration=" + std::to_string(step * steps)}};
  }
  [[nodiscard]] Model model() const {
    const io::ModelText s = source();
    return io::read_model_text(s.text, s.file, s.overrides);
  }
  [[nodiscard]] GradientRequest request() const {
    GradientRequest r;
    for (const std::string& path : parameters)
      r.parameters.push_back(io::gradient_parameter(source(), path));
    for (const std::string& outcome : outcomes) r.outcomes.push_back(parse_outcome(outcome));
    return r;
  }
};

/// Value of an outcome at the end of a run of the program, without any derivative.
inline double value_at_end(const Model& model, const std::string& channel) {
  Simulation simulation(model);
  while (simulation.time() < model.analysis.duration * (1.0 - 1e-9))
    if (!simulation.step(model.analysis.duration).accepted) return std::nan("");
  SystemMap map;
  const System system = build_system(model, &map);
  return OutcomeReader(model, map, channel).value(simulation.system(), simulation.state());
}

/// Central difference of order six between runs. @param part  Of the parameter's value.
inline double difference_of_runs(const GradientParameter& parameter, const std::string& channel,
                                 double part) {
  const double d = part * (parameter.value != 0.0 ? std::abs(parameter.value) : 1.0);
  const auto pair = [&](double k) {
    return value_at_end(parameter.at(parameter.value + k * d), channel) -
           value_at_end(parameter.at(parameter.value - k * d), channel);
  };
  return (45.0 * pair(1.0) - 9.0 * pair(2.0) + pair(3.0)) / (60.0 * d);
}

}  // namespace polhode::test
