// SPDX-License-Identifier: Apache-2.0
// Unstable directions of nearly incompressible quadratic meshes: those of the mesh and those of the
// solid are told apart.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>
#include <polhode/solids/cell_stability.hpp>
#include <polhode/solids/materials/registry.hpp>

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

/// A block of 4 × 1 × 4 cells of 0.25 × 1 × 0.25, clamped on one side and pressed along x by a
/// plate without friction.
constexpr const char* kFlatCells = R"(
format: 1
materials: {m: {type: MATERIAL, youngs_modulus: 1e6, poisson_ratio: 0.3, density: 1000}}
bodies: {plate: {shape: {box: [0.1, 4, 4]}, density: 1000, position: [0.55, 0, 0], motion: {x: -0.3, y: 0, z: 0, rotation_vector: [0, 0, 0]}}}
solids:
  b:
    mesh: {block: {size: [1, 1, 1], cells: [4, 1, 4]}}
    element: hex8_eas9
    material: m
    prescribed: {base: {nodes: {plane: {axis: x, at: min}}, x: 0, y: 0, z: 0}}
contacts: {default: {friction: 0}}
analysis: {type: statics}
output: {hdf5: false}
)";

// Compressed by 30 % such a block fails, or snaps away from the plate into another equilibrium, at
// strains that depend on the load steps. Each run names the element and the stretch from which on
// it has spurious modes, and no loss of stability comes before it.
TEST(MeshInstability, OfFlatCellsWithEnhancedStrainsIsNamedBeforeTheyFail) {
  constexpr double kWay = 0.3;
  for (const char* material : {"neo_hookean", "elastic"}) {
    const std::shared_ptr<const solids::Material> law = solids::make_material(
        "m", {.kind = material, .values = {{"youngs_modulus", 1e6}, {"poisson_ratio", 0.3}}});
    const double bound = solids::stable_stretch("hex8_eas9", law, {0.25, 1.0, 0.25}, 0);
    for (const int steps : {5, 100}) {
      std::string text = kFlatCells;
      text.replace(text.find("MATERIAL"), 8, material);
      Simulation s(
          io::read_model_text(text, "flat.yaml", {format("analysis.load_steps={}", steps)}));
      const RunSummary r = s.run();
      EXPECT_THAT(r.warnings,
                  Contains(HasSubstr(format("hex8_eas9 of this shape has spurious modes below "
                                            "{:.2g}. ",
                                            bound))))
          << material << ' ' << steps;
      EXPECT_TRUE(r.end == RunEnd::finished || r.end == RunEnd::not_converged);
      for (const LimitPoint& point : r.statics->limit_points)
        EXPECT_GT(kWay * point.load_factor, 1.0 - bound) << material << ' ' << steps;
    }
  }
}

}  // namespace
}  // namespace polhode::mesh_instability_tests
