// SPDX-License-Identifier: Apache-2.0
#include <Eigen/QR>
#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/compile/build_system.hpp>
#include <polhode/engines/sparse_engine.hpp>
#include <polhode/engines/tree_engine.hpp>
#include <polhode/newton/least_reactions.hpp>
#include <polhode/stepping/instant.hpp>
#include <support/models.hpp>

namespace polhode::test::least_reactions_tests {
namespace {

Model with_friction(Model model, double mu) {
  for (JointSpec& j : model.joints) j.friction = JointFrictionSpec{.mu = mu, .constant = 0.1};
  return model;
}

bool acts(const Model& model) {
  const System system = build_system(model);
  if (!LeastReactions::may_act(system)) return false;
  State start = system.initial_state();
  EXPECT_TRUE(assemble_positions(system, start).assembled);
  return LeastReactions(system, start).act();
}

}  // namespace

TEST(LeastReactions, ActOnlyWhereFrictionMeetsRedundantRows) {
  EXPECT_TRUE(acts(with_friction(bennett(), 0.1)));
  EXPECT_TRUE(acts(with_friction(n_four_bar(2), 0.1)));
  EXPECT_FALSE(acts(n_four_bar(2))) << "no friction";
  EXPECT_FALSE(acts(with_friction(n_four_bar(2), 0.0))) << "friction that is constant";
  Model chain = with_friction(n_four_bar(1), 0.1);
  chain.joints.pop_back();
  EXPECT_FALSE(LeastReactions::may_act(build_system(chain))) << "no loop";
}

// Against the null vectors of a dense decomposition: the redundant part is removed, and the
// wrenches on the bodies stay. @tests{redundant-part}
TEST(LeastReactions, RemoveTheRedundantPartOfMultipliersAlone) {
  const System system = build_system(with_friction(bennett(), 0.1));
  const State state = system.initial_state();
  std::vector<BodyStep> steps;
  for (int b = 0; b < system.body_count(); ++b) steps.push_back(system.instant(state, b));
  steps.push_back(BodyStep::ground(1.0));
  StepContext context;
  context.ga = GeneralizedAlpha::from_spectral_radius(0.0);
  Mat G = Mat::Zero(system.rows(), 6 * system.body_count());
  const std::vector<double> none(static_cast<std::size_t>(system.rows()), 0.0);
  InteractionSweep(system).run(
      steps, context, none.data(), state.history.data(),
      [&](int i, const PairStep&, const PairTerms& terms) {
        const InteractionRef& ref = system.interactions()[i];
        for (int k = 0; k < ref.rows; ++k) {
          if (ref.a != kGround) G.row(ref.first_row + k).segment<6>(6 * ref.a) = terms.G_a.row(k);
          if (ref.b != kGround) G.row(ref.first_row + k).segment<6>(6 * ref.b) = terms.G_b.row(k);
        }
      });
  const Eigen::CompleteOrthogonalDecomposition<Mat> decomposition(G.transpose());
  ASSERT_EQ(decomposition.rank(), system.rows() - 3);

  TreeEngine tree(system);
  SparseEngine sparse(system, "block_lu");
  for (NewtonEngine* const engine :
       {static_cast<NewtonEngine*>(&tree), static_cast<NewtonEngine*>(&sparse)}) {
    Trial trial;
    trial.context.ga = GeneralizedAlpha::from_spectral_radius(1.0);
    trial.context.dt = 1e-3;
    start_trial(system, state, trial);
    Vec given(system.rows());
    for (int k = 0; k < system.rows(); ++k)
      given[k] = trial.lambda[static_cast<std::size_t>(k)] = 100.0 * ((7 * k) % 11 - 5.0);
    LeastReactions reactions(system, state);
    ASSERT_TRUE(reactions.act());
    engine->begin_step(state, trial);
    ASSERT_TRUE(reactions.begin_step(state, trial, *engine));
    ASSERT_TRUE(reactions.apply(state, trial, *engine));
    engine->store_multipliers(trial);
    const Vec found = Eigen::Map<const Vec>(trial.lambda.data(), system.rows());
    // Of smallest norm with the same wrenches; a first application leaves ε/σ² of the others.
    const Vec wanted = decomposition.solve(Vec(G.transpose() * given));
    EXPECT_LE((found - wanted).norm(), 1e-8 * given.norm()) << engine->name();
    EXPECT_GT((given - wanted).norm(), 0.1 * given.norm());
  }
}

}  // namespace polhode::test::least_reactions_tests
