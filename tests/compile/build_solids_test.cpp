// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/compile/build_system.hpp>
#include <polhode/core/error.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/model_builder.hpp>

namespace polhode::test::build_solids_tests {
namespace {

/// Rounding of sums of some hundred terms of size 1.
constexpr double kRounding = 1e-12;

solids::Selection plane(const Vec3& normal, solids::Selection::Level level) {
  solids::Selection s;
  s.kind = solids::Selection::Kind::kPlane;
  s.normal = normal;
  s.level = level;
  return s;
}
solids::Selection bottom() { return plane(Vec3::UnitZ(), solids::Selection::Level::kMin); }
solids::Selection top() { return plane(Vec3::UnitZ(), solids::Selection::Level::kMax); }

/// A rubber block of 2 cells along each side, centred at the origin of its own coordinates.
SolidSpec block(const std::string& name, const Vec3& size) {
  SolidSpec solid;
  solid.name = name;
  solid.material = "rubber";
  solid.mesh.type = "block";
  solid.mesh.parameters["size"] = {size[0], size[1], size[2]};
  solid.mesh.parameters["cells"] = {2, 2, 2};
  return solid;
}

MaterialSpec rubber() {
  MaterialSpec material;
  material.name = "rubber";
  material.type = "neo_hookean";
  material.parameters = {{"youngs_modulus", 1e5}, {"poisson_ratio", 0.3}};
  material.density = 1000.0;
  return material;
}

/// Two tumbling bodies with a block between them.
Model two_bodies_and_a_pad() {
  ModelBuilder b;
  const Quat turned(Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()));
  b.body("base", {0, 0, -0.1}, 2.0, {0.02, 0.03, 0.04}, turned);
  b.body("plate", {0, 0.01, 0.2}, 1.0, {0.01, 0.01, 0.02});
  b.turning(0, {0.5, -1.0, 2.0}, {0, 0, 0.05});
  b.turning(1, {0.5, -1.0, 2.0}, {0, 0, 0.05});
  b.model.materials = {rubber()};
  SolidSpec pad = block("pad", {0.1, 0.12, 0.2});
  pad.mesh.position = {0, 0, 0.05};
  pad.mesh.orientation = Quat(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
  pad.bonded = {{.body = 0, .place = {}, .nodes = {bottom()}},
                {.body = 1, .place = {}, .nodes = {top()}}};
  b.model.solids = {pad};
  b.model.analysis.step = 1e-3;
  return b.model;
}

std::string message(const Model& model) {
  try {
    (void)build_system(model);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST(BuildSolids, PassesTheInstructionSetToTheElementKernels) {
  Model model = two_bodies_and_a_pad();
  model.analysis.isa = "sse9";
  EXPECT_NE(message(model).find("'sse9' is not available"), std::string::npos) << message(model);
  model.analysis.isa = "baseline";
  EXPECT_EQ(message(model), "");
}

TEST(BuildSolids, RefusesALoadWithoutItsValue) {
  Model model = two_bodies_and_a_pad();
  LoadSpec load;
  load.name = "press";
  load.solid = 0;
  load.type = "pressure";
  model.loads = {load};
  EXPECT_EQ(message(model), "loads.press: 'pressure' is missing. Give its value.");
  model.loads[0].type = "traction";
  EXPECT_EQ(message(model), "loads.press: 'traction' is missing. Give its value.");
}

TEST(BuildSolids, ComputesTheMassAndCentreOfASolid) {
  SystemMap map;
  const Model model = two_bodies_and_a_pad();
  const System system = build_system(model, &map);
  ASSERT_EQ(map.solids.size(), 1u);
  const SolidMap& pad = map.solids[0];
  EXPECT_EQ(pad.node_count(), 27);
  EXPECT_EQ(system.nodes().count(), 27);
  EXPECT_NEAR(pad.mass, 1000.0 * 0.1 * 0.12 * 0.2, kRounding);
  EXPECT_NEAR(pad.plan.volume, 0.1 * 0.12 * 0.2, kRounding);
  EXPECT_NEAR((pad.centre - Vec3(0, 0, 0.05)).norm(), 0.0, kRounding);
  EXPECT_EQ(pad.plan.elements, std::vector<std::string>{"hex8_eas9"});
  // The Jacobian of the map from [-1, 1]^3 to a cell is an eighth of the cell's volume.
  EXPECT_NEAR(pad.plan.least_jacobian, pad.plan.volume / 8 / 8, kRounding);
}

TEST(BuildSolids, BondsNodesWhereTheyAreOnTheirBodies) {
  SystemMap map;
  const Model model = two_bodies_and_a_pad();
  const System system = build_system(model, &map);
  int bonded[2] = {0, 0};
  for (int i = 0; i < system.nodes().count(); ++i) {
    const NodeData& node = system.nodes()[i];
    if (node.body == kFreeNode) continue;
    ++bonded[node.body];
    const BodyMotion m = system.motion(system.initial_state(), node.body);
    EXPECT_NEAR((m.r + m.q * node.Z - node.position).norm(), 0.0, kRounding);
  }
  EXPECT_EQ(bonded[0], 9);
  EXPECT_EQ(bonded[1], 9);
}

TEST(BuildSolids, StartsRigidlyWithTheFirstBodyItIsBondedTo) {
  const Model model = two_bodies_and_a_pad();
  const System system = build_system(model);
  for (int i = 0; i < system.nodes().count(); ++i) {
    const NodeData& node = system.nodes()[i];
    const Vec3 rigid = Vec3(0.5, -1.0, 2.0).cross(node.position - Vec3(0, 0, 0.05));
    EXPECT_NEAR((node.velocity - rigid).norm(), 0.0, kRounding);
  }
}

TEST(BuildSolids, StartsWithTheVelocitiesGiven) {
  Model model = two_bodies_and_a_pad();
  model.solids[0].bonded.clear();
  model.solids[0].angular_velocity = Vec3(0, 0, 3);
  const System system = build_system(model);
  for (int i = 0; i < system.nodes().count(); ++i) {
    const NodeData& node = system.nodes()[i];
    const Vec3 spin = Vec3(0, 0, 3).cross(node.position - Vec3(0, 0, 0.05));
    EXPECT_NEAR((node.velocity - spin).norm(), 0.0, kRounding);
  }
}

TEST(BuildSolids, FixedBodiesHoldNodesAsTheGroundDoes) {
  Model model = two_bodies_and_a_pad();
  model.bodies[0].fixed = true;
  model.bodies[0].velocity = model.bodies[0].angular_velocity = Vec3::Zero();
  SystemMap map;
  const System system = build_system(model, &map);
  for (const int node : map.solids[0].plan.bonded[0])
    EXPECT_EQ(system.nodes()[map.solids[0].first_node + node].body, kGround);
}

TEST(BuildSolids, PrescribesTheComponentsGiven) {
  Model model = two_bodies_and_a_pad();
  SolidSpec& pad = model.solids[0];
  pad.bonded.pop_back();
  PrescribedSpec lid;
  lid.name = "lid";
  lid.nodes = {top()};
  lid.displacement[2] = std::make_shared<Constant>(0.0);
  pad.prescribed = {lid};
  const System system = build_system(model);
  ASSERT_EQ(system.nodes().prescribed().size(), 9u);
  for (const PrescribedComponent& p : system.nodes().prescribed()) EXPECT_EQ(p.component, 2);
}

TEST(BuildSolids, RefusesANodeOnTwoBodies) {
  Model model = two_bodies_and_a_pad();
  model.solids[0].bonded[1].nodes = {plane(Vec3::UnitX(), solids::Selection::Level::kMin)};
  const std::string text = message(model);
  EXPECT_NE(text.find("solids.pad.bonded.plate: node 0 at (-0.05, -0.06, -0.1) and 2 others are "
                      "bonded to 'base' already"),
            std::string::npos)
      << text;
}

TEST(BuildSolids, RefusesASolidWithoutDensity) {
  Model model = two_bodies_and_a_pad();
  model.materials[0].density = 0.0;
  EXPECT_NE(message(model).find("solids.pad: the density is 0 kg/m^3"), std::string::npos);
}

TEST(BuildSolids, WarnsOfElementsThatLock) {
  Model model = two_bodies_and_a_pad();
  model.solids[0].element = "hex8_standard";
  SystemMap map;
  (void)build_system(model, &map);
  ASSERT_FALSE(map.solids[0].plan.warnings.empty());
  EXPECT_NE(map.solids[0].plan.warnings[0].find("solids.pad"), std::string::npos);
}

/// Forces of the bodies on the solid, equal to the change of their own momentum, m r̈ = m g − f, at
/// every instant to round-off.
TEST(InterfaceReactions, ActOnEachBodyWithTheOppositeSign) {
  Model model = two_bodies_and_a_pad();
  model.gravity = {0.5, 0, -9.81};
  model.bodies[1].velocity += Vec3(0.3, 0.0, -0.4);  // So that the pad is deformed.
  Simulation simulation(model);
  EXPECT_EQ(simulation.interfaces(0), (std::vector<std::string>{"base", "plate"}));
  for (int step = 0; step < 3; ++step) {
    for (int b = 0; b < 2; ++b) {
      const Vec3 f = simulation.interface_reaction(0, b).force;
      const double mass = model.bodies[static_cast<std::size_t>(b)].mass;
      const Vec3 rate = mass * simulation.point(b, Vec3::Zero()).acceleration;
      EXPECT_GT(f.norm(), 0.01);
      EXPECT_NEAR((rate + f - mass * model.gravity).norm(), 0.0, 1e-9 * f.norm());
    }
    ASSERT_TRUE(simulation.step(1.0).accepted);
  }
}

/// The same forces as change of the momentum of the solid: Δp = Δt (Σ f + m g). The trapezoidal
/// rule errs by (ω Δt)²/12, below 1e-4 for all motions here.
TEST(InterfaceReactions, ChangeTheMomentumOfTheSolid) {
  Model model = two_bodies_and_a_pad();
  model.gravity = {0.5, 0, -9.81};
  model.bodies[1].velocity += Vec3(0.3, 0.0, -0.4);
  const double dt = 1e-5;
  model.analysis.step = dt;
  Simulation simulation(model);
  const auto momentum_of_solid = [&] {
    Vec3 p = simulation.balance().linear_momentum;
    for (int b = 0; b < 2; ++b)
      p -= model.bodies[static_cast<std::size_t>(b)].mass *
           simulation.system().motion(simulation.state(), b).v;
    return p;
  };
  const auto force = [&] {
    return Vec3(simulation.interface_reaction(0, 0).force +
                simulation.interface_reaction(0, 1).force);
  };
  for (int step = 0; step < 20; ++step) ASSERT_TRUE(simulation.step(1.0).accepted);
  const Vec3 p = momentum_of_solid(), f = force();
  const double size = simulation.interface_reaction(0, 0).force.norm();
  ASSERT_TRUE(simulation.step(1.0).accepted);
  const Vec3 mean = 0.5 * (f + force()) + simulation.solids()[0].mass * model.gravity;
  EXPECT_NEAR(((momentum_of_solid() - p) / dt - mean).norm(), 0.0, 1e-3 * size);
}

/// A solid that turns rigidly with its bodies has neither stress nor stored energy.
TEST(SolidReports, ShowNoStressInASolidThatHasNotDeformed) {
  const Simulation simulation(two_bodies_and_a_pad());
  const SolidReport report = simulation.solid(0);
  ASSERT_EQ(report.position.size(), 27u);
  ASSERT_EQ(report.elements.size(), 8u);
  double volume = 0.0;
  for (const ElementSample& e : report.elements) {
    EXPECT_NEAR(e.cauchy.norm(), 0.0, 1e-9 * 1e5);
    EXPECT_NEAR((e.principal_stretches - Vec3::Ones()).norm(), 0.0, 1e-9);
    volume += e.volume;
  }
  EXPECT_NEAR(volume, 0.1 * 0.12 * 0.2, kRounding);
  for (const Vec3& u : report.displacement) EXPECT_NEAR(u.norm(), 0.0, kRounding);
  // Velocities of a rigid turn about (0, 0, 0.05).
  for (std::size_t i = 0; i < 27; ++i)
    EXPECT_NEAR(
        (report.velocity[i] - Vec3(0.5, -1.0, 2.0).cross(report.position[i] - Vec3(0, 0, 0.05)))
            .norm(),
        0.0, kRounding);
}

}  // namespace polhode::test::build_solids_tests
