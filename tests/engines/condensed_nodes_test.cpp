// SPDX-License-Identifier: Apache-2.0
// Nodes, bodies and joints in one Newton system: laws that hold for all elements.
#include <gtest/gtest.h>

#include <cmath>

#include <polhode/engines/sparse_engine.hpp>
#include <polhode/joints/joint.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/stepping/single_step.hpp>
#include <polhode/stepping/start.hpp>
#include <polhode/stepping/stepper.hpp>
#include <support/bar_elements.hpp>

namespace polhode::condensed_nodes_tests {
namespace {

using test::lattice;

/// A lattice beam along x, its first layer of nodes on one body and, if wanted, its last on
/// another; the bodies tumble.
struct Scene {
  System system;
  int hub = kGround, tip = kGround;

  struct Options {
    bool two_bodies = false, hinge = false, clamp = false;
    double viscosity = 0.0;
    Vec3 gravity = Vec3::Zero();
    int length = 4;
    NodeFactor factor = NodeFactor::every_iteration;
    double rho_inf = 1.0, step = 0.02, tolerance = 1e-5;
  };
  explicit Scene(const Options& o) : options(o) {
    auto [X, bars] = lattice(o.length, 1, 1, 0.5, Vec3(0.5, -0.25, -0.25));
    bars->stiffness = 200.0;
    bars->viscosity = o.viscosity;
    const Vec3 omega(0.7, -1.1, 2.0), v(0.0, 0.0, 0.0);
    system.set_gravity(o.gravity);
    const auto body = [&](const Vec3& r, const char* name) {
      BodyData data{.name = name, .mass = 2.0, .inertia = Vec3(0.3, 0.4, 0.55).asDiagonal()};
      BodyMotion start;
      start.r = r;
      start.v = v + omega.cross(r);
      start.W = omega;
      return system.add_body(data, start);
    };
    if (!o.clamp) hub = body(Vec3::Zero(), "hub");
    const double far = 0.5 + 0.5 * o.length;
    if (o.two_bodies) tip = body(Vec3(far + 0.5, 0, 0), "tip");
    for (const Vec3& x : X) {
      NodeData node{.position = x, .velocity = v + omega.cross(x)};
      if (o.clamp) node.velocity.setZero();
      if (x[0] < 0.51) {
        node.body = hub;
        node.Z = x;
      } else if (o.two_bodies && x[0] > far - 0.01) {
        node.body = tip;
        node.Z = x - Vec3(far + 0.5, 0, 0);
      }
      system.add_node(node);
    }
    system.add_elements(std::move(bars));
    if (o.hinge) {
      const Vec3 at(-0.4, 0.1, 0.0);
      system.group<Joint>().add("pin", "spherical", Participants{kGround, hub},
                                joint_kind("spherical").recipe({.Z_a = at, .Z_b = at}, {}));
    }
    system.finish();
    ga = GeneralizedAlpha::from_spectral_radius(o.rho_inf);
    state = system.initial_state();
    start(system, state, ga, 0.01);
    const LaneKernels& kernels = lane_kernels("automatic");
    auto made =
        std::make_unique<SparseEngine>(system, "block_lu", MomentumRate::momentum, o.factor);
    engine = made.get();
    StepControl control;
    control.step = o.step;
    control.newton.tolerance = o.tolerance;
    control.newton.max_iterations = 30;
    stepper = std::make_unique<Stepper>(system, std::move(made), ga, control, kernels);
    stepper->begin(state);
  }
  void run(int steps, double dt = 0.02) {
    for (int i = 0; i < steps; ++i) {
      const StepReport r = stepper->advance(state, state.t + dt);
      ASSERT_TRUE(r.accepted) << r.message;
    }
  }
  [[nodiscard]] double energy_drift() const {
    return state.ledger.energy_drift / state.ledger.energy_scale;
  }

