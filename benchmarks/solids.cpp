// SPDX-License-Identifier: Apache-2.0
//
// What does a step of a deformable solid cost? A rigid hub on a hinge carries a block of hexahedra
// (EAS, neo-Hookean) and falls from rest, steps of 1 ms. Whole steps are timed, the factorisations
// among them; residual alone and tangent are timed apart. Two blocks on three hubs with joints show
// what a factorisation that is kept and turned is worth with several bodies.
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

#include <polhode/engines/sparse_engine.hpp>
#include <polhode/joints/joint.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/solids/materials/registry.hpp>
#include <polhode/solids/mesh/generators.hpp>
#include <polhode/solids/solid_elements.hpp>
#include <polhode/stepping/start.hpp>
#include <polhode/stepping/stepper.hpp>

#include "measure.hpp"

namespace polhode::benchmark {
namespace {

constexpr double kStep = 1e-3;  ///< [s]

/// Cells along, across and up of a block whose cells are cubes, 12.5 mm wide.
struct Block {
  int x, y, z, steps;
  int count = 1;  ///< Of such blocks: 1, or 2 with a hub between them and one at the end.
};

constexpr double kCell = 0.0125, kHalfHub = 0.05;  ///< [m]

int add_hub(System& system, const char* name, const Vec3& at) {
  BodyMotion start;
  start.r = at;
  return system.add_body(
      {.name = name, .mass = 2.0, .inertia = Vec3(3e-3, 4e-3, 5.5e-3).asDiagonal()}, start);
}

/// A block along x from where a hub ends; its far end is free or bonded to a hub there.
void add_block(System& system, const Block& block, const std::string& name, int hub,
               const Vec3& hub_at, int far_hub) {
  const Vec3 size = kCell * Vec3(block.x, block.y, block.z);
  const solids::Mesh mesh =
      solids::make_mesh(name, "block",
                        {{"size", {size[0], size[1], size[2]}},
                         {"cells", {1.0 * block.x, 1.0 * block.y, 1.0 * block.z}}},
                        "hex8");
  const double first = hub_at[0] + kHalfHub, last = first + size[0];
  std::vector<Vec3> X;
  int first_node = -1;
  for (const Vec3& own : mesh.nodes) {
    NodeData node{.position = own + Vec3(0.5 * (first + last), hub_at[1], hub_at[2])};
    if (node.position[0] < first + 1e-9) {
      node.body = hub;
      node.Z = node.position - hub_at;
    } else if (far_hub != kFreeNode && node.position[0] > last - 1e-9) {
      node.body = far_hub;
      node.Z = node.position - Vec3(last + kHalfHub, hub_at[1], hub_at[2]);
    }
    const int added = system.add_node(node);
    if (first_node < 0) first_node = added;
  }
  for (int i = 0; i < first_node + static_cast<int>(mesh.nodes.size()); ++i)
    X.push_back(system.nodes()[i].position);
  solids::MaterialDescription material;
  material.kind = "neo_hookean";
  material.values = {{"youngs_modulus", 1e7}, {"poisson_ratio", 0.3}};
  solids::SolidElementsDescription d;
  d.name = name;
  d.element = "hex8_eas9";
  d.material = solids::make_material("rubber", material);
  d.density = 1100.0;
  d.connectivity = mesh.blocks[0].nodes;
  for (int& node : d.connectivity) node += first_node;
  d.X = X;
  system.add_elements(solids::make_solid_elements(std::move(d)));
}

void add_joint(System& system, const char* name, const char* type, int body, const Vec3& in_world,
               const Vec3& in_body) {
  Mat3 axes;  // z along the world's y
  axes << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  system.group<Joint>().add(
      name, type, Participants{kGround, body},
      joint_kind(type).recipe({.Z_a = in_world, .Z_b = in_body, .R_a = axes, .R_b = axes}, {}));
}

/// One block on a hinged hub, its far end free; or two blocks on three hubs, the first hinged, the
/// last held in the plane that is normal to the hinge.
void build(System& system, const Block& block) {
  system.set_gravity(Vec3(0, 0, -9.81));
  const Vec3 end(-kHalfHub, 0, 0), pitch(2 * kHalfHub + kCell * block.x, 0, 0);
  const int hub = add_hub(system, "hub", Vec3::Zero());
  if (block.count == 1) {
    add_block(system, block, "block", hub, Vec3::Zero(), kFreeNode);
  } else {
    const int middle = add_hub(system, "middle", pitch), last = add_hub(system, "last", 2 * pitch);
    add_block(system, block, "first", hub, Vec3::Zero(), middle);
    add_block(system, block, "second", middle, pitch, last);
    add_joint(system, "slide", "point_in_plane", last, 2 * pitch, Vec3::Zero());
  }
  add_joint(system, "hinge", "revolute", hub, end, end);
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
  auto made = std::make_unique<SparseEngine>(system, "block_lu", MomentumRate::momentum);
  const SparseEngine* engine = made.get();
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
  const int elements = block.count * block.x * block.y * block.z;
  const double tangent = pass(nodes, state, trial, true), plain = pass(nodes, state, trial, false);
  return {{"benchmark", "solid"},
          {"cells", {block.x, block.y, block.z}},
          {"solids", block.count},
          {"unknowns", system.nodes().unknowns() + 6 * system.body_count() + system.rows()},
          {"steps", block.steps},
          {"mean_ms", 1e3 * sum / block.steps},
          {"median_ms", 1e3 * seconds[seconds.size() / 2]},
          {"first_ms", 1e3 * first},
          {"iterations_per_step", static_cast<double>(state.ledger.iterations) / block.steps},
          {"factorisations", engine->nodes()->factorisations()},
          {"factor_entries", engine->nodes()->factor_entries()},
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
  std::vector<Block> blocks{{20, 4, 4, 100}, {40, 8, 8, 100}, {80, 10, 10, 50}, {40, 8, 8, 50, 2}};
  if (full) blocks.push_back({31, 31, 31, 20});
  for (const Block& block : blocks)
    std::cout << polhode::benchmark::measure(block).dump() << std::endl;
}
