// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include <unistd.h>
#include <Eigen/Core>

#include <polhode/core/format.hpp>
#include <polhode/core/version.hpp>
#include <polhode/io/results/recorder.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/kernels/dispatch.hpp>

#include "command.hpp"
#include "console.hpp"
#include "licences_text.hpp"

namespace polhode::cli {

namespace {

/// Result of one examination.
struct Finding {
  std::string what, result;
  bool passed = true;
};

constexpr double kAxial = 2.0, kAcross = 1.0;  // kg m²
constexpr double kSpin = 3.0, kWobble = 0.5;   // rad/s

/// A free symmetric top.
Model free_top() {
  Model model;
  model.title = "Free top";
  BodySpec top;
  top.name = "top";
  top.mass = 1.0;
  top.inertia = Vec3(kAcross, kAcross, kAxial).asDiagonal();
  top.angular_velocity = {kWobble, 0.0, kSpin};
  model.bodies.push_back(top);
  model.analysis.duration = 1.0;
  model.analysis.step = 1e-3;
  return model;
}

/// Precession of a free symmetric top: the material angular velocity rotates about the axis of
/// symmetry at the rate (I − I_a)/I W_z (Goldstein, Classical Mechanics, section 5.6), here with
/// I_a the moment about the axis.
Finding known_solution() {
  Simulation simulation(free_top());
  const RunSummary summary = simulation.run();
  const double angle = (kAxial - kAcross) / kAcross * kSpin * simulation.time();
  const Vec3 exact(kWobble * std::cos(angle), kWobble * std::sin(angle), kSpin);
  const double error = (simulation.body(0).W - exact).norm() / exact.norm();
  // Second order: about (rate · step)²/12 of the angle, below 1e-6; the limit has a margin.
  const bool passed = summary.end == RunEnd::finished && error < 1e-5 &&
                      summary.energy_drift < 1e-12 && summary.angular_momentum_drift < 1e-12;
  return {"known solution",
          format("free top, 1 s: error {:.1e}, energy drift {:.1e}, momentum drift {:.1e}", error,
                 summary.energy_drift, summary.angular_momentum_drift),
          passed};
}

Finding writing() {
  const char* base = std::getenv("TMPDIR");
  const std::string folder =
      format("{}/polhode-doctor-{}", base != nullptr ? base : P_tmpdir, ::getpid());
  Finding finding{"writing results", "results and pictures in the temporary folder"};
  try {
    Model model = free_top();
    model.analysis.duration = 0.01;
    model.output.paraview = true;
    Simulation simulation(std::move(model));
    io::Recorder recorder(simulation, folder, {});
    simulation.run([&](Simulation& s) { recorder.frame(s); });
    recorder.close();
  } catch (const std::exception& error) {
    finding = {"writing results", error.what(), false};
  }
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  return finding;
}

Finding instruction_sets() {
  std::string list;
  for (const std::string& isa : available_instruction_sets())
    list += (list.empty() ? "" : ", ") + isa;
  return {"instruction sets", list, !list.empty()};
}

template <class Examination>
Finding guarded(const char* what, Examination examine) {
  try {
    return examine();
  } catch (const std::exception& error) {
    return {what, error.what(), false};
  }
}

int doctor() {
  const std::vector<Finding> findings{
      {"version", std::string("polhode ") + version()},
      {"compiler", __VERSION__},
      {"libraries", format("Eigen {}.{}.{}, fmt {}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                           EIGEN_MINOR_VERSION, FMT_VERSION)},
      guarded("instruction sets", instruction_sets),
      guarded("writing results", writing),
      guarded("known solution", known_solution)};
  std::vector<std::vector<std::string>> rows;
  bool passed = true;
  for (const Finding& finding : findings) {
    rows.push_back({finding.passed ? "ok" : "FAILED", finding.what, finding.result});
    passed = passed && finding.passed;
  }
  print(table(rows, "", false));
  return passed ? kOk : kCheckFailed;
}

}  // namespace

Action add_doctor(CLI::App& command) {
  const auto licences = std::make_shared<bool>(false);
  command.add_flag("--licences,--licenses", *licences,
                   "Print what the program contains, with its licences");
  return [licences] {
    if (!*licences) return doctor();
    print(licences_text());
    return static_cast<int>(kOk);
  };
}

}  // namespace polhode::cli
