// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/compile/build_system.hpp>
#include <polhode/core/error.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/method.hpp>
#include <polhode/simulation/smooth_model.hpp>

#include "support/model_builder.hpp"

namespace polhode::test::method_tests {
namespace {

using testing::HasSubstr;

/// Bodies in a row, each hinged to the one before.
Model chain(int bodies) {
  ModelBuilder m;
  int before = kGround;
  for (int k = 0; k < bodies; ++k) {
    const int b = m.body("b" + std::to_string(k), {k + 0.5, 0.0, 0.0}, 1.0, {0.1, 0.1, 0.1});
    m.joint("hinge_" + std::to_string(k), "revolute", before, b, {1.0 * k, 0.0, 0.0},
            Vec3::UnitY());
    before = b;
  }
  return m.model;
}

Model damped_chain() {
  ModelBuilder m;
  m.model = chain(2);
  m.spring("damper", kGround, {0.0, 0.0, 1.0}, 1, {1.5, 0.0, 0.0}, {{"damping", 2.0}});
  return m.model;
}

/// Bodies all of which are connected to the ground and to one another by rods.
Model rods(int bodies) {
  ModelBuilder m;
  for (int k = 0; k < bodies; ++k)
    m.point_mass("p" + std::to_string(k), {std::cos(0.5 * k), std::sin(0.5 * k), 0.1 * k * k}, 1.0);
  for (int k = 0; k < bodies; ++k)
    for (int j = 0; j < k; ++j)
      m.distance("rod_" + std::to_string(j) + "_" + std::to_string(k), j, m.at(j).position, k,
                 m.at(k).position);
  return m.model;
}

Model balls(int count, const std::string& potential) {
  Model model;
  model.contacts.present = true;
  model.contacts.standard.potential = potential;
  model.analysis.step = 1e-3;
  for (int k = 0; k < count; ++k) {
    BodySpec ball;
    ball.name = "ball_" + std::to_string(k);
    ball.mass = 1.0;
    ball.inertia = 0.004 * Mat3::Identity();
    ball.position = {0.3 * k, 0.0, 0.0};
    ball.shapes.emplace_back();
    ball.shapes.back().type = "sphere";
    ball.shapes.back().sizes = {0.2};
    model.bodies.push_back(ball);
  }
  return model;
}

Model block() {
  return io::read_model_text(R"(
format: 1
bodies: {arm: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0, -0.5]}}
materials: {rubber: {type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  pad: {mesh: {block: {size: [0.1, 0.1, 0.1], cells: [1, 1, 1]}}, material: rubber, bonded: {arm: zmin}}
)",
                             "block.yaml");
}

Method method_of(Model model, const AnalysisSpec& analysis = {}) {
  const System system = build_system(model);
  model.analysis = analysis;
  return choose_method(system, model);
}
AnalysisSpec with(const std::function<void(AnalysisSpec&)>& change) {
  AnalysisSpec analysis;
  change(analysis);
  return analysis;
}

struct Chosen {
  std::string engine, narration;
};
Chosen chosen(Model model, const AnalysisSpec& analysis = {}) {
  const System system = build_system(model);
  model.analysis = analysis;
  const Method m = choose_method(system, model);
  return {m.engine->name(), m.narration};
}

TEST(Method, SolvesTreesAndFewLoopsAlongTheTree) {
  EXPECT_EQ(chosen(chain(20)).engine, "tree");
  EXPECT_EQ(chosen(chain(20)).narration, "");
  EXPECT_EQ(chosen(rods(4)).engine, "tree");
}

TEST(Method, SolvesManyLoopsByBlockLu) {
  const Chosen loops = chosen(rods(20));
  EXPECT_EQ(loops.engine, "block_lu");
  EXPECT_THAT(loops.narration, HasSubstr("kinematic loops pass one body"));
}

TEST(Method, SolvesContactOfFewBodiesDirectlyAndOfManyByConjugateGradients) {
  EXPECT_EQ(chosen(balls(49, "barrier")).engine, "contact + block_lu");
  const Chosen many = chosen(balls(50, "barrier"));
  EXPECT_EQ(many.engine, "contact CG");
  EXPECT_THAT(many.narration, HasSubstr("contact alone couples 50 bodies"));
  EXPECT_EQ(chosen(balls(50, "barrier"), with([](auto& a) { a.solver = "klu"; })).engine,
            "contact + klu");
  EXPECT_EQ(chosen(balls(50, "barrier"), with([](auto& a) { a.rho_inf = 0.9; })).engine,
            "contact + block_lu");
  EXPECT_EQ(chosen(balls(2, "nonsmooth")).engine, "impulses: projected Gauss-Seidel");
}

TEST(Method, SolvesSolidsWithMumps) {
  EXPECT_EQ(chosen(block()).engine, "mumps + block_lu");
  EXPECT_EQ(chosen(block(), with([](auto& a) { a.solver = "sparse_lu"; })).engine,
            "mumps + sparse_lu");
}

TEST(Method, TakesTheSolverThatIsGiven) {
  for (const std::string solver : {"tree", "block_lu", "klu", "sparse_lu"})
    EXPECT_EQ(chosen(chain(3), with([&](auto& a) { a.solver = solver; })).engine, solver);
  EXPECT_EQ(chosen(rods(20), with([](auto& a) { a.solver = "tree"; })).engine, "tree");
}

TEST(Method, LeavesTheTreeForSettingsItDoesNotSupport) {
  for (const auto& analysis : {with([](auto& a) { a.momentum_rate = "kinematic"; }),
                               with([](auto& a) { a.jacobian = "every_step"; }),
                               with([](auto& a) { a.jacobian = "never"; })}) {
    const Chosen c = chosen(chain(3), analysis);
    EXPECT_EQ(c.engine, "block_lu");
    EXPECT_THAT(c.narration, HasSubstr("does not support this momentum_rate or jacobian"));
  }
}

TEST(Method, ChoosesTheOrderFromTheTolerance) {
  const auto order = [](const Model& model, const AnalysisSpec& a) {
    return method_of(model, a).control.order;
  };
  const AnalysisSpec tolerance = with([](auto& a) { a.tolerance = 1e-8; });
  EXPECT_EQ(order(chain(2), {}), 2);
  EXPECT_EQ(order(chain(2), tolerance), 6);
  EXPECT_EQ(order(damped_chain(), tolerance), 12) << "the highest of those by extrapolation";
  EXPECT_EQ(order(balls(2, "barrier"), tolerance), 2);
  AnalysisSpec fixed = tolerance;
  fixed.step = 1e-3;
  EXPECT_EQ(order(chain(2), fixed), 2);
  AnalysisSpec damping = tolerance;
  damping.rho_inf = 0.9;
  EXPECT_EQ(order(chain(2), damping), 2);
  AnalysisSpec given = fixed;
  given.order = 8;
  EXPECT_EQ(order(chain(2), given), 8);
}

TEST(Method, ExtrapolatesWhatACompositionCannotReach) {
  const auto method = [](const Model& model, int order, bool fixed) {
    return method_of(model, with([&](auto& a) {
                       a.order = order;
                       if (fixed) a.step = 1e-2;
                     }))
        .control;
  };
  EXPECT_FALSE(method(chain(2), 6, true).extrapolated);
  EXPECT_FALSE(method(chain(2), 4, true).extrapolated);
  EXPECT_TRUE(method(chain(2), 4, false).extrapolated) << "a composition has no estimate";
  EXPECT_TRUE(method(chain(2), 10, true).extrapolated) << "no composition";
  EXPECT_TRUE(method(damped_chain(), 6, true).extrapolated) << "dampers";
  EXPECT_FALSE(method(damped_chain(), 6, true).varies) << "the order is given";
}

TEST(Method, SaysWhatItChoseAndWhy) {
  const AnalysisSpec tolerance = with([](auto& a) { a.tolerance = 1e-8; });
  EXPECT_THAT(chosen(chain(2), tolerance).narration,
              HasSubstr("Order 6 by composition with automatic steps, for the tolerance of 1e-08: "
                        "nothing in the model dissipates"));
  EXPECT_THAT(chosen(damped_chain(), tolerance).narration,
              HasSubstr("Orders 4 to 12 by extrapolation with automatic steps, for the tolerance "
                        "of 1e-08: the model dissipates"));
  EXPECT_THAT(chosen(damped_chain(), tolerance).narration, testing::Not(HasSubstr("Warning")));
  Model rubbing = damped_chain();
  rubbing.joints.front().friction.emplace();
  EXPECT_THAT(chosen(rubbing, tolerance).narration,
              HasSubstr("Order 2 with automatic steps, for the tolerance of 1e-08: the joint "));
}

TEST(Method, HasToleranceAndIterationsForWhatIsInTheModel) {
  const auto newton = [](const Model& model, const AnalysisSpec& a = {}) {
    return method_of(model, a).control.newton;
  };
  const NewtonOptions bodies = newton(chain(2)), solids = newton(block()),
                      contact = newton(balls(2, "barrier")),
                      high = newton(chain(2), with([](auto&a) { a.order = 6; }));
  EXPECT_GT(bodies.tolerance, solids.tolerance);
  EXPECT_GT(solids.tolerance, high.tolerance);
  EXPECT_GT(high.tolerance, contact.tolerance);
  EXPECT_LT(bodies.max_iterations, solids.max_iterations);
  EXPECT_LT(solids.max_iterations, contact.max_iterations);
  EXPECT_TRUE(bodies.line_search);
  EXPECT_FALSE(contact.line_search);  // its engine has one
  EXPECT_EQ(bodies.jacobian, JacobianPolicy::automatic);
  EXPECT_EQ(contact.jacobian, JacobianPolicy::every_iteration);
  const AnalysisSpec given = with([](auto& a) {
    a.newton_tolerance = 1e-3;
    a.max_iterations = 7;
    a.max_step_rotation = 0.5;
  });
  for (const Model& model : {chain(2), block(), balls(2, "barrier")}) {
    EXPECT_EQ(newton(model, given).tolerance, 1e-3);
    EXPECT_EQ(newton(model, given).max_iterations, 7);
    EXPECT_EQ(newton(model, given).max_rotation, 0.5);
  }
}

TEST(Method, WarnsOfNumericalDampingInContacts) {
  const AnalysisSpec damping = with([](auto& a) { a.rho_inf = 0.8; });
  EXPECT_THAT(chosen(balls(2, "barrier"), damping).narration,
              HasSubstr("Warning: rho_inf is 0.8. Numerical damping takes energy"));
  EXPECT_EQ(chosen(chain(2), damping).narration, "");
}

TEST(Method, RefusesSettingsThatCannotBeCombined) {
  struct Refused {
    Model model;
    AnalysisSpec analysis;
    std::string message;
  };
  const auto order = [](int p) { return with([p](auto& a) { a.order = p, a.step = 1e-3; }); };
  const auto tree = with([](auto& a) { a.solver = "tree"; });
  const auto both = [](AnalysisSpec a, const std::function<void(AnalysisSpec&)>& change) {
    change(a);
    return a;
  };
  const std::vector<Refused> all{
      {balls(2, "barrier"), order(4), "orders above 2 cannot be combined with contacts"},
      {chain(1), order(3), "only 2, 4, 6 and 8 exist"},
      {chain(1), both(order(6), [](auto& a) { a.rho_inf = 0.9; }),
       "stages backward in time would add the energy"},
      {damped_chain(), both(order(6), [](auto& a) { a.method = "composition"; }),
       "the model has dampers"},
      {chain(1), both(order(6), [](auto& a) { a.momentum_rate = "kinematic"; }),
       "only the step with momentum_rate: momentum"},
      {chain(1), with([](auto& a) { a.order = 4, a.method = "composition"; }),
       "automatic steps exist for orders 2, 6 and 8"},
      {chain(1), both(tree, [](auto& a) { a.momentum_rate = "kinematic"; }),
       "'tree' needs momentum_rate: momentum"},
      {chain(1), both(tree, [](auto& a) { a.jacobian = "never"; }),
       "'tree' needs momentum_rate: momentum"},
      {balls(2, "barrier"), tree, "'tree' does not support contacts"},
      {block(), tree, "'tree' does not support deformable solids"},
      {chain(1), with([](auto& a) { a.jacobian = "always"; }), "analysis.jacobian: 'always'"},
      {chain(1), with([](auto& a) { a.solver = "gauss"; }), "analysis.solver: 'gauss'"},
  };
  for (const Refused& r : all) {
    try {
      (void)method_of(r.model, r.analysis);
      ADD_FAILURE() << "not refused: " << r.message;
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), HasSubstr(r.message));
    }
  }
}

}  // namespace
}  // namespace polhode::test::method_tests
