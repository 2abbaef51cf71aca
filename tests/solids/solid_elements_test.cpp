// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <solids/solid_step.hpp>

#include <polhode/core/error.hpp>

namespace polhode::test::solid_elements_tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;

std::shared_ptr<const solids::Material> rubber() {
  return solids::make_material(
      "materials.rubber",
      {.kind = "neo_hookean", .values = {{"youngs_modulus", 1e6}, {"poisson_ratio", 0.3}}});
}

solids::SolidElementsDescription cube(const std::string& element = "hex8_standard") {
  static const std::vector<Vec3> X = solids::cell_shape("hex8").nodes;
  return {.name = "solids.pad",
          .element = element,
          .material = rubber(),
          .density = 1000.0,
          .connectivity = {0, 1, 2, 3, 4, 5, 6, 7},
          .X = X};
}

auto refused(const char* part, const char* more = "") {
  return ThrowsMessage<InputError>(
      AllOf(StartsWith("solids.pad"), HasSubstr(part), HasSubstr(more)));
}
auto make(solids::SolidElementsDescription d) {
  return [d] { (void)solids::make_solid_elements(d); };
}

TEST(SolidElements, NameTheElementThatIsInvertedOrFlat) {
  auto d = cube();
  d.connectivity = {0, 1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 7, 0, 1, 2, 3};
  EXPECT_THAT(make(d), refused("element 1", "inverted"));
  std::vector<Vec3> flat = solids::cell_shape("hex8").nodes;
  for (Vec3& X : flat) X[2] = 0.0;
  d = cube();
  d.X = flat;
  EXPECT_THAT(make(d), refused("element 0", "flat"));
  // One corner pushed through the opposite faces: the inversion is not visible at the points of the
  // rule.
  std::vector<Vec3> dented = solids::cell_shape("hex8").nodes;
  dented[6] = Vec3(0.0, 0.0, 0.0);
  d = cube();
  d.X = dented;
  EXPECT_THAT(make(d), refused("element 0"));
}

TEST(SolidElements, RefuseInvalidDescriptions) {
  auto d = cube();
  d.density = 0.0;
  EXPECT_THAT(make(d), refused("density is 0"));
  d = cube();
  d.connectivity.pop_back();
  EXPECT_THAT(make(d), refused("7 node numbers"));
  d = cube();
  d.connectivity[3] = 8;
  EXPECT_THAT(make(d), refused("names node 8"));
  d = cube("hex8_q1p0");
  EXPECT_THAT(make(d), refused("needs an uncoupled material"));
  d = cube();
  d.material = solids::make_material(
      "m", {.kind = "elastic",
            .values = {{"lame", 1.0}, {"shear_modulus", 1.0}},
            .fibres = {{.law = "exponential", .values = {{"xi", 1.0}, {"alpha", 1.0}}}}});
  EXPECT_THAT(make(d), refused("fibres"));
  EXPECT_THROW((void)solids::make_solid_elements(cube("hex20r")), InputError);
}

TEST(SolidElements, WarnOfElementsThatLock) {
  EXPECT_THAT(solids::make_solid_elements(cube())->warnings(),
              testing::ElementsAre(HasSubstr("hex8_standard locks")));
  EXPECT_THAT(solids::make_solid_elements(cube("hex8_eas9"))->warnings(), testing::IsEmpty());
}

TEST(SolidElements, AreChosenByCellsAndMaterial) {
  EXPECT_EQ(solids::choose_element("solids.pad", "hex8", "hex8", false).name, "hex8_eas9");
  EXPECT_EQ(solids::choose_element("solids.pad", "", "hex8", true).name, "hex8_q1p0");
  EXPECT_EQ(solids::choose_element("solids.pad", "", "tet10", true).name, "tet10");
  EXPECT_THAT([] { (void)solids::choose_element("solids.pad", "tet10", "hex8", false); },
              refused("does not fit the mesh", "hex8_eas9"));
  EXPECT_THAT([] { (void)solids::choose_element("solids.pad", "hex8_q1p0", "hex8", false); },
              refused("uncoupled"));
  EXPECT_THAT([] { (void)solids::choose_element("solids.pad", "hex8_eas", "hex8", false); },
              refused("Did you mean 'hex8_eas9'?"));
}

