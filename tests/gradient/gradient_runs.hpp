// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

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
  double rho_inf = 1.0;
  double rest = 0.0;  ///< Length of a last, shorter step.

  [[nodiscard]] io::ModelText source() const {
    return {text,
            "model.yaml",
            "model.yaml",
            {"analysis.step=" + std::to_string(step), "analysis.order=" + std::to_string(order),
             "analysis.duration=" + std::to_string(step * steps + rest),
             "analysis.rho_inf=" + std::to_string(rho_inf)}};
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

/// Central difference of order six of a function.
template <class Function>
double sixth_order_difference(const Function& f, double x, double d) {
  const auto pair = [&](double k) { return f(x + k * d) - f(x - k * d); };
  return (45.0 * pair(1.0) - 9.0 * pair(2.0) + pair(3.0)) / (60.0 * d);
}

/// Magnitude of a parameter, 1 for one that is zero.
inline double size_of(const GradientParameter& parameter) {
  return parameter.value != 0.0 ? std::abs(parameter.value) : 1.0;
}

/// Central difference of order six between runs. @param part  Of the parameter's value.
inline double difference_of_runs(const GradientParameter& parameter, const std::string& channel,
                                 double part) {
  return sixth_order_difference([&](double x) { return value_at_end(parameter.at(x), channel); },
                                parameter.value, part * size_of(parameter));
}

/// Largest relative difference of a gradient from sixth-order differences; parameters whose effect
/// is below a thousandth of the largest are compared with that.
inline double largest_difference(const OutcomeGradient& g,
                                 const std::vector<GradientParameter>& parameters,
                                 const std::vector<double>& of_runs) {
  double largest = 0.0, most = 0.0;
  for (std::size_t j = 0; j < of_runs.size(); ++j)
    largest = std::max(largest, std::abs(of_runs[j]) * size_of(parameters[j]));
  for (std::size_t j = 0; j < of_runs.size(); ++j) {
    const double scale = std::max(std::abs(of_runs[j]), 1e-3 * largest / size_of(parameters[j]));
    most = std::max(most, std::abs(g.by[j] - of_runs[j]) / scale);
  }
  return most;
}

/// That of a gradient and of runs.
/// @param check  Largest difference of tangent and adjoint that is allowed [-].
inline double difference_from_runs(const GradientCase& c, double part = 3e-3,
                                   double check = 1e-11) {
  const GradientRequest request = c.request();
  const OutcomeGradient g = differentiate(c.model(), request).outcomes.front();
  EXPECT_LT(g.spot_check, check);
  std::vector<double> of_runs;
  for (const GradientParameter& parameter : request.parameters)
    of_runs.push_back(difference_of_runs(parameter, request.outcomes.front().channel, part));
  return largest_difference(g, request.parameters, of_runs);
}

}  // namespace polhode::test
