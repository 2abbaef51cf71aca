// SPDX-License-Identifier: Apache-2.0
// Equilibria of solids in contact, from model files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::test::solids_in_statics_tests {
namespace {

/// Three by three elements below, four by four above, which is held by the contact only.
TEST(SolidsInStatics, PassThePatchTestWithMeshesThatDoNotMatch) {
  const double p = 30.0;
  Simulation simulation(io::read_model_text(R"(
format: 1
materials: {m: {type: st_venant_kirchhoff, youngs_modulus: 2000, poisson_ratio: 0.3, density: 1}}
solids:
  lower:
    mesh: {block: {size: [1, 1, 0.5], cells: [3, 3, 2]}, position: [0.5, 0.5, 0.25]}
    element: hex8_standard
    material: m
    contact: {surface: zmax}
    prescribed: {x: {nodes: [xmin, xmax], x: 0}, y: {nodes: [ymin, ymax], y: 0}, z: {nodes: zmin, z: 0}}
  upper:
    mesh: {block: {size: [1, 1, 0.5], cells: [4, 4, 2]}, position: [0.5, 0.5, 0.751]}
    element: hex8_standard
    material: m
    contact: {surface: zmin}
    prescribed: {x: {nodes: [xmin, xmax], x: 0}, y: {nodes: [ymin, ymax], y: 0}}
loads: {p: {type: pressure, solid: upper, surface: zmax, pressure: 30, follower: false}}
contacts: {default: {gap_tolerance: 1 mm}}
analysis: {type: statics}
)",
                                            "patch.yaml"));
  const RunSummary summary = simulation.run();
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  for (int s = 0; s < 2; ++s) {
    double area = 0.0;
    for (const surface_contact::SurfacePointReport& point : simulation.surface_points(s)) {
      EXPECT_NEAR(point.pressure / p, 1.0, 1e-10);
      area += point.force.norm() / p;
    }
    EXPECT_NEAR(area, 0.5, 1e-10) << "each side carries half";
    for (const ElementSample& e : simulation.solid(s).elements)
      EXPECT_NEAR(e.cauchy(2, 2) / p, -1.0, 1e-9);
  }
  EXPECT_NEAR(simulation.contact(0).normal_force, p, 1e-9);
}

