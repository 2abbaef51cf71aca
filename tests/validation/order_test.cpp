// SPDX-License-Identifier: Apache-2.0
// Orders of accuracy, measured on complete models from the model to the report.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/simulation/simulation_details.hpp>
#include <support/convergence.hpp>
#include <support/known_solutions/free_symmetric_top.hpp>
#include <support/known_solutions/heavy_top_reaction.hpp>
#include <support/published_cases.hpp>

namespace polhode::test::order_tests {
namespace {

Simulation run_to(Model model, double t_end, int n, int order = 2) {
  model.analysis.step = t_end / n;
  model.analysis.duration = t_end;
  model.analysis.order = order;
  Simulation simulation(std::move(model));
  while (simulation.time() < t_end * (1.0 - 1e-9)) {
    const StepReport report = simulation.step(t_end);
    if (!report.accepted || report.rejected > 0)
      throw std::runtime_error("refused: " + report.newton.text());
  }
  return simulation;
}

double angle_between(const Quat& p, const Quat& q) {
  return 2.0 * (p.conjugate() * q).vec().norm();
}

class SecondOrder : public testing::TestWithParam<double> {};

TEST_P(SecondOrder, OnTheFreeSymmetricTop) {
  const FreeSymmetricTop exact{1.0, 2.0, {0.8, -0.3, 2.0}};
  Model model = free_symmetric_top(exact.W_0);
  model.analysis.rho_inf = GetParam();
  const double t_end = 2.0;
  const auto at = [&](int n) { return run_to(model, t_end, n).body(0); };
  // |ω| Δt is 0.03 to 0.008: the error is the leading term, 1e-3 to 1e-5, far above round-off.
  const std::vector<int> steps{150, 300, 600};
  expect_order([&](int n) { return angle_between(at(n).q, exact.orientation(t_end)); }, steps, 2.0,
               0.1, "rotation");
  expect_order([&](int n) { return (at(n).W - exact.W(t_end)).norm(); }, steps, 2.0, 0.1,
               "angular velocity");
}

TEST_P(SecondOrder, OnTheHeavyTopInPositionRotationVelocityAndMultipliers) {
  const Reference reference = Reference::read("heavy_top");
  const double t_end = 0.2;
  const auto sample = static_cast<std::size_t>(
      std::lower_bound(reference.t.begin(), reference.t.end(), t_end - 1e-9) - reference.t.begin());
  const Vec& exact = reference.values[sample];
  const Vec3 r = exact.segment<3>(0), W = exact.segment<3>(7);
  const Quat q(exact[3], exact[4], exact[5], exact[6]);
  const Vec3 arm = Vec3::UnitY();
  const Mat3 J_fixed = Vec3(15.234375, 0.46875, 15.234375).asDiagonal();
  const Vec3 force = fixed_point_reaction(q, W, 15.0, J_fixed, arm, kDown);
  Model model = heavy_top();
  model.analysis.rho_inf = GetParam();

  struct Errors {
    double position, rotation, velocity, angular_velocity, reaction;
  };
  std::vector<Errors> errors;
  // The spin of 150 rad/s turns the top by 0.075 to 0.019 in a step.
  const std::vector<int> steps{400, 800, 1600};
  for (int n : steps) {
    const Simulation s = run_to(model, t_end, n);
    const BodyMotion m = s.body(0);
    errors.push_back({(m.r - r).norm(), angle_between(m.q, q), (m.v - q * W.cross(arm)).norm(),
                      (m.W - W).norm(), (s.joint(0).force - force).norm() / force.norm()});
  }
  const auto check = [&](double Errors::*error, const std::string& what) {
    for (std::size_t i = 1; i < errors.size(); ++i)
      EXPECT_NEAR(std::log2(errors[i - 1].*error / errors[i].*error), 2.0, 0.1)
          << what << ": " << errors[i - 1].*error << " to " << errors[i].*error;
  };
  check(&Errors::position, "position");
  check(&Errors::rotation, "rotation");
  check(&Errors::velocity, "velocity");
  check(&Errors::angular_velocity, "angular velocity");
  check(&Errors::reaction, "multipliers");
}

INSTANTIATE_TEST_SUITE_P(SpectralRadius, SecondOrder, testing::Values(0.0, 0.5, 0.9, 1.0),
                         [](const auto& p) {
                           return "0p" + std::to_string(static_cast<int>(10 * p.param));
                         });

/// The same in steps of changing length: H, H/2, H/4, H/2, H, ...
Simulation run_in_changing_steps(Model model, double t_end, int n) {
  const double mean[] = {1.0, 0.5, 0.25, 0.5};
  model.analysis.step = t_end / n;
  model.analysis.duration = t_end;
  Simulation simulation(std::move(model));
  for (int i = 0; simulation.time() < t_end * (1.0 - 1e-9); ++i) {
    const double limit = simulation.time() + mean[i % 4] * t_end / n;
    if (!simulation.step(std::min(t_end, limit)).accepted) throw std::runtime_error("refused");
  }
  return simulation;
}

class SecondOrderInChangingSteps : public testing::TestWithParam<double> {};

double largest_error(const Simulation& s, const Simulation& exact) {
  double most = 0.0;
  for (std::size_t i = 0; i < s.model().bodies.size(); ++i) {
    const auto b = static_cast<int>(i);
    most = std::max({most, (s.body(b).r - exact.body(b).r).norm(),
                     angle_between(s.body(b).q, exact.body(b).q),
                     (s.body(b).v - exact.body(b).v).norm()});
  }
  return most;
}

// @tests{stored-rates}
TEST_P(SecondOrderInChangingSteps, OnABodyThatTumblesOnASpring) {
  const double t_end = 2.0;
  ModelBuilder m;
  const int top = m.body("top", Vec3::Zero(), 1.0, {1.0, 2.0, 3.0});
  m.at(top).angular_velocity = {1.0, -2.0, 0.7};
  m.spring("spring", kGround, {0.3, 0.2, 1.0}, top, {0.3, 0.1, 0.2},
           {{"stiffness", 30.0}, {"free_length", 0.2}});
  const Simulation exact = run_to(m.model, t_end, 400, 6);
  m.model.analysis.rho_inf = GetParam();
  const auto error = [&](int n) {
    return largest_error(run_in_changing_steps(m.model, t_end, n), exact);
  };
  expect_order(error, {72, 144, 288}, 2.0, 0.1, "positions and velocities");
}

// @tests{stored-rates-mean}
TEST_P(SecondOrderInChangingSteps, OnAChainOfRevoluteJoints) {
  const double t_end = 0.5;
  Model model = chain("revolute", 3, true);
  const Simulation exact = run_to(model, t_end, 400, 6);
  model.analysis.rho_inf = GetParam();
  const auto error = [&](int n) {
    return largest_error(run_in_changing_steps(model, t_end, n), exact);
  };
  // The error of the joints' accelerations vanishes as the steps get shorter, so the order is
  // reached from above.
  EXPECT_GE(std::log2(error(72) / error(288)), 2.0 * 1.9);
}

INSTANTIATE_TEST_SUITE_P(SpectralRadius, SecondOrderInChangingSteps,
                         testing::Values(0.0, 0.3, 0.5, 0.8, 1.0), [](const auto& p) {
                           return "0p" + std::to_string(static_cast<int>(10 * p.param));
                         });

// Higher orders: where the error of the compositions is the leading term and still above the
// round-off of the reference.
struct Composed {
  std::string name;
  Model model;
  double t_end;
  Observation observe;
  std::vector<int> steps_4, steps_6, steps_8;
  std::string data;  ///< Empty: compared with a finer run of order 8.
};

Composed composed_heavy_top() {
  return {"heavy_top",    heavy_top(),   0.2,          heavy_top_case().observe,
          {80, 160, 320}, {40, 80, 160}, {30, 40, 60}, "heavy_top"};
}
Composed composed_chain() {
  const auto all_positions = [](const Simulation& s) -> Vec {
    Vec x(9);
    for (int b = 0; b < 3; ++b) x.segment<3>(3 * b) = s.body(b).r;
    return x;
  };
  return {"chain",      chain("revolute", 3, true),
          0.5,          all_positions,
          {20, 40, 80}, {20, 28, 40},
          {16, 20, 24}, ""};
}
Composed composed_four_bar() {
  return {"four_bar",    n_four_bar(1), 2.0,          n_four_bar_case(1).observe,
          {40, 80, 160}, {20, 28, 40},  {15, 20, 30}, "n_four_bar_1"};
}

class HigherOrder : public testing::TestWithParam<Composed> {
 protected:
  [[nodiscard]] Vec exact() const {
    const Composed& c = GetParam();
    if (c.data.empty()) return c.observe(run_to(c.model, c.t_end, 3 * c.steps_8.back(), 8));
    const Reference r = Reference::read(c.data);
    for (std::size_t i = 0; i < r.t.size(); ++i)
      if (std::abs(r.t[i] - c.t_end) < 1e-9) return r.values[i];
    throw std::runtime_error("no sample at the end");
  }
  void expect(int order, const std::vector<int>& steps, double least, double most) const {
    const Composed& c = GetParam();
    const Vec known = exact();
    double last = 0.0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const Simulation s = run_to(c.model, c.t_end, steps[i], order);
      const Vec value = c.observe(s);
      const double error = (value - known.head(value.size())).norm();
      EXPECT_LE(s.summary().energy_drift, 1e-12) << steps[i] << " steps";
      if (i > 0) {
        const double measured = std::log(last / error) / std::log(double(steps[i]) / steps[i - 1]);
        EXPECT_TRUE(measured >= least && measured <= most)
            << "order " << measured << ": " << last << " with " << steps[i - 1] << " steps, "
            << error << " with " << steps[i];
        RecordProperty("order_" + std::to_string(steps[i]), std::to_string(measured));
      }
      last = error;
    }
  }
};

TEST_P(HigherOrder, FourIsObserved) { expect(4, GetParam().steps_4, 3.8, 4.2); }
TEST_P(HigherOrder, SixIsObserved) { expect(6, GetParam().steps_6, 5.8, 6.2); }
TEST_P(HigherOrder, EightIsObserved) { expect(8, GetParam().steps_8, 7.3, 8.7); }

INSTANTIATE_TEST_SUITE_P(Of, HigherOrder,
                         testing::Values(composed_heavy_top(), composed_chain(),
                                         composed_four_bar()),
                         [](const auto& p) { return p.param.name; });

}  // namespace
}  // namespace polhode::test::order_tests