  Options options;
  GeneralizedAlpha ga;
  State state;
  SparseEngine* engine = nullptr;
  std::unique_ptr<Stepper> stepper;
};

TEST(CondensedNodes, KeepsEnergyAndMomentaOfALatticeOnATumblingBody) {
  Scene s({.two_bodies = false});
  s.run(1000);
  EXPECT_LT(s.energy_drift(), 1e-12);
  EXPECT_LT(s.state.ledger.p_drift / s.state.ledger.p_scale, 1e-12);
  EXPECT_LT(s.state.ledger.l_drift / s.state.ledger.l_scale, 1e-12);
  EXPECT_LT(s.state.ledger.iterations, 5 * 1000);
  EXPECT_EQ(s.state.ledger.rejected, 0);
}

TEST(CondensedNodes, KeepsEnergyAndMomentaOfElementsWithoutFreeNodes) {
  for (const int length : {1, 3}) {
    Scene s({.two_bodies = true, .length = length});
    s.run(500);
    EXPECT_LT(s.energy_drift(), 1e-12) << length;
    EXPECT_LT(s.state.ledger.l_drift / s.state.ledger.l_scale, 1e-12) << length;
  }
}

TEST(CondensedNodes, KeepsEnergyOnAJointUnderGravity) {
  Scene s({.two_bodies = true, .hinge = true, .gravity = Vec3(0, 0, -9.81)});
  s.run(500);
  EXPECT_LT(s.energy_drift(), 1e-12);
  EXPECT_LT(s.state.ledger.constraint_max, 1e-12);
  EXPECT_LT(s.state.ledger.l_drift / s.state.ledger.l_scale, 1e-12);
}

TEST(CondensedNodes, LedgerIncludesTheReactionOfGroundOnNodes) {
  Scene s({.clamp = true, .gravity = Vec3(0, 0, -9.81)});
  s.run(300, 0.01);
  EXPECT_LT(s.energy_drift(), 1e-12);
  EXPECT_LT(s.state.ledger.p_drift / s.state.ledger.p_scale, 1e-11);
  EXPECT_LT(s.state.ledger.l_drift / s.state.ledger.l_scale, 1e-11);
}

TEST(CondensedNodes, RecordsTheEnergyDissipatedByViscosity) {
  Scene s({.two_bodies = true, .viscosity = 2.0});
  const double before = s.state.ledger.initial_energy;
  s.run(300);
  EXPECT_GT(s.state.ledger.dissipated.value(), 1e-3 * before);
  EXPECT_LT(s.energy_drift(), 1e-12);
}

TEST(CondensedNodes, ConvergesToTheSameStepWithAReusedFactorisation) {
  Scene newton({.two_bodies = true, .hinge = true, .gravity = Vec3(0, 0, -9.81)});
  Scene kept({.two_bodies = true,
              .hinge = true,
              .gravity = Vec3(0, 0, -9.81),
              .factor = NodeFactor::reuse,
              .tolerance = 1e-9});
  newton.run(200, 0.005);
  kept.run(200, 0.005);
  for (std::size_t k = 0; k < newton.state.node_x.size(); ++k)
    EXPECT_NEAR(newton.state.node_x[k], kept.state.node_x[k], 1e-9);
  EXPECT_LT(kept.engine->nodes()->factorisations(), 60);
  EXPECT_LT(kept.energy_drift(), 1e-11);
}

TEST(CondensedNodes, ConvergesQuadraticallyNearTheSolution) {
  for (const double rho_inf : {1.0, 0.6}) {
    Scene s({.two_bodies = true, .hinge = true, .viscosity = 0.7, .length = 2, .rho_inf = rho_inf});
    s.run(5);
    // One Newton iteration from a point near the solution reduces the increment quadratically.
    Trial trial;
    trial.context.ga = s.ga;
    trial.context.dt = 0.02;
    start_trial(s.system, s.state, trial);
    predict_nodes(s.system, s.state, trial, {});
    SparseEngine engine(s.system, "block_lu", MomentumRate::momentum, NodeFactor::every_iteration);
    engine.begin_step(s.state, trial);
    std::vector<double> increments;
    for (int i = 0; i < 6; ++i)
      increments.push_back(engine.iterate(s.state, trial, true, 1.0).increment);
    EXPECT_LT(increments[2], 20.0 * increments[1] * increments[1]);
    EXPECT_LT(increments[3], std::max(20.0 * increments[2] * increments[2], 1e-12));
    EXPECT_LT(increments[5], 1e-12);
  }
}

TEST(CondensedNodes, AccelerationsOfAnInstantAreRatesOfTheVelocities) {
  Scene s({.two_bodies = true, .hinge = true, .viscosity = 0.5, .gravity = Vec3(0, 0, -9.81)});
  s.run(20);
  project_velocities(s.system, s.state);
  bond_nodes(s.system, s.state);
  const InstantSolution now = instant_solution(s.system, s.state);
  ASSERT_EQ(now.node_a.size(), s.state.node_x.size());
  // Two short steps: the mean of the velocity changes has no alternating error of the first step.
  const double h = 1e-5;
  const State before = s.state;
  s.run(2, h);
  double scale = 0.0;
  for (const double a : now.node_a) scale = std::max(scale, std::abs(a));
  EXPECT_GT(scale, 5.0);
  for (std::size_t k = 0; k < now.node_a.size(); ++k)
    EXPECT_NEAR((s.state.node_v[k] - before.node_v[k]) / (2 * h), now.node_a[k], 1e-3 * scale);
}

TEST(CondensedNodes, IsOfSecondOrder) {
  for (const double rho_inf : {1.0, 0.8, 0.3}) {
    const auto end = [&](int n) {
      Scene s(
          {.two_bodies = true, .viscosity = 2.0, .length = 3, .rho_inf = rho_inf, .step = 0.4 / n});
      s.run(n, 0.4 / n);
      return s.state.node_x;
    };
    const auto reference = end(640);
    const auto error = [&](int n) {
      const auto x = end(n);
      double most = 0.0;
      for (std::size_t k = 0; k < x.size(); ++k)
        most = std::max(most, std::abs(x[k] - reference[k]));
      return most;
    };
    EXPECT_NEAR(std::log2(error(40) / error(80)), 2.0, 0.15) << rho_inf;
  }
}

}  // namespace
}  // namespace polhode::condensed_nodes_tests
