// SPDX-License-Identifier: Apache-2.0
// Elimination along the tree at an instant against the block LU: the same equations, on trees and
// loops, with redundant rows, drives, dampers, beams and contacts.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <polhode/compile/build_system.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/kernels/dispatch.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <polhode/stepping/instant.hpp>
#include <polhode/stepping/instant_tree.hpp>
#include <support/models.hpp>
#include <support/paths.hpp>

namespace polhode::instant_tree_tests {
namespace {

/// Accelerations and velocities differ by rounding, which long chains multiply.
constexpr double kRounding = 2e-11;
/// So do multipliers, but for the redundant part: its rounding is divided by ε = 1e-8 in both.
constexpr double kRoundingOfLeast = 2e-7;

double largest(const std::vector<double>& list) {
  double most = 0.0;
  for (const double x : list) most = std::max(most, std::abs(x));
  return most;
}

/// Compares both at a state, with each instruction set.
void compare(const System& system, const State& state, const std::string& what,
             std::span<const Vec6> more = {}) {
  ASSERT_TRUE(InstantTree::takes(system)) << what;
  InstantSolver reference(system);
  State projected = state;
  const VelocityReport of_lu = reference.project_velocities(projected);
  const InstantSolution lu = reference.accelerations(projected, more);
  ASSERT_TRUE(lu.solved) << what;
  for (const std::string& isa : available_instruction_sets()) {
    SCOPED_TRACE(what + ", " + isa);
    InstantTree tree(system, lane_kernels(isa));
    State own = state;
    VelocityReport velocities;
    InstantSolution solution;
    ASSERT_TRUE(tree.solve(own, more, velocities, solution));
    const double speed = std::max(of_lu.scale, 1e-12);
    EXPECT_NEAR(velocities.residual_before, of_lu.residual_before, kRounding * speed);
    EXPECT_NEAR(velocities.scale, of_lu.scale, 1e-9 * speed);
    EXPECT_EQ(velocities.solves == 0, of_lu.solves == 0);
    const double length = system.length_scale();
    double size = std::max(system.gravity().norm(), speed * speed / length), moved = 0.0,
           accelerated = 0.0;
    for (int b = 0; b < system.body_count(); ++b) {
      const BodyMotion one = system.motion(own, b), other = system.motion(projected, b);
      EXPECT_EQ(one.r, other.r);
      EXPECT_EQ(one.q.coeffs(), other.q.coeffs());
      moved = std::max({moved, (one.v - other.v).norm(), length * (one.W - other.W).norm()});
      size = std::max({size, lu.r_ddot[b].norm(), length * lu.alpha[b].norm()});
      accelerated = std::max({accelerated, (solution.r_ddot[b] - lu.r_ddot[b]).norm(),
                              length * (solution.alpha[b] - lu.alpha[b]).norm()});
    }
    EXPECT_LE(moved, kRounding * speed);
    EXPECT_LE(accelerated, kRounding * size);
    EXPECT_EQ(solution.consistent, lu.consistent);
    const double force = std::max(largest(lu.lambda), system.mean_mass() * size * length);
    double changed = 0.0;
    for (int k = 0; k < system.rows(); ++k)
      changed = std::max(changed, std::abs(solution.lambda[k] - lu.lambda[k]));
    EXPECT_LE(changed, kRoundingOfLeast * force);
  }
}

/// Compares them at the start and after steps of a run.
void compare_run(Model model, const std::string& what, int steps = 12) {
  Simulation simulation(std::move(model));
  compare(simulation.system(), simulation.state(), what + " at the start");
  for (int i = 0; i < steps; ++i)
    if (!simulation.step(1e9).accepted) break;
  compare(simulation.system(), simulation.state(), what);
}

void stepped(Model& model, double step) {
  model.analysis.step = step;
  model.analysis.duration = 1e9;
}

}  // namespace

TEST(InstantTree, HasTheResultsOfTheBlockLuForPublishedMechanisms) {
  const std::vector<std::pair<std::string, Model>> cases{
      {"planar pendulum", test::planar_pendulum()},
      {"one square", test::n_four_bar(1)},
      {"squares", test::n_four_bar(6)},
      {"many squares", test::n_four_bar(40)},
      {"Andrews' squeezer", test::andrews_squeezer()},
      {"Bricard", test::bricard()},
      {"Bennett", test::bennett()},
      {"governor", test::flyball_governor()},
      {"soft governor", test::soft_governor()},
      {"heavy top", test::heavy_top()},
      {"free top", test::free_asymmetric_top()},
      {"slider-crank", test::spatial_slider_crank()},
      {"door", test::door()},
      {"sprung chain", test::sprung_chain(2.0)}};
  for (auto [name, model] : cases) {
    stepped(model, name.starts_with("Andrews") ? 1e-5 : 1e-3);
    compare_run(std::move(model), name);
  }
}

TEST(InstantTree, HasTheResultsOfTheBlockLuInASingularPosition) {
  Model model = test::n_four_bar(4, 0.5 * std::numbers::pi);  // all bars in one line
  stepped(model, 1e-3);
  compare_run(std::move(model), "squares in a line", 0);
}

TEST(InstantTree, TakesFurtherWrenches) {
  Model model = test::bennett();
  stepped(model, 1e-3);
  const Simulation simulation(std::move(model));
  std::vector<Vec6> more(static_cast<std::size_t>(simulation.system().body_count()));
  for (std::size_t b = 0; b < more.size(); ++b)
    more[b] << 3.0, -2.0, 1.0 + static_cast<double>(b), 0.4, -0.5, 0.6;
  compare(simulation.system(), simulation.state(), "Bennett's mechanism, pushed", more);
}

/// One solver serves all instants of a run: nothing of one is left in the next.
TEST(InstantTree, HasTheSameBitsWhateverCameBefore) {
  Model model = test::n_four_bar(3, 0.2);
  stepped(model, 1e-3);
  Simulation simulation(std::move(model));
  InstantTree used(simulation.system(), lane_kernels("automatic"));
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(simulation.step(1e9).accepted);
    InstantTree fresh(simulation.system(), lane_kernels("automatic"));
    State one = simulation.state(), other = simulation.state();
    VelocityReport velocities;
    InstantSolution of_used, of_fresh;
    ASSERT_TRUE(used.solve(one, {}, velocities, of_used));
    ASSERT_TRUE(fresh.solve(other, {}, velocities, of_fresh));
    EXPECT_EQ(of_used.lambda, of_fresh.lambda);
    EXPECT_EQ(of_used.r_ddot, of_fresh.r_ddot);
    EXPECT_EQ(of_used.alpha, of_fresh.alpha);
  }
}

