// SPDX-License-Identifier: Apache-2.0
// Vibrations of turning rotors: whirl forward and backward, and the speed above which inner damping
// makes them grow.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/modal.hpp>

namespace polhode::rotor_modes_tests {
namespace {

using Complex = std::complex<double>;

ModesReport modes_of(const std::string& text, const io::Overrides& overrides = {}) {
  const ModalAnalysis analysis(io::read_model_text(text, "rotor.yaml", overrides));
  EXPECT_TRUE(analysis.converged()) << analysis.message();
  // Freedoms with nearly no mass have high frequencies, which are accurate to some digits only.
  for (const std::string& warning : analysis.report().warnings)
    EXPECT_NE(warning.find("is accurate to"), std::string::npos) << warning;
  return analysis.report();
}

/// Angular frequencies of oscillations, ascending.
std::vector<double> frequencies(const ModesReport& r) {
  std::vector<double> list;
  for (const Mode& mode : r.modes)
    if (mode.kind == ModeKind::oscillation) list.push_back(mode.eigenvalue.imag());
  std::sort(list.begin(), list.end());
  return list;
}

/// A disc at the end of a shaft without mass, with a bearing at the other end. With w = y + iz:
/// (k_11 − mω²)(k_22 + J_p Ω ω − J_t ω²) = k_12², k of the cantilever, ω of both signs: forward and
/// backward whirl (Stodola; G. Genta, Dynamics of Rotating Systems, 2005, chapter 4).
constexpr const char* kOverhung = R"(
format: 1
variables: {spin: 100, flat: 0}
sections:
  shaft: {type: general, EA: 1e8, GA_y: 1e8, GA_z: 1e8, GJ: 1e3, EI_y: 300, EI_z: 300, mass_per_length: 1e-4, inertia_per_length: [1e-8, 1e-8, 1e-8]}
beams:
  shaft: {points: [[0, 0, 0], [0.5, 0, 0]], elements: 4, section: shaft, up: y, bonded: {disc: end}, angular_velocity: [spin, 0, 0]}
bodies:
  disc: {mass: 4, inertia: [0.08, 0.04, 0.04 + flat], position: [0.5, 0, 0], angular_velocity: [spin, 0, 0]}
joints:
  bearing: {type: revolute, bodies: [ground, shaft.start], at: [0, 0, 0], axis: x}
analysis: {type: modes, count: 6}
output: {hdf5: false}
)";

std::vector<double> overhung(double spin) {
  const double L = 0.5, EI = 300.0, m = 4.0, J_p = 0.08, J_t = 0.04;
  const double k_11 = 12.0 * EI / (L * L * L), k_12 = 6.0 * EI / (L * L), k_22 = 4.0 * EI / L;
  // In ω: a companion matrix of (mω² − k_11)(J_t ω² − J_p Ω ω − k_22) − k_12².
  const double a[] = {k_11 * k_22 - k_12 * k_12, k_11 * J_p * spin, -m * k_22 - k_11 * J_t,
                      -m * J_p * spin, m * J_t};
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  for (int i = 0; i < 3; ++i) A(i, i + 1) = 1.0;
  for (int i = 0; i < 4; ++i) A(3, i) = -a[i] / a[4];
  const Eigen::Vector4cd roots = A.eigenvalues();
  std::vector<double> list;
  for (int i = 0; i < 4; ++i) list.push_back(std::abs(roots[i].real()));
  std::sort(list.begin(), list.end());
  return list;
}

// @tests{modes-gyroscopic}
TEST(RotorModes, OfAnOverhungDiscSplitByTheGyroscopicMoment) {
  for (const double spin : {0.0, 10.0, 100.0, 1000.0}) {
    const ModesReport r = modes_of(kOverhung, {format("variables.spin={}", spin)});
    EXPECT_EQ(r.symmetric, spin == 0.0);
    std::vector<double> found = frequencies(r);
    const std::vector<double> known = overhung(spin);
    ASSERT_GE(found.size(), 4u) << spin;
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(found[i], known[i], 1e-4 * known[i]) << spin << ' ' << i;
    EXPECT_EQ(r.modes[0].kind, ModeKind::free);
    EXPECT_NE(r.modes[0].motion.find("rotates about x"), std::string::npos) << r.modes[0].motion;
  }
}

TEST(RotorModes, WarnThatModesOfAnAsymmetricRotorHoldForAnInstant) {
  const ModalAnalysis rotor(io::read_model_text(kOverhung, "rotor.yaml", {"variables.flat=0.01"}));
  ASSERT_FALSE(rotor.report().warnings.empty());
  EXPECT_NE(rotor.report().warnings[0].find("modes hold for this instant only"), std::string::npos);
}

/// A round shaft on two bearings, EI k⁴ − (μ + ι k²) ω² + 2 ι k² Ω ω = 0, k = nπ/L, with the rotary
/// inertia ι = ρI (rotating Rayleigh beam).
constexpr const char* kRayleigh = R"(
format: 1
variables: {spin: 50, n: 60}
sections:
  shaft: {type: general, EA: 1e10, GA_y: 1e10, GA_z: 1e10, GJ: 1e5, EI_y: 1e4, EI_z: 1e4, mass_per_length: 10, inertia_per_length: [0.4, 0.2, 0.2]}
beams:
  shaft: {points: [[0, 0, 0], [2, 0, 0]], elements: n, section: shaft, up: y, angular_velocity: [spin, 0, 0]}
joints:
  left: {type: spherical, bodies: [ground, shaft.start], at: [0, 0, 0]}
  right: {type: point_on_line, bodies: [ground, shaft.end], at: [2, 0, 0], axis: x}
analysis: {type: modes, count: 9}
)";