TEST(SolidElements, ReportAnEnhancedElementThatIsCompressedTooFar) {
  const auto group = solids::make_solid_elements(cube("hex8_eas9"));
  SolidStep step(solids::cell_shape("hex8").nodes, context_of(1.0));
  step.begin(*group);
  const auto least_at = [&](double stretch) {
    for (int i = 0; i < 8; ++i)
      step.x_n[3 * i + 1] = stretch * step.X[static_cast<std::size_t>(i)][1];
    step.stand_still();
    return step.with(
        [&](const NodeStep& s) { return group->least_stretch(s, step.history.data()); });
  };
  EXPECT_NEAR(least_at(0.75).value, 0.75, 1e-14);
  EXPECT_EQ(group->stretch_warning(least_at(0.75)), "");
  EXPECT_THAT(group->stretch_warning(least_at(0.65)),
              AllOf(HasSubstr("element 0"), HasSubstr("0.65"), HasSubstr("0.7")));
}

TEST(SolidElements, NameTheElementThatCollapses) {
  const auto group = solids::make_solid_elements(cube());
  SolidStep step(solids::cell_shape("hex8").nodes, context_of(1.0));
  step.begin(*group);
  for (int i = 4; i < 8; ++i) step.x_n1[3 * i + 2] = -2.0;
  const SolidStep::Result r = step.evaluate(*group);
  EXPECT_LT(r.report.least_volume, 0.0);
  EXPECT_EQ(r.report.worst_element, 0);
}

// The pressure of mean dilatation that the tangent uses is extrapolated with the displacements of
// nodes: after a small displacement it is exact to second order. Forces do not depend on it.
TEST(MeanDilatation, ExtrapolatesItsPressureForTangentsOnly) {
  const solids::ElementKind& kind = solids::element_kind("hex8_q1p0");
  Random random(3);
  const std::vector<Vec3> X = distorted_element(kind, random);
  const auto group =
      one_element(kind, X,
                  solids::make_material("m", {.kind = "mooney_rivlin_uncoupled",
                                              .values = {{"c1", 1.0}, {"bulk_modulus", 1e3}}}));
  const auto difference = [&](double size, bool advance) {
    SolidStep step(X, context_of(1.0));
    step.begin(*group);
    Random moves(9);
    for (double& x : step.x_n) x += moves.number(0.05);
    step.stand_still();
    step.mixed_point = true;
    step.evaluate(*group);
    Vec du(step.x_n.size());
    for (double& d : du) d = moves.number(size);
    step.x_n += du;
    if (advance) group->advance(du.data(), Mat3::Identity(), step.scratch.data());
    const SolidStep::Result mixed = step.evaluate(*group);
    step.mixed_point = false;
    const SolidStep::Result plain = step.evaluate(*group);
    EXPECT_LT((mixed.force - plain.force).norm(), 1e-14 * plain.force.norm());
    return (mixed.tangent - plain.tangent).norm() / plain.tangent.norm();
  };
  EXPECT_NEAR(difference(1e-3, true) / difference(1e-4, true), 100.0, 10.0);
  EXPECT_NEAR(difference(1e-3, false) / difference(1e-4, false), 10.0, 1.0);
}

// @tests{solid-condensation}
// One correction at a time, nodes and modes together: Newton's method converges as with modes in
// equilibrium at every evaluation.
TEST(EnhancedStrains, ConvergeTogetherWithTheNodes) {
  const solids::ElementKind& kind = solids::element_kind("hex8_eas9");
  Random random(3);
  const std::vector<Vec3> X = distorted_element(kind, random);
  const auto group = one_element(kind, X, rubber());
  SolidStep step(X, context_of(1.0));
  step.begin(*group);
  step.stand_still();
  // Held at one face, bent at the other.
  std::vector<int> free;
  Vec load = Vec::Zero(24);
  for (int i = 0; i < 8; ++i)
    if (X[static_cast<std::size_t>(i)][0] > 0.0) {
      for (int c = 0; c < 3; ++c) free.push_back(3 * i + c);
      load[3 * i] = X[static_cast<std::size_t>(i)][2] > 0.0 ? 5e4 : -5e4;
    }
  std::vector<double> moves;
  for (int k = 0; k < 10; ++k) {
    const SolidStep::Result r = step.evaluate(*group);
    const Vec part = r.tangent(free, free).fullPivLu().solve(Vec((r.force + load)(free)));
    Vec du = Vec::Zero(24);
    for (std::size_t j = 0; j < free.size(); ++j) du[free[j]] = -part[static_cast<int>(j)];
    step.x_n += du;
    moves.push_back(std::max(du.cwiseAbs().maxCoeff(),
                             group->advance(du.data(), Mat3::Identity(), step.scratch.data())));
  }
  EXPECT_GT(moves[0], 0.05);
  EXPECT_LT(moves[5], 1e-9);
  EXPECT_LT(moves.back(), 1e-14);
  EXPECT_LT((step.evaluate(*group).force + load)(free).norm(), 1e-9);
}

}  // namespace
}  // namespace polhode::test::solid_elements_tests
