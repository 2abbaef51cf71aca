// SPDX-License-Identifier: Apache-2.0
//
// What does precision cost? Each case is run at orders 2, 4, 6 and 8 with ever shorter steps, and
// with automatic steps at ever smaller tolerances: error at the end against CPU time of the steps.
//
// Prints one JSON object a line: first the reference of a case, then its runs.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <polhode/simulation/method.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/published_cases.hpp>

#include "measure.hpp"
#include "pendulum.hpp"
#include "sized_models.hpp"

namespace polhode::benchmark {
namespace {

/// A motion and what of it is compared.
struct Case {
  std::string name;
  Model model;
  test::Observation observe;
  double duration;               ///< [s]
  double coarsest;               ///< Length of the parts of the coarsest step of any order [s].
  double reference_step;         ///< Of order 8, where there is no closed form [s].
  std::optional<Vec> exact;      ///< At the end, from a closed form.
  std::optional<Vec> published;  ///< At the end, from reference data of others.
};

Case published_case(const std::string& name, const test::PublishedCase& p, double duration,
                    double coarsest, double reference_step) {
  const test::Reference data = test::Reference::read(p.data);
  std::optional<Vec> at_end;
  for (std::size_t i = 0; i < data.t.size(); ++i)
    if (std::abs(data.t[i] - duration) < 1e-9 * duration) at_end = data.values[i];
  return {name, p.model, p.observe, duration, coarsest, reference_step, {}, at_end};
}

/// A chain of hinges that swings for a second; compared is the far end of its first body, as in
/// the figures of other programs.
Case chain_case(int N) {
  const auto observe = [](const Simulation& s) -> Vec { return test::place_of(s, 0, kRodEnd); };
  return {"chain_" + std::to_string(N), chain(N, "revolute"), observe, 1.0, 0.02, 0.005, {}, {}};
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  // Angle from straight down: released level, on the left.
  cases.push_back(published_case("pendulum", test::planar_pendulum_case(), 10.0, 0.1, 0.0));
  const double angle = pendulum_angle(-9.81, -0.5 * std::numbers::pi, 0.0, 10.0);
  cases.back().exact = Vec{{std::sin(angle), -std::cos(angle)}};
  for (const int N : {1, 40}) {
    cases.push_back(published_case("n_four_bar_" + std::to_string(N), test::n_four_bar_case(N),
                                   10.0, 0.08, 0.0));
    // All verticals stay parallel: a pendulum, its angle from upright.
    const double w2 = 9.81 * (0.5 * (3.0 * N + 1.0)) / ((4.0 * N + 1.0) / 3.0);
    const double phi = pendulum_angle(w2, 0.0, 1.0, 10.0);
    cases.back().exact = Vec{{std::sin(phi), std::cos(phi)}};
  }
  cases.push_back(published_case("andrews_squeezer", test::andrews_case(), 0.03, 2e-4, 5e-5));
  cases.push_back(published_case("bricard", test::bricard_case(), 10.0, 0.05, 0.02));
  cases.push_back(published_case("heavy_top", test::heavy_top_case(), 2.0, 0.008, 0.002));
  for (const int N : {10, 80, 100, 1000}) cases.push_back(chain_case(N));
  return cases;
}

/// A run to the end, with the CPU time of its steps.
struct Outcome {
  Vec end;
  double cpu = 0.0;  ///< [s]
  Ledger ledger;
};

/// @param analysis  Order and step, or tolerance.
/// @param least     Repeats short runs until so much time has passed; their median counts [s].
Outcome run(const Case& c, const AnalysisSpec& analysis, double least) {
  Model model = c.model;
  model.analysis = analysis;
  model.analysis.duration = c.duration;
  const Simulation start(model);
  Outcome outcome;
  std::vector<double> times;
  State state;
  for (double spent = 0.0; times.size() < 5 && (times.empty() || spent < least);) {
    Method method = choose_method(start.system(), model);
    Stepper stepper(start.system(), std::move(method.engine), method.ga, method.control,
                    *method.kernels);
    state = start.state();
    stepper.begin(state);
    const double begin = thread_cpu();
    while (state.t < c.duration * (1.0 - 1e-9)) {
      const StepReport report = stepper.advance(state, c.duration);
      if (!report.accepted) throw std::runtime_error(report.message);
    }
    times.push_back(thread_cpu() - begin);
    spent += times.back();
  }
  outcome.cpu = median(times);
  outcome.ledger = state.ledger;
  outcome.end = c.observe(Simulation(model, state));
  return outcome;
}

AnalysisSpec fixed_steps(int order, double step) {
  AnalysisSpec a;
  a.order = order;
  a.step = step;
  return a;
}

double difference(const Vec& a, const Vec& b) { return (a - b.head(a.size())).norm(); }

/// What a case's runs are compared with, and how far it may itself be off.
struct Truth {
  Vec value;
  double uncertainty = 0.0;
};

Truth find_truth(const Case& c) {
  Truth truth;
  nlohmann::ordered_json j{{"benchmark", "reference"}, {"case", c.name}, {"duration", c.duration}};
  if (c.exact) {
    truth = {*c.exact, 1e-12};
    j["source"] = "closed form";
  } else {
    const double fine = c.reference_step;
    truth.value = run(c, fixed_steps(8, fine), 0.0).end;
    truth.uncertainty = difference(truth.value, run(c, fixed_steps(8, 1.4142 * fine), 0.0).end);
    j["source"] = "order 8, steps of " + std::to_string(1e3 * fine) + " ms";
  }
  j["uncertainty"] = truth.uncertainty;
  if (c.published) j["difference_from_published"] = difference(truth.value, *c.published);
  std::cout << j << std::endl;
  return truth;
}

/// So many runs of a case may fail for steps too coarse.
constexpr int kMaxFailures = 20;
/// Short runs are repeated until they have taken so long together [s].
constexpr double kEnoughSeconds = 0.2;
/// Errors of interest [m or rad]: coarser ones are not reported, finer ones end a row of runs.
constexpr double kCoarsestError = 0.1, kFinestError = 3e-10;

class Row {
 public:
  Row(const Case& c, const Truth& truth, double most_seconds)
      : case_(c), truth_(truth), most_seconds_(most_seconds) {}

