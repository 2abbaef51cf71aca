// SPDX-License-Identifier: Apache-2.0
//
// What does a step of a deformable solid cost? A rigid hub on a hinge carries a block of hexahedra
// (EAS, neo-Hookean) and falls from rest, steps of 1 ms. Whole steps are timed, the factorisations
// among them; residual alone and tangent are timed apart.
//
// Prints one JSON object a line.

#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <sys/resource.h>

#include <polhode/fe/materials/registry.hpp>
#include <polhode/fe/mesh/generators.hpp>
#include <polhode/fe/solid_elements.hpp>
#include <polhode/joints/joint.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/solve/coupled_engine.hpp>
#include <polhode/solve/start.hpp>
#include <polhode/solve/stepper.hpp>

#include "measure.hpp"

namespace polhode::benchmark {
namespace {

constexpr double kStep = 1e-3;  ///< [s]

/// Cells along, across and up of a block whose cells are cubes, 12.5 mm wide.
struct Block {
  int x, y, z, steps;
};

void build(System& system, const Block& block) {
  constexpr double kCell = 0.0125, kHalfHub = 0.05;
  const Vec3 size = kCell * Vec3(block.x, block.y, block.z);
  const Mesh mesh = make_mesh("block", "block",
                              {{"size", {size[0], size[1], size[2]}},
                               {"cells", {1.0 * block.x, 1.0 * block.y, 1.0 * block.z}}},
                              "hex8");
  system.set_gravity(Vec3(0, 0, -9.81));
  const int hub = system.add_body(
      {.name = "hub", .mass = 2.0, .inertia = Vec3(3e-3, 4e-3, 5.5e-3).asDiagonal()}, {});
  std::vector<Vec3> X;
  for (const Vec3& own : mesh.nodes) {
    X.push_back(own + Vec3(kHalfHub + 0.5 * size[0], 0, 0));
    NodeData node{.position = X.back()};
    if (node.position[0] < kHalfHub + 1e-9) {
      node.body = hub;
      node.Z = node.position;
    }
    system.add_node(node);
  }
  MaterialDescription material;
  material.kind = "neo_hookean";
  material.values = {{"youngs_modulus", 1e7}, {"poisson_ratio", 0.3}};
  SolidElementsDescription d;
  d.name = "block";
  d.element = "hex8_eas9";
  d.material = make_material("rubber", material);
  d.density = 1100.0;
  d.connectivity = mesh.blocks[0].nodes;
  d.X = X;
  system.add_elements(make_solid_elements(std::move(d)));
  const Vec3 at(-kHalfHub, 0, 0);
  Mat3 axes;  // z along the world's y
  axes << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  system.group<Joint>().items.emplace_back(
      "hinge", "revolute", Participants{kGround, hub},
      joint_kind("revolute").recipe({.Z_a = at, .Z_b = at, .R_a = axes, .R_b = axes}, {}));
  system.finish();
}

/// Most memory that the program has held so far [MiB].
double peak_mebibytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Seconds of one pass over the elements, the least of several.
double pass(NodeSystem& nodes, const State& state, Trial& trial, bool tangent) {
  const std::vector<Mat3> here(nodes.system().nodes().pieces().size(), Mat3::Identity());
  double least = 1e30;
  for (int i = 0; i < 5; ++i) {
    const double from = thread_cpu();
    nodes.assemble(state, trial, tangent, here);
    least = std::min(least, thread_cpu() - from);
  }
  return least;
}

nlohmann::json measure(const Block& block) {
  System system;
  build(system, block);
  const GeneralizedAlpha ga = GeneralizedAlpha::from_spectral_radius(1.0);
  State state = system.initial_state();
  start(system, state, ga, kStep);
  auto made = std::make_unique<CoupledEngine>(system, "block_lu", MomentumRate::momentum);
  const CoupledEngine* engine = made.get();
  StepControl control;
  control.step = kStep;
  control.newton.tolerance = 1e-6;
  control.newton.max_iterations = 30;
  Stepper stepper(system, std::move(made), ga, control, lane_kernels("automatic"));
  stepper.begin(state);
  std::vector<double> seconds;
  for (int i = 0; i < block.steps; ++i) {
    const double from = thread_cpu();
    const StepReport report = stepper.advance(state, state.t + kStep);
    if (!report.accepted) throw std::runtime_error(report.message);
    seconds.push_back(thread_cpu() - from);
  }
  double sum = 0.0;
  for (const double s : seconds) sum += s;
  const double first = seconds.front();
  std::sort(seconds.begin(), seconds.end());

  NodeSystem nodes(system);
  Trial trial;
  trial.context.ga = ga;
  trial.context.dt = kStep;
  start_trial(system, state, trial);
  predict_nodes(system, state, trial, {});
  const int elements = block.x * block.y * block.z;
  const double tangent = pass(nodes, state, trial, true), plain = pass(nodes, state, trial, false);
  return {{"benchmark", "solid"},
          {"cells", {block.x, block.y, block.z}},
          {"unknowns", system.nodes().unknowns() + 6 + system.rows()},
          {"steps", block.steps},
          {"mean_ms", 1e3 * sum / block.steps},
          {"median_ms", 1e3 * seconds[seconds.size() / 2]},
          {"first_ms", 1e3 * first},
          {"iterations_per_step", static_cast<double>(state.ledger.iterations) / block.steps},
          {"factorisations", engine->factorisations()},
          {"factor_entries", engine->factor_entries()},
          {"energy_drift", state.ledger.energy_drift / state.ledger.energy_scale},
          {"residual_us_per_element", 1e6 * plain / elements},
          {"tangent_us_per_element", 1e6 * tangent / elements},
          {"peak_MiB", peak_mebibytes()}};
}

}  // namespace
}  // namespace polhode::benchmark

int main(int argc, char** argv) {
  using polhode::benchmark::Block;
  CLI::App app("Cost of a step of a deformable block on a hinged hub");
  bool full = false;
  app.add_flag("--full", full, "with a cube of 32 x 32 x 32 nodes, which takes a minute or two");
  CLI11_PARSE(app, argc, argv);
  std::vector<Block> blocks{{20, 4, 4, 100}, {40, 8, 8, 100}, {80, 10, 10, 50}};
  if (full) blocks.push_back({31, 31, 31, 20});
  for (const Block& block : blocks)
    std::cout << polhode::benchmark::measure(block).dump() << std::endl;
}