/// Deformable solids and coupled masses are for the block LU.
TEST(InstantTree, DoesNotTakeSolids) {
  const Model model = io::read_model(test::source_dir() + "/examples/rubber_bushing/model.yaml");
  EXPECT_FALSE(InstantTree::takes(build_system(model)));
  EXPECT_TRUE(InstantTree::takes(build_system(test::n_four_bar(2))));
}

TEST(InstantTree, HasTheResultsOfTheBlockLuForEachTypeOfJoint) {
  for (const std::string type :
       {"fixed", "revolute", "prismatic", "cylindrical", "spherical", "universal", "planar",
        "point_on_line", "point_in_plane", "parallel_axes", "constant_velocity", "distance"})
    for (const bool grounded : {true, false}) {
      Model model = test::chain(type, 4, grounded);
      stepped(model, 1e-3);
      compare_run(std::move(model), type + (grounded ? " on the ground" : " floating"));
    }
}

TEST(InstantTree, HasTheResultsOfTheBlockLuForTheExamples) {
  int compared = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_dir() + "/examples")) {
    const std::filesystem::path file = entry.path() / "model.yaml";
    if (!std::filesystem::exists(file)) continue;
    Model model = io::read_model(file);
    if (model.analysis.type != "dynamics") continue;
    Simulation simulation(std::move(model));
    if (!InstantTree::takes(simulation.system())) continue;
    for (int i = 0; i < 25; ++i)
      if (!simulation.step(1e9).accepted) break;
    compare(simulation.system(), simulation.state(), entry.path().filename().string());
    ++compared;
  }
  EXPECT_GE(compared, 25);
}

}  // namespace polhode::instant_tree_tests
