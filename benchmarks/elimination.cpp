// SPDX-License-Identifier: Apache-2.0
//
// What does a body cost in a Newton iteration? Whole steps are timed - predictor, assembly,
// elimination, update, checks, ledger - and divided by bodies and iterations. Beside the
// elimination along the tree, with each instruction set of this machine, runs our own block LU, in
// turns, so that a machine that changes its speed changes both.
//
// Prints one JSON object a line.

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <polhode/compile/build_system.hpp>
#include <polhode/engines/sparse_engine.hpp>
#include <polhode/engines/tree_engine.hpp>
#include <polhode/stepping/start.hpp>
#include <polhode/stepping/stepper.hpp>
#include <support/models.hpp>

#include "measure.hpp"
#include "sized_models.hpp"

namespace polhode::benchmark {
namespace {

/// A kind of mechanism and the sizes it is asked for.
struct Family {
  std::string name;
  Model (*model)(int size);
  double step;             ///< [s]
  std::vector<int> sizes;  ///< Bodies; cells for n_four_bar.
};

/// A motor at the first hinge keeps the speed of the start.
Model driven_four_bar(int N) {
  Model model = test::n_four_bar(N);
  LoadSpec motor;
  motor.name = "motor";
  motor.type = "rotary_motor";
  motor.joint = "ground0";
  motor.drive = "speed";
  motor.value = std::make_shared<test::Constant>(-1.0);
  model.loads.push_back(motor);
  return model;
}

const std::vector<Family>& families() {
  static const std::vector<Family> all{
      {"chain_revolute", [](int N) { return chain(N, "revolute"); }, 5e-3, {10, 100, 1000}},
      {"chain_spherical", [](int N) { return chain(N, "spherical"); }, 5e-3, {10, 100, 1000}},
      {"binary_tree", binary_tree, 5e-3, {10, 100, 1000}},
      {"n_four_bar", [](int N) { return test::n_four_bar(N); }, 1e-2, {1, 10, 40, 100}},
      {"n_four_bar_driven", driven_four_bar, 1e-2, {1, 10, 40, 100}}};
  return all;
}

/// Above this many bodies only the first instruction set runs, and no block LU.
constexpr int kMaxBodiesCompared = 1000;
/// Bodies times steps of one repetition, and bounds of the number of steps.
constexpr int kBodySteps = 200'000, kFewestSteps = 3, kMaxSteps = 200;

/// One way to solve the steps of a system, run from the same start again and again.
class Contender {
 public:
  /// @param isa  Empty: the block LU.
  Contender(const System& system, const State& start, double dt, const std::string& isa)
      : start_(&start), name_(isa.empty() ? "block_lu" : "tree"), isa_(isa) {
    const double before = heap_bytes();
    std::unique_ptr<NewtonEngine> engine;
    if (isa.empty()) {
      engine = std::make_unique<SparseEngine>(system, "block_lu");
    } else {
      auto tree = std::make_unique<TreeEngine>(system, isa);
      engine_bytes_ = static_cast<double>(tree->memory());
      engine = std::move(tree);
    }
    StepControl control;
    control.step = dt;
    control.horizon = 1e9;  // the runs are counted in steps
    stepper_ = std::make_unique<Stepper>(system, std::move(engine),
                                         GeneralizedAlpha::from_spectral_radius(1.0), control,
                                         lane_kernels(isa.empty() ? "automatic" : isa));
    repeat(1);  // what is allocated on first use
    stepper_bytes_ = heap_bytes() - before;
    samples_.clear();
  }

  /// Runs so many steps from the start and notes the CPU time of an iteration.
  void repeat(int steps) {
    state_ = *start_;
    stepper_->begin(state_);
    const double begin = thread_cpu();
    for (int i = 0; i < steps; ++i) {
      const StepReport report = stepper_->advance(state_, 1e9);
      if (!report.accepted) throw std::runtime_error(report.message);
    }
    const double seconds = thread_cpu() - begin;
    samples_.push_back(seconds / static_cast<double>(state_.ledger.iterations));
  }

