// SPDX-License-Identifier: Apache-2.0
// Solids of several materials that share nodes.
#include <cmath>

#include <gmock/gmock.h>

#include <polhode/compile/solid_point.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/io/results/checkpoint.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/scratch.hpp>

namespace polhode::regions_tests {
namespace {

using testing::HasSubstr;

constexpr double kSoft = 1e6, kHard = 4e6;  // Young's moduli [Pa]

// A bar of 2 m by 0.2 m by 0.2 m from x = 0 on, without lateral contraction, so that its strain is
// that of a bar. The rest of the text is indented below `bar`.
std::string bar(const std::string& element, const std::string& region, const std::string& more,
                const std::string& end) {
  return "format: 1\nmaterials:\n"
         "  soft: {type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0, density: 1000}\n"
         "  hard: {type: elastic, youngs_modulus: 4 MPa, poisson_ratio: 0, density: 3000}\n"
         "solids:\n  bar:\n"
         "    mesh: {block: {size: [2, 0.2, 0.2], cells: [4, 2, 2]}, position: [1, 0, 0]}\n"
         "    element: " +
         element + "\n    material: soft\n" + region + more + end;
}
/// The half beyond x = 1 m, in the coordinates of the mesh.
const std::string kBeyond =
    "    regions: {tip: {material: hard, within: {box: {from: [0, -1, -1], to: [2, 1, 1]}}}}\n";
/// The half above z = 0.
const std::string kAbove =
    "    regions: {top: {material: hard, within: {box: {from: [-2, -1, 0], to: [2, 1, 1]}}}}\n";
const std::string kWall = "    prescribed:\n      wall: {nodes: xmin, x: 0, y: 0, z: 0}\n";

Simulation solved(const std::string& text) {
  Simulation s(io::read_model_text(text, "bar.yaml"));
  const RunSummary done = s.run();
  EXPECT_EQ(done.end, RunEnd::finished) << done.message;
  return s;
}

/// Stretch of a bar at a force per undeformed area P = E λ (λ² − 1)/2.
double stretch_at(double stress, double modulus) {
  double stretch = 1.0;
  for (int k = 0; k < 50; ++k)
    stretch -= (modulus * stretch * (stretch * stretch - 1.0) / 2.0 - stress) /
               (modulus * (3.0 * stretch * stretch - 1.0) / 2.0);
  return stretch;
}

constexpr const char* kElements[] = {"hex8_standard", "hex8",  "hex20",  "hex27",  "tet4",
                                     "tet10",         "tet15", "wedge6", "wedge15"};

// One behind the other: the stress is the same, on every kind of element, and the patch of each
// material has its own homogeneous strain up to the interface.
TEST(Regions, InSeriesHaveTheSameStress) {
  const std::string pull =
      "loads: {pull: {type: traction, solid: bar, surface: xmax, traction: [200 kPa, 0, 0]}}\n"
      "analysis: {type: statics}\n";
  const double soft = stretch_at(2e5, kSoft), hard = stretch_at(2e5, kHard);
  for (const char* element : kElements) {
    SCOPED_TRACE(element);
    const Simulation s = solved(bar(element, kBeyond, kWall, pull));
    const SolidReport& r = s.solid(0);
    const SolidPlan& plan = s.solids()[0].plan;
    for (std::size_t k = 0; k < r.position.size(); ++k) {
      const Vec3& X = plan.start[k];
      const double x = X.x() <= 1.0 ? soft * X.x() : soft + hard * (X.x() - 1.0);
      EXPECT_NEAR((r.position[k] - Vec3(x, X.y(), X.z())).norm(), 0.0, 1e-9) << k;
    }
    // Cauchy's stress is P, as the cross section does not change; at the interface too.
    for (const Mat3& stress : r.nodal.cauchy) {
      EXPECT_NEAR(stress(0, 0), 2e5, 1e-2);
      EXPECT_NEAR(stress(1, 1), 0.0, 1e-2);
    }
    EXPECT_LT(r.nodal.error_energy, 1e-12 * r.nodal.energy);
  }
}

// Side by side: the stretch is the same, and the end carries the sum of both forces.
TEST(Regions, InParallelAddTheirForces) {
  const std::string held = kWall + "      end: {nodes: xmax, x: 0.2, y: 0, z: 0}\n";
  const double stretch = 1.1, area = 0.02;
  const double force = (kSoft + kHard) * area * stretch * (stretch * stretch - 1.0) / 2.0;
  for (const char* element : kElements) {
    SCOPED_TRACE(element);
    const Simulation s = solved(bar(element, kAbove, held, "analysis: {type: statics}\n"));
    EXPECT_NEAR(s.interface_reaction(0, 1).force.x(), force, 1e-9 * force);
    // The stress jumps: each material has its own, which the estimate of its error does not count.
    const solids::NodalFields& nodal = s.solid(0).nodal;
    EXPECT_LT(nodal.error_energy, 1e-12 * nodal.energy);
  }
}

// Named twice, of the same material, they are the solid without regions.
TEST(Regions, OfOneMaterialChangeNothing) {
  const std::string region =
      "    regions: {tip: {material: soft, elements: [1, 3, 5, 7, 9, 11, 13, 15]}}\n";
  const std::string pull =
      "loads: {pull: {type: traction, solid: bar, surface: xmax, traction: [50 kPa, 0, 30 kPa]}}\n"
      "analysis: {type: statics}\n";
  const Simulation one = solved(bar("hex8", "", kWall, pull));
  const Simulation two = solved(bar("hex8", region, kWall, pull));
  for (std::size_t k = 0; k < one.solid(0).position.size(); ++k)
    EXPECT_LT((one.solid(0).position[k] - two.solid(0).position[k]).norm(), 1e-10) << k;
}

// Densities are those of the regions: the centre of mass falls as it should, by gravity and by a
// force per mass, and its place is that of 1000 and 3000 kg/m³.
TEST(Regions, HaveTheirOwnDensity) {
  for (const char* load :
       {"gravity: [0, 0, -8]\n",
        "loads: {w: {type: body_force, solid: bar, acceleration: [0, 0, -8]}}\n"})
    for (const char* step : {"0.05", "0.01", "0.0005"}) {
      const Simulation s =
          solved(bar("hex8", kBeyond, "",
                     load + std::string("analysis: {duration: 0.1, step: ") + step + "}\n"));
      EXPECT_NEAR(s.solids()[0].mass, 0.04 * 1000 + 0.04 * 3000, 1e-9);
      EXPECT_NEAR(s.solids()[0].centre.x(), (0.5 * 1000 + 1.5 * 3000) / 4000, 1e-12);
      for (std::size_t k = 0; k < s.solid(0).position.size(); ++k) {
        const Vec3 fall = s.solid(0).position[k] - s.solids()[0].plan.start[k];
        EXPECT_NEAR((fall - Vec3(0, 0, -0.04)).norm(), 0.0, 1e-10) << load << step;
      }
    }
  const std::string lighter =
      "    regions: {tip: {material: hard, density: 500, elements: [0]}}\n    density: 2000\n";
  const Simulation s = solved(bar("hex8", lighter, "", "analysis: {duration: 0.01, step: 0.01}\n"));
  EXPECT_NEAR(s.solids()[0].mass, 0.08 * (15.0 / 16 * 2000 + 500.0 / 16), 1e-9);
}

// Thrown and turning, with waves across the interface: energy and momentum to rounding at any step.
TEST(Regions, ConserveEnergyAndMomentum) {
  for (const char* element : {"hex8", "tet10"})
    for (const char* step : {"20 ms", "2 ms", "0.2 ms"}) {
      SCOPED_TRACE(std::string(element) + ", " + step);
      Simulation s(io::read_model_text(
          bar(element, kBeyond, "    velocity: [1, 2, 3]\n    angular_velocity: [3, -2, 4]\n",
              "analysis: {duration: 40 ms, step: " + std::string(step) + "}\n"),
          "bar.yaml"));
      const RunSummary done = s.run();
      ASSERT_EQ(done.end, RunEnd::finished) << done.message;
      EXPECT_LT(done.energy_drift, 1e-10);
      EXPECT_LT(done.linear_momentum_drift, 1e-10);
      EXPECT_LT(done.angular_momentum_drift, 1e-10);
    }
}

// Waves of a bar of two materials, against steps a tenth as long: second order.
TEST(Regions, ConvergeAtSecondOrder) {
  const auto positions = [](double step) {
    const std::string pull =
        "loads: {pull: {type: traction, solid: bar, surface: xmax, traction: [20*sin(60*t) kPa, 0, "
        "0]}}\n";
    return solved(bar("hex8_standard", kBeyond, kWall,
                      pull + "analysis: {duration: 0.1, step: " + std::to_string(step) + "}\n"))
        .solid(0)
        .position;
  };
  const std::vector<Vec3> exact = positions(5e-5);
  const auto error = [&](double step) {
    const std::vector<Vec3> x = positions(step);
    double sum = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) sum += (x[k] - exact[k]).squaredNorm();
    return std::sqrt(sum);
  };
  const double coarse = error(2e-3), fine = error(1e-3);
  EXPECT_GT(coarse, 1e-7);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.2);
}

