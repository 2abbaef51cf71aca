// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numbers>

#include <polhode/statics/modes.hpp>
#include <polhode/statics/statics.hpp>
#include <statics/static_models.hpp>
#include <support/bar_elements.hpp>

namespace polhode::modes_tests {
namespace {

using test::add_body, test::add_joint, test::add_load;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// A chain of n equal masses and n + 1 equal springs between two walls, on rails along x:
/// ω_j = 2 √(k/m) sin(jπ / (2(n + 1))).
TEST(Modes, AChainOfMassesAndSpringsHasItsClosedFormFrequencies) {
  const int n = 5;
  const double k = 70.0, mass = 2.0;
  System system;
  std::vector<int> bodies;
  for (int i = 1; i <= n; ++i)
    bodies.push_back(add_body(system, "m" + std::to_string(i), mass, {double(i), 0, 0}));
  // The axis of a prismatic joint is z of its frame.
  const Mat3 R = (Mat3() << 0, 0, 1, 1, 0, 0, 0, 1, 0).finished();
  for (int i = 0; i < n; ++i)
    add_joint(system, "prismatic", "rail" + std::to_string(i), kGround, bodies[i],
              {double(i + 1), 0, 0}, Vec3::Zero(), R);
  for (int i = 0; i <= n; ++i)
    add_load(system, "spring_damper",
             {.name = "s" + std::to_string(i),
              .bodies = {i == 0 ? kGround : bodies[i - 1], i == n ? kGround : bodies[i]},
              .Z_a = i == 0 ? Vec3::Zero() : Vec3::Zero(),
              .Z_b = i == n ? Vec3(n + 1.0, 0, 0) : Vec3::Zero(),
              .values = {{"stiffness", k}, {"free_length", 1.0}}});
  system.finish();
  const ModesReport report = find_modes(system, system.initial_state(), {.count = 10});
  ASSERT_EQ(report.modes.size(), 5u);
  EXPECT_EQ(report.freedoms, 5);
  EXPECT_TRUE(report.complete);
  for (int j = 1; j <= n; ++j) {
    const double omega = 2.0 * std::sqrt(k / mass) * std::sin(j * std::numbers::pi / (2.0 * n + 2));
    EXPECT_NEAR(report.modes[j - 1].frequency, omega / kTwoPi, 1e-12 * omega);
    EXPECT_LT(report.modes[j - 1].residual, 1e-10);
  }
  double effective = 0.0;  // of all modes together: everything moves along x
  for (const Mode& mode : report.modes) effective += mode.effective_mass.x();
  EXPECT_NEAR(effective, 1.0, 1e-12);
  EXPECT_NEAR(report.total_mass, n * mass, 1e-12);
}

/// A compound pendulum about its equilibrium, where the hinge's multipliers make the stiffness:
/// ω² = m g a / (J + m a²). @tests{modes-saddle}
TEST(Modes, APendulumSwingsAtItsSmallOscillationFrequency) {
  const double m = 1.3, g = 9.81, a = 0.6;
  System system;
  system.set_gravity({0, -g, 0});
  const int rod = add_body(system, "rod", m, {0, -a, 0});  // J = m, see static_models.hpp
  add_joint(system, "revolute", "hinge", kGround, rod, Vec3::Zero(), {0, a, 0});
  system.finish();
  State state = system.initial_state();
  ASSERT_TRUE(solve_statics(system, state).converged);
  const ModesReport report = find_modes(system, state);
  ASSERT_EQ(report.modes.size(), 1u);
  const double omega = std::sqrt(m * g * a / (m + m * a * a));
  EXPECT_NEAR(report.modes[0].frequency, omega / kTwoPi, 1e-12);
  EXPECT_LT(report.unbalanced, 1e-14);
}

TEST(Modes, AnInvertedPendulumHasANegativeSquare) {
  System system;
  system.set_gravity({0, -9.81, 0});
  const int rod = add_body(system, "rod", 1.0, {0, 1, 0});
  add_joint(system, "revolute", "hinge", kGround, rod, Vec3::Zero(), {0, -1, 0});
  system.finish();
  State state = system.initial_state();
  ASSERT_TRUE(solve_statics(system, state).converged);
  const ModesReport report = find_modes(system, state);
  ASSERT_EQ(report.modes.size(), 1u);
  EXPECT_NEAR(report.modes[0].omega_squared, -9.81 / 2.0, 1e-11);
}

/// The same lattice of bars by the dense solver and by Lanczos iterations: free, with a body bonded
/// to its end and a pendulum on a hinge below that.
System hanging_lattice(int cells) {
  System system;
  auto [X, bars] = test::lattice(cells, 2, 2, 0.5, Vec3::Zero());
  bars->stiffness = 1e4;
  bars->density = 0.3;
  const Vec3 end(0.5 * cells, 0.5, 0.5);
  const int plate = add_body(system, "plate", 3.0, end);
  const int bob = add_body(system, "bob", 1.0, end - Vec3(0, 1, 0));
  for (const Vec3& x : X) {
    NodeData node{.position = x};
    if (x.x() > end.x() - 1e-9) {
      node.body = plate;
      node.Z = x - end;
    }
    system.add_node(node);
  }
  system.add_elements(std::move(bars));
  add_joint(system, "spherical", "hinge", plate, bob, Vec3::Zero(), {0, 1, 0});
  system.finish();
  return system;
}

TEST(Modes, LanczosAndDenseSolutionsAgreeAndCountTheirModes) {
  // 561 unknowns are sparse, but not if more than a third of them are wanted.
  const System system = hanging_lattice(20);
  const ModesReport sparse = find_modes(system, system.initial_state(), {.count = 16});
  const ModesReport dense = find_modes(system, system.initial_state(), {.count = 300});
  EXPECT_EQ(sparse.freedoms, -1);
  EXPECT_GT(dense.freedoms, 0);
  EXPECT_TRUE(sparse.complete) << (sparse.warnings.empty() ? "" : sparse.warnings[0]);
  EXPECT_TRUE(dense.complete);
  ASSERT_EQ(sparse.modes.size(), 16u);
  for (int i = 0; i < 16; ++i) {
    // A free system: six rigid motions and three rotations of the bob have no stiffness.
    EXPECT_EQ(sparse.modes[i].rigid, i < 9) << sparse.modes[i].frequency;
    EXPECT_EQ(dense.modes[i].rigid, i < 9) << dense.modes[i].frequency;
    if (i < 9) continue;
    EXPECT_NEAR(sparse.modes[i].frequency, dense.modes[i].frequency,
                1e-8 * dense.modes[i].frequency);
    EXPECT_LT(sparse.modes[i].residual, 1e-6);
  }
}

TEST(Modes, AreNoLongerSoughtWhenTheyAreStopped) {
  const System system = hanging_lattice(20);
  const std::atomic<bool> stop = true;
  EXPECT_THROW(
      {
        const ModesReport report =
            find_modes(system, system.initial_state(), {.count = 16, .stop = &stop});
        static_cast<void>(report);
      },
      ModesStopped);
}

TEST(Modes, ShapesOfNodesFollowTheBodiesTheyAreBondedTo) {
  const System system = hanging_lattice(3);
  const ModesReport report = find_modes(system, system.initial_state(), {.count = 12});
  const Mode& mode = report.modes.back();
  const std::vector<double> d = node_shape(system, system.initial_state(), mode.shape);
  for (int i = 0; i < system.nodes().count(); ++i) {
    const NodeData& node = system.nodes()[i];
    if (node.body < 0) continue;
    const Vec6 x = mode.shape.segment<6>(6 * node.body);
    const Vec3 expected = x.head<3>() + x.tail<3>().cross(node.Z);
    EXPECT_LT((Eigen::Map<const Vec3>(d.data() + 3 * i) - expected).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace polhode::modes_tests
