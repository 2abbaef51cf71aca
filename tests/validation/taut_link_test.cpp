// SPDX-License-Identifier: Apache-2.0
// Links with slack that begin at their stop and are loaded from there on.
#include <gtest/gtest.h>

#include <cmath>

#include <polhode/core/format.hpp>
#include <support/run_text.hpp>

namespace polhode::test::taut_link_tests {
namespace {

constexpr double kLength = 0.05;

/// A stone on a string at its full length, with a velocity normal to the string.
Simulation stone(double e, double step, double along) {
  return made(format(R"(
format: 1
gravity: [0, 0, 0]
bodies: {{stone: {{mass: 0.1, inertia: [1e-5, 2e-5, 3e-5], position: [0.05, 0, 0], velocity: [{2}, 1, 0]}}}}
joints:
  string: {{type: slack_link, bodies: [ground, stone], at: [[0, 0, 0], [0.05, 0, 0]], limits: {{upper: 0.05, restitution: {0}}}}}
analysis: {{duration: 0.4 s, step: {1}}}
output: {{hdf5: false}}
)",
                     e, step, along));
}

/// @returns how far the string was stretched at most [m].
double run_taut(Simulation& s) {
  double longest = 0.0;
  const RunSummary summary =
      s.run({}, [&](Simulation& now) { longest = std::max(longest, now.body(0).r.norm()); });
  EXPECT_EQ(summary.end, RunEnd::finished) << summary.message;
  EXPECT_LT(summary.energy_drift, 1e-9);
  return longest - kLength;
}

constexpr double kSpan = 0.4, kBand = 1e-3 * 0.01414;  // a thousandth of its radius of gyration

/// The tension is the centripetal force; the angle is v t / l.
// @tests{turn-law}
TEST(TautLink, GuidesAStoneInACircle) {
  for (const double e : {0.0, 0.5})
    for (const double step : {5e-3, 1e-3, 5e-5}) {
      SCOPED_TRACE(format("e = {}, step {} s", e, step));
      Simulation s = stone(e, step, 0.0);
      EXPECT_LT(run_taut(s), 0.5 * kBand);
      const double angle = kSpan / kLength;
      const Vec3 r = kLength * Vec3(std::cos(angle), std::sin(angle), 0.0);
      EXPECT_LT((s.body(0).r - r).norm(), 20.0 * step * step + 2e-5)
          << "order 2, and the initial settling";
    }
}

/// The string stops the velocity along it and then carries its tension without further penetration.
/// An earlier version took the tension for an impact in each step and moved towards the end of its
/// band each time.
// @tests{turn-law}
TEST(TautLink, TightensAndThenCarriesItsTension) {
  for (const double e : {0.0, 0.5})
    for (const double step : {5e-3, 1e-3, 5e-5}) {
      SCOPED_TRACE(format("e = {}, step {} s", e, step));
      Simulation s = stone(e, step, 0.3);
      EXPECT_LT(run_taut(s), 0.5 * kBand);
      EXPECT_NEAR(s.body(0).v.norm(), 1.0, 1e-4);
    }
}

}  // namespace
}  // namespace polhode::test::taut_link_tests
