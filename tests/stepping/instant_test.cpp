// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <polhode/math/quaternion.hpp>
#include <polhode/stepping/instant.hpp>

#include "engines/mechanisms.hpp"

namespace polhode::instant_tests {
namespace {

using namespace test;

bool same_motion(const System& system, const State& x, const State& y) {
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyMotion m = system.motion(x, b), n = system.motion(y, b);
    if (m.r != n.r || m.q.coeffs() != n.q.coeffs() || m.v != n.v || m.W != n.W) return false;
  }
  return true;
}

void displace(const System& system, State& state, double size) {
  for (int b = 0; b < system.body_count(); ++b) {
    BodyMotion m = system.motion(state, b);
    m.r += size * Vec3(std::sin(b + 1.0), std::cos(3.0 * b), std::sin(5.0 * b + 2.0));
    m.q = quaternion_from_cayley(size * Vec3(std::cos(b), std::sin(2.0 * b), 0.5)) * m.q;
    state.set_motion(system.slot(b), m);
  }
}

TEST(AssemblePositions, LeavesAnAssembledStateAlone) {
  for (const Mechanism& m :
       {double_pendulum(), bricard_system(), four_bars(2, 0.0), door_system()}) {
    const System system = m.system();
    State state = system.initial_state();
    const PositionReport report = assemble_positions(system, state);
    EXPECT_TRUE(report.assembled);
    EXPECT_EQ(report.iterations, 0);
    EXPECT_EQ(report.largest_move, 0.0);
    EXPECT_TRUE(same_motion(system, state, system.initial_state()));
  }
}

TEST(AssemblePositions, BringsADisplacedMechanismTogether) {
  for (const double size : {0.01, 0.1})
    for (const Mechanism& m :
         {double_pendulum(), bricard_system(), four_bars(3, 1.2), door_system()}) {
      const System system = m.system();
      State state = system.initial_state();
      displace(system, state, size);
      const PositionReport report = assemble_positions(system, state);
      EXPECT_TRUE(report.assembled);
      EXPECT_GT(report.residual_before, 0.1 * size);
      EXPECT_LT(report.residual, 1e-13);
      EXPECT_GT(report.largest_move, 0.1 * size);
      EXPECT_LT(report.largest_move, 10.0 * size);
      EXPECT_GE(report.moved_body, 0);
      EXPECT_LE(report.iterations, 20);
      EXPECT_TRUE(report.unsatisfied.empty());
    }
}

TEST(AssemblePositions, NamesJointsThatContradictOneAnother) {
  // A rod one metre long between ground points 1.2 m apart, and an independent pendulum beside it.
  Mechanism m;
  const int rod = m.body("rod", {0.5, 0, 0});
  m.joint("left", "spherical", kGround, rod, {0, 0, 0});
  m.joint("right", "spherical", kGround, rod, {1.0, 0, 0});
  m.model.joints.back().Z_a = {1.2, 0.0, 0.0};
  const int other = m.body("other", {0.5, 3, 0});
  m.joint("separate", "spherical", kGround, other, {0, 3, 0});
  const System system = m.system();
  State state = system.initial_state();
  const PositionReport report = assemble_positions(system, state);
  EXPECT_FALSE(report.assembled);
  EXPECT_LT(report.iterations, 60);
  EXPECT_NEAR(report.residual, 0.1, 1e-6);  // shared evenly
  ASSERT_EQ(report.unsatisfied.size(), 2u);
  EXPECT_EQ(system.name(system.interactions()[report.unsatisfied[0]]), "left");
  EXPECT_EQ(system.name(system.interactions()[report.unsatisfied[1]]), "right");
}

TEST(ProjectVelocities, LeavesAdmissibleVelocitiesAlone) {
  const System system = four_bars(3, 1.1).system();
  State state = system.initial_state();
  const VelocityReport report = project_velocities(system, state);
  EXPECT_EQ(report.solves, 0);
  EXPECT_TRUE(same_motion(system, state, system.initial_state()));
}

TEST(ProjectVelocities, KeepsTheMomentumAboutAHinge) {
  // Impulses at the hinge have no moment about it: (J + m d²) φ̇ = J ω + m d v.
  Mechanism m;
  const int bar = m.body("bar", {0.5, 0, 0}, 2.0, {0.01, 0.2, 0.2});
  m.joint("hinge", "revolute", kGround, bar, {0, 0, 0});
  m.velocity(bar, {0.4, 1.0, 0.3}, {0.2, 0.1, 3.0});
  const System system = m.system();
  State state = system.initial_state();
  const VelocityReport report = project_velocities(system, state);
  const double rate = (0.2 * 3.0 + 2.0 * 0.5 * 1.0) / (0.2 + 2.0 * 0.25);
  const BodyMotion now = system.motion(state, bar);
  EXPECT_LT((now.v - Vec3(0, 0.5 * rate, 0)).norm(), 1e-14);
  EXPECT_LT((now.omega() - Vec3(0, 0, rate)).norm(), 1e-14);
  EXPECT_GT(report.residual_before, 0.1);
  EXPECT_LT(report.residual, 1e-14);
}

/// A hinge that hardly moves beside a fast body: the violation of its rows is small relative to the
/// speeds of the model, not to those of the hinge.
TEST(ProjectVelocities, ReportsTheLargestSpeedOfAnyBody) {
  Mechanism m;
  const int door = m.body("door", {0, 0, 0}, 2.0, {0.1, 0.2, 0.2});
  const int fast = m.body("fast", {5, 0, 0}, 1.0, {0.1, 0.1, 0.1});
  m.joint("hinge", "revolute", kGround, door, {0, 0, 0});
  m.velocity(door, {1e-9, 0, 0}, {0, 0, 0});
  m.velocity(fast, {0, 3.0, 0}, {0, 0, 1.0});
  const System system = m.system();
  State state = system.initial_state();
  const VelocityReport report = project_velocities(system, state);
  EXPECT_NEAR(report.residual_before, 1e-9, 1e-15);
  EXPECT_NEAR(report.scale, 3.0, 1e-12);
}

TEST(ProjectVelocities, WorksWithRedundantRowsAndInSingularPositions) {
  for (const Mechanism& plain : {bricard_system(), four_bars(3, 0.0), door_system()}) {
    Mechanism m = plain;
    for (int b = 0; b < static_cast<int>(m.model.bodies.size()); ++b)
      m.velocity(b, {0.3 * b, 1.0, -0.2}, {0.1, 0.2, 1.0 + 0.1 * b});
    const System system = m.system();
    State state = system.initial_state();
    EXPECT_LT(project_velocities(system, state).residual, 1e-13);
    EXPECT_EQ(project_velocities(system, state).solves,
              0);  // a projection: a second one changes nothing
  }
}

// @tests{eq:rbm-linear-momentum-balance} @tests{eq:rbm-angular-momentum-balance}
TEST(InstantSolution, MatchesThePhysicalPendulum) {
  const double mass = 2.0, d = 0.5, J = 0.2, angle = 0.7, rate = 1.5;
  Mechanism m;
  m.model.gravity = {0.0, -9.81, 0.0};
  const Vec3 out(std::cos(angle), std::sin(angle), 0.0), across(-out.y(), out.x(), 0.0);
  const int bar =
      m.body("bar", d * out, mass, {0.01, J, J}, Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ())));
  m.joint("hinge", "revolute", kGround, bar, {0, 0, 0});
  m.velocity(bar, d * rate * across, {0, 0, rate});
  const System system = m.system();
  const InstantSolution s = instant_solution(system, system.initial_state());
  const double phi_ddot = -mass * 9.81 * d * std::cos(angle) / (J + mass * d * d);
  EXPECT_NEAR(s.alpha[0].z(), phi_ddot, 1e-13);
  const Vec3 r_ddot = d * phi_ddot * across - d * rate * rate * out;
  EXPECT_LT((s.r_ddot[0] - r_ddot).norm(), 1e-13);
  // The first three multipliers are the force of the hinge on the bar.
  const Vec3 hinge = mass * (r_ddot - system.gravity());
  EXPECT_LT((Vec3(s.lambda[0], s.lambda[1], s.lambda[2]) - hinge).norm(), 1e-12);
}