TEST(Regions, ContinueFromACheckpointWithTheSameBits) {
  const Model model =
      io::read_model_text(bar("hex8", kBeyond, kWall + "    velocity: [0, 0.4, 0]\n",
                              "analysis: {duration: 20 ms, step: 1 ms}\n"),
                          "bar.yaml");
  const test::Scratch folder;
  Simulation straight(model);
  for (int k = 0; k < 10; ++k) straight.step(model.analysis.duration);
  io::write_checkpoint(folder / "half.pst", model, straight.system(), straight.state());
  Simulation continued(model, io::read_checkpoint(folder / "half.pst", model, straight.system()));
  for (Simulation* s : {&straight, &continued})
    while (s->time() < 0.02 * (1 - 1e-12)) s->step(0.02);
  EXPECT_EQ(straight.state_hash(), continued.state_hash());
}

// Fibres of one direction by element are those of the material; of two, those of two materials.
TEST(Regions, FibresMayDifferByElement) {
  const auto model = [](const std::string& direction, const std::string& other,
                        const std::string& solid) {
    const auto tissue = [](const std::string& name, const std::string& along) {
      return "  " + name +
             ": {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000, "
             "fibre: {law: exponential, xi: 3 MPa, alpha: 0, direction: " +
             along + "}}\n";
    };
    return "format: 1\nmaterials:\n" + tissue("one", direction) + tissue("two", other) +
           "solids:\n  bar:\n    mesh: {block: {size: [2, 0.2, 0.2], cells: [2, 1, 1]}, position: "
           "[1, 0, 0], orientation: {axis: x, angle: 30 deg}}\n    element: hex20\n    material: "
           "one\n" +
           solid + kWall +
           "loads: {pull: {type: traction, solid: bar, surface: xmax, traction: [50 kPa, 0, 9 "
           "kPa]}}\nanalysis: {type: statics}\n";
  };
  const std::string a = "[0.8, 0.6, 0]", b = "[0.6, 0, -0.8]";
  const Simulation plain = solved(model(a, b, ""));
  const Simulation listed = solved(model("z", b, "    fibre_directions: [" + a + ", " + a + "]\n"));
  EXPECT_EQ(plain.state_hash(), listed.state_hash());
  const std::string region = "    regions: {half: {material: two, elements: [0]}}\n";
  const Simulation two = solved(model(a, b, region));
  const Simulation both = solved(model("z", b, "    fibre_directions: [" + b + ", " + a + "]\n"));
  const Simulation all =
      solved(model("z", "z", region + "    fibre_directions: [" + b + ", " + a + "]\n"));
  double apart = 0.0;
  for (std::size_t k = 0; k < two.solid(0).position.size(); ++k) {
    apart = std::max(apart, (two.solid(0).position[k] - plain.solid(0).position[k]).norm());
    EXPECT_LT((two.solid(0).position[k] - both.solid(0).position[k]).norm(), 1e-11) << k;
    EXPECT_LT((two.solid(0).position[k] - all.solid(0).position[k]).norm(), 1e-11) << k;
  }
  EXPECT_GT(apart, 1e-3);
}

