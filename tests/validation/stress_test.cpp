// SPDX-License-Identifier: Apache-2.0
// Stresses at nodes, where engineers read them: bending of beams that are one, two and four
// elements thick, and Lamé's tube.
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include <polhode/io/read_model.hpp>
#include <polhode/model/build_solids.hpp>
#include <polhode/model/simulation.hpp>
#include <polhode/model/solid_report.hpp>

namespace polhode {
namespace {

struct Solved {
  Mesh mesh;
  NodalAverages nodal;
};

Solved solve(const std::string& text, const Overrides& overrides) {
  Simulation s(read_model_text(text, "solid.yaml", overrides));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  const SolidMap& map = s.solids().at(0);
  return {map.plan.mesh, nodal_averages(map.plan.mesh, s.solid(0).elements)};
}

/// Stress at the node nearest to a place of the mesh.
Mat3 stress_at(const Solved& s, const Vec3& place) {
  std::size_t best = 0;
  for (std::size_t i = 0; i < s.mesh.nodes.size(); ++i)
    if ((s.mesh.nodes[i] - place).norm() < (s.mesh.nodes[best] - place).norm()) best = i;
  EXPECT_LT((s.mesh.nodes[best] - place).norm(), 1e-9);
  return s.nodal.cauchy[best];
}

// σ = M z/I, M = F (L − x): F = 1 N, 1 m long, 0.1 m square, so σ = 3 kPa in the middle.
constexpr const char* kCantilever = R"(
format: 1
variables: {thick: 1, along: 10}
materials: {steel: {type: elastic, youngs_modulus: 200 GPa, poisson_ratio: 0, density: 7800}}
bodies: {wall: {fixed: true}}
solids:
  bar:
    mesh: {block: {size: [1, 0.1, 0.1], cells: [along, 1, thick]}, position: [0, 0, 0]}
    element: hex20
    material: steel
    bonded: {wall: {plane: {axis: x, at: min}}}
loads: {shear: {type: traction, solid: bar, surface: xmax, traction: [0, 0, 100]}}
analysis: {type: statics}
output: {hdf5: false}
)";

// @tests{nodal-stress}
TEST(NodalStress, OfACantileverIsThatOfBendingHoweverThinTheMesh) {
  const std::map<std::string, std::array<double, 3>> allowed{{"hex20", {0.01, 0.01, 0.01}},
                                                             {"hex27", {0.01, 0.01, 0.01}},
                                                             {"hex8_eas9", {0.02, 0.02, 0.02}},
                                                             {"tet10", {0.06, 0.05, 0.03}}};
  for (const auto& [element, bounds] : allowed)
    for (int k = 0; k < 3; ++k) {
      const int thick = 1 << k;
      const Solved s = solve(
          kCantilever, {"solids.bar.element=" + element, "variables.thick=" + std::to_string(thick),
                        "variables.along=" + std::to_string(10 * thick)});
      for (const double side : {-1.0, 1.0}) {
        const Mat3 sigma = stress_at(s, {0.0, side * 0.05, side * 0.05});
        EXPECT_NEAR(sigma(0, 0), -side * 3000.0, bounds[static_cast<std::size_t>(k)] * 3000.0)
            << element << ' ' << thick;
        EXPECT_NEAR(von_mises(sigma), 3000.0, 1.5 * bounds[static_cast<std::size_t>(k)] * 3000.0)
            << element << ' ' << thick;
      }
    }
}

// Lamé: an inner pressure p in a tube of radii a, b: hoop stress p a²/(b² − a²)(1 + b²/r²), radial
// stress the same with a minus. Nothing holds the tube in its plane, and nothing has to.
constexpr const char* kTube = R"(
format: 1
variables: {n: 2}
materials: {steel: {type: elastic, youngs_modulus: 200 GPa, poisson_ratio: 0.3, density: 7800}}
solids:
  tube:
    mesh: {tube: {outer: 0.4, inner: 0.2, length: 0.05, cells: [n, 8*n, 1]}}
    element: hex20
    material: steel
    prescribed:
      below: {nodes: start, z: 0}
      above: {nodes: end, z: 0}
loads: {inside: {type: pressure, solid: tube, surface: inner, pressure: 1 MPa}}
analysis: {type: statics}
output: {hdf5: false}
)";

// @tests{nodal-stress} @tests{stress-error}
TEST(NodalStress, OfATubeUnderPressureIsThatOfLame) {
  double error_before = 0.0;
  for (const int n : {2, 4}) {
    const Solved s = solve(kTube, {"variables.n=" + std::to_string(n)});
    double worst = 0.0, estimate = 0.0;
    for (std::size_t i = 0; i < s.mesh.nodes.size(); ++i) {
      const Vec3 X = s.mesh.nodes[i], e(X.x(), X.y(), 0.0), r = e.normalized();
      const Vec3 t = r.cross(Vec3::UnitZ());
      const double part = 1e6 * 0.01 / (0.04 - 0.01), q = 0.04 / e.squaredNorm();
      worst = std::max({worst, std::abs(t.dot(s.nodal.cauchy[i] * t) - part * (1.0 + q)),
                        std::abs(r.dot(s.nodal.cauchy[i] * r) - part * (1.0 - q))});
    }
    for (const double error : s.nodal.stress_error) estimate = std::max(estimate, error);
    EXPECT_LT(worst, n == 2 ? 0.15e6 : 0.05e6) << n;  // of a largest stress of 1.67 MPa
    EXPECT_GT(estimate, 0.1 * worst) << n;
    EXPECT_LT(estimate, 10.0 * worst) << n;
    if (n > 2) {
      EXPECT_LT(worst, 0.5 * error_before);
    }
    error_before = worst;
  }
}

}  // namespace
}  // namespace polhode
