// SPDX-License-Identifier: Apache-2.0
// Modes with dampers against closed forms, reports of free motions, and modes of cables.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/modal.hpp>

namespace polhode::damped_modes_tests {
namespace {

using Complex = std::complex<double>;
using ::testing::HasSubstr;

ModesReport modes_of(const std::string& text, const io::Overrides& overrides = {}) {
  const ModalAnalysis analysis(io::read_model_text(text, "model.yaml", overrides));
  EXPECT_TRUE(analysis.converged()) << analysis.message();
  return analysis.report();
}

constexpr const char* kOscillator = R"(
format: 1
variables: {zeta: 0.1}
bodies:
  mass: {mass: 3, inertia: [1, 1, 1]}
joints:
  rail: {type: prismatic, bodies: [ground, mass], at: [0, 0, 0], axis: x}
loads:
  spring: {type: spring_damper, bodies: [ground, mass], at: [[-1, 0, 0], [0, 0, 0]], stiffness: 1200, damping: 2*zeta*3*20}
analysis: {type: modes, count: 2}
)";

/// λ = −ζω ± ω √(ζ² − 1), ω = 20/s. @tests{modes-damped}
TEST(DampedModes, OfAnOscillatorHaveItsDampingRatio) {
  for (const double zeta : {1e-9, 1e-3, 0.1, 0.7, 0.999}) {
    const ModesReport r = modes_of(kOscillator, {format("variables.zeta={}", zeta)});
    ASSERT_EQ(r.modes.size(), 1u) << zeta;
    EXPECT_EQ(r.modes[0].kind, ModeKind::oscillation);
    EXPECT_NEAR(r.modes[0].frequency, 10.0 / std::numbers::pi, 1e-9);
    if (zeta > 1e-6) {
      EXPECT_NEAR(r.modes[0].damping, zeta, 1e-9);
    }
    EXPECT_NEAR(r.modes[0].eigenvalue.imag(), 20.0 * std::sqrt(1.0 - zeta * zeta), 1e-6);
    EXPECT_THAT(r.warnings.at(0), HasSubstr("2 modes were requested, but the model has 1 only"));
  }
  const ModesReport r = modes_of(kOscillator, {"variables.zeta=2"});
  ASSERT_EQ(r.modes.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(r.modes[i].kind, ModeKind::overdamped);
    EXPECT_NEAR(r.modes[i].eigenvalue.real(),
                20.0 * (-2.0 + (i == 0 ? 1.0 : -1.0) * std::sqrt(3.0)), 1e-9);
  }
}

TEST(DampedModes, OfADamperAloneAreOneFreeAndOneOverdamped) {
  const ModesReport r =
      modes_of(kOscillator, {"loads.spring.stiffness=0", "loads.spring.damping=6"});
  ASSERT_EQ(r.modes.size(), 2u);
  EXPECT_EQ(r.modes[0].kind, ModeKind::free);
  EXPECT_EQ(r.modes[0].motion, "body 'mass' moves along x");
  EXPECT_EQ(r.modes[1].kind, ModeKind::overdamped);
  EXPECT_NEAR(r.modes[1].eigenvalue.real(), -2.0, 1e-9);
}

/// A block of viscoelastic material: its oscillations, λ² + τω²λ + ω² = 0 with the ω of the elastic
/// block, come first, overdamped modes after them.
TEST(DampedModes, OfAViscousSolidBeginWithItsOscillations) {
  const std::string block = R"(
format: 1
materials: {m: {type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000VISCOUS}}
solids:
  bar:
    mesh: {block: {size: [1, 0.1, 0.12], cells: [4, 1, 1]}}
    element: hex8
    material: m
    bonded: {ground: xmin}
analysis: {type: modes, count: 4}
)";
  const auto with = [&](const std::string& viscosity) {
    std::string text = block;
    text.replace(text.find("VISCOUS"), 7, viscosity);
    return modes_of(text.c_str(), {});
  };
  const double tau = 0.1;
  const ModesReport elastic = with(""), viscous = with(", viscosity: {relaxation_time: 0.1 s}");
  int oscillations = 0;
  for (const Mode& mode : elastic.modes) {
    const double w = 2.0 * std::numbers::pi * mode.frequency, zeta = 0.5 * tau * w;
    if (zeta >= 1.0) break;
    const Mode& damped = viscous.modes.at(static_cast<std::size_t>(oscillations++));
    EXPECT_EQ(damped.kind, ModeKind::oscillation);
    EXPECT_NEAR(damped.frequency, mode.frequency, 1e-6 * mode.frequency);
    EXPECT_NEAR(damped.damping, zeta, 1e-6);
  }
  EXPECT_EQ(oscillations, 2);
  ASSERT_EQ(viscous.modes.size(), 6u) << "followed by overdamped ones up to the given number";
  for (std::size_t i = 2; i < 6; ++i) {
    EXPECT_EQ(viscous.modes[i].kind, ModeKind::overdamped);
    EXPECT_LT(viscous.modes[i].eigenvalue.real(), -1.0 / tau);
  }
}