/// A free block that is pulled at one end and, by the body it is bonded to, at the other: its
/// elongation is that of one whose body is fixed to the ground, and it does not drift for any size
/// of the load. @tests{statics-deflation} @tests{statics-rigid}
TEST(SolidsInStatics, WithoutSupportsStretchWithoutDrift) {
  const auto run = [](bool held, const std::string& load) {
    Simulation s(io::read_model_text(
        R"(
format: 1
variables: {p: 10 kPa}
bodies: {hub: {mass: 1, inertia: [1, 1, 1], position: [-2, 0, 0]}}
joints: {)" +
            std::string(held ? "weld: {type: fixed, bodies: [ground, hub], at: [-2, 0, 0]}" : "") +
            R"(}
materials: {m: {type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  b:
    mesh: {block: {size: [4, 1, 1], cells: [4, 1, 1]}}
    element: hex20
    material: m
    bonded: {hub: xmin}
loads:
  pull: {type: traction, solid: b, surface: xmax, traction: [p, 0, 0]}
  back: {type: force, body: hub, force: [-p, 0, 0]}
analysis: {type: statics}
output: {hdf5: false}
)",
        "free.yaml", {"variables.p=" + load}));
    const RunSummary r = s.run();
    EXPECT_EQ(r.end, RunEnd::finished) << r.message;
    EXPECT_TRUE(r.statics->converged) << r.statics->message;
    EXPECT_LE(r.newton_iterations, 8) << load;
    double end = -1e9, start = 1e9, aside = 0.0;
    for (const Vec3& x : s.solid(0).position) {
      end = std::max(end, x.x());
      start = std::min(start, x.x());
    }
    for (const Vec3& d : s.solid(0).displacement) aside = std::max(aside, d.norm());
    return std::pair(end - start, aside);
  };
  for (const char* load : {"10", "10000", "50000"}) {
    const auto [held, stretch] = run(true, load);
    const auto [length, way] = run(false, load);
    EXPECT_NEAR(length, held, 1e-7 * (held - 4.0)) << load;
    EXPECT_LT(way, stretch) << load;
  }
}

/// A ball pressed onto one twice as stiff: the pole of the stiffer one rests in a dent of the
/// other, as near to one triangle as to its mirror image. Hertz: 4/3 E* √R* δ^(3/2) (K. L. Johnson,
/// Contact Mechanics, 1985, section 4.2). @tests{statics-kink}
TEST(SolidsInStatics, FindAnEquilibriumAtAKinkOfTheContact) {
  Simulation simulation(io::read_model_text(R"(
format: 1
variables: {T: 1 s}
materials:
  soft: {type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}
  stiff: {type: elastic, youngs_modulus: 2 MPa, poisson_ratio: 0.3, density: 1000}
solids:
  upper:
    mesh: {sphere: {diameter: 2, octants: 1, cells: [5, 4], grading: [0.06, 14]}, position: [0, 0, 1.0001], orientation: {axis: x, angle: 180 deg}}
    material: soft
    contact: {surface: outer}
    prescribed: {x: {nodes: xmid, x: 0}, y: {nodes: ymid, y: 0}, z: {nodes: zmid, z: "-4e-3*t/T"}}
  lower:
    mesh: {sphere: {diameter: 2, octants: 1, cells: [6, 4], grading: [0.06, 14]}, position: [0, 0, -1], orientation: {axis: z, angle: -90 deg}}
    material: stiff
    contact: {surface: outer}
    prescribed: {x: {nodes: xmid, x: 0}, y: {nodes: ymid, y: 0}, z: {nodes: zmid, z: 0}}
contacts: {default: {gap_tolerance: 2e-5, reference_pressure: 20 kPa}}
analysis: {type: statics, load_steps: 6}
)",
                                            "dent.yaml"));
  const RunSummary summary = simulation.run();
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  const double modulus = 1.0 / (0.91 / 1e6 + 0.91 / 2e6), deep = 3.9e-3;
  const double force = 4.0 / 3.0 * modulus * std::sqrt(0.5) * std::pow(deep, 1.5);
  EXPECT_NEAR(4.0 * simulation.contact(0).normal_force / force, 1.0, 0.1);  // measured 1.04
}

/// A small block pushed across a large one, farther than the search radius of the contact neighbour
/// list.
TEST(SolidsInStatics, FindNewContactPartnersAsTheyMove) {
  const auto pressed = [](double start, double way) {
    Simulation simulation(io::read_model_text(format(R"(
format: 1
variables: {{T: 1 s, way: {} m}}
materials: {{m: {{type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}}}
solids:
  table:
    mesh: {{block: {{size: [2, 0.5, 0.2], cells: [20, 5, 2]}}, position: [0, 0, -0.1]}}
    material: m
    contact: {{surface: zmax}}
    prescribed: {{z: {{nodes: zmin, x: 0, y: 0, z: 0}}}}
  block:
    mesh: {{block: {{size: [0.23, 0.23, 0.1], cells: [3, 3, 2]}}, position: [{}, 0, 0.0504]}}
    material: m
    contact: {{surface: zmin}}
    prescribed: {{top: {{nodes: zmax, x: "way*t/T", y: 0, z: "-2e-3*t/T"}}}}
contacts: {{default: {{gap_tolerance: 0.2 mm}}}}
analysis: {{type: statics, load_steps: 8}}
)",
                                                     way, start),
                                              "pushed.yaml"));
    const RunSummary summary = simulation.run();
    EXPECT_EQ(summary.end, RunEnd::finished) << summary.message;
    return simulation.contact(0).normal_force;
  };
  const double stays = pressed(0.35, 0.0), goes = pressed(-0.35, 0.7);
  EXPECT_GT(stays, 100.0);
  EXPECT_NEAR(goes / stays, 1.0, 0.03) << "the meshes are at other relative positions";
}

}  // namespace
}  // namespace polhode::test::solids_in_statics_tests