// @tests{modes-gyroscopic}
TEST(RotorModes, OfARayleighShaftAreThoseOfItsEquation) {
  for (const char* n : {"30", "60"})  // dense, and by Arnoldi iterations
    for (const double spin : {50.0, 400.0}) {
      const ModesReport r =
          modes_of(kRayleigh, {format("variables.spin={}", spin), std::string("variables.n=") + n});
      std::vector<double> known;
      for (int k = 1; k <= 3; ++k) {
        const double q = std::pow(k * std::numbers::pi / 2.0, 2);
        const double a = 10.0 + 0.2 * q, b = 0.2 * q * spin, c = 1e4 * q * q;
        known.push_back((std::sqrt(b * b + a * c) - b) / a);
        known.push_back((std::sqrt(b * b + a * c) + b) / a);
      }
      std::sort(known.begin(), known.end());
      const std::vector<double> found = frequencies(r);
      ASSERT_GE(found.size(), 6u);
      for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(found[i], known[i], (n[0] == '3' ? 2e-3 : 1e-3) * known[i])
            << n << ' ' << spin << ' ' << i;
    }
}

/// A point-like disc on a rotating viscous shaft, with dampers to the ground: m λ² + (c_i + c_e) λ
/// + k − iΩ c_i = 0 in y + iz. It whirls with growing amplitude above ω (1 + c_e/c_i) (Jeffcott's
/// rotor with internal damping: Genta, chapter 3).
constexpr const char* kJeffcott = R"(
format: 1
variables: {spin: 40, tau: 1e-3, c: 4}
sections:
  shaft: {type: general, EA: 1e8, GA_y: 1e8, GA_z: 1e8, GJ: 1e3, EI_y: 300, EI_z: 300, mass_per_length: 1e-4, inertia_per_length: [1e-8, 1e-8, 1e-8], relaxation_time: tau}
beams:
  shaft: {points: [[0, 0, 0], [0.5, 0, 0]], elements: 4, section: shaft, up: y, bonded: {disc: end}, angular_velocity: [spin, 0, 0]}
bodies:
  disc: {mass: 4, inertia: [1e-5, 1e-5, 1e-5], position: [0.5, 0, 0], angular_velocity: [spin, 0, 0]}
joints:
  bearing: {type: revolute, bodies: [ground, shaft.start], at: [0, 0, 0], axis: x}
loads:
  in_y: {type: spring_damper, bodies: [ground, disc], at: [[0.5, 9, 0], [0.5, 0, 0]], damping: c}
  in_z: {type: spring_damper, bodies: [ground, disc], at: [[0.5, 0, 9], [0.5, 0, 0]], damping: c}
analysis: {type: modes, count: 4}
)";

// @tests{modes-circulatory}
TEST(RotorModes, AreUnstableAboveTheLimitSpeedOfInternalDamping) {
  const double k = 3.0 * 300.0 / 0.125, m = 4.0, c_i = 1e-3 * k, c_e = 4.0;
  const double limit = std::sqrt(k / m) * (1.0 + c_e / c_i);
  for (const double part : {0.5, 0.99, 1.01, 1.5}) {
    const double spin = part * limit;
    const ModesReport r = modes_of(kJeffcott, {format("variables.spin={}", spin)});
    bool grows = false;
    const Complex b(c_i + c_e, 0.0), root = std::sqrt(b * b - 4.0 * m * Complex(k, -spin * c_i));
    for (const Complex known : {(-b + root) / (2.0 * m), (-b - root) / (2.0 * m)}) {
      double nearest = 1e9;
      for (const Mode& mode : r.modes)
        nearest = std::min({nearest, std::abs(mode.eigenvalue - known),
                            std::abs(std::conj(mode.eigenvalue) - known)});
      EXPECT_LT(nearest, 1e-4 * std::abs(known)) << part << ' ' << known;
    }
    for (const Mode& mode : r.modes) grows = grows || mode.kind == ModeKind::flutter;
    EXPECT_EQ(grows, part > 1.0) << part;
  }
}

}  // namespace
}  // namespace polhode::rotor_modes_tests
