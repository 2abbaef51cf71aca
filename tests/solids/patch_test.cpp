// SPDX-License-Identifier: Apache-2.0
// Patch test of meshes of every element, and their stiffness in bending.
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include <solids/solid_step.hpp>

#include <polhode/solids/loads/traction.hpp>
#include <polhode/solids/mesh/generators.hpp>

namespace polhode::test::patch_tests {
namespace {

struct Constant : TimeFunction {
  double value;
  explicit Constant(double v) : value(v) {}
  double operator()(double /*t*/) const override { return value; }
  bool is_constant() const override { return true; }
};

std::unique_ptr<solids::SolidElements> solid_of(const solids::Mesh& mesh,
                                                const solids::ElementKind& kind,
                                                std::shared_ptr<const solids::Material> material) {
  const std::vector<Vec3> fibres = test::example_directions(*material);
  return solids::make_solid_elements({.name = "solids.block",
                                      .element = kind.name,
                                      .material = std::move(material),
                                      .density = 1000.0,
                                      .connectivity = mesh.blocks[0].nodes,
                                      .X = mesh.nodes,
                                      .fibres = fibres});
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const solids::ElementKind& kind : solids::element_kinds()) names.push_back(kind.name);
  return names;
}

/// Indices of the components of nodes that keep() does not fix.
template <class Keep>
std::vector<int> free_components(const std::vector<Vec3>& X, const Keep& keep) {
  std::vector<int> free;
  for (std::size_t i = 0; i < X.size(); ++i)
    for (int c = 0; c < 3; ++c)
      if (!keep(X[i])) free.push_back(3 * static_cast<int>(i) + c);
  return free;
}

/// Moves corners that are not on the boundary; nodes between them follow, so that edges are
/// straight.
void distort(solids::Mesh& mesh, const solids::CellShape& cell, Random& random) {
  std::set<int> corners;
  for (std::size_t e = 0; e < mesh.blocks[0].nodes.size(); e += cell.nodes.size())
    for (int a = 0; a < cell.corners; ++a)
      corners.insert(mesh.blocks[0].nodes[e + static_cast<std::size_t>(a)]);
  for (const int i : corners)
    if (mesh.nodes[static_cast<std::size_t>(i)].cwiseAbs().maxCoeff() < 0.49)
      mesh.nodes[static_cast<std::size_t>(i)] += random.vector(0.08);
  if (cell.corners == cell.size()) return;
  const solids::CellShape& straight = solids::cell_shape(cell.corners == 8   ? "hex8"
                                                         : cell.corners == 6 ? "wedge6"
                                                                             : "tet4");
  for (std::size_t e = 0; e < mesh.blocks[0].nodes.size(); e += cell.nodes.size()) {
    const int* own = mesh.blocks[0].nodes.data() + e;
    for (int a = cell.corners; a < cell.size(); ++a) {
      const Vec N = solids::shape_functions(straight, cell.nodes[static_cast<std::size_t>(a)]);
      Vec3 x = Vec3::Zero();
      for (int b = 0; b < cell.corners; ++b)
        x += N[b] * mesh.nodes[static_cast<std::size_t>(own[b])];
      mesh.nodes[static_cast<std::size_t>(own[a])] = x;
    }
  }
}

class Patch : public testing::TestWithParam<std::string> {};

// The boundary of a distorted block has a homogeneous large strain: the interior has the same
// strain at every point.
TEST_P(Patch, IsStrainedHomogeneouslyIfItsBoundaryIs) {
  const solids::ElementKind& kind = solids::element_kind(GetParam());
  for (const solids::MaterialDescription& d : example_materials()) {
    if (!suits(kind, d)) continue;
    SCOPED_TRACE(label(d));
    Random random(11);
    solids::Mesh mesh = solids::make_mesh("patch", "block",
                                          {{"size", {1, 1, 1}}, {"cells", {2, 2, 2}}}, kind.shape);
    distort(mesh, kind.cell(), random);
    const auto group = solid_of(mesh, kind, example_material(d));
    Mat3 F;
    F << 1.08, 0.05, -0.03, 0.02, 0.93, 0.06, -0.04, 0.03, 1.02;
    const std::vector<int> free =
        free_components(mesh.nodes, [](const Vec3& X) { return X.cwiseAbs().maxCoeff() > 0.4999; });
    SolidStep step(mesh.nodes, context_of(1.0));
    step.begin(*group);
    step.stand_still();
    const auto exact = [&](int i) -> Vec3 { return F * mesh.nodes[static_cast<std::size_t>(i)]; };
    for (int i = 0; i < step.nodes(); ++i) step.x_n.segment<3>(3 * i) = exact(i);
    for (const int k : free) step.x_n[k] += random.number(0.01);
    double move = 1.0;
    for (int iteration = 0; iteration < 12 && move > 1e-14; ++iteration) {
      const SolidStep::Result r = step.evaluate(*group);
      Vec du = Vec::Zero(step.x_n.size());
      if (!free.empty()) {
        const Vec part = Mat(r.tangent(free, free)).partialPivLu().solve(r.force(free));
        for (std::size_t k = 0; k < free.size(); ++k) du[free[k]] = -part[static_cast<int>(k)];
      }
      step.x_n += du;
      move = std::max(du.cwiseAbs().maxCoeff(),
                      group->advance(du.data(), Mat3::Identity(), step.scratch.data()));
    }
    double error = 0.0;
    for (int i = 0; i < step.nodes(); ++i)
      error = std::max(error, (step.x_n.segment<3>(3 * i) - exact(i)).norm());
    EXPECT_LT(error, 1e-12);
    step.with([&](const NodeStep& s) {
      group->commit(s, step.history.data(), step.scratch.data());
      return 0;
    });
    std::vector<ElementSample> samples(static_cast<std::size_t>(group->size()));
    step.with([&](const NodeStep& s) { return group->sample(s, step.history.data(), samples); });
    const Mat3 E = 0.5 * (F.transpose() * F - Mat3::Identity());
    Vec6 e;
    e << E(0, 0), E(1, 1), E(2, 2), E(0, 1), E(1, 2), E(2, 0);
    std::vector<Vec3> A = test::example_directions(group->material());
    for (Vec3& a : A) a.normalize();
    const Vec6 s = solids::discrete_stress(group->material(), e, e, A).S;
    Mat3 S;
    S << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    const Mat3 cauchy = F * S * F.transpose() / F.determinant();
    for (const ElementSample& sample : samples)
      EXPECT_LT((sample.cauchy - cauchy).norm(), 1e-11 * group->material().bulk_modulus());
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, Patch, testing::ValuesIn(kind_names()),
                         [](const auto& test) { return test.param; });

/// Deflection of a cantilever of square section under a small shear at its end, over that of
/// Timoshenko's beam with a shear factor of 5/6.
double cantilever(const std::string& element, int along, int across, double slenderness) {
  const double L = 10.0, h = L / slenderness, E = 1e4, nu = 0.3, P = 1.0;
  const solids::ElementKind& kind = solids::element_kind(element);
  const double n = along, m = across;
  const solids::Mesh mesh =
      solids::make_mesh("beam", "block", {{"size", {L, h, h}}, {"cells", {n, m, m}}}, kind.shape);
  const double mu = E / (2.0 * (1.0 + nu));
  const solids::MaterialDescription described =
      kind.sizes().mean_dilatation
          ? solids::MaterialDescription{.kind = "mooney_rivlin_uncoupled",
                                        .values = {{"c1", 0.5 * mu},
                                                   {"bulk_modulus", E / (3.0 * (1.0 - 2.0 * nu))}}}
          : solids::MaterialDescription{.kind = "elastic",
                                        .values = {{"youngs_modulus", E}, {"poisson_ratio", nu}}};
  const auto group = solid_of(mesh, kind, solids::make_material("m", described));
  SolidStep step(mesh.nodes, context_of(1.0));
  step.begin(*group);
  step.stand_still();
  std::vector<solids::LoadedFaces> end;
  for (const solids::FaceBlock& block : mesh.surfaces.at("xmax").blocks)
    end.push_back({block.type, block.nodes});
  const auto load = solids::make_traction(
      "loads.end", end, mesh.nodes, {nullptr, nullptr, std::make_shared<Constant>(P / (h * h))});
  const std::vector<int> free =
      free_components(mesh.nodes, [&](const Vec3& X) { return X[0] < -0.4999 * L; });
  const Mat K = -step.evaluate(*group).tangent(free, free);
  const Vec f = step.evaluate(*load, false).force(free);
  const Vec u = K.ldlt().solve(f);
  // The mean deflection of the loaded face, in the sense of the load's work.
  const double deflection = f.dot(u) / P;
  const double I = h * h * h * h / 12.0;
  return deflection / (P * L * L * L / (3.0 * E * I) + P * L / (5.0 / 6.0 * mu * h * h));
}

// Hexahedra with two nodes per edge, against an independent program to its three digits.
TEST(Cantilever, HasThePublishedStiffnessOfItsElements) {
  EXPECT_NEAR(cantilever("hex8_standard", 5, 1, 10.0), 0.367, 1e-3);
  EXPECT_NEAR(cantilever("hex8_standard", 10, 1, 10.0), 0.643, 1e-3);
  EXPECT_NEAR(cantilever("hex8_standard", 10, 1, 100.0), 0.025, 1e-3);
  EXPECT_NEAR(cantilever("hex8_eas9", 5, 1, 10.0), 0.970, 1e-3);
  EXPECT_NEAR(cantilever("hex8_eas9", 10, 1, 10.0), 0.985, 1e-3);
  EXPECT_NEAR(cantilever("hex8_eas9", 10, 2, 10.0), 0.976, 1e-3);
  EXPECT_NEAR(cantilever("hex8_eas9", 10, 1, 100.0), 0.988, 1e-3);
  EXPECT_NEAR(cantilever("hex8_q1p0", 10, 1, 10.0), 1.197,
              1e-3);  // too soft: one layer is not enough
  EXPECT_NEAR(cantilever("hex8_q1p0", 10, 2, 10.0), 0.759, 1e-3);
}

// Quadratic elements are within the thickness of the clamp, where Poisson's contraction is held:
// about ν² (h/L) and less than 3 %.
TEST(Cantilever, BendsByTheClosedFormWithQuadraticElements) {
  for (const char* element : {"hex20", "hex27", "tet10", "tet15", "wedge15"})
    EXPECT_NEAR(cantilever(element, 10, 1, 10.0), 0.985, 0.015) << element;
  EXPECT_LT(cantilever("tet4", 10, 1, 10.0), 0.4);
}

}  // namespace
}  // namespace polhode::test::patch_tests
