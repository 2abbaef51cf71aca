// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <joints/joint_cases.hpp>
#include <polhode/core/error.hpp>
#include <polhode/joints/frame_motion.hpp>
#include <polhode/math/exp_map.hpp>
#include <support/derivative.hpp>

namespace polhode::test::frame_motion_tests {
namespace {

/// a + b sin(c t), whose derivatives are known.
class Swing final : public TimeFunction {
 public:
  Swing(double a, double b, double c) : a_(a), b_(b), c_(c) {}
  double operator()(double t) const override { return a_ + b_ * std::sin(c_ * t); }
  [[nodiscard]] TimeRates rates(double t, TimeSide) const override {
    const double s = std::sin(c_ * t);
    return {a_ + b_ * s, b_ * c_ * std::cos(c_ * t), -b_ * c_ * c_ * s};
  }

 private:
  double a_, b_, c_;
};

FrameMotion swinging(FrameMotion::Rotation rotation) {
  const auto swing = [](double a, double b, double c) { return std::make_shared<Swing>(a, b, c); };
  FrameMotion m;
  m.displacement = {swing(0.2, 0.3, 2.0), swing(0.0, -0.2, 3.0), swing(-0.1, 0.4, 1.0)};
  m.rotation = rotation;
  m.sequence = "zxz";
  m.parameters = {swing(0.9, 0.5, 2.0), swing(0.4, 0.7, 1.5), swing(-0.3, 0.6, 2.5), nullptr};
  if (rotation == FrameMotion::Rotation::quaternion) m.parameters[3] = swing(0.5, 0.2, 2.0);
  if (rotation == FrameMotion::Rotation::none) m.parameters = {};
  return m;
}

constexpr FrameMotion::Rotation kRotations[] = {
    FrameMotion::Rotation::vector, FrameMotion::Rotation::euler, FrameMotion::Rotation::quaternion};

// Against differences of the placements, and those against Eigen's rotations.
TEST(FrameMotion, HasTheRatesOfItsPlacement) {
  for (const auto rotation : kRotations)
    for (const double t : {0.0, 0.4, 3.0}) {
      const FrameMotion m = swinging(rotation);
      const FrameMotion::Course c = m.course(t, TimeSide::kAfter);
      constexpr double h = 1e-4;
      const auto before = m.at(t - h, 1.0), now = m.at(t, 1.0), after = m.at(t + h, 1.0);
      EXPECT_LT((now.D - c.D).norm(), 1e-14);
      EXPECT_LT((now.D.transpose() * now.D - Mat3::Identity()).norm(), 1e-14);
      EXPECT_LT(((after.d - before.d) / (2.0 * h) - c.d_dot).norm(), 1e-7);
      EXPECT_LT(((after.d - 2.0 * now.d + before.d) / (h * h) - c.d_ddot).norm(), 1e-6);
      const Mat3 D_dot = (after.D - before.D) / (2.0 * h);
      const Mat3 D_ddot = (after.D - 2.0 * now.D + before.D) / (h * h);
      EXPECT_LT((D_dot - hat(c.omega) * c.D).norm(), 1e-6) << t;
      EXPECT_LT((D_ddot - (hat(c.alpha) + hat(c.omega) * hat(c.omega)) * c.D).norm(), 1e-6) << t;
    }
}

TEST(FrameMotion, ReadsItsParametersAsEigenDoes) {
  const auto value = [](const TimeFunctionPtr& f) { return (*f)(0.7); };
  const FrameMotion v = swinging(FrameMotion::Rotation::vector);
  const Vec3 phi(value(v.parameters[0]), value(v.parameters[1]), value(v.parameters[2]));
  EXPECT_LT((v.at(0.7, 1.0).D - Eigen::AngleAxisd(phi.norm(), phi.normalized()).matrix()).norm(),
            1e-14);
  FrameMotion e = swinging(FrameMotion::Rotation::euler);
  const auto turn = [&](int axis, int k) {
    return Eigen::AngleAxisd(value(e.parameters[static_cast<std::size_t>(k)]), Vec3::Unit(axis));
  };
  EXPECT_LT((e.at(0.7, 1.0).D - (turn(2, 0) * turn(0, 1) * turn(2, 2)).matrix()).norm(), 1e-14);
  e.sequence = "XYZ";
  EXPECT_LT((e.at(0.7, 1.0).D - (turn(2, 2) * turn(1, 1) * turn(0, 0)).matrix()).norm(), 1e-14);
}

// Rotation vectors about zero and beyond a turn: both branches of the half angle's functions.
TEST(FrameMotion, TurnsByAnyAngle) {
  for (const double angle : {0.0, 1e-9, 0.5, 0.999, 1.001, 3.0, 7.0}) {
    FrameMotion m;
    m.rotation = FrameMotion::Rotation::vector;
    m.parameters[1] = std::make_shared<Swing>(angle, 1.0, 2.0);
    const FrameMotion::Course c = m.course(0.0, TimeSide::kAfter);
    EXPECT_LT((c.D - exp_map(Vec3(0.0, angle, 0.0))).norm(), 1e-14) << angle;
    EXPECT_LT((c.omega - Vec3(0.0, 2.0, 0.0)).norm(), 1e-13) << angle;
    EXPECT_LT(c.alpha.norm(), 1e-12) << angle;
  }
}

/// Joints of every kind whose frame moves, in random steps far off their constraints.
template <class What>
void for_moving_joints(What&& what) {
  for (const char* type : {"fixed", "spherical", "revolute", "universal", "generic"})
    for (const JointCase& c : joint_cases(type))
      for (const double rho_inf : {1.0, 0.5, 0.0}) {
        if (c.parameters.free.size() > 3) continue;
        SCOPED_TRACE(c.name() + ", rho_inf " + std::to_string(rho_inf));
        Random random(5);
        const StepContext context = context_of(rho_inf);
        Joint joint = make_joint(c, random_frames(random));
        joint.set_motion(swinging(kRotations[c.parameters.free.size() % 3]));
        PairMotion m(random, context);
        what(joint, m);
        m.a_moves = false;
        what(joint, m);
      }
}

Displacement allowed(const PairMotion& m, const Vec& d) {
  Displacement out = d;
  for (int k = 0; k < 12; ++k)
    if (!m.moves(k)) out[k] = 0.0;
  return out;
}

// @tests{moving-frame}
TEST(FrameMotion, KeepsTheTangentsOfItsJoint) {
  for_moving_joints([](const Joint& joint, const PairMotion& m) {
    expect_derivative(
        wrench_tangent(evaluate(joint, m)),
        [&](const Vec& d) -> Vec { return wrenches(evaluate(joint, m, allowed(m, d))); }, "D");
    const PairTerms t = evaluate(joint, m);
    Eigen::Matrix<double, Eigen::Dynamic, 12> G(joint.rows(), 12);
    G << t.G_a.topRows(joint.rows()), t.G_b.topRows(joint.rows());
    expect_derivative(
        G,
        [&](const Vec& d) -> Vec { return evaluate(joint, m, allowed(m, d)).g.head(joint.rows()); },
        "G");
  });
}

// The bodies and the drive together give the whole change of g; the wrenches are opposite where the
// points meet. @tests{moving-frame}
TEST(FrameMotion, SuppliesTheWorkDoneOnTheBodies) {
  for_moving_joints([](const Joint& joint, const PairMotion& m) {
    if (m.context.ga.rho_inf != 1.0) return;
    const PairTerms t = evaluate(joint, m);
    PairMotion start = m;
    start.context.dt = 0.0;
    const Vec6 g_n = start.at_start([&](const PairStep& s) { return joint.residual(s); });
    PrescribedRows rows;
    m.with(Displacement::Zero(), [&](const PairStep& s) {
      joint.prescribed(s, TimeSide::kBefore, rows);
      return 0;
    });
    const Eigen::Map<const Vec6> lambda(m.lambda.data());
    const int n = joint.rows();
    const double put_in = lambda.head(n).dot(rows.increment.head(n));
    EXPECT_NEAR(lambda.head(n).dot(t.g.head(n) - g_n.head(n)) + put_in,
                wrenches(t).dot(step_motion(m)), 1e-12);
    if (!m.a_moves) return;  // the wrench of the ground is not read
    EXPECT_LT((t.wrench_a.head<3>() + t.wrench_b.head<3>()).norm(), 1e-13);
  });
}

TEST(FrameMotion, IsRefusedByADistanceJoint) {
  Random random(1);
  Joint joint = make_joint(joint_cases("distance").front(), random_frames(random));
  EXPECT_THROW(joint.set_motion(swinging(FrameMotion::Rotation::none)), InputError);
}

}  // namespace
}  // namespace polhode::test::frame_motion_tests
