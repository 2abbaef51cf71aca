// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/solids/mesh/check_mesh.hpp>
#include <polhode/solids/mesh/generators.hpp>

namespace polhode::generators_tests {
namespace {

const solids::MeshParameters kBlock{
    {"size", {0.3, 0.2, 0.1}}, {"cells", {3, 2, 2}}, {"grading", {2, 1, 3}}};
const solids::MeshParameters kCylinder{
    {"diameter", {0.2}}, {"length", {0.5}}, {"cells", {2, 16, 3}}};
const solids::MeshParameters kTube{
    {"outer", {0.2}}, {"inner", {0.15}}, {"length", {0.5}}, {"cells", {1, 16, 3}}};
const solids::MeshParameters kSphere{{"diameter", {2.0}}, {"cells", {3, 2}}, {"grading", {0.5, 2}}};

struct Solid {
  const char* generator;
  const solids::MeshParameters* parameters;
  double volume;
  std::vector<std::string> sides;
};

const std::vector<Solid>& solids() {
  using std::numbers::pi;
  static const std::vector<Solid> all{
      {"block", &kBlock, 0.006, {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"}},
      {"cylinder", &kCylinder, pi * 0.01 * 0.5, {"outer", "start", "end"}},
      {"tube", &kTube, pi * (0.01 - 0.075 * 0.075) * 0.5, {"outer", "inner", "start", "end"}},
      {"sphere", &kSphere, 4.0 / 3.0 * pi, {"outer"}},
  };
  return all;
}

double volume(const solids::Mesh& mesh) {
  double sum = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) sum += solids::element_volume(mesh, e);
  return sum;
}

/// ∫ n dA and ∫ X·n dA / 3 of a surface, by Gauss' rule of degree 5 with the faces' own shape.
struct Flux {
  Vec3 area = Vec3::Zero();
  double volume = 0.0;
};
Flux flux(const solids::Mesh& mesh, const solids::Surface& surface) {
  Flux sum;
  const double p = std::sqrt(0.6);
  const double xs[] = {-p, 0.0, p}, ws[] = {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  for (const solids::FaceBlock& block : surface.blocks) {
    const solids::CellShape& shape = block.shape();
    const bool triangle = shape.corners == 3;
    for (int f = 0; f < block.size(); ++f)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          Vec3 xi{xs[i], xs[j], 0.0};
          double weight = ws[i] * ws[j];
          if (triangle) {
            const double u = 0.5 * (1.0 + xs[i]), v = 0.5 * (1.0 + xs[j]);
            xi = {u, v * (1.0 - u), 0.0};
            weight *= 0.25 * (1.0 - u);
          }
          const Vec N = solids::shape_functions(shape, xi);
          const Mat D = solids::shape_gradients(shape, xi);
          Vec3 X = Vec3::Zero(), a = Vec3::Zero(), b = Vec3::Zero();
          for (int n = 0; n < shape.size(); ++n) {
            const Vec3& Xn = mesh.nodes[block.nodes[shape.size() * f + n]];
            X += N[n] * Xn;
            a += D(n, 0) * Xn;
            b += D(n, 1) * Xn;
          }
          const Vec3 normal = weight * a.cross(b);
          sum.area += normal;
          sum.volume += X.dot(normal) / 3.0;
        }
  }
  return sum;
}

class EveryGenerator : public testing::TestWithParam<std::tuple<std::size_t, std::string>> {};

// If two neighbours divided their common face differently, it would count as boundary twice and the
// fluxes would not cancel; if a cell were inverted, its volume would be missing.
TEST_P(EveryGenerator, FillsItsShapeWithoutGaps) {
  const auto& [index, type] = GetParam();
  const Solid& solid = solids()[index];
  if (std::string(solid.generator) == "sphere" && type.starts_with("wedge")) {
    EXPECT_THROW((void)solids::make_mesh("mesh", "sphere", kSphere, type), InputError);
    return;
  }
  const solids::Mesh mesh = solids::make_mesh("mesh", solid.generator, *solid.parameters, type);
  EXPECT_EQ(mesh.blocks[0].type, type);
  EXPECT_THAT(solids::mesh_faults(mesh), testing::IsEmpty());
  const double filled = volume(mesh);
  const solids::Surface all = solids::boundary(mesh);
  const Flux outside = flux(mesh, all);
  const double size = solids::extent(mesh).size();
  EXPECT_LT(outside.area.norm(), 1e-12 * size * size);
  EXPECT_NEAR(outside.volume, filled, 1e-12 * filled);
  // Area lost by straight sides of a circle: sin(h)/h of 16 sides is 1 − 2.6e-2; of a sphere twice
  // as much. Quadratic sides leave the square of that.
  const bool quadratic = solids::cell_shape(type).order == 2;
  const double tolerance = index == 0 ? 1e-12 : quadratic ? 2e-3 : 0.1;
  EXPECT_NEAR(filled, solid.volume, tolerance * solid.volume);

  // The named sides are the whole boundary.
  int named = 0;
  for (const auto& [name, surface] : mesh.surfaces) named += surface.size();
  EXPECT_EQ(named, all.size());
  std::vector<std::string> names;
  for (const auto& [name, surface] : mesh.surfaces) names.push_back(name);
  EXPECT_THAT(names, testing::UnorderedElementsAreArray(solid.sides));
}

INSTANTIATE_TEST_SUITE_P(Meshes, EveryGenerator,
                         testing::Combine(testing::Range<std::size_t>(0, 4),
                                          testing::Values("hex8", "hex20", "hex27", "tet4", "tet10",
                                                          "tet15", "wedge6", "wedge15")),
                         [](const auto& one) {
                           return std::string(solids()[std::get<0>(one.param)].generator) + "_" +
                                  std::get<1>(one.param);
                         });

TEST(BlockMesh, GrowsItsCellsByTheGrading) {
  const solids::Mesh mesh = solids::make_mesh(
      "m", "block", {{"size", {7, 1, 1}}, {"cells", {3, 1, 1}}, {"grading", {4, 1, 1}}});
  // Lengths 1, 2, 4, centred.
  std::set<double> xs;
  for (const Vec3& X : mesh.nodes) xs.insert(std::round(1e9 * X[0]) / 1e9);
  EXPECT_THAT(xs, testing::ElementsAre(-3.5, -2.5, -0.5, 3.5));
}

TEST(CylinderMesh, HasNodesOfQuadraticElementsOnItsRim) {
  for (const char* type : {"hex20", "hex27", "tet10", "wedge15"}) {
    const solids::Mesh mesh = solids::make_mesh("m", "cylinder", kCylinder, type);
    for (int node : mesh.surfaces.at("outer").nodes())
      EXPECT_NEAR(std::hypot(mesh.nodes[node][0], mesh.nodes[node][1]), 0.1, 1e-15) << type;
  }
}

TEST(SphereMesh, IsCutAlongCoordinatePlanesWhenOctantsAreLeftOut) {
  solids::MeshParameters octant = kSphere;
  for (const auto& [octants, cuts] : std::map<double, std::size_t>{{1, 3}, {2, 2}, {4, 1}}) {
    octant["octants"] = {octants};
    const solids::Mesh mesh = solids::make_mesh("m", "sphere", octant, "hex27");
    EXPECT_NEAR(volume(mesh), octants / 6.0 * std::numbers::pi, 1e-3 * octants);
    EXPECT_EQ(mesh.surfaces.size(), cuts + 1);
    EXPECT_LT(flux(mesh, solids::boundary(mesh)).area.norm(), 1e-12);
    EXPECT_GE(solids::extent(mesh).least[2], 0.0);
  }
}

TEST(LineMesh, RunsThroughItsPoints) {
  const solids::Mesh mesh =
      solids::make_mesh("m", "line", {{"points", {0, 0, 0, 1, 0, 0, 1, 2, 0}}, {"cells", {2}}});
  ASSERT_EQ(mesh.nodes.size(), 5U);
  EXPECT_EQ(mesh.nodes[2], Vec3(1, 0, 0));
  EXPECT_EQ(mesh.nodes[4], Vec3(1, 2, 0));
  EXPECT_THAT(mesh.blocks[0].nodes, testing::ElementsAre(0, 1, 1, 2, 2, 3, 3, 4));
  EXPECT_THAT(mesh.node_sets.at("end"), testing::ElementsAre(4));
  const solids::Mesh curved =
      solids::make_mesh("m", "line", {{"points", {0, 0, 0, 1, 0, 0}}, {"cells", {2}}}, "line3");
  EXPECT_THAT(curved.blocks[0].nodes, testing::ElementsAre(0, 2, 1, 2, 4, 3));
}

TEST(MakeMesh, ReportsInvalidParameters) {
  const auto message = [](const char* generator, solids::MeshParameters parameters,
                          const char* type) {
    try {
      (void)solids::make_mesh("solids.pad.mesh", generator, parameters, type);
      return std::string("no error");
    } catch (const InputError& e) {
      return std::string(e.what());
    }
  };
  EXPECT_EQ(message("blok", {}, ""),
            "solids.pad.mesh: there is no mesh generator 'blok'. Did you mean 'block'? Generators: "
            "block, cylinder, tube, sphere, line.");
  EXPECT_EQ(message("block", {{"size", {1, 1, 1}}}, ""),
            "solids.pad.mesh: 'cells' is missing. Give x, y, z: cells along each side.");
  EXPECT_EQ(message("block", {{"size", {1, 1}}, {"cells", {1, 1, 1}}}, ""),
            "solids.pad.mesh.size: 2 numbers are given, but there are 3: x, y, z. Give each once.");
  EXPECT_EQ(message("block", {{"size", {1, 1, 1}}, {"cells", {1, 1.5, 1}}}, ""),
            "solids.pad.mesh.cells: 1.5 is not a count of cells. Give a whole number of reasonable "
            "size.");
  EXPECT_EQ(message("block", {{"size", {1, -1, 1}}, {"cells", {1, 1, 1}}}, ""),
            "solids.pad.mesh.size: -1 is not positive. Give a positive number.");
  EXPECT_EQ(message("block", {{"size", {1, 1, 1}}, {"cells", {1e4, 1e4, 1e4}}}, ""),
            "solids.pad.mesh: 1000000000000 cells are too many for one mesh. Use fewer.");
  EXPECT_EQ(message("sphere", kSphere, "wedge6"),
            "solids.pad.mesh: a 'sphere' cannot be made of 'wedge6'. Types: hex8, hex20, hex27, "
            "tet4, tet10, tet15.");
  EXPECT_EQ(message("cylinder", {{"diameter", {1}}, {"length", {1}}, {"cells", {1, 6, 1}}}, ""),
            "solids.pad.mesh: cells: 6 cells around, which 4 does not divide. Use 4, 8, 12, ….");
  EXPECT_EQ(
      message("tube", {{"inner", {1}}, {"outer", {2}}, {"length", {1}}, {"cells", {1, 2, 1}}}, ""),
      "solids.pad.mesh: cells: 2 cells around are too few. Use at least 3.");
  EXPECT_EQ(
      message("block", {{"size", {1, 1, 1}}, {"cells", {1, 1, 1}}, {"grading", {1, 1e5, 1}}}, ""),
      "solids.pad.mesh.grading: a ratio of 100000 is too far from 1. Stay between 1e-4 and "
      "1e4.");
}

TEST(InlineMesh, TakesTheTypeFromTheCountOfNodes) {
  const std::vector<Vec3> nodes{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const solids::Mesh mesh = solids::inline_mesh("m", nodes, {{0, 1, 2, 3}}, {{"foot", {2, 0, 2}}});
  EXPECT_EQ(mesh.blocks[0].type, "tet4");
  EXPECT_THAT(mesh.node_sets.at("foot"), testing::ElementsAre(0, 2));
  EXPECT_THROW((void)solids::inline_mesh("m", nodes, {{0, 1, 2, 4}}, {}), InputError);
  EXPECT_THROW((void)solids::inline_mesh("m", nodes, {{0, 1, 2, 2}}, {}), InputError);
  EXPECT_THROW((void)solids::inline_mesh("m", nodes, {{0, 1, 2, 3, 3}}, {}), InputError);
  EXPECT_THROW((void)solids::inline_mesh("m", nodes, {{0, 1, 2, 3}}, {{"x", {-1}}}), InputError);
}

}  // namespace
}  // namespace polhode::generators_tests
