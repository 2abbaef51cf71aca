// SPDX-License-Identifier: Apache-2.0
// Laws that every kind of joint must satisfy when its rows are enforced by a stiffness. Runs over
// the registry.
#include <polhode/core/error.hpp>

#include <joints/joint_cases.hpp>
#include <support/derivative.hpp>

namespace polhode::test::enforcement_tests {
namespace {

constexpr JointEnforcement kSprings{JointEnforcement::Law::penalty, 40.0, 3.0};

class EveryPenalisedJoint : public testing::TestWithParam<std::string> {
 protected:
  /// Calls what(joint, motion) for joints far off their constraint.
  template <class What>
  void for_samples(What&& what) {
    for (const JointCase& c : joint_cases(GetParam()))
      for (const double rho_inf : {1.0, 0.5, 0.0})
        for (unsigned seed = 1; seed <= 2; ++seed) {
          SCOPED_TRACE(c.name() + ", rho_inf " + std::to_string(rho_inf));
          Random random(seed);
          Joint joint = make_joint(c, random_frames(random));
          joint.set_enforcement(kSprings, 0.0);
          PairMotion motion(random, context_of(rho_inf));
          what(joint, motion);
          motion.a_moves = false;
          what(joint, motion);
        }
  }
};

double energy(const Joint& joint, const PairMotion& m, bool at_start) {
  const auto stored = [&](const PairStep& s) { return joint.work(s).stored; };
  return at_start ? m.at_start(stored) : m.with(Displacement::Zero(), stored);
}

// @tests{compliance-row}
TEST_P(EveryPenalisedJoint, HasTheGradientOfItsRows) {
  for_samples([](const Joint& joint, const PairMotion& m) {
    const PairTerms t = evaluate(joint, m);
    const int n = joint.rows();
    Eigen::Matrix<double, Eigen::Dynamic, 12> G(n, 12);
    G << t.G_a.topRows(n), t.G_b.topRows(n);
    expect_derivative(
        G,
        [&](const Vec& d) -> Vec {
          Displacement allowed = d;
          for (int k = 0; k < 12; ++k)
            if (!m.moves(k)) allowed[k] = 0.0;
          return evaluate(joint, m, allowed).g.head(n);
        },
        joint.type() + " G");
  });
}

// With λ = −k g the work of the wrenches is the decrease of the springs' energy, for turns of a
// radian.
// @tests{compliance-row}
TEST_P(EveryPenalisedJoint, StoresTheWorkDoneOnIt) {
  for_samples([](const Joint& joint, const PairMotion& given) {
    if (given.context.ga.rho_inf != 1.0) return;
    PairMotion m = given;
    const PairTerms rows = evaluate(joint, m);
    for (int k = 0; k < joint.rows(); ++k) {
      ASSERT_GT(rows.compliance[k], 0.0);
      m.lambda[static_cast<std::size_t>(k)] = -rows.g[k] / rows.compliance[k];
    }
    const double gain = energy(joint, m, false) - energy(joint, m, true);
    const double scale = std::max(energy(joint, m, false), energy(joint, m, true));
    EXPECT_NEAR(wrenches(evaluate(joint, m)).dot(step_motion(m)), -gain, 1e-13 * (1.0 + scale));
  });
}

// The weight of a row that is a tenth as stiff as the stiffest joint is 10, and it is exact.
// @tests{augmented-rows}
TEST_P(EveryPenalisedJoint, IsExactAndWeightedWithAugmentedRows) {
  for (const JointCase& c : joint_cases(GetParam())) {
    Random random(7);
    Joint joint = make_joint(c, random_frames(random));
    joint.set_enforcement({JointEnforcement::Law::augmented, 40.0, 40.0}, 400.0);
    const PairTerms t = evaluate(joint, PairMotion(random, context_of(1.0)));
    EXPECT_TRUE(t.compliance.isZero(0.0));
    EXPECT_FALSE(joint.penalised());
    for (int k = 0; k < joint.rows(); ++k)
      EXPECT_DOUBLE_EQ(t.weight[k], c.kind->name == "constant_velocity" && k == 3 ? 40.0 : 10.0);
  }
}

std::vector<std::string> kinds_with_rows() {
  std::vector<std::string> names;
  for (const JointKind& kind : joint_kinds())
    if (kind.name != "slack_link") names.push_back(kind.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryPenalisedJoint, testing::ValuesIn(kinds_with_rows()),
                         [](const auto& with) { return with.param; });

TEST(JointEnforcement, RequiresTheStiffnessesOfItsRows) {
  const JointKind& hinge = joint_kind("revolute");
  Joint joint("hinge", "revolute", Participants{0, 1}, hinge.recipe({}, {}));
  const auto refused_at = [&](const JointEnforcement& e, double stiffest) -> std::string {
    try {
      joint.set_enforcement(e, stiffest);
    } catch (const InputError& error) {
      return error.where();
    }
    return "";
  };
  using Law = JointEnforcement::Law;
  EXPECT_EQ(refused_at({Law::penalty, 1e6, 0.0}, 0.0), "turning_stiffness");
  EXPECT_EQ(refused_at({Law::penalty, 0.0, 1e6}, 0.0), "stiffness");
  EXPECT_EQ(refused_at({Law::augmented, 1e6, 1e2}, 1e9), "type");  // 1e7 apart
  EXPECT_EQ(refused_at({Law::penalty, 1e6, 1e2}, 0.0), "");
}

}  // namespace
}  // namespace polhode::test::enforcement_tests