  [[nodiscard]] double microseconds_an_iteration() const { return 1e6 * median(samples_); }
  /// Bytes of solver, stepper and the state it works on.
  [[nodiscard]] double bytes() const { return stepper_bytes_; }
  [[nodiscard]] nlohmann::ordered_json figures(int bodies) const {
    const Ledger& l = state_.ledger;
    nlohmann::ordered_json j{
        {"solver", name_},
        {"instruction_set", isa_},
        {"us_per_body_iteration", microseconds_an_iteration() / bodies},
        {"iterations_per_step", static_cast<double>(l.iterations) / static_cast<double>(l.steps)},
        {"rejected_steps", l.rejected},
        {"energy_drift", l.energy_drift / l.energy_scale},
        {"repetitions", samples_.size()}};
    if (engine_bytes_ > 0.0) j["engine_bytes_per_body"] = engine_bytes_ / bodies;
    return j;
  }

 private:
  const State* start_;
  std::string name_, isa_;
  std::unique_ptr<Stepper> stepper_;
  State state_;
  double engine_bytes_ = 0.0, stepper_bytes_ = 0.0;
  std::vector<double> samples_;
};

/// Times all contenders on one model in turns and prints a line for each.
/// @param alone  Leave out the block LU, for a profiler.
void measure(const Family& family, int size, const std::vector<std::string>& sets, int repetitions,
             bool alone) {
  const Model model = family.model(size);
  const int bodies = static_cast<int>(model.bodies.size());
  const double before = heap_bytes();
  const System system = build_system(model);
  const double system_bytes = heap_bytes() - before;
  State start = system.initial_state();  // consistent as it is, see sized_models.hpp
  initialize_histories(system, start);

  std::vector<Contender> contenders;
  contenders.reserve(sets.size() + 1);
  const bool compared = bodies <= kMaxBodiesCompared && !alone;
  for (const std::string& isa : sets)
    if (compared || alone || contenders.empty())
      contenders.emplace_back(system, start, family.step, isa);
  if (compared) contenders.emplace_back(system, start, family.step, "");

  const int steps = std::clamp(kBodySteps / bodies, kFewestSteps, kMaxSteps);
  for (int i = 0; i < repetitions; ++i)
    for (Contender& c : contenders) c.repeat(steps);

  for (const Contender& c : contenders) {
    nlohmann::ordered_json j{
        {"benchmark", "elimination"}, {"model", family.name}, {"size", size},
        {"bodies", bodies},           {"steps", steps},       {"dt", family.step}};
    j.update(c.figures(bodies));
    if (before > 0.0) j["bytes_per_body"] = (system_bytes + c.bytes()) / bodies;
    if (compared)
      j["block_lu_ratio"] =
          contenders.back().microseconds_an_iteration() / c.microseconds_an_iteration();
    std::cout << j << std::endl;
  }
}

}  // namespace
}  // namespace polhode::benchmark

int main(int argc, char** argv) {
  using namespace polhode;
  using namespace polhode::benchmark;
  CLI::App app{"Time of a body in a Newton iteration, and memory of a body."};
  std::vector<std::string> names, sets = available_instruction_sets();
  std::vector<int> sizes;
  int repetitions = 5;
  bool alone = false;
  app.add_option("--model", names, "Only these: chain_revolute, chain_spherical, ...");
  app.add_option("--size", sizes, "Instead of the standard sizes, to 1000000");
  app.add_option("--isa", sets, "Only these instruction sets");
  app.add_option("--repetitions", repetitions, "Of which the median counts")
      ->check(CLI::PositiveNumber);
  app.add_flag("--alone", alone, "Leave out the block LU, for a profiler");
  CLI11_PARSE(app, argc, argv);
  try {
    for (const Family& family : families()) {
      if (!names.empty() && std::find(names.begin(), names.end(), family.name) == names.end())
        continue;
      for (const int size : sizes.empty() ? family.sizes : sizes)
        measure(family, size, sets, repetitions, alone);
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  return 0;
}
