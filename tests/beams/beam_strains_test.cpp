// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <polhode/beams/beam_strains.hpp>
#include <polhode/math/exp_map.hpp>
#include <polhode/math/hat.hpp>
#include <support/derivative.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::beam_strains_tests {
namespace {

/// Invariants of general matrices in place of rotations, as averages of rotations are.
Vec15 some_invariants(Random& random, double size) {
  const Mat3 D = random.frame();
  const Mat3 R = exp_map(size * random.direction());
  Mat3 bent = D * R;
  bent += 0.02 * Mat3::NullaryExpr([&] { return random.number(); });
  return beam_invariants({D * (Vec3(0.9, 0.0, 0.0) + random.vector(0.3)), D, bent});
}

}  // namespace

TEST(BeamEta, IsItsClosedForm) {
  for (const double phi : {0.3, 1.0, 2.0, 3.0, 3.14159}) {
    const double closed = (1.0 - 0.5 * phi / std::tan(0.5 * phi)) / (phi * phi);
    EXPECT_NEAR(beam_eta(phi * phi).value, closed, 2e-16 / (phi * phi)) << phi;
  }
  EXPECT_NEAR(beam_eta(0.0).value, 1.0 / 12.0, 3e-17);
  EXPECT_NEAR(beam_eta(0.0).first, 1.0 / 720.0, 1e-18);
  EXPECT_NEAR(beam_eta(0.0).second, 2.0 / 30240.0, 1e-19);
}

TEST(BeamEta, HasItsDerivatives) {
  for (const double x : {0.0, 0.5, 4.0, 9.0}) {
    const double h = 1e-4;
    const Eta ahead = beam_eta(x + h), behind = beam_eta(x - h);
    EXPECT_NEAR(beam_eta(x).first, (ahead.value - behind.value) / (2 * h), 1e-11);
    EXPECT_NEAR(beam_eta(x).second, (ahead.first - behind.first) / (2 * h), 1e-11);
  }
}

// A helix is the curve of constant strains. D' = D hat(K), p' = D Γ. @tests{beam-strains}
TEST(BeamStrains, AreThoseOfAnElementWithConstantStrains) {
  Random random(3);
  for (int sample = 0; sample < 8; ++sample) {
    const double L = 0.8;
    const Vec3 K = random.vector(1.8), Gamma = Vec3(1, 0, 0) + random.vector(0.2);
    const Mat3 D = random.frame(), R = exp_map(L * K);
    // ∫ exp(s K̂) ds Γ by Gauss's rule on 64 pieces: exact to round-off.
    Vec3 end = Vec3::Zero();
    for (int i = 0; i < 64; ++i)
      for (const double at : {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)})
        end += 0.5 * L / 64 * exp_map((i + at) * L / 64 * K) * Gamma;
    const Vec6 e = beam_strain_values(beam_invariants({D * end, D, D * R}), L);
    EXPECT_LT((e.head<3>() - Gamma).norm(), 1e-8);
    EXPECT_LT((e.tail<3>() - K).norm(), 1e-14);
  }
}

// @tests{beam-invariants}
TEST(BeamStrains, DoNotChangeInRigidMotions) {
  Random random(4);
  for (int sample = 0; sample < 8; ++sample) {
    const Mat3 D_1 = random.frame(), D_2 = D_1 * exp_map(random.vector(1.3)), Q = random.frame();
    const Vec3 y = random.vector();
    const Vec6 e = beam_strain_values(beam_invariants({y, D_1, D_2}), 0.7);
    EXPECT_LT((beam_strain_values(beam_invariants({Q * y, Q * D_1, Q * D_2}), 0.7) - e).norm(),
              1e-14);
  }
}

// The same element from its other end: x and y of the section are reversed, z is kept.
TEST(BeamStrains, AreTheSameFromTheOtherEnd) {
  Random random(5);
  const Mat3 about_z = Vec3(-1, -1, 1).asDiagonal();
  for (int sample = 0; sample < 8; ++sample) {
    const Mat3 noise = 0.05 * Mat3::NullaryExpr([&] { return random.number(); });
    const Mat3 D_1 = random.frame(), D_2 = D_1 * exp_map(random.vector(1.3)) + noise;
    const Vec3 y = random.vector();
    const Vec6 e = beam_strain_values(beam_invariants({y, D_1, D_2}), 0.7);
    const Vec6 r = beam_strain_values(beam_invariants({-y, D_2 * about_z, D_1 * about_z}), 0.7);
    const Vec6 expected = (Vec6() << e[0], e[1], -e[2], e[3], e[4], -e[5]).finished();
    EXPECT_LT((r - expected).norm(), 1e-14);
  }
}

TEST(BeamStrains, HaveTheirDerivatives) {
  Random random(6);
  for (const double size : {0.0, 1e-5, 0.05, 0.12, 1.0, 2.4}) {
    const Vec15 iota = some_invariants(random, size);
    const BeamStrains b = beam_strains(iota, 0.7);
    EXPECT_LT((b.e - beam_strain_values(iota, 0.7)).norm(), 1e-14);
    expect_derivative(
        b.by_iota, [&](const Vec& d) -> Vec { return beam_strain_values(iota + d, 0.7); },
        "strains", 1e-9);
    const Vec6 sigma = (Vec6() << random.vector(), random.vector()).finished();
    expect_derivative(
        beam_strain_hessian(iota, 0.7, sigma),
        [&](const Vec& d) -> Vec {
          return beam_strains(iota + d, 0.7).by_iota.transpose() * sigma;
        },
        "their second derivative", 1e-8);
  }
}

}  // namespace polhode::test::beam_strains_tests
