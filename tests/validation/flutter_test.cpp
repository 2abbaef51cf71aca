// SPDX-License-Identifier: Apache-2.0
// Columns under follower forces: frequencies, and the loads at which they flutter.
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/modal.hpp>

namespace polhode::flutter_tests {
namespace {

ModesReport modes_of(const std::string& text, const io::Overrides& overrides = {}) {
  const ModalAnalysis analysis(io::read_model_text(text, "column.yaml", overrides));
  EXPECT_TRUE(analysis.converged()) << analysis.message();
  return analysis.report();
}

bool flutters(const ModesReport& r) {
  for (const Mode& mode : r.modes)
    if (mode.kind == ModeKind::flutter) return true;
  return false;
}

/// Load at which flutter begins, between two loads.
template <class Report>
double flutter_load(double stable, double fluttering, Report&& report_at) {
  EXPECT_FALSE(flutters(report_at(stable)));
  EXPECT_TRUE(flutters(report_at(fluttering)));
  while (fluttering - stable > 1e-4 * fluttering) {
    const double middle = 0.5 * (stable + fluttering);
    (flutters(report_at(middle)) ? fluttering : stable) = middle;
  }
  return 0.5 * (stable + fluttering);
}

// E I = m = L = 1, shear and rotary inertia negligible.
constexpr const char* kBeck = R"(
format: 1
variables: {P: 10, n: 20, tau: 0}
sections:
  bar: {type: general, EA: 1e7, GA_y: 1e7, GA_z: 1e7, GJ: 1, EI_y: 1, EI_z: 100, mass_per_length: 1, inertia_per_length: [1e-8, 1e-8, 1e-8], relaxation_time: tau}
beams:
  bar: {points: [[0, 0, 0], [1, 0, 0]], elements: n, section: bar, up: y, bonded: {ground: start}}
loads: {press: {type: force, body: bar.end, force: [-P, 0, 0], body_fixed: true}}
analysis: {type: modes, count: 4}
)";

/// Beck's characteristic equation, p = P L²/(E I), Ω² = m ω² L⁴/(E I): M. Beck, Z. angew. Math.
/// Phys. 3 (1952) 225-228.
double beck(double p, double Omega) {
  const double root = std::sqrt(0.25 * p * p + Omega * Omega);
  const double a = std::sqrt(root + 0.5 * p), b = std::sqrt(root - 0.5 * p);
  return p * p + 2.0 * Omega * Omega * (1.0 + std::cos(a) * std::cosh(b)) +
         p * Omega * std::sin(a) * std::sinh(b);
}

double beck_root(double p, double low, double high) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    ((beck(p, low) > 0.0) == (beck(p, middle) > 0.0) ? low : high) = middle;
  }
  return low;
}

// @tests{modes-quadratic}
TEST(Flutter, BecksColumnHasItsFrequencyAndIsStableAtHalfTheLoad) {
  for (const double P : {2.0, 10.0, 15.0}) {
    const ModesReport r = modes_of(kBeck, {format("variables.P={}", P), "variables.n=40"});
    EXPECT_FALSE(r.symmetric);
    ASSERT_EQ(r.modes.size(), 4u);
    const double first = beck_root(P, 3.0, 9.2 + 0.1 * P) / (2.0 * std::numbers::pi);
    EXPECT_EQ(r.modes[0].kind, ModeKind::oscillation) << P;
    EXPECT_EQ(r.modes[0].damping, 0.0);
    EXPECT_NEAR(r.modes[0].frequency, first, 1e-3 * first) << P;
    EXPECT_LT(r.modes[0].residual, 1e-6);
    if (P == 10.0) {
      EXPECT_NEAR(r.modes[0].frequency, 0.824, 1e-3);
    }
  }
}

/// 20.05 E I/L². @tests{modes-damped}
TEST(Flutter, BecksColumnFluttersAtItsLoadOnAnyMesh) {
  for (const int n : {10, 20, 40, 80})  // 80 by Arnoldi iterations
    EXPECT_NEAR(
        flutter_load(
            19.0, 21.0,
            [&](double P) {
              return modes_of(kBeck, {format("variables.P={}", P), format("variables.n={}", n)});
            }),
        20.051,
        (n == 10   ? 5e-3
         : n == 20 ? 1.5e-3
                   : 1e-3) *
            20.051)
        << n;
}

