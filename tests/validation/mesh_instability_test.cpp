// SPDX-License-Identifier: Apache-2.0
// Unstable directions of nearly incompressible quadratic meshes: those of the mesh and those of the
// solid are told apart.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>

namespace polhode::mesh_instability_tests {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kMesh = "unstable directions are those of the mesh";

/// A tube under follower pressure 0.3 mu in plane strain: inflated to 1.28158 times its inner
/// radius, and stable.
constexpr const char* kTube = R"(
format: 1
variables: {cells: 3}
materials: {s: {type: mooney_rivlin_uncoupled, c1: 5e4, bulk_modulus: 2e8, density: 1000}}
solids:
  b:
    mesh: {tube: {outer: 0.2, inner: 0.1, length: 0.02, cells: [cells, 16, 1]}}
    element: ELEMENT
    material: s
    prescribed: {z: {nodes: [start, end], z: 0}, x: {nodes: {plane: {axis: x, at: 0}}, x: 0}, y: {nodes: {plane: {axis: y, at: 0}}, y: 0}}
loads: {p: {type: pressure, solid: b, surface: inner, pressure: 3e4}}
analysis: {type: statics}
output: {hdf5: false}
)";

/// A column on rollers below and above, pressed by 8 % of its length of 8 widths: it buckles at
/// (pi/8)²/12 = 1.3 %, in both directions.
constexpr const char* kColumn = R"(
format: 1
materials: {s: {type: mooney_rivlin_uncoupled, c1: 5e4, bulk_modulus: 2e8, density: 1000}}
solids:
  b:
    mesh: {block: {size: [1, 1, 8], cells: [1, 1, 8]}}
    element: hex20
    material: s
    prescribed:
      foot: {nodes: {plane: {axis: z, at: min}}, x: 0, y: 0, z: 0}
      head: {nodes: {plane: {axis: z, at: max}}, z: -0.64}
analysis: {type: statics}
output: {hdf5: false}
)";

RunSummary run(std::string text, const std::string& element, int cells) {
  if (const std::size_t at = text.find("ELEMENT"); at != std::string::npos)
    text.replace(at, 7, element);
  io::Overrides overrides;
  if (cells > 0) overrides.push_back(format("variables.cells={}", cells));
  Simulation s(io::read_model_text(text, "mesh.yaml", overrides));
  RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  return r;
}

// @tests{even-pressure}
TEST(MeshInstability, OfANearlyIncompressibleTubeIsThatOfThePressure) {
  const RunSummary coarse = run(kTube, "hex20", 3);
  ASSERT_GT(coarse.statics->unstable, 0);
  EXPECT_THAT(
      coarse.warnings,
      Contains(HasSubstr(format("solids.b: {} of the {} {}: the pressure oscillates within "
                                "nearly incompressible hex20, and with its mean in each "
                                "element there are none.",
                                coarse.statics->unstable, coarse.statics->unstable, kMesh))));
  for (const char* element : {"hex8_q1p0"}) {
    const RunSummary stable = run(kTube, element, 3);
    EXPECT_EQ(stable.statics->unstable, 0) << element;
    EXPECT_THAT(stable.warnings, Not(Contains(HasSubstr(kMesh)))) << element;
  }
}

TEST(MeshInstability, IsNotReportedForAColumnThatBuckles) {
  const RunSummary column = run(kColumn, "hex20", 0);
  ASSERT_GE(column.statics->unstable, 2);
  EXPECT_THAT(column.warnings, Not(Contains(HasSubstr(kMesh))));
}

}  // namespace
}  // namespace polhode::mesh_instability_tests