TEST(InstantSolution, DistributesTheLoadOfADoorEvenly) {
  const System system = door_system().system();
  const InstantSolution s = instant_solution(system, system.initial_state());
  EXPECT_TRUE(s.solved && s.consistent);
  // Weight m g in equal parts: the smallest multipliers. Rounding 1e-16 over ε = 1e-8.
  const double weight = 20.0 * 9.81;
  EXPECT_NEAR(s.lambda[2], 0.5 * weight, 1e-6 * weight);
  EXPECT_NEAR(s.lambda[7], 0.5 * weight, 1e-6 * weight);
  EXPECT_LT(s.r_ddot[0].norm(), 1e-12 * 9.81);
}

TEST(InstantSolution, WorksInASingularPosition) {
  const System system = four_bars(2, 0.0).system();
  const InstantSolution s = instant_solution(system, system.initial_state());
  EXPECT_TRUE(s.solved);
  EXPECT_TRUE(s.consistent);  // these velocities belong to a branch
  EXPECT_LT(s.residual, 1e-12);
  for (double l : s.lambda) EXPECT_LT(std::abs(l), 1e3);
}

TEST(InstantSolution, ReportsVelocitiesThatFitNoMotionOfASingularPosition) {
  // A flat triangle of two bars whose far end is held: the middle may move across to first order,
  // but not to second order, because the bars would stretch: γ ≠ 0 where G has lost a row.
  Mechanism m;
  const Vec3 rod(1e-3, 1.0 / 12.0, 1.0 / 12.0);
  const int first = m.body("first", {0.5, 0, 0}, 1.0, rod);
  const int second = m.body("second", {1.5, 0, 0}, 1.0, rod);
  m.joint("A", "revolute", kGround, first, {0, 0, 0});
  m.joint("B", "revolute", first, second, {1, 0, 0});
  m.joint("C", "revolute", second, kGround, {2, 0, 0});
  m.velocity(first, {0, 0.5, 0}, {0, 0, 1});
  m.velocity(second, {0, 0.5, 0}, {0, 0, -1});
  const System system = m.system();
  const InstantSolution s = instant_solution(system, system.initial_state());
  EXPECT_TRUE(s.solved);
  EXPECT_FALSE(s.consistent);
  for (double l : s.lambda) EXPECT_LT(std::abs(l), 1e3);  // multipliers stay bounded
}

TEST(InstantSolution, IsTheSameWithEachLinearSolver) {
  const System system = double_pendulum().system();
  State state = system.initial_state();
  project_velocities(system, state);
  const InstantSolution s = InstantSolver(system, "block_lu").accelerations(state);
  for (const char* name : {"klu", "sparse_lu"}) {
    const InstantSolution t = InstantSolver(system, name).accelerations(state);
    for (std::size_t b = 0; b < 2; ++b) {
      EXPECT_LT((s.alpha[b] - t.alpha[b]).norm(), 1e-11);
      EXPECT_LT((s.r_ddot[b] - t.r_ddot[b]).norm(), 1e-11);
    }
  }
}

}  // namespace
}  // namespace polhode::instant_tests