/// Chains of n masses with one damper at the end: the eigenvalues of the companion matrix. Longer
/// chains are solved by Arnoldi iterations.
TEST(DampedModes, OfAChainWithADamperAtItsEndAreThoseOfItsCompanionMatrix) {
  for (const int n : {5, 60}) {
    std::string bodies, joints, loads;
    for (int i = 0; i < n; ++i) {
      bodies += format("  m{}: {{mass: 2, inertia: [1, 1, 1], position: [{}, 0, 0]}}\n", i, i + 1);
      joints += format(
          "  rail{0}: {{type: prismatic, bodies: [ground, m{0}], at: [{1}, 0, 0], axis: x}}\n", i,
          i + 1);
      loads += format(
          "  s{0}: {{type: spring_damper, bodies: [{1}, m{0}], at: [[{0}, 0, 0], [{2}, 0, 0]], "
          "stiffness: 70, damping: {3}}}\n",
          i, i == 0 ? "ground" : format("m{}", i - 1), i + 1, i == n - 1 ? 5 : 0);
    }
    const ModesReport r = modes_of("format: 1\nbodies:\n" + bodies + "joints:\n" + joints +
                                   "loads:\n" + loads + "analysis: {type: modes, count: 4}\n");
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n), C = K, A(2 * n, 2 * n);
    for (int i = 0; i < n; ++i)
      for (Eigen::MatrixXd* X : {&K, &C}) {
        const double x = X == &K ? 70.0 : (i == n - 1 ? 5.0 : 0.0);
        (*X)(i, i) += x;
        if (i == 0) continue;
        (*X)(i - 1, i - 1) += x;
        (*X)(i, i - 1) -= x;
        (*X)(i - 1, i) -= x;
      }
    A << Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Identity(n, n), -0.5 * K, -0.5 * C;
    const Eigen::VectorXcd known = A.eigenvalues();
    ASSERT_EQ(r.modes.size(), 4u);
    for (const Mode& mode : r.modes) {
      EXPECT_LT((known.array() - mode.eigenvalue).abs().minCoeff(),
                1e-7 * std::abs(mode.eigenvalue))
          << n << ' ' << mode.eigenvalue;
      EXPECT_LT(mode.residual, 1e-6);
    }
    double slowest = 1e9;
    for (int i = 0; i < 2 * n; ++i) slowest = std::min(slowest, std::abs(known[i]));
    EXPECT_NEAR(std::abs(r.modes[0].eigenvalue), slowest, 1e-7 * slowest);
  }
}

TEST(DampedModes, OfAFreeBodyAreThreeTranslationsAndThreeRotations) {
  const ModesReport r = modes_of(R"(
format: 1
bodies:
  brick: {mass: 2, inertia: [1, 2, 3], position: [4, 5, 6], orientation: {axis: z, angle: 20 deg}}
analysis: {type: modes, count: 8}
)");
  ASSERT_EQ(r.modes.size(), 6u);
  std::vector<std::string> motions;
  for (const Mode& mode : r.modes) {
    EXPECT_EQ(mode.kind, ModeKind::free);
    motions.push_back(mode.motion);
  }
  EXPECT_THAT(motions, ::testing::IsSupersetOf(
                           {"body 'brick' moves along x", "body 'brick' moves along y",
                            "body 'brick' moves along z", "body 'brick' rotates about z"}));
  EXPECT_THAT(r.warnings.at(0), HasSubstr("8 modes were requested, but the model has 6 only"));
}

/// A chain that hangs: ω_k = j_0k/2 √(g/L), j_0k the zeros of J_0 (D. Bernoulli); in two planes.
TEST(DampedModes, OfAHangingChainAreThoseOfBernoulli) {
  const ModesReport r = modes_of(R"(
format: 1
gravity: [0, 0, -9.81]
cables:
  chain: {through: [[ground, [0, 0, 0]], [bob]], stiffness: 1e6, mass_per_length: 1, elements: 100}
bodies:
  bob: {mass: 1e-9, inertia: [1e-12, 1e-12, 1e-12], position: [0, 0, -2]}
analysis: {type: modes, count: 12}
)");
  std::vector<double> found;
  for (const Mode& mode : r.modes)
    if (mode.kind == ModeKind::oscillation)
      found.push_back(2.0 * std::numbers::pi * mode.frequency);
  std::sort(found.begin(), found.end());
  ASSERT_GE(found.size(), 6u);
  const double zeros[] = {2.404826, 5.520078, 8.653728};
  for (int k = 0; k < 6; ++k) {
    const double known = 0.5 * zeros[k / 2] * std::sqrt(9.81 / 2.0);
    EXPECT_NEAR(found[static_cast<std::size_t>(k)], known, 2e-3 * known) << k;
  }
}

TEST(DampedModes, OfAModelWithoutFreedomsAreEmptyWithAWarning) {
  const ModesReport r = modes_of(R"(
format: 1
bodies:
  block: {mass: 1, inertia: [1, 1, 1]}
joints:
  weld: {type: fixed, bodies: [ground, block], at: [0, 0, 0]}
analysis: {type: modes, count: 3}
)");
  EXPECT_TRUE(r.modes.empty());
  EXPECT_THAT(r.warnings.at(0), HasSubstr("every degree of freedom is constrained"));
}

}  // namespace
}  // namespace polhode::damped_modes_tests
