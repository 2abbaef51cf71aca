// SPDX-License-Identifier: Apache-2.0
//
// Cost of a frame, in Newton iterations. After every step of a mechanism a frame is computed
// and written: velocities on the rows, accelerations and reactions at the instant, reports of
// bodies and joints, the results file. Beside the elimination along the tree runs the block LU at
// the same instants.
//
// Prints one JSON object a line.

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <polhode/io/results/write_results.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <polhode/stepping/instant.hpp>
#include <support/models.hpp>

#include "measure.hpp"
#include "sized_models.hpp"

namespace polhode::benchmark {
namespace {

struct Case {
  std::string name;
  Model model;
  double step;  ///< [s]
};

std::vector<Case> cases() {
  return {{"n_four_bar_40", test::n_four_bar(40), 1e-2},
          {"chain_revolute_100", chain(100, "revolute"), 5e-3},
          {"binary_tree_100", binary_tree(100), 5e-3}};
}

/// Times parts of a frame.
class Watch {
 public:
  template <class Work>
  void time(Work&& work) {
    const double begin = thread_cpu();
    work();
    seconds_.push_back(thread_cpu() - begin);
  }
  [[nodiscard]] double microseconds() const { return 1e6 * median(seconds_); }
  /// With what is done for several frames at once.
  [[nodiscard]] double mean_microseconds() const {
    double sum = 0.0;
    for (const double s : seconds_) sum += s;
    return 1e6 * sum / static_cast<double>(seconds_.size());
  }

 private:
  std::vector<double> seconds_;
};

void measure(Case c, int frames, const std::string& folder) {
  c.model.analysis.step = c.step;
  c.model.analysis.duration = 1e9;
  Simulation simulation(std::move(c.model));
  const std::string path = folder + "/benchmark_frames.h5";
  io::ResultsFile file(path, io::results_layout(simulation), {});
  file.append(io::results_frame(simulation));  // the first one lays out the file
  InstantSolver solver(simulation.system());
  Watch step, instant, reports, writing, block_lu;
  for (int i = 0; i < frames; ++i) {
    step.time([&] {
      const StepReport report = simulation.step(1e9);
      if (!report.accepted) throw std::runtime_error(report.message);
    });
    instant.time([&] { (void)simulation.body(0); });
    io::ResultsFrame frame;
    reports.time([&] { frame = io::results_frame(simulation); });
    writing.time([&] { file.append(frame); });
    State state = simulation.state();
    block_lu.time([&] {
      solver.project_velocities(state);
      if (!solver.accelerations(state).solved) throw std::runtime_error("no accelerations");
    });
  }
  file.close();
  std::filesystem::remove(path);
  const double iteration = step.microseconds() *
                           static_cast<double>(simulation.state().ledger.steps) /
                           static_cast<double>(simulation.state().ledger.iterations);
  const double whole =
      instant.microseconds() + reports.microseconds() + writing.mean_microseconds();
  std::cout << nlohmann::ordered_json{{"benchmark", "frames"},
                                      {"model", c.name},
                                      {"frames", frames},
                                      {"instruction_set", simulation.summary().instruction_set},
                                      {"us_iteration", iteration},
                                      {"us_instant", instant.microseconds()},
                                      {"us_instant_block_lu", block_lu.microseconds()},
                                      {"us_reports", reports.microseconds()},
                                      {"us_writing", writing.mean_microseconds()},
                                      {"iterations_a_frame", whole / iteration}}
            << std::endl;
}

}  // namespace
}  // namespace polhode::benchmark

int main(int argc, char** argv) {
  using namespace polhode::benchmark;
  CLI::App app{"Time of a frame and its parts."};
  int frames = 300;
  std::string folder = std::filesystem::temp_directory_path().string();
  app.add_option("--frames", frames, "Of each model")->check(CLI::PositiveNumber);
  app.add_option("--folder", folder, "For the results file, which is removed");
  CLI11_PARSE(app, argc, argv);
  try {
    for (Case& c : cases()) measure(std::move(c), frames, folder);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  return 0;
}
