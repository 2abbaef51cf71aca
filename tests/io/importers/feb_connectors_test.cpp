// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <io/importers/feb_fixture.hpp>

namespace polhode::feb_tests {
namespace {

using testing::HasSubstr;

class FebConnectors : public FebFixture {
 protected:
  Model joined(const std::string& type, const std::string& inside, const std::string& more = "") {
    return read(two_bodies(control(), connector(type, inside), more));
  }
};

TEST_F(FebConnectors, EveryTypeHasItsFreedoms) {
  const auto count = [&](const std::string& type, const std::string& inside = "") {
    return freedoms(joined(type, inside));
  };
  EXPECT_EQ(count("rigid spherical joint"), 3);
  EXPECT_EQ(count("rigid joint"), 3);
  EXPECT_EQ(count("rigid revolute joint"), 1);
  EXPECT_EQ(count("rigid prismatic joint"), 1);
  EXPECT_EQ(count("rigid cylindrical joint"), 2);
  EXPECT_EQ(count("rigid planar joint"), 3);
  EXPECT_EQ(count("rigid lock"), 0);
  EXPECT_EQ(count("rigid spring", tag("insertion_b", "0,0,1") + tag("k", "2")), 6);
  EXPECT_EQ(count("generic rigid joint", tag("prescribe_x", "0") + tag("prescribe_Rz", "0")), 4);
}

// J q'' = m g l cos(q) from rest at q = 0: J q'^2 / 2 = m g l sin(q).
TEST_F(FebConnectors, APendulumFallsAsItsEnergySays) {
  const Model m = joined("rigid revolute joint",
                         tag("joint_origin", "-0.5,0,0") + tag("rotation_axis", "0,1,0"),
                         tag("Loads", typed("body_load", "body force", tag("force", "0,0,9.81"))));
  EXPECT_EQ(m.gravity, Vec3(0, 0, -9.81));
  const double J = kMoments.y() + kMass * 0.25;
  for (const double step : kSteps) {
    const BodyMotion bar = run(m, 0.2, step).body("bar");
    EXPECT_NEAR(0.5 * J * bar.omega().y() * bar.omega().y() / (kMass * 9.81), -bar.r.z(),
                error_at(step));
    EXPECT_LT(bar.r.z(), -0.1);
  }
}

// The rotation is that of body b relative to body a, about the axis.
TEST_F(FebConnectors, RotationsArePrescribedByCurves) {
  const Model m =
      joined("rigid revolute joint",
             tag("rotation_axis", "0,0,1") + tag("prescribed_rotation", "1") +
                 tag("rotation", "0.5", "lc='1'"),
             tag("LoadData", tag("load_controller", tag("math", "t^2"), "id='1' type='math'")));
  const BodyMotion bar = run(m, 1.0).body("bar");
  EXPECT_NEAR(bar.omega().z(), 1.0, 1e-9);
  EXPECT_NEAR((bar.Lambda() * Vec3::UnitX() - Vec3(std::cos(0.5), std::sin(0.5), 0)).norm(), 0.0,
              1e-9);
}

// FEBio applies moments and forces of connectors to body a, and their opposite to body b.
TEST_F(FebConnectors, MomentsAndForcesActOnTheFirstBody) {
  const double t = 0.5;
  const Model hinge =
      joined("rigid revolute joint", tag("rotation_axis", "0,0,1") + tag("moment", "3"));
  const Model slider =
      joined("rigid prismatic joint", tag("translation_axis", "0,1,0") + tag("force", "8"));
  const Model ball = joined("rigid spherical joint", tag("moment_y", "2"));
  const Model sleeve = joined("rigid cylindrical joint",
                              tag("joint_axis", "0,0,1") + tag("force", "8") + tag("moment", "3"));
  for (const double step : kSteps) {
    EXPECT_NEAR(run(hinge, t, step).body("bar").omega().z(), -3 / kMoments.z() * t, error_at(step));
    EXPECT_NEAR(run(slider, t, step).body("bar").r.y(), -8 / kMass * t * t / 2, error_at(step));
    EXPECT_NEAR(run(ball, t, step).body("bar").omega().y(), -2 / kMoments.y() * t, error_at(step));
    const BodyMotion bar = run(sleeve, t, step).body("bar");
    EXPECT_NEAR(bar.r.z(), -8 / kMass * t * t / 2, error_at(step));
    EXPECT_NEAR(bar.omega().z(), -3 / kMoments.z() * t, error_at(step));
  }
}

TEST_F(FebConnectors, TranslationsArePrescribed) {
  const std::string ramp = tag("LoadData", curve(1, "0,0;2,2"));
  const Model planar =
      joined("rigid planar joint",
             tag("rotation_axis", "0,0,1") + tag("translation_axis_1", "0,1,0") +
                 tag("prescribed_translation_1", "1") + tag("translation_1", "0.2", "lc='1'") +
                 tag("prescribed_translation_2", "1") + tag("translation_2", "0.3", "lc='1'") +
                 tag("prescribed_rotation", "1") + tag("rotation", "0", "lc='1'"),
             ramp);
  EXPECT_NEAR((run(planar, 1.0).body("bar").r - Vec3(-0.3, 0.2, 0)).norm(), 0.0, 1e-9);
  const Model sleeve =
      joined("rigid cylindrical joint",
             tag("joint_axis", "0,1,0") + tag("prescribed_translation", "1") +
                 tag("translation", "0.4", "lc='1'") + tag("prescribed_rotation", "1") +
                 tag("rotation", "0.1", "lc='1'"),
             ramp);
  const BodyMotion bar = run(sleeve, 1.0).body("bar");
  EXPECT_NEAR((bar.r - Vec3(0, 0.4, 0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(bar.omega().y(), 0.1, 1e-9);
  const Model ball = joined("rigid spherical joint",
                            tag("prescribed_rotation", "1") + tag("rotation_x", "0.3", "lc='1'") +
                                tag("rotation_z", "0.4", "lc='1'"),
                            ramp);
  const Vec3 axis(0.3, 0, 0.4);
  EXPECT_NEAR((run(ball, 1.0).body("bar").Lambda() -
               Eigen::AngleAxisd(0.5, axis.normalized()).toRotationMatrix())
                  .norm(),
              0.0, 1e-9);
  const Model generic =
      joined("generic rigid joint",
             tag("joint", "0,0,0") + tag("prescribe_x", "0.1", "lc='1'") + tag("prescribe_y", "0") +
                 tag("prescribe_z", "0") + tag("prescribe_Rx", "0") + tag("prescribe_Ry", "0") +
                 tag("prescribe_Rz", "0.2", "lc='1'"),
             ramp);
  const BodyMotion moved = run(generic, 1.0).body("bar");
  EXPECT_NEAR((moved.r - Vec3(0.1, 0, 0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(moved.omega().z(), 0.2, 1e-9);
}

// m x'' = -k (x - 0.2) along the spring, from rest at x = 0 where its length is 1 and that without
// force 1.2: x = 0.2 (cos(w t) - 1), towards the base.
TEST_F(FebConnectors, ASpringOscillates) {
  const double k = 500.0, w = std::sqrt(k / kMass), t = 1.0;
  const Model m =
      joined("rigid spring", tag("k", "500") + tag("insertion_a", "0,0,-1") +
                                 tag("insertion_b", "0,0,0") + tag("free_length", "1.2"));
  for (const double step : kSteps)
    EXPECT_NEAR(run(m, t, step).body("bar").r.z(), 0.2 * (1 - std::cos(w * t)), error_at(step));
  const Model relaxed =
      joined("rigid spring", tag("insertion_a", "0,0,-1") + tag("insertion_b", "0,0,0"));
  EXPECT_EQ(relaxed.loads[0].parameters.at("free_length"), 1.0);
}

TEST_F(FebConnectors, DampersTakeExponentially) {
  const std::string start =
      typed("rigid_ic", "initial_rigid_velocity", tag("rb", "bar") + tag("value", "0.3,0.4,0")) +
      typed("rigid_ic", "initial_rigid_angular_velocity", tag("rb", "bar") + tag("value", "0,0,2"));
  const auto damped = [&](const std::string& inside, bool swapped) {
    return read(
        two_bodies(control(), start + (swapped ? connector("rigid damper", inside, "bar", "base")
                                               : connector("rigid damper", inside))));
  };
  const double t = 0.5, rate = 200 / kMass;
  for (const bool swapped : {false, true})
    for (const double step : kSteps) {
      const Model m = damped(tag("c", "200") + tag("insertion_a", swapped ? "0,0,0" : "0,0,3") +
                                 tag("insertion_b", swapped ? "0,0,3" : "0,0,0"),
                             swapped);
      EXPECT_NEAR(run(m, t, step).body("bar").v.x(), 0.3 * std::exp(-rate * t), error_at(step));
    }
  const Model turning =
      read(two_bodies(control(), start + connector("rigid angular damper", tag("c", "5"))));
  for (const double step : kSteps)
    EXPECT_NEAR(run(turning, t, step).body("bar").omega().z(), 2 * std::exp(-5 / kMoments.z() * t),
                error_at(step));
}

TEST_F(FebConnectors, ContractileForcesPullTheBodiesTogether) {
  const Model m =
      joined("rigid contractile force",
             tag("f0", "16", "lc='1'") + tag("insertion_a", "0,0,4") + tag("insertion_b", "0,0,0"),
             tag("LoadData", curve(1, "0,1;1,1")));
  EXPECT_NEAR(run(m, 1.0).body("bar").r.z(), 16 / kMass / 2, 1e-9);
}

/// The block on a spring below a corner, between nodes of rigid bodies, with a speed along z.
std::string on_a_spring(const std::string& law, double speed) {
  return feb(control() +
             tag("Material", rigid(1, "base", tag("center_of_mass", "0,0,0")) + rigid(2, "bar")) +
             tag("Mesh", block(1, "part", Vec3(-0.5, -0.1, -0.2), Vec3(0.5, 0.1, 0.2)) +
                             tag("Nodes", tag("node", "-0.5,-0.1,-1.2", "id='101'")) +
                             tag("NodeSet", "101", "name='anchor'") +
                             tag("DiscreteSet", tag("delem", "101,1"), "name='ligament'")) +
             tag("MeshDomains", domain("part", "bar")) +
             tag("Boundary", tag("bc", tag("rb", "base"), "type='rigid' node_set='anchor'")) +
             tag("Rigid", fixed("base", "111111") + fixed("bar", "110111") +
                              typed("rigid_ic", "initial_rigid_velocity",
                                    tag("rb", "bar") + tag("value", format("0,0,{}", speed)))) +
             tag("Discrete", law + "<discrete dmat='1' discrete_set='ligament'/>"));
}

// A length of 1 m without force: z = v/w sin(w t), and a slack ligament does not act.
TEST_F(FebConnectors, SpringsBetweenNodesOfRigidBodies) {
  const auto law = [](const std::string& type, const std::string& inside) {
    return tag("discrete_material", inside, "id='1' type='" + type + "'");
  };
  const std::string points = tag("force",
                                 tag("interpolate", "linear") + tag("extend", "extrapolate") +
                                     tag("points", tag("pt", "-0.01,-5") + tag("pt", "0.01,5")),
                                 "type='point'");
  const double w = std::sqrt(500 / kMass), t = 0.4;
  for (const std::string& spring :
       {law("linear spring", tag("E", "500")), law("nonlinear spring", points)})
    for (const double step : kSteps)
      EXPECT_NEAR(run(read(on_a_spring(spring, 0.3)), t, step).body("bar").r.z(),
                  0.3 / w * std::sin(w * t), error_at(step));
  const std::string ligament = law("tension-only linear spring", tag("E", "500"));
  EXPECT_NEAR(run(read(on_a_spring(ligament, 0.3)), t, 1e-3).body("bar").r.z(),
              0.3 / w * std::sin(w * t), error_at(1e-3));
  EXPECT_NEAR(run(read(on_a_spring(ligament, -0.3)), t, 1e-3).body("bar").r.z(), -0.3 * t, 1e-9);
  EXPECT_THAT(fault(on_a_spring(law("Hill", ""), 0)),
              HasSubstr("springs of type 'hill' are not read"));
  EXPECT_THAT(fault(on_a_spring(law("nonlinear spring", ""), 0)), HasSubstr("no <force> of type"));
  std::string loose = on_a_spring(ligament, 0);
  loose.replace(loose.find("type='rigid' node_set"), 21, "type='fluid' node_set");
  EXPECT_THAT(fault(loose), HasSubstr("an end that is on no rigid body"));
}

// A crank of 0.2 m turned at 2 rad/s, a rod of 0.5 m and a slider along x.
TEST_F(FebConnectors, ASliderCrankMovesAsItsGeometrySays) {
  const auto bar = [&](int first, const std::string& name, double from, double to) {
    return block(first, name, Vec3(from, -0.01, -0.01), Vec3(to, 0.01, 0.01));
  };
  const auto between = [&](const std::string& name, const std::string& type, const std::string& a,
                           const std::string& b, const std::string& inside) {
    return tag("rigid_connector", tag("body_a", a) + tag("body_b", b) + inside,
               "name='" + name + "' type='" + type + "'");
  };
  const std::string axis = tag("rotation_axis", "0,0,1");
  const Model m = read(
      feb(control() +
          tag("Material", rigid(1, "base", tag("center_of_mass", "0,0,0")) + rigid(2, "crank") +
                              rigid(3, "rod") + rigid(4, "slider")) +
          tag("Mesh", bar(1, "p1", 0, 0.2) + bar(11, "p2", 0.2, 0.7) + bar(21, "p3", 0.65, 0.75)) +
          tag("MeshDomains", domain("p1", "crank") + domain("p2", "rod") + domain("p3", "slider")) +
          tag("Rigid",
              fixed("base", "111111") +
                  between("drive", "rigid revolute joint", "base", "crank",
                          tag("joint_origin", "0,0,0") + axis + tag("prescribed_rotation", "1") +
                              tag("rotation", "2", "lc='1'")) +
                  between("pin", "rigid revolute joint", "crank", "rod",
                          tag("joint_origin", "0.2,0,0") + axis) +
                  between("wrist", "rigid spherical joint", "rod", "slider",
                          tag("joint_origin", "0.7,0,0")) +
                  between("guide", "rigid prismatic joint", "base", "slider",
                          tag("joint_origin", "0.7,0,0") + tag("translation_axis", "1,0,0"))) +
          tag("LoadData", tag("load_controller", tag("math", "t"), "id='1' type='math'"))));
  for (const double step : {1e-2, 1e-3, 1e-4}) {
    const double q = 2 * 0.8;
    const double x = 0.2 * std::cos(q) + std::sqrt(0.25 - 0.04 * std::sin(q) * std::sin(q));
    EXPECT_NEAR(run(m, 0.8, step).body("slider").r.x(), x, 1e-9);
  }
}

TEST_F(FebConnectors, WhatCannotBeIsNamed) {
  const auto what = [&](const std::string& type, const std::string& inside) {
    return fault(two_bodies(control(), connector(type, inside)));
  };
  EXPECT_THAT(what("rigid hook", ""), HasSubstr("a connector of type 'rigid hook' is not read"));
  EXPECT_THAT(what("rigid revolute joint", tag("prescribed_rotation", "1") + tag("moment", "1")),
              HasSubstr("'link' has a motion and a force along it"));
  EXPECT_THAT(what("rigid spring", tag("k", "-1")), HasSubstr("<k> is -1"));
  EXPECT_THAT(what("rigid revolute joint", tag("rotation_axis", "0,0,0")),
              HasSubstr("<rotation_axis> has no length"));
  EXPECT_THAT(what("generic rigid joint", tag("prescribe_Rx", "1")),
              HasSubstr("turns about several axes"));
  EXPECT_THAT(fault(two_bodies(control(), connector("rigid lock", "", "bar", "bar"))),
              HasSubstr("connects a body with itself"));
  EXPECT_THAT(fault(two_bodies(control(), connector("rigid lock", "", "bar", "barr"))),
              HasSubstr("<body_b> of <rigid_connector> is 'barr', which is no rigid body"));
}

}  // namespace
}  // namespace polhode::feb_tests