  /// Runs once and prints. @returns false if finer runs would show nothing new.
  bool add(const std::string& order, const AnalysisSpec& a) {
    nlohmann::ordered_json j{
        {"benchmark", "work_precision"}, {"case", case_.name}, {"order", order}};
    if (a.step) j["step"] = *a.step;
    if (a.tolerance) j["tolerance"] = *a.tolerance;
    Outcome o;
    try {
      o = run(case_, a, kEnoughSeconds);
    } catch (const std::exception& e) {  // too coarse
      std::fprintf(stderr, "%s, order %s: %s\n", case_.name.c_str(), order.c_str(), e.what());
      return ++failures_ < kMaxFailures;
    }
    const double error = difference(o.end, truth_.value);
    j["error"] = error;
    j["cpu_s"] = o.cpu;
    j["steps"] = o.ledger.steps;
    j["rejected_steps"] = o.ledger.rejected;
    j["newton_iterations"] = o.ledger.iterations;
    if (o.ledger.energy_scale > 0.0)
      j["energy_drift"] = o.ledger.energy_drift / o.ledger.energy_scale;
    if (error < kCoarsestError && error > 2.0 * truth_.uncertainty) std::cout << j << std::endl;
    return error > std::max(kFinestError, 2.0 * truth_.uncertainty) && 2.0 * o.cpu < most_seconds_;
  }

 private:
  const Case& case_;
  const Truth& truth_;
  double most_seconds_;
  int failures_ = 0;
};

/// Runs of a case at every order and with automatic steps.
/// @param refinement  Ratio of a step to the next finer one.
void measure(const Case& c, double most_seconds, double refinement) {
  const Truth truth = find_truth(c);
  Row row(c, truth, most_seconds);
  // Stages of a step of each order: a coarsest step is as long as all its parts.
  for (const auto& [order, stages] :
       std::vector<std::pair<int, int>>{{2, 1}, {4, 5}, {6, 22}, {8, 34}}) {
    const double coarsest = std::ceil(c.duration / (c.coarsest * stages));
    double steps = coarsest;
    for (int k = 1; row.add(std::to_string(order), fixed_steps(order, c.duration / steps)); ++k)
      steps = std::max(steps + 1.0, std::round(coarsest * std::pow(refinement, k)));
  }
  for (int digits = 3; digits <= 10; ++digits) {
    AnalysisSpec a;
    a.tolerance = std::pow(10.0, -digits);
    if (!row.add("automatic", a)) break;
  }
}

}  // namespace
}  // namespace polhode::benchmark

int main(int argc, char** argv) {
  using namespace polhode::benchmark;
  CLI::App app{"Error against CPU time at every order."};
  std::vector<std::string> names;
  double most_seconds = 1.0, refinement = 2.0;
  app.add_option("--case", names, "Only these: pendulum, n_four_bar_40, ...");
  app.add_option("--most-seconds", most_seconds, "Longest run that is tried");
  app.add_option("--refinement", refinement, "Ratio of a step to the next finer one")
      ->check(CLI::Range(1.05, 10.0));
  CLI11_PARSE(app, argc, argv);
  try {
    for (const Case& c : all_cases())
      if (names.empty() || std::find(names.begin(), names.end(), c.name) != names.end())
        measure(c, most_seconds, refinement);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  return 0;
}