// A kind of element of its own, as for nearly incompressible regions of hexahedra.
TEST(Regions, MayHaveAnotherKindOfElement) {
  const std::string text =
      "format: 1\nmaterials:\n"
      "  bone: {type: neo_hookean, youngs_modulus: 10 MPa, poisson_ratio: 0.3, density: 1800}\n"
      "  disc: {type: mooney_rivlin_uncoupled, c1: 0.2 MPa, c2: 0, bulk_modulus: 50 MPa, density: "
      "1100}\n"
      "solids:\n  bar:\n    mesh: {block: {size: [2, 0.2, 0.2], cells: [4, 2, 2]}}\n"
      "    element: hex8_standard\n    material: bone\n"
      "    regions: {disc: {material: disc, element: hex8_q1p0, within: {box: {from: [0, -1, -1], "
      "to: [0.5, 1, 1]}}}}\n" +
      kWall + "analysis: {type: statics}\n";
  const Simulation s(io::read_model_text(text, "bar.yaml"));
  EXPECT_EQ(s.solids()[0].plan.elements, (std::vector<std::string>{"hex8_standard", "hex8_q1p0"}));
  std::string wrong = text;
  wrong.replace(wrong.find("hex8_q1p0"), 9, "tet10");
  try {
    static_cast<void>(io::read_model_text(wrong, "bar.yaml"));
    ADD_FAILURE() << "read";
  } catch (const io::ModelErrors& e) {
    EXPECT_THAT(e.text(), HasSubstr("'tet10' has tet10 cells, but the region has hex8"));
  }
}

