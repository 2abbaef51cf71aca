// SPDX-License-Identifier: Apache-2.0
// Step length of Newton's method where an iterate inverts elements: it is reduced before the step
// is rejected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/engines/sparse_engine.hpp>
#include <polhode/equations/iterate_snapshot.hpp>
#include <polhode/solids/loads/traction.hpp>
#include <polhode/solids/materials/registry.hpp>
#include <polhode/solids/mesh/generators.hpp>
#include <polhode/solids/mesh/selection.hpp>
#include <polhode/solids/solid_elements.hpp>
#include <polhode/statics/statics.hpp>
#include <polhode/stepping/start.hpp>
#include <polhode/stepping/stepper.hpp>
#include <statics/static_models.hpp>

namespace polhode::retreat_tests {
namespace {

using testing::HasSubstr;

/// A cube of one metre and E = 1 Pa on the ground, pressed on its top.
void press(System& system, const std::string& element, const solids::MaterialDescription& material,
           double pressure) {
  const solids::Mesh mesh =
      solids::make_mesh("cube", "block", {{"size", {1, 1, 1}}, {"cells", {2, 2, 2}}}, "hex8");
  for (const Vec3& X : mesh.nodes)
    system.add_node({.position = X, .body = X.z() < -0.5 + 1e-9 ? kGround : kFreeNode});
  solids::SolidElementsDescription d;
  d.name = "solids.cube";
  d.element = element;
  d.material = solids::make_material("materials.m", material);
  d.density = 1.0;
  d.connectivity = mesh.blocks.at(0).nodes;
  d.X = mesh.nodes;
  system.add_elements(solids::make_solid_elements(std::move(d)));
  std::vector<solids::LoadedFaces> top;
  for (const solids::FaceBlock& block : mesh.surfaces.at("zmax").blocks)
    top.push_back({block.type, block.nodes});
  system.add_elements(
      solids::make_traction("loads.press", top, mesh.nodes, test::constant({0.0, 0.0, -pressure})));
  system.finish();
}

const solids::MaterialDescription kFoam{
    .kind = "neo_hookean", .values = {{"youngs_modulus", 1.0}, {"poisson_ratio", 0.0}}};
const solids::MaterialDescription kLinear{
    .kind = "elastic", .values = {{"youngs_modulus", 1.0}, {"poisson_ratio", 0.0}}};

/// One step so long that inertia is negligible: at ρ∞ = 0 it ends near equilibrium.
StepReport one_long_step(const System& system, State& state, double least) {
  const GeneralizedAlpha ga = GeneralizedAlpha::from_spectral_radius(0.0);
  StepControl control;
  control.step = 50.0;
  control.min_step = least;
  control.newton.max_iterations = 30;
  start(system, state, ga, 50.0);
  Stepper stepper(system,
                  std::make_unique<SparseEngine>(system, "block_lu", MomentumRate::momentum), ga,
                  control, lane_kernels("automatic"));
  stepper.begin(state);
  return stepper.advance(state, 50.0);
}

// The first iterate, by the stiffness at rest, has the top 1.5 m below where it was.
TEST(Retreat, RecoversAStepWhoseFirstIterateInvertsElements) {
  for (const char* element : {"hex8_standard", "hex8_eas9"}) {
    System system;
    press(system, element, kFoam, 1.5);
    State state = system.initial_state();
    const StepReport report = one_long_step(system, state, 50.0);
    EXPECT_TRUE(report.accepted) << element << ": " << report.message;
    EXPECT_EQ(report.rejected, 0) << element;
    double least = 1.0;
    for (std::size_t k = 2; k < state.node_x.size(); k += 3)
      if (state.node_x[k] > -0.5 + 1e-9) least = std::min(least, state.node_x[k] + 0.5);
    EXPECT_GT(least, 0.05) << element;
    EXPECT_LT(least, 0.5) << element;
  }
}

TEST(Retreat, RecoversALoadStep) {
  for (const char* element : {"hex8_standard", "hex8_eas9"}) {
    System system;
    press(system, element, kFoam, 1.5);
    State state = system.initial_state();
    const StaticReport report = solve_statics(system, state, {.load_steps = 1});
    EXPECT_TRUE(report.converged) << element << ": " << report.message;
    EXPECT_EQ(report.steps.size(), 1u) << element;
  }
}

// A pressure above the maximum that the material can carry: there is no solution.
TEST(Retreat, NamesTheWorstElementIfThereIsNoSolution) {
  System system;
  press(system, "hex8_standard", kLinear, 1.5);
  State state = system.initial_state();
  const StepReport report = one_long_step(system, state, 50.0);
  EXPECT_FALSE(report.accepted);
  EXPECT_THAT(report.message, HasSubstr("of 'solids.cube'"));
}

TEST(IterateSnapshot, RestoresOnlyWhatIterationsChange) {
  System system;
  press(system, "hex8_eas9", kFoam, 0.1);
  const State state = system.initial_state();
  Trial trial;
  start_trial(system, state, trial);
  trial.node_x = state.node_x;
  trial.node_u.assign(state.node_x.size(), 0.0);
  trial.node_v = trial.node_u;
  trial.element_scratch.assign(system.nodes().scratch_size(), 0.0);
  std::vector<double> inside = element_unknowns(system, trial);
  ASSERT_FALSE(inside.empty());
  EXPECT_LT(inside.size(), trial.element_scratch.size() / 10);
  IterateSnapshot kept;
  kept.keep(system, trial);
  for (std::size_t k = 0; k < inside.size(); ++k) inside[k] = static_cast<double>(k);
  set_element_unknowns(system, inside, trial);
  EXPECT_EQ(element_unknowns(system, trial), inside);
  trial.node_x[0] += 1.0;
  kept.restore(system, trial);
  EXPECT_EQ(trial.node_x, state.node_x);
  EXPECT_EQ(element_unknowns(system, trial), std::vector<double>(inside.size(), 0.0));
  EXPECT_EQ(part_way({0.0, 2.0}, {1.0, 4.0}, 0.5), (std::vector<double>{0.5, 3.0}));
}

}  // namespace
}  // namespace polhode::retreat_tests
