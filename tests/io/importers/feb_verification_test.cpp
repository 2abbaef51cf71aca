// SPDX-License-Identifier: Apache-2.0
// Problems of FEBio's own verification suite with rigid bodies, in files of ours, with its figures:
// the norm of all displacements of free nodes and of displacements and rotation vectors of rigid
// bodies at the end.
// Definitions and figures: github.com/febiosoftware/TestSuite, Verify4 and
// code/linuxGoldStandards.py.
#include <map>

#include "feb_fixture.hpp"

namespace polhode::feb_verification_tests {
namespace {

using namespace feb_tests;

/// FEBio's penalty joints stay open by up to their tolerances, 1e-4 of 100 and more.
constexpr double kOpen = 1e-6;

class FebVerification : public FebFixture {
 protected:
  /// FEBio's figure of a file at its end, with rotations beyond half a turn.
  double figure(const std::string& text, double step = 0.0) {
    Model model = read(text);
    const bool dynamic = model.analysis.type == "dynamics";
    const double end = dynamic ? model.analysis.duration : *model.analysis.history;
    if (dynamic && step > 0.0) model.analysis.step = step;
    std::vector<std::string> names;
    for (const BodySpec& b : model.bodies) names.push_back(b.name);
    Simulation simulation(std::move(model));
    std::map<std::string, BodyMotion> start;
    std::map<std::string, Vec3> turn;
    for (const std::string& name : names) start[name] = simulation.body(name);
    const std::vector<double> at_start = simulation.state().node_x;
    while (simulation.time() < end * (1.0 - 1e-9)) {
      simulation.step(end);
      for (const std::string& name : names)
        turn[name] = next_to(turn[name], simulation.body(name).q * start[name].q.conjugate());
    }
    double sum = 0.0;
    for (const std::string& name : names)
      sum += (simulation.body(name).r - start[name].r).squaredNorm() + turn[name].squaredNorm();
    const Nodes& nodes = simulation.system().nodes();
    for (int n = 0; n < nodes.count(); ++n)
      for (int k = 0; k < 3; ++k)
        if (nodes.unknown(n, k) >= 0) {
          const auto i = static_cast<std::size_t>(3 * n + k);
          sum += std::pow(simulation.state().node_x[i] - at_start[i], 2);
        }
    return std::sqrt(sum);
  }

