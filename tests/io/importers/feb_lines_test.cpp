// SPDX-License-Identifier: Apache-2.0
// Solids of several materials, ties, and springs, trusses and cables, in files of FEBio.
#include <cmath>

#include <polhode/compile/build_solids.hpp>
#include <polhode/compile/solid_point.hpp>

#include "feb_fixture.hpp"

namespace polhode::feb_lines_tests {
namespace {

using namespace feb_tests;

using testing::HasSubstr;

/// Square faces of 1 m across x, with four nodes each from this number on.
std::string face(int first, double x) {
  static const double y[] = {0, 1, 1, 0}, z[] = {0, 0, 1, 1};
  std::string nodes;
  for (int k = 0; k < 4; ++k)
    nodes += tag("node", format("{},{},{}", x, y[k], z[k]), format("id='{}'", first + k));
  return tag("Nodes", nodes);
}
/// A cube between two faces.
std::string cube(int id, const std::string& name, int from, int to) {
  std::string list;
  for (int k = 0; k < 8; ++k) list += format("{}{}", k > 0 ? "," : "", (k < 4 ? from : to - 4) + k);
  return tag("Elements", tag("elem", list, format("id='{}'", id)),
             "type='hex8' name='" + name + "'");
}
std::string quad(const std::string& name, int first) {
  return tag("Surface",
             tag("quad4", format("{},{},{},{}", first, first + 1, first + 2, first + 3), "id='1'"),
             "name='" + name + "'");
}
std::string elastic(int id, const std::string& name, double modulus) {
  return tag("material", tag("density", "1000") + tag("E", format("{}", modulus)) + tag("v", "0"),
             format("id='{}' name='{}' type='isotropic elastic'", id, name));
}
std::string zero(const std::string& set, const std::string& components) {
  std::string inside;
  for (int k = 0; k < 3; ++k)
    inside += tag(std::string(1, "xyz"[k]) + "_dof",
                  std::string(1, components[static_cast<std::size_t>(k)]));
  return tag("bc", inside, "type='zero displacement' node_set='" + set + "' name='" + set + "_0'");
}
const std::string kRamp = tag("LoadData", curve(1, "0,0;1,1"));

constexpr double kSoft = 1e6, kHard = 4e6;

/// Two cubes behind each other, held at x = 0, whose end is moved by 0.3 m.
/// @param tied  Their faces at x = 1 have nodes of their own, at this distance.
std::string stretched(bool tied, double apart = 0.0, const std::string& more = "") {
  const int second = tied ? 21 : 5;
  return feb(
      control("STATIC", 10, 0.1) +
      tag("Material", elastic(1, "soft", kSoft) + elastic(2, "hard", kHard)) +
      tag("Mesh",
          face(1, 0) + face(5, 1) + face(9, 2) + (tied ? face(21, 1 + apart) : "") +
              cube(1, "one", 1, 5) + cube(2, "two", second, 9) +
              tag("NodeSet", "1,2,3,4", "name='wall'") +
              tag("NodeSet", "9,10,11,12", "name='end'") +
              (tied ? tag("NodeSet", "5,21", "name='both'") : "") + quad("a", 5) +
              quad("b", second) +
              tag("SurfacePair", tag("primary", "a") + tag("secondary", "b"), "name='pair'")) +
      tag("MeshDomains", domain("one", "soft") + domain("two", "hard")) +
      tag("Boundary", zero("wall", "111") + zero("end", "011") +
                          tag("bc", tag("dof", "x") + tag("value", "0.3", "lc='1'"),
                              "type='prescribed displacement' node_set='end' name='pull'")) +
      (tied ? tag("Contact", tag("contact", "", "type='tied-elastic' name='t' surface_pair='pair'"))
            : "") +
      kRamp + more);
}

/// Force per area of a bar of a stretch, and the stretch at a force by bisection.
double stress(double modulus, double stretch) {
  return modulus * stretch * (stretch * stretch - 1.0) / 2.0;
}
double root(const std::function<double(double)>& f, double low, double high) {
  for (int k = 0; k < 100; ++k) (f(0.5 * (low + high)) > 0 ? high : low) = 0.5 * (low + high);
  return low;
}

class FebLines : public FebFixture {
 protected:
  static Simulation solved(const Model& model) {
    Simulation simulation(model);
    const RunSummary done = simulation.run();
    EXPECT_EQ(done.end, RunEnd::finished) << done.message;
    return simulation;
  }
  static Vec3 at(const Simulation& s, const Vec3& X) {
    return s.solid_point(0, solid_point("", s.solids()[0].plan.mesh, X))[0];
  }
};

// The middle moves so that both have the same force; the tie is that of shared nodes.
TEST_F(FebLines, SolidsOfTwoMaterialsShareTheirNodes) {
  const double middle =
      root([](double x) { return stress(kSoft, 1 + x) - stress(kHard, 1.3 - x); }, 0.0, 0.3);
  for (const bool tied : {false, true}) {
    const Model model = read(stretched(tied));
    ASSERT_EQ(model.solids.size(), 1u);
    ASSERT_EQ(model.solids[0].regions.size(), 1u);
    EXPECT_EQ(model.solids[0].material, "soft");
    EXPECT_EQ(model.solids[0].regions[0].material, "hard");
    const Simulation s = solved(model);
    EXPECT_NEAR(at(s, Vec3(1, 0.5, 0.5)).x(), 1 + middle, 1e-9) << tied;
    EXPECT_NEAR(s.interface_reaction(0, 0).force.x(), -stress(kSoft, 1 + middle), 1e-3) << tied;
  }
}

TEST_F(FebLines, TiesNeedNodesThatCoincide) {
  EXPECT_THAT(fault(stretched(true, 0.01)),
              HasSubstr("a tie between two solids whose nodes do not coincide"));
  EXPECT_THAT(fault(stretched(true, 0.0,
                              tag("Loads", tag("nodal_load", tag("dof", "y") + tag("scale", "1"),
                                               "type='nodal_load' node_set='both'")))),
              HasSubstr("on both nodes of a tied pair"));
}

// Hexahedra have FEBio's strains beside other cells, too, in regions of their own.
TEST_F(FebLines, HexahedraBesideOthersKeepTheirKind) {
  const std::string wedge = tag(
      "Elements", tag("elem", "5,6,8,9,10,12", "id='2'") + tag("elem", "6,7,8,10,11,12", "id='3'"),
      "type='penta6' name='two'");
  std::string text = stretched(false);
  const std::string old = cube(2, "two", 5, 9);
  text.replace(text.find(old), old.size(), wedge);
  const Model model = read(text);
  EXPECT_EQ(model.solids[0].element, "");
  ASSERT_EQ(model.solids[0].regions.size(), 1u);
  EXPECT_EQ(model.solids[0].regions[0].element, "hex8_standard");
  EXPECT_EQ(model.solids[0].regions[0].elements, std::vector<int>{0});
  const double middle =
      root([](double x) { return stress(kSoft, 1 + x) - stress(kHard, 1.3 - x); }, 0.0, 0.3);
  // Triangles and a square on a face move alike at their nodes only.
  EXPECT_NEAR(at(solved(model), Vec3(1, 0.5, 0.5)).x(), 1 + middle, 5e-3);
  EXPECT_THAT(notes(text), testing::Not(HasSubstr("enhanced strains")));
}

/// A soft cube held at x = 0, whose end is pulled by 100 kN on each node; lines from its nodes to
/// four fixed ones at x = 3.
std::string restrained(const std::string& materials, const std::string& lines,
                       const std::string& domains, const std::string& more,
                       const std::string& anchors = "31,32,33,34") {
  return feb(control("STATIC", 10, 0.1) + tag("Material", elastic(1, "soft", kSoft) + materials) +
             tag("Mesh", face(1, 0) + face(5, 1) + face(31, 3) + cube(1, "one", 1, 5) + lines +
                             tag("NodeSet", "1,2,3,4", "name='wall'") +
                             tag("NodeSet", "5,6,7,8", "name='end'") +
                             tag("NodeSet", anchors, "name='anchors'")) +
             tag("MeshDomains", domain("one", "soft") + domains) +
             tag("Boundary", zero("wall", "111") + zero("anchors", "111") + zero("end", "011")) +
             tag("Loads", tag("nodal_load", tag("dof", "x") + tag("scale", "1e5", "lc='1'"),
                              "type='nodal_load' node_set='end'")) +
             kRamp + more);
}

const std::string kSet =
    tag("DiscreteSet",
        tag("delem", "5,31") + tag("delem", "6,32") + tag("delem", "33,7") + tag("delem", "34,8"),
        "name='four'");
const std::string kSprings =
    tag("Discrete", tag("discrete_material", tag("E", "4e5"), "id='1' type='linear spring'") +
                        "<discrete dmat='1' discrete_set='four'/>");

TEST_F(FebLines, SpringsEndOnNodesOfSolids) {
  const Model model = read(restrained("", kSet, "", kSprings));
  const double u = root([](double x) { return 4 * 4e5 * x + stress(kSoft, 1 + x) - 4e5; }, 0, 1);
  Simulation s = solved(model);
  EXPECT_NEAR(at(s, Vec3(1, 0.5, 0.5)).x(), 1 + u, 1e-9);
  // Pushed by the cube: a force along x on the second end.
  EXPECT_NEAR(s.load("four_1")[0], 4e5 * u, 1e-3);
  EXPECT_NEAR(s.load("four_3")[0], -4e5 * u, 1e-3);
  EXPECT_THAT(fault(restrained("", kSet, "", kSprings, "31,32,33")),
              HasSubstr("a spring of 'four' has an end that is on no rigid body and no solid"));
}

std::string trusses(const std::string& elements) {
  return tag("Elements", elements, "type='line2' name='rods'");
}
const std::string kRods = trusses(tag("elem", "5,31", "id='11'") + tag("elem", "6,32", "id='12'") +
                                  tag("elem", "33,7", "id='13'") + tag("elem", "34,8", "id='14'"));
const std::string kRodMaterial =
    tag("material", tag("density", "7") + tag("E", "1e7") + tag("v", "0.3"),
        "id='2' name='steel' type='linear truss'");
std::string rod_domain(const std::string& area) {
  return tag("BeamDomain", area.empty() ? "" : tag("cross_sectional_area", area),
             "name='rods' mat='steel' type='linear-truss'");
}

// Trusses carry E A L ln(l/L)/l, with L = 2 m.
TEST_F(FebLines, TrussesHaveALogarithmicStrain) {
  const double u = root(
      [](double x) {
        const double l = 2 - x;
        return -4 * 1e7 * 0.05 * 2 * std::log(l / 2) / l + stress(kSoft, 1 + x) - 4e5;
      },
      0, 1);
  Simulation s = solved(read(restrained(kRodMaterial, kRods, rod_domain("0.05"), "")));
  EXPECT_NEAR(at(s, Vec3(1, 0.5, 0.5)).x(), 1 + u, 1e-9);
  const double l = 2 - u;
  EXPECT_NEAR(s.load("rods_11")[0], -1e7 * 0.05 * 2 * std::log(l / 2) / l, 1e-3);
  EXPECT_THAT(fault(restrained(kRodMaterial, kRods, rod_domain(""), "")),
              HasSubstr("the trusses 'rods' have no cross section"));
  EXPECT_THAT(fault(restrained(kRodMaterial, kRods, rod_domain("0.05"), "", "31,32,34")),
              HasSubstr("a truss of 'rods' has an end that is on no rigid body and no solid"));
  EXPECT_THAT(fault(restrained(kRodMaterial, trusses(tag("elem", "5,5", "id='1'")),
                               rod_domain("0.05"), "")),
              HasSubstr("a truss of 'rods' has no length"));
  std::string weak = kRodMaterial;
  weak.replace(weak.find("1e7"), 3, "0");
  EXPECT_THAT(fault(restrained(weak, kRods, rod_domain("0.05"), "")),
              HasSubstr("<E> of 'steel' is 0"));
  std::string text = restrained(kRodMaterial, kRods, rod_domain("0.05"), "");
  text.replace(text.find("STATIC"), 6, "DYNAMIC");
  EXPECT_THAT(notes(text), HasSubstr("the trusses 'rods' have no mass"));
}

// In one step of several springs are switched, which those on solids are not.
TEST_F(FebLines, SpringsOnSolidsActInAllSteps) {
  std::string text = restrained("", kSet, "", "");
  const std::string old = control("STATIC", 10, 0.1);
  text.erase(text.find(old), old.size());
  const std::string end = "</febio_spec>";
  text.insert(text.find(end), tag("Step", tag("step", old + kSprings) + tag("step", old)));
  EXPECT_THAT(fault(text), HasSubstr("has an end on a solid, and is in one step of several"));
}

std::string point(const std::string& body, const std::string& position) {
  return tag("rigid_cable_point", tag("rigid_body_id", body) + tag("position", position));
}

// Its tension pulls the block towards the next point, and along its direction at the end.
TEST_F(FebLines, CablesHaveOneTension) {
  const auto cable = [](const std::string& points) {
    return two_bodies(
        control(),
        typed("rigid_load", "rigid_cable",
              tag("force", "32", "lc='1'") + tag("force_direction", "0,0,2") + points),
        tag("LoadData", curve(1, "0,1;1,1")));
  };
  for (const double step : kSteps) {
    const Model ends = read(cable(point("base", "0,0,4") + point("bar", "0,0,0")));
    EXPECT_NEAR(run(ends, 1.0, step).body("bar").r.z(), 2 * 32 / kMass / 2, 1e-9) << step;
    // Over the block and back up: twice the tension, and the end is on the base.
    const Model over =
        read(cable(point("base", "0,0,4") + point("bar", "0,0,0") + point("base", "0,0,5")));
    EXPECT_NEAR(run(over, 1.0, step).body("bar").r.z(), 2 * 32 / kMass / 2, 1e-9) << step;
  }
  EXPECT_THAT(fault(cable("")), HasSubstr("the rigid_cable has no points"));
  EXPECT_THAT(fault(cable(point("nobody", "0,0,0"))),
              HasSubstr("'nobody', which is no rigid body"));
}

/// A rigid femur on two layers of cartilage on the ground, with four ligaments beside them. It is
/// pressed down along x within a second, held for one, and unloaded within the third.
std::string knee() {
  const std::string corners[] = {"101,201", "104,202", "108,203", "105,204"};
  std::string lines, anchors;
  for (int k = 0; k < 4; ++k) {
    lines += tag("delem", corners[k]);
    anchors += tag("node", format("0,{},{}", k == 1 || k == 2 ? 1.5 : -0.5, k > 1 ? 1.5 : -0.5),
                   format("id='{}'", 201 + k));
  }
  const std::string ligaments =
      tag("Discrete", tag("discrete_material", tag("E", "2e4"), "id='1' type='linear spring'") +
                          "<discrete dmat='1' discrete_set='ligaments'/>");
  return feb(
      control("STATIC", 30, 0.1) +
      tag("Material",
          elastic(1, "deep", kHard) + elastic(2, "surface", kSoft) + rigid(3, "femur")) +
      tag("Mesh", face(1, 0) + face(5, 1) + face(9, 2) + cube(1, "one", 1, 5) +
                      cube(2, "two", 5, 9) +
                      block(101, "bone", Vec3(2, -0.5, -0.5), Vec3(3, 1.5, 1.5)) +
                      tag("Nodes", anchors) + tag("NodeSet", "1,2,3,4", "name='tibia'") +
                      tag("NodeSet", "201:204", "name='anchors'") + quad("cartilage", 9) +
                      tag("Surface", tag("quad4", "101,104,108,105", "id='1'"), "name='condyle'") +
                      tag("SurfacePair", tag("primary", "cartilage") + tag("secondary", "condyle"),
                          "name='joint'") +
                      tag("DiscreteSet", lines, "name='ligaments'")) +
      tag("MeshDomains",
          domain("one", "deep") + domain("two", "surface") + domain("bone", "femur")) +
      tag("Boundary", zero("tibia", "111") + zero("anchors", "111")) +
      tag("Rigid", fixed("femur", "011111") + typed("rigid_load", "rigid_force",
                                                    tag("rb", "femur") + tag("dof", "Rx") +
                                                        tag("value", "-2e5", "lc='1'"))) +
      tag("Contact", tag("contact", "", "type='sliding-elastic' name='c' surface_pair='joint'")) +
      ligaments + tag("LoadData", curve(1, "0,0;1,1;2,1;3,0")));
}

// Both layers carry the same stress, and the ligaments what they are shortened by.
TEST_F(FebLines, AKneeIsLoadedHeldAndUnloaded) {
  const auto shortened = [](double stress_there) {
    const auto layer = [&](double modulus) {
      return 1 - root([&](double l) { return stress(modulus, l) + stress_there; }, 0.6, 1.0);
    };
    return layer(kSoft) + layer(kHard);
  };
  const double carried = root([&](double p) { return p + 4 * 2e4 * shortened(p) - 2e5; }, 0.0, 2e5);
  ASSERT_GT(shortened(carried), 0.1);
  Model model = read(knee());
  for (const double t : {1.0, 2.0, 3.0}) {
    Model part = model;
    part.analysis.history = t;
    Simulation s = solved(part);
    const double u = t < 2.5 ? shortened(carried) : 0.0;
    // The barrier keeps surfaces apart by a part of the band.
    EXPECT_NEAR(s.body("femur").r.x(), 2.5 - u, 0.01) << t;
    EXPECT_NEAR(s.load("ligaments_1")[3], 2 - u, 0.01) << t;
    EXPECT_NEAR(s.interface_reaction(0, 0).force.x(), t < 2.5 ? carried : 0.0, 0.02 * carried) << t;
  }
}

}  // namespace
}  // namespace polhode::feb_lines_tests
