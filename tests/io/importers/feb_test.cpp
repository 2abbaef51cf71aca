// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <polhode/io/importers/feb_curves.hpp>
#include <polhode/io/text/write_yaml.hpp>

#include <io/importers/feb_fixture.hpp>

namespace polhode::feb_tests {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Rows of numbers as nodes, from number 1 on.
std::string nodes(const std::vector<Vec3>& points) {
  std::string list;
  for (std::size_t k = 0; k < points.size(); ++k)
    list += tag("node", format("{},{},{}", points[k].x(), points[k].y(), points[k].z()),
                format("id='{}'", k + 1));
  return tag("Nodes", list);
}

/// One element of all nodes, of a rigid body "bar" of density 1000.
std::string one_element(const std::string& type, const std::vector<Vec3>& points) {
  std::string list;
  for (std::size_t k = 0; k < points.size(); ++k) list += format("{} ", k + 1);
  return feb(control() + tag("Material", rigid(1, "bar")) +
             tag("Mesh", nodes(points) + tag("Elements", tag("elem", list, "id='1'"),
                                             "type='" + type + "' name='part'")) +
             tag("MeshDomains", domain("part", "bar")) + tag("Rigid", ""));
}

class Feb : public FebFixture {
 protected:
  Model with_rigid(const std::string& inside, const std::string& more = "",
                   const std::string& control_text = control()) {
    return read(two_bodies(control_text, inside, more));
  }
};

/// Corners of the unit cube in FEBio's order, and the middles of its edges.
std::vector<Vec3> cube20() {
  std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                      {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (const auto& e : {std::array{0, 1},
                        {1, 2},
                        {2, 3},
                        {3, 0},
                        {4, 5},
                        {5, 6},
                        {6, 7},
                        {7, 4},
                        {0, 4},
                        {1, 5},
                        {2, 6},
                        {3, 7}})
    x.push_back(0.5 * (x[static_cast<std::size_t>(e[0])] + x[static_cast<std::size_t>(e[1])]));
  return x;
}

TEST_F(Feb, MassesAreIntegratedOverTheMesh) {
  const BodySpec bar = body(with_rigid(""), "bar");
  EXPECT_NEAR(bar.mass, kMass, 1e-12 * kMass);
  EXPECT_NEAR((bar.inertia - Mat3(kMoments.asDiagonal())).norm(), 0.0, 1e-12 * kMoments.norm());
  EXPECT_TRUE(body(with_rigid(""), "base").fixed);
  std::vector<Vec3> far = cube20();
  for (Vec3& x : far) x += Vec3(1000, -2000, 500);
  const BodySpec cube = body(read(one_element("hex20", far)), "bar");
  EXPECT_NEAR(cube.mass, 1000.0, 1e-9);
  EXPECT_NEAR((cube.position - Vec3(1000.5, -1999.5, 500.5)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((cube.inertia - 1000.0 / 6.0 * Mat3::Identity()).norm(), 0.0, 1e-6);
}

// The face y = 0 of a cube bulges by b N(x, z) with the mean value 4/9 of its shape function.
TEST_F(Feb, FaceNodesOfHex27AreThoseOfFebio) {
  std::vector<Vec3> x = cube20();
  for (const Vec3& face :
       {Vec3(0.5, 0, 0.5), Vec3(1, 0.5, 0.5), Vec3(0.5, 1, 0.5), Vec3(0, 0.5, 0.5),
        Vec3(0.5, 0.5, 0), Vec3(0.5, 0.5, 1), Vec3(0.5, 0.5, 0.5)})
    x.push_back(face);
  const double b = 0.09;
  x[20].y() -= b;
  const BodySpec cube = body(read(one_element("hex27", x)), "bar");
  EXPECT_NEAR(cube.mass, 1000.0 * (1.0 + 4.0 / 9.0 * b), 1e-9);
  EXPECT_NEAR(cube.position.x(), 0.5, 1e-12);
  EXPECT_NEAR(cube.position.z(), 0.5, 1e-12);
  EXPECT_LT(cube.position.y(), 0.5);
}

// The tetrahedron of the axes: a sixth of the cube, integrals of x^2 1/60 and of x y 1/120.
TEST_F(Feb, TetrahedraAndPrismsHaveTheirMoments) {
  std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double V = 1.0 / 6.0, second = 1.0 / 60.0 - V / 16.0, product = 1.0 / 120.0 - V / 16.0;
  const auto check = [&](const std::string& type) {
    const BodySpec tet = body(read(one_element(type, x)), "bar");
    EXPECT_NEAR(tet.mass, 1000 * V, 1e-10) << type;
    EXPECT_NEAR((tet.position - Vec3(0.25, 0.25, 0.25)).norm(), 0.0, 1e-13) << type;
    EXPECT_NEAR(tet.inertia(0, 0), 1000 * 2 * second, 1e-10) << type;
    EXPECT_NEAR(tet.inertia(0, 1), -1000 * product, 1e-10) << type;
  };
  check("tet4");
  for (const auto& e : {std::array{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}})
    x.push_back(0.5 * (x[static_cast<std::size_t>(e[0])] + x[static_cast<std::size_t>(e[1])]));
  check("tet10");
  const double third = 1.0 / 3.0;
  for (const Vec3& middle : {Vec3(third, third, 0), Vec3(third, 0, third),
                             Vec3(third, third, third), Vec3(0, third, third)})
    x.push_back(middle);
  x.emplace_back(0.25, 0.25, 0.25);
  check("tet15");
  // A face bulges by b 27 times the product of its barycentric coordinates, of the mean value 0.45.
  const double b = 0.05;
  const Vec3 out[] = {-Vec3::UnitZ(), -Vec3::UnitY(), Vec3::Ones(), -Vec3::UnitX()};
  for (std::size_t f = 0; f < 4; ++f) {
    std::vector<Vec3> bulged = x;
    bulged[10 + f] += b * out[f];
    const double more = 0.45 * b * (f == 2 ? 1.5 : 0.5);
    EXPECT_NEAR(body(read(one_element("tet15", bulged)), "bar").mass, 1000 * (V + more), 1e-10)
        << f;
  }
  std::vector<Vec3> prism{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}};
  EXPECT_NEAR(body(read(one_element("penta6", prism)), "bar").mass, 1000.0, 1e-10);
  for (const auto& e :
       {std::array{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}})
    prism.push_back(
        0.5 * (prism[static_cast<std::size_t>(e[0])] + prism[static_cast<std::size_t>(e[1])]));
  EXPECT_NEAR(body(read(one_element("penta15", prism)), "bar").mass, 1000.0, 1e-10);
  EXPECT_THAT(fault(one_element("pyra5", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}})),
              HasSubstr("pyra5 elements of a rigid body are not read"));
}

// FEBio has the inertia about a pivot at the origin, and the weight at the centre of the mesh: the
// bar falls as on a hinge, J q'^2 / 2 = m g l sin(q).
TEST_F(Feb, CentresOfMassThatArePivotsStayWhereTheFileHasThem) {
  const std::string text =
      feb(control() + tag("Material", rigid(1, "bar", tag("center_of_mass", "0,0,0"))) +
          tag("Mesh", block(1, "part", Vec3(0, -0.1, -0.2), Vec3(1, 0.1, 0.2))) +
          tag("MeshDomains", domain("part", "bar")) + tag("Rigid", fixed("bar", "111101")) +
          tag("Loads", typed("body_load", "body force", tag("force", "0,0,9.81"))));
  const Model m = read(text);
  const double J = kMoments.y() + kMass * 0.25;
  EXPECT_EQ(body(m, "bar").position, Vec3(0, 0, 0));
  EXPECT_NEAR(body(m, "bar").inertia(1, 1), J, 1e-10);
  EXPECT_THAT(notes(text),
              HasSubstr("the centre of mass of 'bar' is (0, 0, 0) in the file and (0.5, 0, 0)"));
  for (const double step : kSteps) {
    const BodyMotion bar = run(m, 0.3, step).body("bar");
    const double height = (bar.Lambda() * Vec3(0.5, 0, 0)).z();
    EXPECT_NEAR(0.5 * J * bar.omega().squaredNorm() / (kMass * 9.81), -height, error_at(step));
    EXPECT_LT(height, -0.1);
  }
}

TEST_F(Feb, FreedomsAreFixedAndPrescribed) {
  EXPECT_EQ(freedoms(with_rigid("")), 6);
  EXPECT_EQ(freedoms(with_rigid(fixed("bar", "101000"))), 4);
  EXPECT_EQ(freedoms(with_rigid(fixed("bar", "000110"))), 4);
  const auto prescribe = [](const std::string& type, const std::string& dof,
                            const std::string& value) {
    return typed("rigid_bc", type,
                 tag("rb", "2") + tag("dof", dof) + tag("value", value, "lc='1'"));
  };
  const std::string ramp = tag("LoadData", curve(1, "0,0;1,1"));
  const Model moved =
      with_rigid(fixed("bar", "011000") + prescribe("rigid_displacement", "x", "0.4"), ramp);
  EXPECT_EQ(freedoms(moved), 3);
  EXPECT_NEAR((run(moved, 0.5).body("bar").r - Vec3(0.2, 0, 0)).norm(), 0.0, 1e-10);
  const Model turned =
      with_rigid(fixed("bar", "111110") + prescribe("rigid_rotation", "Rw", "0.6"), ramp);
  EXPECT_NEAR(run(turned, 0.5).body("bar").omega().z(), 0.6, 1e-9);
  const auto together = [&](const std::string& type, const std::string& values) {
    return with_rigid(typed("rigid_bc", type, tag("rb", "bar") + values), ramp);
  };
  const Model vector =
      together("rigid_rotation_vector", tag("vx", "0.3", "lc='1'") + tag("vy", "0.4", "lc='1'"));
  EXPECT_NEAR((run(vector, 1.0).body("bar").Lambda() -
               Eigen::AngleAxisd(0.5, Vec3(0.6, 0.8, 0)).toRotationMatrix())
                  .norm(),
              0.0, 1e-9);
  // FEBio's angles are about the fixed axes x, then y, then z.
  const Model euler =
      together("rigid_euler_angles", tag("Ex", "90", "lc='1'") + tag("Ez", "90", "lc='1'"));
  const Mat3 R = run(euler, 1.0).body("bar").Lambda();
  EXPECT_NEAR((R * Vec3::UnitX() - Vec3::UnitY()).norm(), 0.0, 1e-9);
  EXPECT_NEAR((R * Vec3::UnitY() - Vec3::UnitZ()).norm(), 0.0, 1e-9);
  EXPECT_THAT(notes(two_bodies(control(), fixed("bar", "000100"))),
              HasSubstr("one rotation of 'bar' is fixed"));
  EXPECT_THAT(fault(two_bodies(control(), prescribe("rigid_rotation", "Rw", "1"), ramp)),
              HasSubstr("a rotation is prescribed while another one is free"));
}

// Constant forces and moments; a follower force F on a body that turns at w has the acceleration
// F/m (cos w t, sin w t).
TEST_F(Feb, RigidLoadsAccelerateBodies) {
  const auto load = [](const std::string& type, const std::string& inside) {
    return typed("rigid_load", type, tag("rb", "bar") + inside);
  };
  const Model pushed = with_rigid(load("rigid_force", tag("dof", "Ry") + tag("value", "8")));
  const Model turned = with_rigid(load("rigid_moment", tag("dof", "Ru") + tag("value", "3")));
  const Model target =
      with_rigid(load("rigid_force", tag("dof", "Rz") + tag("load_type", "2") + tag("value", "8")),
                 "", control("DYNAMIC", 100, 0.01));
  const double w = 2.0;
  const Model follows =
      with_rigid(typed("rigid_ic", "initial_rigid_angular_velocity",
                       tag("rb", "bar") + tag("value", "0,0,2")) +
                 load("rigid_follower_force", tag("insertion", "0,0,0") + tag("force", "8,0,0")));
  const Model twice =
      with_rigid(typed("rigid_ic", "initial_rigid_angular_velocity",
                       tag("rb", "bar") + tag("value", "0,0,2")) +
                 load("rigid_force", tag("dof", "Rx") + tag("load_type", "1") + tag("value", "8")));
  const Model moment = with_rigid(load("rigid_follower_moment", tag("moment", "0,0,3")));
  for (const double step : kSteps) {
    EXPECT_NEAR(run(pushed, 1.0, step).body("bar").r.y(), 8 / kMass / 2, error_at(step));
    EXPECT_NEAR(run(turned, 0.5, step).body("bar").omega().x(), 3 / kMoments.x() * 0.5,
                error_at(step));
    EXPECT_NEAR(run(moment, 0.5, step).body("bar").omega().z(), 3 / kMoments.z() * 0.5,
                error_at(step));
    EXPECT_NEAR(run(target, 1.0, step).body("bar").r.z(), 8 / kMass / 6, error_at(step));
    const double size = 8 / kMass / (w * w);
    for (const Model& m : {follows, twice}) {
      const BodyMotion bar = run(m, 1.0, step).body("bar");
      EXPECT_NEAR(bar.r.x(), size * (1 - std::cos(w)), error_at(step));
      EXPECT_NEAR(bar.r.y(), size * (w - std::sin(w)), error_at(step));
    }
  }
  const Model pair = with_rigid(typed("rigid_load", "rigid_axial_force",
                                      tag("rbA", "base") + tag("rbB", "bar") + tag("ra", "0,0,3") +
                                          tag("rb", "0,0,0") + tag("force", "8")));
  EXPECT_NEAR(run(pair, 1.0).body("bar").r.z(), 8 / kMass / 2, 1e-9);
}

TEST_F(Feb, BodyForcesAreMinusTheAcceleration) {
  const Model changing = with_rigid(
      "", tag("Loads", typed("body_load", "body force", tag("force", "0,0,6", "lc='1'"))) +
              tag("LoadData", curve(1, "0,0;1,1")));
  EXPECT_TRUE(changing.gravity.isZero(0.0));
  for (const double step : kSteps)
    EXPECT_NEAR(run(changing, 1.0, step).body("bar").r.z(), -1.0, error_at(step));
}

/// FEBio's rule for a value between points, written out anew: Lagrange's parabola.
double lagrange(double t, const std::array<double, 2>& a, const std::array<double, 2>& b,
                const std::array<double, 2>& c) {
  return a[1] * (t - b[0]) * (t - c[0]) / ((a[0] - b[0]) * (a[0] - c[0])) +
         b[1] * (t - a[0]) * (t - c[0]) / ((b[0] - a[0]) * (b[0] - c[0])) +
         c[1] * (t - a[0]) * (t - b[0]) / ((c[0] - a[0]) * (c[0] - b[0]));
}

TEST_F(Feb, LoadCurvesFollowFebiosRules) {
  const auto value = [&](const std::string& rule, const std::string& extend, double t) {
    const Model m = with_rigid(
        typed("rigid_load", "rigid_force",
              tag("rb", "bar") + tag("dof", "Rx") + tag("value", "2", "lc='7'")),
        tag("LoadData", curve(7, "1,1;2,3;3,2;5,4", rule, extend)), control("DYNAMIC", 1000, 0.01));
    return (*(*m.loads.at(0).vector)[0])(t) / 2;
  };
  const std::array<double, 2> p[] = {{1, 1}, {2, 3}, {3, 2}, {5, 4}};
  EXPECT_NEAR(value("LINEAR", "CONSTANT", 1.5), 2.0, 1e-14);
  EXPECT_NEAR(value("LINEAR", "CONSTANT", 0.2), 1.0, 1e-14);
  EXPECT_NEAR(value("LINEAR", "CONSTANT", 9.0), 4.0, 1e-14);
  // A step has the value of its end.
  EXPECT_NEAR(value("STEP", "CONSTANT", 0.5), 1.0, 1e-14);
  EXPECT_NEAR(value("STEP", "CONSTANT", 1.5), 3.0, 1e-14);
  EXPECT_NEAR(value("STEP", "CONSTANT", 4.0), 4.0, 1e-14);
  EXPECT_NEAR(value("SMOOTH", "CONSTANT", 1.3), lagrange(1.3, p[0], p[1], p[2]), 1e-13);
  EXPECT_NEAR(value("SMOOTH", "CONSTANT", 4.1), lagrange(4.1, p[1], p[2], p[3]), 1e-13);
  EXPECT_NEAR(value("SMOOTH", "CONSTANT", 2.25),
              0.75 * lagrange(2.25, p[0], p[1], p[2]) + 0.25 * lagrange(2.25, p[1], p[2], p[3]),
              1e-13);
  const double w = 0.25;
  EXPECT_NEAR(value("SMOOTH STEP", "CONSTANT", 2.25), 3 - w * w * w * (10 - 15 * w + 6 * w * w),
              1e-13);
  EXPECT_NEAR(value("LINEAR", "EXTRAPOLATE", 0.5), 0.0, 1e-13);
  EXPECT_NEAR(value("LINEAR", "EXTRAPOLATE", 7.0), 6.0, 1e-13);
  const double d = 0.004;  // A thousandth of the curve.
  EXPECT_NEAR(value("SMOOTH", "EXTRAPOLATE", 8.0),
              4 + 3 * (4 - lagrange(5 - d, p[1], p[2], p[3])) / d, 1e-9);
  EXPECT_NEAR(value("LINEAR", "REPEAT", 5.5), 2.0, 1e-13);
  EXPECT_NEAR(value("LINEAR", "REPEAT", 9.5), 2.0, 1e-13);
  EXPECT_NEAR(value("LINEAR", "REPEAT", 0.5), 3.5, 1e-13);
  EXPECT_NEAR(value("LINEAR", "REPEAT OFFSET", 9.5), 2.0 + 6.0, 1e-13);
  EXPECT_NEAR(value("STEP", "REPEAT OFFSET", 5.5), 3.0 + 3.0, 1e-13);
}

TEST_F(Feb, ExpressionsAreThoseOfAModelFile) {
  std::string unknown;
  EXPECT_EQ(io::expression_of_feb("2*H(t-1)*ln(t+1e-3)^2", unknown),
            "2*step(t-1, 0)*log(t+1e-3)^2");
  EXPECT_EQ(io::expression_of_feb("log(t)/PI", unknown), "log10(t)/pi");
  EXPECT_EQ(io::expression_of_feb("2*x", unknown), "");
  EXPECT_EQ(unknown, "x");
  EXPECT_EQ(io::expression_of_feb("t;1", unknown), "");
}

TEST_F(Feb, AnalysesHaveTheirStepsAndDamping) {
  const auto analysis = [&](const std::string& text) { return with_rigid("", "", text).analysis; };
  const auto plain =
      analysis(control("DYNAMIC", 200, 0.01, typed("solver", "solid", tag("rhoi", "0.8"))));
  EXPECT_EQ(plain.duration, 2.0);
  EXPECT_EQ(plain.step, 0.01);
  EXPECT_EQ(plain.rho_inf, 0.8);
  const std::string automatic =
      control("DYNAMIC", 10, 0.1, typed("time_stepper", "default", tag("dtmax", "0.05", "lc='3'")));
  const Model stepped =
      with_rigid("", tag("LoadData", curve(3, "0,0.02;0.5,0.03;1,0.04", "STEP")), automatic);
  EXPECT_EQ(stepped.analysis.max_step, 0.04);
  EXPECT_EQ(stepped.output.every, 0.5);
  EXPECT_THAT(notes(two_bodies(automatic, "", tag("LoadData", curve(3, "0,0.02;0.5,0.03;1,0.04")))),
              HasSubstr("the time stepper becomes automatic steps"));
}

// A body on a spring in statics: 8 N stretch it by 8 / 100, following the curve of the load.
TEST_F(Feb, StaticsFollowsTheCurvesOfLoads) {
  const Model m =
      with_rigid(fixed("bar", "110111") +
                     typed("rigid_load", "rigid_force",
                           tag("rb", "bar") + tag("dof", "Rz") + tag("value", "8", "lc='1'")) +
                     connector("rigid spring", tag("k", "100") + tag("insertion_a", "0,0,-1") +
                                                   tag("insertion_b", "0,0,0")),
                 tag("LoadData", curve(1, "0,0;1,1;2,0.5")), control("STATIC", 20, 0.1));
  EXPECT_EQ(m.analysis.type, "statics");
  EXPECT_EQ(m.analysis.history, 2.0);
  EXPECT_EQ(m.analysis.load_steps, 20);
  EXPECT_EQ(m.output.every, 0.1);
}

TEST_F(Feb, ConvertedModelsHaveTheSameBits) {
  const std::string path =
      write("model.feb",
            two_bodies(control("DYNAMIC", 100, 0.01),
                       connector("rigid revolute joint",
                                 tag("joint_origin", "-0.5,0,0") + tag("rotation_axis", "0,1,0.3")),
                       tag("Loads", typed("body_load", "body force", tag("force", "0.1,0,9.81")))));
  const Model converted =
      io::read_model_text(io::expanded_model(path, io::Overrides{}).text, "converted.yaml");
  const Simulation a = run(io::read_model(path), 0.5), b = run(converted, 0.5);
  EXPECT_EQ(a.body("bar").r, b.body("bar").r);
  EXPECT_EQ(a.body("bar").omega(), b.body("bar").omega());
  EXPECT_GT(a.body("bar").omega().norm(), 1.0);
}

TEST_F(Feb, SectionsOfTheOnlyStepCount) {
  const Model m = read(feb(
      tag("Material", rigid(1, "bar")) + tag("Mesh", block(1, "p", Vec3(0, 0, 0), Vec3(1, 1, 1))) +
      tag("MeshDomains", domain("p", "bar")) +
      tag("Step", tag("step",
                      control("DYNAMIC", 10, 0.1) + tag("Rigid", fixed("bar", "111000")) +
                          tag("Loads", typed("body_load", "const", tag("z", "9"))),
                      "id='1' name='s'"))));
  EXPECT_EQ(freedoms(m), 3);
  EXPECT_EQ(m.gravity, Vec3(0, 0, -9));
}

TEST_F(Feb, RequestsForTheLogFileBecomeProbes) {
  const auto request = [](const std::string& kind, const std::string& data,
                          const std::string& items) {
    return tag(kind, items, "data='" + data + "' file='log.txt'");
  };
  const std::string text = two_bodies(
      control(), connector("rigid revolute joint", tag("rotation_axis", "0,1,0")),
      tag("Output", tag("plotfile", "", "type='febio'") +
                        tag("logfile", request("rigid_body_data", "x;y;z;qx;qy;qz;qw;omx", "2") +
                                           request("rigid_connector_data", "RCFx", "") +
                                           request("node_data", "ux", "7") +
                                           request("element_data", "sx", "1"))));
  const Model m = read(text);
  ASSERT_EQ(m.output.probes.size(), 3u);
  EXPECT_EQ(m.output.probes[0].name, "bar");
  EXPECT_EQ(m.output.probes[1].name, "link");
  EXPECT_EQ(m.output.probes[2].name, "node_7");
  const std::string said = notes(text);
  EXPECT_THAT(said, HasSubstr("requests for the log file become probes"));
  EXPECT_THAT(said, HasSubstr("<element_data> of the log file is in the frames of results.h5"));
  EXPECT_THAT(fault(two_bodies(control(), "",
                               tag("Output", tag("logfile", request("node_data", "x", "70"))))),
              HasSubstr("there is no node 70"));
}

TEST_F(Feb, WhatIsNotReadIsSaid) {
  const auto says = [&](const std::string& section) {
    return fault(two_bodies(control(), "", section));
  };
  EXPECT_THAT(says(tag("Constraints", tag("constraint", ""))),
              HasSubstr("<Constraints> is not read"));
  EXPECT_THAT(notes(two_bodies(control(), "", tag("Constraints", tag("constraint", ""))),
                    {"import.allow_partial=true"}),
              HasSubstr("left out: <Constraints> is not read"));
  EXPECT_THAT(notes(two_bodies(control(), "", tag("Odd", ""))),
              HasSubstr("<Odd> in <febio_spec> is unknown"));
  EXPECT_THAT(fault(two_bodies(control(), typed("rigid_load", "rigid_cable", ""))),
              HasSubstr("the rigid_cable has no points"));
  EXPECT_THAT(fault(feb(control() + tag("Material", typed("material", "biphasic", "")))),
              HasSubstr("of type 'biphasic' is not read"));
}

TEST_F(Feb, BrokenFilesAreErrorsWithTheirLines) {
  EXPECT_THAT(fault("<febio_spec version='2.5'/>"),
              HasSubstr("the version '2.5' of FEBio's format is not read"));
  EXPECT_THAT(fault("<robot/>"), HasSubstr("<robot>, not <febio_spec>"));
  EXPECT_THAT(fault(feb("")), HasSubstr("the file has no <Control>"));
  const std::string whole = two_bodies(control(), fixed("bar", "100000"));
  for (std::size_t size = 1; size + 2 < whole.size(); size += 97)
    EXPECT_THAT(fault(whole.substr(0, size)), HasSubstr("error: ")) << size;
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    const std::size_t at = text.find(from);
    if (at == std::string::npos) return std::string("no " + from);
    return fault(text.replace(at, from.size(), to));
  };
  EXPECT_THAT(replaced("-0.5,-0.1,-0.2", "-0.5,nan,-0.2"),
              HasSubstr("<node> is '-0.5,nan,-0.2', not 3 numbers"));
  EXPECT_THAT(replaced("-0.5,-0.1,-0.2", "-0.5,1e999,1"), HasSubstr("not 3 numbers"));
  EXPECT_THAT(replaced("1,2,3,4,5,6,7,8", "1,2,3,4,5,6,7,9"), HasSubstr("there is no node 9"));
  EXPECT_THAT(replaced("1,2,3,4,5,6,7,8", "1,2,3,4,5,6,7"), HasSubstr("has 7 nodes, not 8"));
  EXPECT_THAT(replaced("1,2,3,4,5,6,7,8", "1:99999999"), HasSubstr("more than 5000000 numbers"));
  EXPECT_THAT(replaced("1,2,3,4,5,6,7,8", "5,6,7,8,1,2,3,4"),
              HasSubstr("the element 1 is inverted"));
  EXPECT_THAT(replaced("<node id='2'", "<node id='1'"), HasSubstr("the node 1 stands twice"));
  EXPECT_THAT(replaced("name='bar'", "name='base'"), HasSubstr("the material 'base' stands twice"));
  EXPECT_THAT(replaced("hex8", "hex9"), HasSubstr("the type of elements 'hex9' is not known"));
  EXPECT_THAT(replaced("name='part' mat", "name='prt' mat"),
              HasSubstr("there are no elements 'prt'"));
  EXPECT_THAT(replaced("<rb>bar", "<rb>bra"), HasSubstr("Did you mean 'bar'"));
  EXPECT_THAT(replaced(">1000<", ">1e400<"), HasSubstr("not a number"));
  EXPECT_THAT(replaced("<time_steps>1000", "<time_steps>1e30"),
              HasSubstr("Give 1 to 1000000000 steps"));
  EXPECT_THAT(replaced("<step_size>0.001", "<step_size>-1"),
              HasSubstr("<step_size> of <Control> is -1"));
  EXPECT_THAT(fault(two_bodies(control(), typed("rigid_load", "rigid_force",
                                                tag("rb", "bar") + tag("dof", "Rx") +
                                                    tag("value", "1", "lc='4'")))),
              HasSubstr("there is no load controller 4"));
  EXPECT_THAT(
      fault(two_bodies(control(),
                       typed("rigid_load", "rigid_force",
                             tag("rb", "bar") + tag("dof", "Rx") + tag("value", "1", "lc='1'")),
                       tag("LoadData", curve(1, "0,0;1e-9,1", "LINEAR", "REPEAT")))),
      HasSubstr("more than 100000 points"));
  EXPECT_THAT(fault(two_bodies(control(), "", tag("LoadData", curve(1, "0,0") + curve(1, "0,0")))),
              HasSubstr("the load controller 1 stands twice"));
}

}  // namespace
}  // namespace polhode::feb_tests
