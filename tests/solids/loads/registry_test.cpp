// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <solids/solid_step.hpp>
#include <support/derivative.hpp>

#include <polhode/core/error.hpp>
#include <polhode/solids/loads/registry.hpp>

namespace polhode::test::solid_load_registry_tests {
namespace {

struct Line : TimeFunction {
  double value, slope;
  Line(double v, double s) : value(v), slope(s) {}
  double operator()(double t) const override { return value + slope * t; }
  bool is_constant() const override { return slope == 0.0; }
};

/// A load on all of one distorted cell.
solids::SolidLoadDescription description(const solids::SolidLoadKind& kind,
                                         const solids::ElementKind& element,
                                         std::span<const Vec3> X, double slope) {
  const auto number = [&](double v) { return std::make_shared<Line>(v, v * slope); };
  solids::SolidLoadDescription d{.name = "loads.x", .X = {X.begin(), X.end()}, .density = 1000.0};
  if (kind.value) d.value = number(3.0);
  if (kind.vector) d.vector = {number(1.0), nullptr, number(-2.0)};
  for (const Parameter& p : kind.parameters) d.values[p.name] = p.standard.value_or(1.0);
  for (const solids::CellFace& face : element.cell().faces)
    d.faces.push_back({face.type, face.nodes});
  for (int i = 0; i < element.sizes().nodes; ++i) d.nodes.push_back(i);
  d.elements = {{element.name, d.nodes}};
  return d;
}

/// A load is external and has its tangent. Its work over a step at ρ∞ = 1 is force times
/// displacement, stored energy if it is dead and constant, else supplied.
void check_laws(const solids::SolidLoadKind& kind, const solids::SolidLoadDescription& d,
                const SolidStep& moved, bool potential) {
  const solids::ElementGroups groups = kind.make(d);
  ASSERT_FALSE(groups.empty());
  for (const std::unique_ptr<ElementGroup>& group : groups) {
    SolidStep step = moved;
    step.begin(*group);
    EXPECT_EQ(group->name(), "loads.x");
    EXPECT_TRUE(group->external());
    EXPECT_EQ(group->conservative(), potential);
    const SolidStep::Result result = step.evaluate(*group);
    expect_derivative(
        result.tangent,
        [&](const Vec& change) {
          SolidStep other = step;
          other.x_n1 += change;
          return other.evaluate(*group).force;
        },
        kind.name, 1e-8);
    const double done = result.force.dot(step.x_n1 - step.x_n);
    const Work work = step.work(*group);
    // Sums of at most 27 nodes, each a product of force and position.
    const double rounding = 1e-13 * result.force.norm() * (step.x_n.norm() + step.x_n1.norm());
    if (potential) {
      EXPECT_EQ(work.put_in, 0.0);
      EXPECT_NEAR(step.stored_at_start(*group) - work.stored, done, rounding);
    } else {
      EXPECT_EQ(work.stored, 0.0);
      EXPECT_NEAR(work.put_in, done, rounding);
    }
  }
}

TEST(SolidLoadRegistry, HasKindsThatObeyTheLawsOfLoads) {
  Random random{7};
  const solids::ElementKind& element = solids::element_kind("hex20");
  const std::vector<Vec3> X = distorted_element(element, random);
  SolidStep step(X, context_of(1.0));
  step.move_at_random(random, 0.1, 0.3);
  for (const solids::SolidLoadKind& kind : solids::solid_load_kinds()) {
    SCOPED_TRACE(kind.name);
    EXPECT_NE(kind.value.has_value(), kind.vector.has_value());
    for (const double slope : {0.0, 0.5}) {
      solids::SolidLoadDescription d = description(kind, element, X, slope);
      check_laws(kind, d, step, slope == 0.0);
      if (!kind.can_follow) continue;
      for (const solids::FollowerRule rule :
           {solids::FollowerRule::kMomentum, solids::FollowerRule::kWork}) {
        d.follower = rule;
        check_laws(kind, d, step, false);
      }
    }
  }
}

TEST(SolidLoadRegistry, ListsTheNamesWhenOneIsUnknown) {
  try {
    (void)solids::solid_load_kind("loads.x.type", "torque");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "loads.x.type: 'torque' does not act on solids. Use one of: pressure, traction, "
                 "body_force, nodal_force.");
  }
}

}  // namespace
}  // namespace polhode::test::solid_load_registry_tests