/// Bars of length l = 1 without mass, 2 m and m = 1 at their ends, hinges of stiffness k = 1 and
/// damping b_1, b_2. The load at which it flutters, undamped: 7/2 − √2 (H. Ziegler, Ing.-Arch. 20
/// (1952) 49-56); damped, B = b_1/b_2: (4B² + 33B + 4)/(2(B² + 7B + 6)) + b_1 b_2/2 (G. Herrmann,
/// I.-C. Jong, J. Appl. Mech. 32 (1965) 592-597).
constexpr const char* kZiegler = R"(
format: 1
variables: {P: 1, b1: 0, b2: 0}
bodies:
  one: {mass: 2, inertia: [1e-10, 1e-10, 1e-10], position: [1, 0, 0]}
  two: {mass: 1, inertia: [1e-10, 1e-10, 1e-10], position: [2, 0, 0]}
joints:
  foot: {type: revolute, bodies: [ground, one], at: [0, 0, 0], axis: y}
  knee: {type: revolute, bodies: [one, two], at: [1, 0, 0], axis: y}
loads:
  at_foot: {type: torsional_spring, joint: foot, stiffness: 1, damping: b1}
  at_knee: {type: torsional_spring, joint: knee, stiffness: 1, damping: b2}
  press: {type: force, body: two, force: [-P, 0, 0], body_fixed: true}
analysis: {type: modes, count: 4}
)";

// @tests{modes-damped}
TEST(Flutter, ZieglersPendulumFluttersAtItsLoadsUndampedAndDamped) {
  const auto load = [](double b_1, double b_2) {
    return flutter_load(0.1, 4.0, [&](double P) {
      return modes_of(kZiegler, {format("variables.P={}", P), format("variables.b1={}", b_1),
                                 format("variables.b2={}", b_2)});
    });
  };
  EXPECT_NEAR(load(0.0, 0.0), 3.5 - std::numbers::sqrt2, 3e-4);
  for (const auto& [b_1, b_2] : {std::pair(0.01, 0.01), {0.1, 0.1}, {0.5, 0.05}, {0.02, 0.2}}) {
    const double B = b_1 / b_2;
    const double known =
        (4.0 * B * B + 33.0 * B + 4.0) / (2.0 * (B * B + 7.0 * B + 6.0)) + 0.5 * b_1 * b_2;
    EXPECT_NEAR(load(b_1, b_2), known, 1e-3 * known) << b_1 << ' ' << b_2;
  }
}

TEST(Flutter, ZieglersPendulumDivergesUnderAWeight) {
  // A vertical dead force: (3 − √5)/2 k/l, Euler's load; beyond it the motion grows without
  // oscillation.
  const std::string dead = [] {
    std::string text = kZiegler;
    const std::string follower = ", body_fixed: true";
    return text.erase(text.find(follower), follower.size());
  }();
  const double critical = 0.5 * (3.0 - std::sqrt(5.0));
  for (const double part : {0.999, 1.001}) {
    const ModesReport r = modes_of(dead, {format("variables.P={}", part * critical)});
    EXPECT_TRUE(r.symmetric);
    EXPECT_EQ(r.modes[0].kind, part < 1.0 ? ModeKind::oscillation : ModeKind::divergence);
    ASSERT_EQ(r.modes.size(), 2u);
    EXPECT_FALSE(r.warnings.empty());  // four were wanted
  }
}

/// A follower force distributed uniformly over a cantilever: 40.05 E I/L³ (H. Leipholz, Ing.-Arch.
/// 34 (1965) 255-263), as forces at the nodes.
std::string leipholz(int n, double q) {
  std::string text = format(R"(
format: 1
sections:
  bar: {{type: general, EA: 1e7, GA_y: 1e7, GA_z: 1e7, GJ: 1, EI_y: 1, EI_z: 100, mass_per_length: 1, inertia_per_length: [1e-8, 1e-8, 1e-8]}}
beams:
  bar: {{points: [[0, 0, 0], [1, 0, 0]], elements: {0}, section: bar, up: y, bonded: {{ground: start}}}}
analysis: {{type: modes, count: 4}}
loads:
)",
                            n);
  for (int k = 1; k <= n; ++k)
    text += format("  q{0}: {{type: force, body: bar.{0}, force: [{1}, 0, 0], body_fixed: true}}\n",
                   k, -q / n * (k == n ? 0.5 : 1.0));
  return text;
}

TEST(Flutter, LeipholzColumnFluttersAtItsLoad) {
  for (const int n : {25, 50})
    EXPECT_NEAR(flutter_load(35.0, 45.0, [&](double q) { return modes_of(leipholz(n, q)); }), 40.05,
                1e-3 * 40.05)
        << n;
}

}  // namespace
}  // namespace polhode::flutter_tests