 private:
  /// The rotation vector of a rotation that is next to one before.
  static Vec3 next_to(const Vec3& before, const Quat& q) {
    const Eigen::AngleAxisd turn(q);
    Vec3 best = turn.angle() * turn.axis();
    for (int k = -3; k <= 3; ++k) {
      const Vec3 other = (turn.angle() + 2.0 * 3.14159265358979323846 * k) * turn.axis();
      if ((other - before).norm() < (best - before).norm()) best = other;
    }
    return best;
  }
};

std::string made(int id, const std::string& name, const std::string& density,
                 const std::string& com = "") {
  return tag("material", tag("density", density) + (com.empty() ? "" : tag("center_of_mass", com)),
             format("id='{}' name='{}' type='rigid body'", id, name));
}
std::string joint(const std::string& type, const std::string& a, const std::string& b,
                  const std::string& origin, const std::string& more, const std::string& name) {
  return tag("rigid_connector",
             tag("body_a", a) + tag("body_b", b) + tag("joint_origin", origin) + more,
             "name='" + name + "' type='" + type + "'");
}
std::string axis(const char* kind, const char* direction) { return tag(kind, direction); }

/// Control of a dynamic analysis with a spectral radius.
std::string damped(int steps, double step, const std::string& rho) {
  return control("DYNAMIC", steps, step, typed("solver", "solid", tag("rhoi", rho)));
}

// dy01 and dy05: a cube falls for a second, deformable and rigid.
TEST_F(FebVerification, CubesFall) {
  const std::string fall = tag("Loads", typed("body_load", "const", tag("z", "1", "lc='1'"))) +
                           tag("LoadData", curve(1, "0,1;1,1"));
  const auto cube = [&](const std::string& material) {
    return feb(control("DYNAMIC", 10, 0.1) + tag("Material", material) +
               tag("Mesh", block(1, "part", Vec3(-0.5, -0.5, 0), Vec3(0.5, 0.5, 1))) +
               tag("MeshDomains", domain("part", "m")) + fall);
  };
  EXPECT_NEAR(figure(cube(tag("material", tag("density", "1000") + tag("E", "1") + tag("v", "0"),
                              "id='1' name='m' type='neo-Hookean'"))),
              1.41421356237, 1e-9);
  EXPECT_NEAR(figure(cube(made(1, "m", "1"))), 0.5, 1e-9);
}

// rj01: a four-bar linkage of two sliders, by 360 of a link of 150.
TEST_F(FebVerification, AFourBarLinkage) {
  const std::string text = feb(
      control("STATIC", 80, 0.01) +
      tag("Material", made(1, "slider1", "1e-9") + made(2, "slider2", "1e-9") +
                          made(3, "link", "1e-9") + made(4, "ground", "1", "0,0,0")) +
      tag("Mesh", block(1, "p2", Vec3(-12, -12, 0), Vec3(12, 12, 2)) +
                      block(11, "p1", Vec3(-165, -10, 0), Vec3(-135, 10, 2)) +
                      block(21, "p3", Vec3(-150, -5, 2), Vec3(0, 5, 4))) +
      tag("MeshDomains", domain("p1", "slider1") + domain("p2", "slider2") + domain("p3", "link")) +
      tag("Rigid",
          fixed("ground", "111111") +
              joint("rigid prismatic joint", "ground", "slider1", "-150,0,2",
                    axis("translation_axis", "1,0,0") + tag("prescribed_translation", "1") +
                        tag("translation", "1", "lc='1'"),
                    "j1") +
              joint("rigid prismatic joint", "ground", "slider2", "0,0,2",
                    axis("translation_axis", "1,1,0"), "j2") +
              joint("rigid revolute joint", "slider1", "link", "-150,0,2",
                    axis("rotation_axis", "0,0,1"), "j3") +
              joint("rigid revolute joint", "slider2", "link", "0,0,2",
                    axis("rotation_axis", "0,0,1"), "j4")) +
      tag("LoadData", curve(1, "0,0;1,450")));
  EXPECT_NEAR(figure(text), 468.620212024, kOpen * 468.62);
}

// rj04: a slider-crank of arms 30 and 90, driven once around.
TEST_F(FebVerification, ASliderCrank) {
  const std::string hinge = axis("rotation_axis", "0,0,1");
  const std::string text = feb(
      damped(72, 0.5, "0") +
      tag("Material", made(1, "ground", "1e-9", "0,0,0") + made(2, "crank", "1e-9", "0,0,0") +
                          made(3, "conrod", "1e-9") + made(4, "slider", "1e-9")) +
      tag("Mesh", block(1, "p1", Vec3(0, -5, 0), Vec3(30, 5, 2)) +
                      block(11, "p2", Vec3(30, -5, -2), Vec3(120, 5, 0)) +
                      block(21, "p3", Vec3(105, -10, 0), Vec3(135, 10, 2))) +
      tag("MeshDomains", domain("p1", "crank") + domain("p2", "conrod") + domain("p3", "slider")) +
      tag("Rigid",
          fixed("ground", "111111") +
              joint("rigid revolute joint", "ground", "crank", "0,0,0",
                    hinge + tag("prescribed_rotation", "1") + tag("rotation", "1", "lc='1'"),
                    "j1") +
              joint("rigid revolute joint", "crank", "conrod", "30,0,0", hinge, "j2") +
              joint("rigid revolute joint", "conrod", "slider", "130,0,0", hinge, "j3") +
              joint("rigid prismatic joint", "ground", "slider", "0,0,0",
                    axis("translation_axis", "1,0,0"), "j4")) +
      tag("LoadData", curve(1, "0,0;36,6.283185307", "SMOOTH")));
  EXPECT_NEAR(figure(text), 6.283185307, 1e-8);
}

/// rj08 and rj09: a slider on a spring, pulled by a force of 1 or moved by 1.
std::string slider(const std::string& bodies, const std::string& more) {
  return feb(control("STATIC", 10, 0.1) +
             tag("Material", made(1, "ground", "1", "0,0,0") + made(2, "slider", "1")) +
             tag("Mesh", block(1, "p1", Vec3(-0.5, -0.5, 0), Vec3(0.5, 0.5, 1))) +
             tag("MeshDomains", domain("p1", "slider")) +
             tag("Rigid", fixed("ground", "111111") +
                              tag("rigid_connector",
                                  bodies + tag("joint_origin", "0,0,0") +
                                      axis("translation_axis", "0,0,1") + more,
                                  "name='j' type='rigid prismatic joint'") +
                              tag("rigid_connector",
                                  tag("body_a", "ground") + tag("body_b", "slider") +
                                      tag("k", "1") + tag("insertion_a", "0,0,1") +
                                      tag("insertion_b", "0,0,3") + tag("free_length", "0"),
                                  "name='s' type='rigid spring'")) +
             tag("LoadData", curve(1, "0,0;1,1")));
}
TEST_F(FebVerification, ASliderOnASpring) {
  EXPECT_NEAR(figure(slider(tag("body_a", "slider") + tag("body_b", "ground"),
                            tag("force", "1", "lc='1'"))),
              1.0, 1e-9);
  // FEBio's joint is open by 1e-7.
  EXPECT_NEAR(
      figure(slider(tag("body_a", "ground") + tag("body_b", "slider"),
                    tag("prescribed_translation", "1") + tag("translation", "1", "lc='1'"))),
      0.9999999001, 2e-7);
}

/// rj11 and rj12: a mass on a spring under a sudden weight, without and with a damper.
std::string oscillator(const std::string& damper) {
  const std::string ends = tag("body_a", "ground") + tag("body_b", "mass") +
                           tag("insertion_a", "0,0,0") + tag("insertion_b", "0,0,2");
  return feb(
      damped(1000, 0.001, "0.5") +
      tag("Material", made(1, "ground", "1e-9", "0,0,0") + made(2, "mass", "1e-9")) +
      tag("Mesh", block(1, "p", Vec3(-2, -0.5, 2), Vec3(2, 0.5, 3))) +
      tag("MeshDomains", domain("p", "mass")) +
      tag("Rigid", fixed("ground", "111111") + fixed("mass", "110111") +
                       tag("rigid_connector", ends + tag("k", "3.924e-5") + tag("free_length", "0"),
                           "name='s' type='rigid spring'") +
                       damper) +
      tag("Loads", typed("body_load", "const", tag("z", "-9810", "lc='1'"))) +
      tag("LoadData", curve(1, "0,0;1,1", "STEP")));
}
TEST_F(FebVerification, AMassOnASpring) {
  const double omega = std::sqrt(9810.0);
  // FEBio's figure is that of its step, from which the closed form differs by 0.14.
  const double exact = 1.0 - std::cos(omega);
  EXPECT_NEAR(figure(oscillator("")), 1.05212853531, 0.02);
  EXPECT_NEAR(figure(oscillator(""), 1e-4), exact, 2e-3);
  EXPECT_NEAR(figure(oscillator(""), 1e-5), exact, 2e-5);
  const std::string damper =
      tag("rigid_connector",
          tag("body_a", "ground") + tag("body_b", "mass") + tag("insertion_a", "0,0,0") +
              tag("insertion_b", "0,0,2") + tag("c", "1e-7"),
          "name='d' type='rigid damper'");
  for (const double step : {1e-3, 1e-4})
    EXPECT_NEAR(figure(oscillator(damper), step), 1.00000322842, 1e-5) << step;
}

// rj15: a knee of three cylindrical joints after Grood and Suntay.
TEST_F(FebVerification, AKneeOfThreeCylindricalJoints) {
  const auto sleeve = [](const char* a, const char* b, const char* direction, int first,
                         const char* shift, const char* name) {
    return joint("rigid cylindrical joint", a, b, "0,0,0",
                 tag("joint_axis", direction) + tag("prescribed_translation", "1") +
                     tag("translation", shift, format("lc='{}'", first)) +
                     tag("prescribed_rotation", "1") +
                     tag("rotation", "1.5708", format("lc='{}'", first + 1)),
                 name);
  };
  const std::string text = feb(
      control("STATIC", 70, 0.1) +
      tag("Material", made(1, "femur", "1", "0,0,0") + made(2, "tibia", "1", "0,0,0") +
                          made(3, "link1", "1", "0,0,0") + made(4, "link2", "1", "0,0,0")) +
      tag("Mesh", block(11, "p2", Vec3(-1, -10, -0.5), Vec3(1, 0, 0.5)) +
                      block(21, "p3", Vec3(-1.5, -0.25, -0.25), Vec3(1.5, 0.25, 0.25)) +
                      block(31, "p4", Vec3(-0.25, -0.25, -1), Vec3(0.25, 0.25, 1))) +
      tag("MeshDomains", domain("p2", "tibia") + domain("p3", "link1") + domain("p4", "link2")) +
      tag("Rigid", fixed("femur", "111111") + sleeve("femur", "link1", "1,0,0", 1, "1", "j1") +
                       sleeve("link1", "link2", "0,0,1", 3, "1", "j2") +
                       sleeve("link2", "tibia", "0,1,0", 5, "-1", "j3")) +
      tag("LoadData", curve(1, "0,0;0.2,1;0.8,-1;1,0;6,0;6.2,1;6.8,-1;7,0") +
                          curve(2, "1,0;1.5,1;2,0;6,0;6.5,1;7,1") +
                          curve(3, "2,0;2.2,1;2.8,-1;3,0;6,0;6.2,1;6.8,-1;7,0") +
                          curve(4, "3,0;3.2,0.5;3.8,-0.5;4,0;6,0;6.5,0;7,0.5") +
                          curve(5, "4,0;4.5,1;5,0;6,0;6.5,1;7,0") +
                          curve(6, "5,0;5.2,0.5;5.8,-0.5;6,0;6.5,0;6.8,0;7,0")));
  EXPECT_NEAR(figure(text), 2.89290803522, 1e-7);
}

// rj14: a block slides on an incline of 30 degrees, held by a spring in its plane.
TEST_F(FebVerification, ABlockOnAnIncline) {
  const Vec3 up(0, -0.5, 0.8660254), along(0, 0.8660254, 0.5);
  const Vec3 corner(1.75, 3.4640973, 1.9999973);
  std::string nodes, list;
  int id = 0;
  for (const auto& [a, b, c] : std::vector<std::array<int, 3>>{{0, 0, 0},
                                                               {1, 0, 0},
                                                               {1, 1, 0},
                                                               {0, 1, 0},
                                                               {0, 0, 1},
                                                               {1, 0, 1},
                                                               {1, 1, 1},
                                                               {0, 1, 1}}) {
    const Vec3 x = corner + a * Vec3::UnitX() + b * along + c * up;
    nodes += tag("node", format("{},{},{}", x.x(), x.y(), x.z()), format("id='{}'", ++id));
    list += format("{}{}", id > 1 ? "," : "", id);
  }
  const std::string text = feb(
      damped(1000, 0.01, "0.5") +
      tag("Material", made(1, "plane", "1", "0,0,0") + made(2, "block", "1")) +
      tag("Mesh", tag("Nodes", nodes) +
                      tag("Elements", tag("elem", list, "id='1'"), "type='hex8' name='p'")) +
      tag("MeshDomains", domain("p", "block")) +
      tag("Rigid",
          fixed("plane", "111111") +
              joint("rigid planar joint", "plane", "block", "0,0,0",
                    tag("rotation_axis", "0,-0.5,0.8660254") + tag("translation_axis_1", "1,0,0"),
                    "j") +
              tag("rigid_connector",
                  tag("body_a", "plane") + tag("body_b", "block") + tag("k", "3") +
                      tag("insertion_a", "0,3.8971143,2.25") +
                      tag("insertion_b", "1.75,3.8971143,2.25") + tag("free_length", "0"),
                  "name='s' type='rigid spring'")) +
      tag("Loads", typed("body_load", "const", tag("z", "1", "lc='1'"))) +
      tag("LoadData", curve(1, "0,0;1,9.81", "STEP")));
  // FEBio's figure is that of its step, from which the limit differs by 0.06.
  const double coarse = figure(text), fine = figure(text, 1e-3);
  EXPECT_NEAR(coarse, 6.57565262489, 0.02);
  EXPECT_NEAR(figure(text, 1e-4), fine + (fine - coarse) / 99.0, 1e-4);
}

/// Nodes and hexahedra of a beam of equal cells along x.
std::string cells(int first, const std::string& name, const Vec3& from, const Vec3& size,
                  const std::array<int, 3>& count) {
  std::string nodes, elements;
  const auto number = [&](int i, int j, int k) {
    return first + (k * (count[1] + 1) + j) * (count[0] + 1) + i;
  };
  for (int k = 0; k <= count[2]; ++k)
    for (int j = 0; j <= count[1]; ++j)
      for (int i = 0; i <= count[0]; ++i)
        nodes += tag("node",
                     format("{},{},{}", from.x() + size.x() * i / count[0],
                            from.y() + size.y() * j / count[1], from.z() + size.z() * k / count[2]),
                     format("id='{}'", number(i, j, k)));
  int id = first;
  for (int k = 0; k < count[2]; ++k)
    for (int j = 0; j < count[1]; ++j)
      for (int i = 0; i < count[0]; ++i)
        elements += tag(
            "elem",
            format("{},{},{},{},{},{},{},{}", number(i, j, k), number(i + 1, j, k),
                   number(i + 1, j + 1, k), number(i, j + 1, k), number(i, j, k + 1),
                   number(i + 1, j, k + 1), number(i + 1, j + 1, k + 1), number(i, j + 1, k + 1)),
            format("id='{}'", id++));
  return tag("Nodes", nodes) + tag("Elements", elements, "type='hex8' name='" + name + "'");
}
/// Numbers of the nodes of such a beam at one end.
std::string end_of(int first, const std::array<int, 3>& count, int i) {
  std::string list;
  for (int k = 0; k <= count[2]; ++k)
    for (int j = 0; j <= count[1]; ++j)
      list += format("{}{}", list.empty() ? "" : ",",
                     first + (k * (count[1] + 1) + j) * (count[0] + 1) + i);
  return list;
}
std::string held(const std::string& set, const std::string& components) {
  std::string inside;
  for (int k = 0; k < 3; ++k)
    inside += tag(std::string(1, "xyz"[k]) + "_dof",
                  std::string(1, components[static_cast<std::size_t>(k)]));
  return tag("bc", inside, "type='zero displacement' node_set='" + set + "'");
}
/// Nodes of a set that a body carries.
std::string attached(const std::string& set, const std::string& rigid_body) {
  return tag("bc", tag("rb", rigid_body), "type='rigid' node_set='" + set + "'");
}
std::string soft() {
  return tag("material", tag("density", "1") + tag("E", "1") + tag("v", "0"),
             "id='1' name='soft' type='neo-Hookean'");
}

// ri01: a rigid body pulls a bar of 8 x 2 x 2 elements with a force of 0.05.
TEST_F(FebVerification, ARigidBodyPullsABar) {
  const std::array<int, 3> count{8, 2, 2};
  const std::string text =
      feb(control("STATIC", 10, 0.1) + tag("Material", soft() + made(2, "grip", "1")) +
          tag("Mesh", cells(1, "bar", Vec3(-2, -0.5, 0), Vec3(4, 1, 1), count) +
                          block(201, "g", Vec3(2, -0.5, 0), Vec3(3, 0.5, 1)) +
                          tag("NodeSet", end_of(1, count, 0), "name='left'") +
                          tag("NodeSet", end_of(1, count, 8), "name='right'")) +
          tag("MeshDomains", domain("bar", "soft") + domain("g", "grip")) +
          tag("Boundary", held("left", "111") + attached("right", "grip")) +
          tag("Rigid", typed("rigid_load", "rigid_force",
                             tag("rb", "grip") + tag("dof", "Rx") + tag("value", "1", "lc='1'"))) +
          tag("LoadData", curve(1, "0,0;1,0.05")));
  EXPECT_NEAR(figure(text), 0.93239783082, 1e-9);
}

}  // namespace
}  // namespace polhode::feb_verification_tests
