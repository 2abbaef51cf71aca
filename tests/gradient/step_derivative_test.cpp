// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <gradient/gradient_runs.hpp>
#include <polhode/core/error.hpp>
#include <polhode/gradient/step_derivative.hpp>
#include <polhode/math/quaternion.hpp>

namespace polhode::test::step_derivative_tests {
namespace {

constexpr const char* kLinkage = R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies:
  one: {mass: 1.2, inertia: [2e-2, 3e-2, 1e-2], position: [0.3, 0, 0], angular_velocity: [0, 2, 0.5]}
  two: {mass: 0.7, inertia: [1e-2, 2e-2, 1.5e-2], position: [0.6, 0.2, 0]}
joints:
  A: {type: spherical, bodies: [ground, one], at: [0, 0, 0]}
  B: {type: revolute, bodies: [one, two], at: [0.6, 0, 0], axis: [0.3, 0.1, 1]}
loads:
  strut: {type: spring_damper, bodies: [ground, two], at: [[0, 1, 0], [0.6, 0.3, 0]], stiffness: 60, damping: 2}
analysis: {duration: 1 s, step: 20 ms}
)yaml";

/// Two states a step apart.
struct Step {
  Model model = io::read_model_text(kLinkage, "model.yaml");
  Simulation simulation{model};
  State from, to;
  Step() {
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(simulation.step(1.0).accepted);
    from = simulation.state();
    EXPECT_TRUE(simulation.step(1.0).accepted);
    to = simulation.state();
  }
};

/// Check that the pull is the transpose of the push, for vectors of no structure.
void expect_transpose(StepDerivative& derivative, Eigen::Index inputs) {
  Vec dy(derivative.state_size()), mu(derivative.state_size()), R(inputs);
  for (Eigen::Index i = 0; i < dy.size(); ++i) {
    dy[i] = std::cos(1.0 + 2.4 * static_cast<double>(i));
    mu[i] = std::sin(2.0 + 1.7 * static_cast<double>(i));
  }
  for (Eigen::Index i = 0; i < R.size(); ++i) R[i] = std::cos(0.3 + 1.1 * static_cast<double>(i));
  Vec forward = dy, backward = mu;
  derivative.push(R, forward);
  const Vec eta = derivative.pull(backward);
  const double a = mu.dot(forward), b = backward.dot(dy) + eta.dot(R);
  EXPECT_NEAR(a, b, 1e-11 * forward.norm() * mu.norm());
}

/// @tests{reversed-step}
TEST(ReversedStep, HasTheSameForcesAndTurnsBackIntoItself) {
  const Step s;
  const System& system = s.simulation.system();
  const StepDerivative derivative(system);
  const Trial step = derivative.trial(s.from, s.to, s.to.dt_last);
  const Trial back = reversed(system, step, s.to);
  EXPECT_EQ(back.context.dt, -step.context.dt);
  EXPECT_NEAR(back.context.t_alpha(), step.context.t_alpha(), 1e-15);
  NewtonSystem forward(system, MomentumRate::momentum), backward(system, MomentumRate::momentum);
  forward.assemble(s.from, step, false);
  backward.assemble(s.to, back, false);
  for (int b = 0; b < 2; ++b) {
    // Both are the residual of the same solution; forces are of order 10.
    EXPECT_LT((forward.body_residual(b) - backward.body_residual(b)).norm(), 1e-9);
    EXPECT_GT(forward.body_residual_scale(b).norm(), 1.0);
  }
  const Trial again = reversed(system, back, s.from);
  for (int b = 0; b < 2; ++b) {
    const BodyStep x = body_step(system, s.from, step, b), y = body_step(system, s.from, again, b);
    EXPECT_LT((x.r_n1 - y.r_n1).norm() + (x.Lambda_n1 - y.Lambda_n1).norm(), 1e-14);
    EXPECT_LT((x.v_n1 - y.v_n1).norm(), 1e-11);
  }
}

/// @tests{step-derivative}
TEST(StepDerivative, IsThatOfDifferencesOfOneStep) {
  Step s;
  const System& system = s.simulation.system();
  StepDerivative derivative(system);
  const double h = s.to.dt_last;
  derivative.linearize(s.from, s.to, derivative.trial(s.from, s.to, h));
  EXPECT_LT(derivative.asymmetry(), 1e-9);
  EXPECT_LT(derivative.jump(), 1e-9);
  // A change of the start, which the steps themselves carry to t_n, stays on the constraints.
  const auto state_after = [&](double change, int steps) {
    Model model = s.model;
    model.bodies[0].angular_velocity.y() += change;
    Simulation simulation(model);
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(simulation.step(1.0).accepted);
    return simulation.state();
  };
  const auto derivative_after = [&](int steps, const State& at) {
    const double d = 1e-2;
    Vec sum = Vec::Zero(derivative.state_size());
    const double weights[3] = {45.0, -9.0, 1.0};
    for (int k = 1; k <= 3; ++k)
      for (const double sign : {1.0, -1.0}) {
        const State moved = state_after(sign * k * d, steps);
        for (int b = 0; b < 2; ++b) {
          const BodyMotion m = system.motion(at, b), n = system.motion(moved, b);
          const Quat turn = n.q * m.q.conjugate();
          Vec y(kStateNumbers);
          y << n.r - m.r, 2.0 / turn.w() * turn.vec(), n.v - m.v, n.W - m.W;
          sum.segment(kStateNumbers * b, kStateNumbers) += sign * weights[k - 1] / (60.0 * d) * y;
        }
      }
    return sum;
  };
  Vec dy = derivative_after(5, s.from);
  const Vec expected = derivative_after(6, s.to);
  derivative.push(Vec::Zero(derivative.unknowns()), dy);
  EXPECT_LT((dy - expected).norm(), 1e-9 * expected.norm());
}

TEST(StepDerivative, ReportsAMatrixThatCannotBeFactored) {
  Step s;
  const System& system = s.simulation.system();
  StepDerivative derivative(system);
  Trial step = derivative.trial(s.from, s.to, s.to.dt_last);
  step.lambda[0] = std::nan("");
  try {
    derivative.linearize(s.from, s.to, step);
    FAIL();
  } catch (const SolveError& error) {
    EXPECT_NE(std::string(error.what()).find("The matrix of the step at t = 0.1 s is singular"),
              std::string::npos)
        << error.what();
  }
}

/// @tests{damped-step-derivative}
TEST(WrenchDerivative, IsThatOfTheStepSeenBackwardsWhereLawsAreSymmetric) {
  const Step s;
  const System& system = s.simulation.system();
  const Trial step = StepDerivative(system).trial(s.from, s.to, s.to.dt_last);
  WrenchDerivative wrenches(system);
  std::vector<BodyStep> steps;
  for (int b = 0; b < 2; ++b) steps.push_back(body_step(system, s.from, step, b));
  steps.push_back(BodyStep::ground(0.5));
  wrenches.evaluate(s.from, step, steps, step.scale(system));
  NewtonSystem backward(system, MomentumRate::momentum);
  const Trial back = reversed(system, step, s.to);
  backward.assemble(s.to, back, true);
  for (std::size_t b = 0; b < 2; ++b) {
    const BodyData& body = system.bodies()[b];
    const int at = static_cast<int>(b);
    const MomentumRates m =
        momentum_rates(body.mass, body.inertia, system.motion(s.to, at),
                       body_step(system, s.to, back, at), back.context, MomentumRate::momentum);
    Mat6 expected = backward.values().diagonal[b];
    expected.topLeftCorner<3, 3>().diagonal().array() -= step.scale(system) * m.K_r;
    expected.bottomRightCorner<3, 3>() -= step.scale(system) * m.K_theta;
    const Mat6 K = wrenches.by_place().diagonal[b] - wrenches.by_velocity().diagonal[b];
    EXPECT_LT((K - expected).norm(), 1e-10 * expected.norm()) << b;
    EXPECT_GT(wrenches.by_velocity().diagonal[b].norm(), b == 1 ? 1e-3 * expected.norm() : -1.0);
  }
}

/// @tests{damped-step-derivative}
TEST(StepDerivative, OfADampedStepPulledBackIsTheTransposeOfThePush) {
  for (const double rho : {0.0, 0.7}) {
    Model model = io::read_model_text(kLinkage, "model.yaml");
    model.analysis.rho_inf = rho;
    Simulation simulation(model);
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(simulation.step(1.0).accepted);
    const State before = simulation.state();
    EXPECT_TRUE(simulation.step(1.0).accepted);
    const State& to = simulation.state();
    StepDerivative derivative(simulation.system(), rho);
    const State& from = derivative.beginning(before, to.dt_last);
    derivative.linearize(from, to, derivative.trial(from, to, to.dt_last));
    EXPECT_EQ(derivative.state_size(), 30 * 2);
    EXPECT_LT(derivative.jump(), 1e-9);
    expect_transpose(derivative, derivative.inputs());
  }
}

/// @tests{step-adjoint}
TEST(StepDerivative, PulledBackIsTheTransposeOfThePush) {
  const Step s;
  StepDerivative derivative(s.simulation.system());
  derivative.linearize(s.from, s.to, derivative.trial(s.from, s.to, s.to.dt_last));
  expect_transpose(derivative, derivative.unknowns());
  EXPECT_LT(derivative.defect(), 1e-12);
}

}  // namespace
}  // namespace polhode::test::step_derivative_tests
