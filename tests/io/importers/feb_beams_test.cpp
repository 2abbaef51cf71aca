// SPDX-License-Identifier: Apache-2.0
// Linear beams of FEBio files, and rigid bodies that are locked to a parent.
#include "feb_fixture.hpp"

namespace polhode::feb_beams_tests {
namespace {

using namespace feb_tests;
using testing::HasSubstr;

constexpr double kE = 2e6, kG = 8e5, kArea = 0.02, kShear = 0.016, kSecond = 3e-5;

std::string section(const std::string& second = "3e-5", const std::string& more = "") {
  return tag("material",
             tag("density", "1000") + tag("E", "2e6") + tag("G", "8e5") + tag("A", "0.02") +
                 tag("A1", "0.016") + tag("A2", "0.016") + tag("I1", "3e-5") + tag("I2", second) +
                 more,
             "id='1' name='rod' type='linear beam'");
}

/// A beam along x of 1 m in some elements, with the conditions and loads of a file.
std::string beam(int elements, const std::string& material, const std::string& more,
                 const std::string& rigid_bodies = "", const std::string& mesh = "") {
  std::string nodes, lines;
  for (int k = 0; k <= elements; ++k)
    nodes +=
        tag("node", format("{},0,0", static_cast<double>(k) / elements), format("id='{}'", k + 1));
  for (int k = 0; k < elements; ++k)
    lines += tag("elem", format("{},{}", k + 1, k + 2), format("id='{}'", k + 1));
  return feb(control("STATIC", 1, 1.0) + tag("Material", material + rigid_bodies) +
             tag("Mesh", tag("Nodes", nodes) + tag("Elements", lines, "type='line2' name='strut'") +
                             tag("NodeSet", "1", "name='wall'") +
                             tag("NodeSet", format("{}", elements + 1), "name='tip'") + mesh) +
             tag("MeshDomains", "<BeamDomain name='strut' mat='rod' type='linear-beam'/>" +
                                    std::string(mesh.empty() ? "" : domain("part", "head"))) +
             more + tag("LoadData", curve(1, "0,0;1,1")));
}
const std::string kClamp = tag("bc", tag("x_dof", "1") + tag("y_dof", "1") + tag("z_dof", "1"),
                               "type='zero displacement' node_set='wall'") +
                           tag("bc", tag("u_dof", "1") + tag("v_dof", "1") + tag("w_dof", "1"),
                               "type='zero rotation' node_set='wall'");
std::string load(const std::string& force) {
  return tag("Loads", tag("nodal_load", tag("value", force, "lc='1'"),
                          "name='f' type='nodal_force' node_set='tip'"));
}

class FebBeams : public FebFixture {
 protected:
  /// Displacement of a body, or a node of a beam, in equilibrium.
  Vec3 shift(const std::string& text, const std::string& name) {
    Simulation simulation(read(text));
    const Vec3 start = simulation.body(name).r;
    while (simulation.time() < 1.0 - 1e-9) simulation.step(1.0);
    return simulation.body(name).r - start;
  }
};

// n elements with one point each: F (L³ (1 - 1/4n²) / 3EI + L / GA), for small forces.
TEST_F(FebBeams, CantileversBend) {
  const double force = 1e-4;
  for (const int n : {1, 4, 10}) {
    const Vec3 u = shift(beam(n, section(), tag("Boundary", kClamp) + load("0,0,1e-4")),
                         format("strut.{}", n));
    const double exact =
        force * ((1.0 - 0.25 / (n * n)) / (3.0 * kE * kSecond) + 1.0 / (kG * kShear));
    EXPECT_NEAR(u.z(), exact, 1e-7 * exact) << n;
    EXPECT_NEAR(u.y(), 0.0, 1e-12);
  }
}

TEST_F(FebBeams, BarsAreStretched) {
  const Vec3 u = shift(beam(3, section(), tag("Boundary", kClamp) + load("400,0,0")), "strut.3");
  EXPECT_NEAR(u.x(), 400.0 / (kE * kArea), 1e-9);
}

// A rigid body at the end carries the force at its far side, 0.5 m from it: the tip bends by F
// L²/2EI times that in addition, and the body turns with it.
TEST_F(FebBeams, RigidBodiesAreAtTheirEnds) {
  const std::string head =
      tag("material", tag("density", "1"), "id='2' name='head' type='rigid body'");
  std::string mesh = block(101, "part", Vec3(1, -0.1, -0.1), Vec3(1.5, 0.1, 0.1));
  const std::string more =
      tag("Boundary", kClamp + tag("bc", tag("rb", "head"), "type='rigid' node_set='tip'")) +
      tag("Rigid", typed("rigid_load", "rigid_follower_force",
                         tag("rb", "head") + tag("force", "0,0,1e-4", "lc='1'") +
                             tag("insertion", "1.5,0,0") + tag("relative", "0")));
  const double f = 1e-4, EI = kE * kSecond;
  const double tip = f * (1.0 / (3 * EI) + 0.5 / (2 * EI) + 1.0 / (kG * kShear));
  const double turn = f * (1.0 / (2 * EI) + 0.5 / EI);
  const Vec3 u = shift(beam(20, section(), more, head, mesh), "head");
  EXPECT_NEAR(u.z(), tip + 0.25 * turn, 1e-3 * tip);
}

TEST_F(FebBeams, WhatCannotBeReadIsNamed) {
  EXPECT_THAT(fault(beam(2, section("4e-5"), tag("Boundary", kClamp))),
              HasSubstr("the section of 'rod' differs in its two directions"));
  EXPECT_THAT(fault(beam(2, section("0"), tag("Boundary", kClamp))),
              HasSubstr("the linear beam 'rod' has no <I2> above zero"));
  EXPECT_THAT(fault(beam(2, section(),
                         tag("Boundary", tag("bc", tag("x_dof", "1"),
                                             "type='zero displacement' node_set='wall'")))),
              HasSubstr("the node 1 of a beam is held in some directions, or prescribed"));
  EXPECT_THAT(fault(beam(2, section(),
                         tag("Boundary", tag("bc", tag("u_dof", "1"),
                                             "type='zero rotation' node_set='wall'")))),
              HasSubstr("fixes some of the rotations alone"));
}

// Two blocks that are locked to each other fall as one with the mass of both.
TEST_F(FebBeams, BodiesAreLockedToTheirParents) {
  const auto two = [](const std::string& parent) {
    return feb(control() +
               tag("Material", rigid(1, "one") + rigid(2, "two", tag("parent_id", parent))) +
               tag("Mesh", block(1, "p1", Vec3::Zero(), Vec3::Ones()) +
                               block(11, "p2", Vec3(1, 0, 0), Vec3(2, 1, 1))) +
               tag("MeshDomains", domain("p1", "one") + domain("p2", "two")) +
               tag("Rigid", typed("rigid_load", "rigid_force",
                                  tag("rb", "one") + tag("dof", "Rx") + tag("value", "2000"))));
  };
  const Model m = read(two("1"));
  EXPECT_EQ(freedoms(m), 6);
  for (const double step : kSteps) EXPECT_NEAR(run(m, 1.0, step).body("two").v.x(), 1.0, 1e-8);
  EXPECT_EQ(freedoms(read(two("0"))), 12);
  EXPECT_THAT(fault(two("7")),
              HasSubstr("<parent_id> of 'two' is 7, which is no other rigid body"));
  EXPECT_THAT(fault(two("2")),
              HasSubstr("<parent_id> of 'two' is 2, which is no other rigid body"));
}

}  // namespace
}  // namespace polhode::feb_beams_tests
