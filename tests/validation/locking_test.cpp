// SPDX-License-Identifier: Apache-2.0
// Warnings before a run of elements that are too stiff for incompressible material or in bending.
#include <array>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::locking_tests {
namespace {

struct Solved {
  double displacement;
  bool warned;
};

Solved solve(const std::string& text, const std::string& element, double poisson, int n,
             int component) {
  Simulation s(io::read_model_text(
      text, "solid.yaml",
      {"solids.part.element=" + element, format("materials.m.poisson_ratio={}", poisson),
       "variables.n=" + std::to_string(n)}));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  const SolidPoint point = solid_point("point", s.solids()[0].plan.mesh,
                                       component == 0 ? Vec3(0.1, 0, 0) : Vec3(0.5, 0, 0));
  return {s.solid_point(0, point)[1][component], !s.solids()[0].plan.warnings.empty()};
}

// Lamé: u(a) = (1 + ν)/E p a²/(b² − a²) ((1 − 2ν) a + b²/a), for any ν.
constexpr const char* kTube = R"(
format: 1
variables: {n: 2}
materials: {m: {type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  part:
    mesh: {tube: {outer: 0.4, inner: 0.2, length: 0.05, cells: [n, 8*n, 1]}}
    material: m
    prescribed:
      below: {nodes: start, z: 0}
      above: {nodes: end, z: 0}
      across: {nodes: {plane: {axis: x, at: 0}}, x: 0}
      along: {nodes: {plane: {axis: y, at: 0}}, y: 0}
loads: {inside: {type: pressure, solid: part, surface: inner, pressure: 1 Pa}}
analysis: {type: statics}
output: {hdf5: false}
)";

constexpr const char* kCantilever = R"(
format: 1
variables: {n: 1}
materials: {m: {type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  part:
    mesh: {block: {size: [1, 0.1, 0.1], cells: [10*n, n, n]}}
    material: m
    bonded: {ground: xmin}
loads: {shear: {type: traction, solid: part, surface: xmax, traction: [0, 0, 0.01]}}
analysis: {type: statics}
output: {hdf5: false}
)";

// Two quadratic elements through the wall of the tube, or four linear ones, one and two through the
// cantilever: more than 10 % too stiff in either means a warning, and a warning means that.
TEST(Locking, IsReportedBeforeARunWhereItIsMeasured) {
  const std::map<std::string, int> elements{{"hex8_standard", 2}, {"hex8_eas9", 2}, {"hex20", 1},
                                            {"hex27", 1},         {"tet4", 2},      {"tet10", 2},
                                            {"tet15", 2},         {"wedge6", 2},    {"wedge15", 1}};
  for (const double nu : {0.3, 0.49, 0.4999}) {
    const double lame = (1.0 + nu) / 1e6 / 3.0 * ((1.0 - 2.0 * nu) * 0.1 + 0.4);
    const double beam = solve(kCantilever, "tet10", nu, 3, 2).displacement;
    for (const auto& [element, finer] : elements) {
      const Solved tube = solve(kTube, element, nu, 2 * finer, 0);
      const Solved bar = solve(kCantilever, element, nu, finer, 2);
      const double lack = std::max(1.0 - tube.displacement / lame, 1.0 - bar.displacement / beam);
      RecordProperty(format("{}_{}", element, nu), format("{:.3f}", lack));
      EXPECT_EQ(tube.warned, bar.warned);
      if (lack > 0.1) {
        EXPECT_TRUE(tube.warned) << element << ' ' << nu << ' ' << lack;
      }
      if (tube.warned) {
        EXPECT_GT(lack, 0.1) << element << ' ' << nu;
      }
    }
  }
}

}  // namespace
}  // namespace polhode::locking_tests
