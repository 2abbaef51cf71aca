// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <solids/solid_step.hpp>
#include <support/derivative.hpp>

#include <polhode/core/error.hpp>
#include <polhode/solids/elements/reference_data.hpp>
#include <polhode/solids/loads/body_force.hpp>
#include <polhode/solids/loads/nodal_force.hpp>
#include <polhode/solids/loads/pressure.hpp>
#include <polhode/solids/loads/traction.hpp>

namespace polhode::test::solid_loads_tests {
namespace {

struct Value : TimeFunction {
  double value, slope;
  explicit Value(double v, double s = 0.0) : value(v), slope(s) {}
  double operator()(double t) const override { return value + slope * t; }
  bool is_constant() const override { return slope == 0.0; }
};
TimeFunctionPtr constant(double v) { return std::make_shared<Value>(v); }

/// The whole boundary of one distorted cell.
struct Closed {
  Random random{5};
  const solids::ElementKind& kind;
  std::vector<Vec3> X;
  std::vector<solids::LoadedFaces> faces;

  explicit Closed(const std::string& element) : kind(solids::element_kind(element)) {
    X = distorted_element(kind, random);
    for (const solids::CellFace& face : kind.cell().faces) faces.push_back({face.type, face.nodes});
  }
  /// Volume inside the faces: ∫ x·n dA/3 by the faces themselves.
  [[nodiscard]] double volume(const Vec& x) const {
    double sum = 0.0;
    for (const solids::LoadedFaces& f : faces) {
      const solids::CellShape& shape = solids::cell_shape(f.shape);
      for (const solids::QuadraturePoint& q : solids::face_rule(f.shape)) {
        const Vec N = solids::shape_functions(shape, q.xi);
        const Mat D = solids::shape_gradients(shape, q.xi);
        Vec3 at = Vec3::Zero(), xi = Vec3::Zero(), eta = Vec3::Zero();
        for (int a = 0; a < shape.size(); ++a) {
          const Vec3 p = x.segment<3>(3 * f.nodes[static_cast<std::size_t>(a)]);
          at += N[a] * p;
          xi += D(a, 0) * p;
          eta += D(a, 1) * p;
        }
        sum += q.weight * at.dot(xi.cross(eta)) / 3.0;
      }
    }
    return sum;
  }
};

class ClosedSurface : public testing::TestWithParam<std::string> {};

// @tests{solid-follower-pressure}
TEST_P(ClosedSurface, HasNoMomentByOneRuleAndExactWorkByTheOther) {
  Closed cell(GetParam());
  SolidStep step(cell.X, context_of(1.0));
  step.move_at_random(cell.random, 0.1, 0.3);
  const double p = 3.0;
  for (const solids::FollowerRule rule :
       {solids::FollowerRule::kMomentum, solids::FollowerRule::kWork}) {
    const auto groups = solids::make_follower_pressure("loads.p", cell.faces, constant(p), rule);
    Vec force = Vec::Zero(step.x_n.size());
    double put_in = 0.0;
    for (const auto& group : groups) {
      step.begin(*group);
      force += step.evaluate(*group).force;
      put_in += step.work(*group).put_in;
    }
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    for (int i = 0; i < step.nodes(); ++i) {
      sum += force.segment<3>(3 * i);
      moment += (0.5 * (step.x_n + step.x_n1)).segment<3>(3 * i).cross(force.segment<3>(3 * i));
    }
    EXPECT_LT(sum.norm(), 1e-13 * p * 24.0);  // area of a cell
    EXPECT_NEAR(put_in, force.dot(step.x_n1 - step.x_n), 1e-12 * p * 8.0);
    const double work = -p * (cell.volume(step.x_n1) - cell.volume(step.x_n));
    if (rule == solids::FollowerRule::kMomentum) {
      EXPECT_LT(moment.norm(), 1e-13 * p * 24.0 * step.x_n.norm());
      EXPECT_GT(std::abs(put_in - work), 1e-6 * std::abs(work));
    } else {
      EXPECT_NEAR(put_in, work, 1e-13 * p * 24.0 * step.x_n.norm());
    }
  }
}

TEST_P(ClosedSurface, HasTheTangentOfItsForces) {
  Closed cell(GetParam());
  for (const double rho_inf : {1.0, 0.25})
    for (const solids::FollowerRule rule :
         {solids::FollowerRule::kMomentum, solids::FollowerRule::kWork}) {
      SolidStep step(cell.X, context_of(rho_inf));
      step.move_at_random(cell.random, 0.1, 0.3);
      const auto groups = solids::make_follower_pressure("loads.p", cell.faces,
                                                         std::make_shared<Value>(2.0, 1.0), rule);
      for (const auto& group : groups) {
        step.begin(*group);
        expect_derivative(
            step.evaluate(*group).tangent,
            [&](const Vec& d) {
              SolidStep other = step;
              other.x_n1 += d;
              return other.evaluate(*group).force;
            },
            "pressure", 1e-8);
      }
    }
}

TEST_P(ClosedSurface, HasTheResultantsOfTractionAndPressure) {
  Closed cell(GetParam());
  SolidStep step(cell.X, context_of(1.0));
  step.move_at_random(cell.random, 0.1);
  const auto pressure = solids::make_dead_pressure("loads.p", cell.faces, cell.X, constant(3.0));
  const auto traction = solids::make_traction("loads.t", cell.faces, cell.X,
                                              {constant(1.0), nullptr, constant(-2.0)});
  step.begin(*pressure);
  const Vec push = step.evaluate(*pressure).force, pull = step.evaluate(*traction).force;
  Vec3 sum = Vec3::Zero(), total = Vec3::Zero();
  for (int i = 0; i < step.nodes(); ++i) {
    sum += push.segment<3>(3 * i);
    total += pull.segment<3>(3 * i);
  }
  EXPECT_LT(sum.norm(), 1e-13 * 3.0 * 24.0);
  EXPECT_NEAR(total[2], -2.0 * total[0], 1e-13 * total.norm());
  EXPECT_EQ(total[1], 0.0);
  // Dead and constant: a potential. Pressure at the start acts on the undeformed volume.
  const double stored = step.work(*traction).stored;
  SolidStep start = step;
  start.stand_still();
  const double at_start =
      start.with([&](const NodeStep& s) { return traction->work(s, nullptr, nullptr).stored; });
  EXPECT_NEAR(pull.dot(step.x_n1 - step.x_n), at_start - stored, 1e-12 * pull.norm());
  SolidStep rest(cell.X, context_of(1.0));
  rest.stand_still();
  const Vec at_rest = rest.evaluate(*pressure).force;
  EXPECT_NEAR(at_rest.dot(rest.x_n), -3.0 * 3.0 * cell.volume(rest.x_n), 1e-12 * 72.0);
}

TEST_P(ClosedSurface, DistributesTheWeightOfItsVolumeOverItsNodes) {
  Closed cell(GetParam());
  std::vector<int> connectivity;
  for (int i = 0; i < cell.kind.sizes().nodes; ++i) connectivity.push_back(i);
  const auto load =
      solids::make_body_force("loads.b", cell.kind.name, connectivity, cell.X,
                              {constant(2.0), std::make_shared<Value>(0.0, 1.0), nullptr}, 1000.0);
  SolidStep step(cell.X, context_of(1.0, 0.2, 0.4));  // t_{n+αf} = 0.5
  step.begin(*load);
  step.move_at_random(cell.random, 0.1);
  step.context.load_factor = 0.5;
  const Vec force = step.evaluate(*load).force;
  double M[27 * 27];
  solids::element_mass(cell.kind, 1000.0, connectivity, cell.X, M);
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < step.nodes(); ++i) sum += force.segment<3>(3 * i);
  double mass = 0.0;
  for (int i = 0; i < step.nodes() * step.nodes(); ++i) mass += M[i];
  EXPECT_NEAR(sum[0], 0.5 * 2.0 * mass, 1e-12 * mass);
  EXPECT_NEAR(sum[1], 0.5 * 0.5 * mass, 1e-12 * mass);
  EXPECT_EQ(sum[2], 0.0);
  EXPECT_NEAR(step.work(*load).put_in, force.dot(step.x_n1 - step.x_n), 1e-12 * mass);
  EXPECT_TRUE(load->external());
  EXPECT_FALSE(load->conservative());
}

INSTANTIATE_TEST_SUITE_P(Shapes, ClosedSurface,
                         testing::Values("hex8_standard", "hex20", "hex27", "tet4", "tet10",
                                         "tet15", "wedge6", "wedge15"),
                         [](const auto& test) { return test.param; });

TEST(SolidLoads, PutTheSameForceOnEveryNode) {
  Closed cell("hex8_standard");
  const auto load =
      solids::make_nodal_force("loads.f", {1, 5}, cell.X, {nullptr, constant(4.0), nullptr});
  SolidStep step(cell.X, context_of(1.0));
  step.begin(*load);
  const Vec force = step.evaluate(*load).force;
  EXPECT_EQ(force[4], 4.0);
  EXPECT_EQ(force[16], 4.0);
  EXPECT_EQ(force.norm(), std::sqrt(32.0));
}

TEST(SolidLoads, AreRefusedWithoutFacesOrNodes) {
  const std::vector<Vec3> X(4, Vec3::Zero());
  EXPECT_THROW((void)solids::make_traction("loads.t", {}, X, {}), InputError);
  EXPECT_THROW((void)solids::make_nodal_force("loads.f", {}, X, {}), InputError);
  const std::vector<solids::LoadedFaces> lines = {{"line2", {0, 1}}};
  EXPECT_THROW((void)solids::make_dead_pressure("loads.p", lines, X, constant(1.0)), InputError);
}

}  // namespace
}  // namespace polhode::test::solid_loads_tests
