// SPDX-License-Identifier: Apache-2.0
// Friction of joints with redundant rows: closed forms of doors on three hinges, friction against
// the reactions that are reported, and singular positions.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <support/convergence.hpp>
#include <support/models.hpp>
#include <support/run_text.hpp>

namespace polhode::test::redundant_friction_tests {
namespace {

/// A door of 20 kg whose centre of mass is 0.5 m from its axis, at the height of its middle hinge.
std::string door(const std::string& hinge, const std::string& more) {
  std::string joints = "joints:\n";
  for (const auto& [name, height] :
       {std::pair("low", "-0.7"), std::pair("middle", "0"), std::pair("high", "0.7")})
    joints +=
        format("  {}: {{type: revolute, bodies: [ground, door], at: [0, 0, {}], axis: z, {}}}\n",
               name, height, hinge);
  return "format: 1\nbodies:\n"
         "  door: {mass: 20, inertia: [2, 2, 2.5], position: [0.5, 0, 0], velocity: [0, w, 0], "
         "angular_velocity: [0, 0, 2*w]}\n" +
         joints + more;
}

}  // namespace

// Three hinges carry F = m ρ √(ω⁴ + α²) together, evenly: J α = −μ r F gives α = −κ ω² with
// κ = c/√(1 − c²), c = μ r m ρ/J, hence ω = ω₀/(1 + κ ω₀ t).
TEST(DoorOnThreeHinges, SlowsDownByTheClosedForm) {
  const double c = 0.3 * 0.02 * 20.0 * 0.5 / 7.5, kappa = c / std::sqrt(1.0 - c * c), w0 = 6.0;
  for (const char* const solver : {"tree", "block_lu"})
    expect_order(
        [&](int steps) {
          Simulation s = made("variables: {w: 3}\n" +
                              door("friction: {mu: 0.3, radius: 20 mm, stiffness: 1e7}", "") +
                              format("analysis: {{duration: 2 s, step: {:.17g} s, solver: "
                                     "{}}}\noutput: {{hdf5: false}}\n",
                                     2.0 / steps, solver));
          finished(s);
          // Of forces of 90 N, up to the rounding of redundant reactions over their ε of 1e-8.
          for (int j = 0; j < 3; ++j) EXPECT_LT(s.joint(j).moment.head<2>().norm(), 1e-5);
          return std::abs(s.body(0).omega().z() - w0 / (1.0 + kappa * w0 * 2.0));
        },
        {50, 500, 5000}, 2.0, 0.3, solver);
}

namespace {

/// Largest difference, after some time, of a hinge's friction from its limit by the reactions that
/// are reported. The bristle takes the reaction of the middle of a step: the mean of those at its
/// ends, to second order.
double lag(Simulation& s, int joints, double mu_radius, double across, double from, double until,
           double step) {
  const auto limit = [&](const JointReport& j) {
    // Reports are along the axes of the joint: z is that of the hinge.
    return mu_radius * (j.force.head<2>().norm() + across * j.moment.head<2>().norm());
  };
  double most = 0.0;
  std::vector<double> before(static_cast<std::size_t>(joints), 0.0);
  while (s.time() < until - 0.5 * step) {
    const StepReport r = s.step(1e3);
    EXPECT_TRUE(r.accepted) << r.message;
    if (!r.accepted) break;
    for (int j = 0; j < joints; ++j) {
      const JointReport now = s.joint(j, true);
      double& last = before[static_cast<std::size_t>(j)];
      const double here = limit(now), mean = 0.5 * (here + last);
      if (s.time() > from) most = std::max(most, std::abs(mean - std::abs(now.friction[0])));
      last = here;
    }
  }
  return most;
}

}  // namespace

// Friction is that of the reaction that is reported, also where its distribution is a convention or
// given by stiffnesses: a motor turns the door under gravity.
TEST(DoorOnThreeHinges, RubsByTheReactionsThatAreReported) {
  for (const bool stiffnesses : {false, true}) {
    std::string text = "variables: {w: 0}\ngravity: [0, 0, -9.81]\n" +
                       door("friction: {mu: 0.3, radius: 20 mm, length: 0.1, stiffness: 1e7}",
                            "loads:\n  motor: {type: rotary_motor, joint: low, speed: {table: "
                            "[[0, 0], [2 s, 24]]}}\n");
    if (stiffnesses) {
      const auto give = [&](const std::string& to, double k) {
        const std::size_t at = text.find("friction", text.find(to + ": {type"));
        text.insert(at, format("enforcement: {{type: augmented, stiffness: {:.17g}, "
                               "turning_stiffness: {:.17g}}}, ",
                               k, 0.02 * k));
      };
      give("low", 3e7);
      give("middle", 1e7);
      give("high", 2e7);
    }
    for (const char* const solver : {"tree", "block_lu"})
      for (const double step : {20e-3, 2e-3, 0.2e-3}) {
        Simulation s =
            made(text + format("analysis: {{duration: 1 s, step: {:.17g} s, solver: {}}}\n"
                               "output: {{hdf5: false}}\n",
                               step, solver));
        // F'' h²/8 of each of three, and rounding over ε.
        EXPECT_LE(lag(s, 3, 0.3 * 0.02, 20.0, 0.5, 1.0, step), 15.0 * step * step + 1e-5)
            << solver << ' ' << step;
      }
  }
}

// The reactions of Bennett's linkage turn in space with its redundant rows, and averages of its
// directions over a step are not exactly redundant.
TEST(BennettsLinkage, RubsByTheReactionsThatAreReported) {
  for (const char* const solver : {"tree", "block_lu"})
    for (const double step : {10e-3, 1e-3, 0.1e-3}) {
      Model model = bennett();
      for (JointSpec& j : model.joints)
        j.friction = JointFrictionSpec{.mu = 0.2, .radius = 0.01, .stiffness = 1e5, .damping = 0.0};
      model.analysis.step = step;
      model.analysis.duration = 0.4;
      model.analysis.solver = solver;
      Simulation s(std::move(model));
      const double most = lag(s, 4, 0.2 * 0.01, 0.0, 0.1, 0.4, step);
      EXPECT_LE(most, 2e-3 * step * step + 3e-8) << solver << ' ' << step;
      EXPECT_LE(s.state().ledger.energy_drift, 1e-9) << solver << ' ' << step;
    }
}

// Friction in all hinges, through the flat position, whose rank is deficient, on any grid: the
// parallelograms stay parallelograms, the ledger closes, and the energy lost is that of fine steps.
// (At an angle φ from flat friction needs forces of μ r/φ: pins are small, so that this is a small
// force at all grids. Of three it leaves an integral of 1/φ, which depends on the grid.)
TEST(FlatFourBarWithFriction, IsPassedOnTheSameBranch) {
  for (const int N : {1, 3})
    for (const double phi : {0.0, 0.777}) {
      double fine = 0.0;
      for (const double step : {0.0025, 0.01, 0.01 * std::numbers::sqrt2, 0.02}) {
        Model model = n_four_bar(N, phi);
        for (JointSpec& j : model.joints)
          j.friction = JointFrictionSpec{.mu = 0.1, .radius = 1e-4, .stiffness = 1e4};
        model.analysis.step = step;
        model.analysis.duration = 2.0;
        Simulation s(std::move(model));
        const RunSummary r = finished(s);
        EXPECT_LE(r.energy_drift, N == 1 ? 1e-10 : 1e-5) << N << ' ' << step << ' ' << phi;
        EXPECT_LE(r.constraint_residual_max, 1e-13) << N << ' ' << step << ' ' << phi;
        double apart = 0.0;
        for (int i = 1; i <= N; ++i)
          apart =
              std::max(apart, (s.body(i).q * Vec3::UnitX() - s.body(0).q * Vec3::UnitX()).norm());
        EXPECT_LE(apart, 1e-6) << N << ' ' << step << ' ' << phi;
        if (N > 1) continue;
        if (fine == 0.0) fine = s.balance().dissipated;
        EXPECT_NEAR(s.balance().dissipated, fine, 0.01 * fine) << step << ' ' << phi;
      }
    }
}

// The motor turns the door by ω = a t. Each of three hinges carries a third of
// m ρ a √(1 + a² t⁴), and the motor J a + μ r F. At 400 N the middle hinge breaks, an event sees
// 350 N on another one, and in the end two hinges carry half each.
TEST(DoorOnThreeHinges, BreaksAndSwitchesByTheReactionsThatRub) {
  const double a = 16.0;
  const auto force = [&](double t) { return 10.0 * a * std::hypot(1.0, a * t * t); };
  const auto time_of = [&](double F) {
    return std::sqrt(std::sqrt(std::pow(F / (10.0 * a), 2) - 1.0) / a);
  };
  for (const double step : {10e-3, 1e-3, 0.1e-3}) {
    std::string text =
        "variables: {w: 0}\n" +
        door("friction: {mu: 0.3, radius: 20 mm, stiffness: 1e6}",
             "loads:\n"
             "  motor: {type: rotary_motor, joint: low, speed: {table: [[0, 0], [1 s, 16]]}}\n"
             "  sign: {type: force, body: door, force: [0, 0, 0]}\n"
             "events:\n"
             "  seen: {when: {joint: high, channel: force, above: 350 N}, off: [sign]}\n");
    text.insert(text.find("friction", text.find("middle: {type")), "breaks: {force: 400 N}, ");
    Simulation s = made(
        text +
        format("analysis: {{duration: 0.8 s, step: {:.17g} s}}\noutput: {{hdf5: false}}\n", step));
    const RunSummary r = finished(s);
    ASSERT_EQ(r.events.size(), 2U);
    for (const auto& e : r.events) {
      const double F = 3.0 * (e.name == "seen" ? 350.0 : 400.0);
      EXPECT_NEAR(e.time, time_of(F), 1e-3 * step + 1e-9) << e.name << ' ' << step;
    }
    // The bristle takes the reaction of a step, which the jump of accelerations has set swinging.
    EXPECT_NEAR(s.load(0)[2], 7.5 * a + 0.3 * 0.02 * force(0.8), 100.0 * step) << step;
    EXPECT_NEAR(s.joint(0).force.norm(), 0.5 * force(0.8), 1e-2 * step * force(0.8)) << step;
  }
}

}  // namespace polhode::test::redundant_friction_tests