TEST(Regions, FaultsAreNamed) {
  const auto fault = [](const std::string& region) -> std::string {
    try {
      static_cast<void>(io::read_model_text(
          bar("hex8", region, kWall, "analysis: {type: statics}\n"), "bar.yaml"));
      return "none";
    } catch (const io::ModelErrors& e) {
      return e.text();
    }
  };
  EXPECT_EQ(fault(kBeyond), "none");
  EXPECT_THAT(fault("    regions: {a: {material: hard}}\n"), HasSubstr("has no elements"));
  EXPECT_THAT(fault("    regions: {a: {material: stone, elements: [0]}}\n"),
              HasSubstr("unknown material 'stone'"));
  EXPECT_THAT(fault("    regions: {a: {material: hard, elements: [16]}}\n"),
              HasSubstr("element 16 does not exist"));
  EXPECT_THAT(fault("    regions: {a: {material: hard, elements: [3]}, b: {material: soft, "
                    "elements: [3, 4]}}\n"),
              HasSubstr("element 3 is in 'a' already"));
  EXPECT_THAT(fault("    regions: {a: {material: hard, within: xmax}}\n"),
              HasSubstr("but no whole element"));
  EXPECT_THAT(fault("    regions: [1]\n"), HasSubstr("expects a map from names to regions"));
  EXPECT_THAT(fault("    fibre_directions: [x]\n"),
              HasSubstr("has 1 directions, but the elements have 0 families of fibres"));
  EXPECT_THAT(fault("    fibre_directions: x\n"), HasSubstr("expects a list of directions"));
}

}  // namespace
}  // namespace polhode::regions_tests
