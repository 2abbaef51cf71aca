// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <random>

#include <polhode/dynamics/momentum_step.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/system/interaction.hpp>

namespace polhode::test {

/// Pseudo-random numbers, the same in every run.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double number(double size = 1.0) {
    // Not a standard distribution: those differ between libraries.
    return size * (2.0 * static_cast<double>(engine_()) / 4294967295.0 - 1.0);
  }
  Vec3 vector(double size = 1.0) { return {number(size), number(size), number(size)}; }
  Vec3 direction() {
    Vec3 d = vector();
    while (d.norm() < 0.1) d = vector();
    return d.normalized();
  }
  // One call after the other: compilers differ in the order in which they evaluate operands.
  Quat orientation() {
    const double angle = number();
    return quaternion_from_rotation_vector(2.5 * direction() * angle);
  }
  Mat3 frame() { return orientation().toRotationMatrix(); }
  Mat3 inertia() {
    const Mat3 R = frame();
    const double c = number(), b = number(), a = number();
    return R * Vec3(1.0 + 0.3 * a, 1.2 + 0.3 * b, 1.5 + 0.3 * c).asDiagonal() * R.transpose();
  }
  BodyMotion motion() {
    BodyMotion m;
    m.r = vector();
    m.q = orientation();
    m.v = vector(2.0);
    m.W = vector(2.0);
    m.a = vector();
    m.A = vector();
    m.h_dot = vector();
    return m;
  }

 private:
  std::mt19937 engine_;
};

[[nodiscard]] inline StepContext context_of(double rho_inf, double dt = 0.3, double t_n = 0.7) {
  return {.ga = GeneralizedAlpha::from_spectral_radius(rho_inf), .t_n = t_n, .dt = dt};
}

/// Displacements of sides a and b in 12 numbers (Δr_a, Δθ_a, Δr_b, Δθ_b).
using Displacement = Eigen::Matrix<double, 12, 1>;

/// Two bodies in a large step (turns of about a radian), in general or with one of them as the
/// ground.
struct PairMotion {
  StepContext context;
  BodyMotion a_n, b_n;
  Vec3 u_a, theta_a, u_b, theta_b;
  bool a_moves = true, b_moves = true;
  std::array<double, kMaxRows> lambda{};
  std::array<double, 24> history{};

  PairMotion(Random& random, const StepContext& with) : context(with) {
    a_n = random.motion();
    b_n = random.motion();
    u_a = random.vector(0.5);
    u_b = random.vector(0.5);
    theta_a = random.vector(0.7);
    theta_b = random.vector(0.7);
    for (double& l : lambda) l = random.number(2.0);
  }

  [[nodiscard]] BodyStep a(const Displacement& d = Displacement::Zero()) const {
    return a_moves ? side(a_n, u_a, theta_a, d.segment<3>(0), d.segment<3>(3))
                   : BodyStep::ground(context.ga.alpha_f);
  }
  [[nodiscard]] BodyStep b(const Displacement& d = Displacement::Zero()) const {
    return b_moves ? side(b_n, u_b, theta_b, d.segment<3>(6), d.segment<3>(9))
                   : BodyStep::ground(context.ga.alpha_f);
  }
  /// The wrenches' tangent and rows by columns that belong to the ground are to be ignored.
  [[nodiscard]] bool moves(int column) const { return column < 6 ? a_moves : b_moves; }

  /// Calls what(PairStep) with the displaced step.
  template <class What>
  auto with(const Displacement& d, What&& what) const {
    const BodyStep step_a = a(d), step_b = b(d);
    return what(PairStep{step_a, step_b, context, lambda.data(), history.data()});
  }
  /// Calls what(PairStep) at the instant t_n.
  template <class What>
  auto at_start(What&& what) const {
    const BodyStep step_a = a_moves ? instant(a_n) : BodyStep::ground(1.0);
    const BodyStep step_b = b_moves ? instant(b_n) : BodyStep::ground(1.0);
    return what(PairStep{step_a, step_b, context, lambda.data(), history.data()});
  }

  [[nodiscard]] static BodyStep instant(const BodyMotion& m) {
    return BodyStep::at_instant(m.r, m.Lambda(), m.v, m.W);
  }

 private:
  [[nodiscard]] BodyStep side(const BodyMotion& m, const Vec3& u, const Vec3& theta, const Vec3& dr,
                              const Vec3& dtheta) const {
    return newmark_step(m, u + dr, compose_cayley(dtheta, theta), context);
  }
};

template <class Item>
[[nodiscard]] PairTerms evaluate(const Item& item, const PairMotion& motion,
                                 const Displacement& d = Displacement::Zero()) {
  return motion.with(d, [&](const PairStep& step) {
    PairTerms terms;
    terms.set_zero();
    item.evaluate(step, terms);
    return terms;
  });
}

[[nodiscard]] inline Displacement wrenches(const PairTerms& t) {
  return (Displacement() << t.wrench_a, t.wrench_b).finished();
}

[[nodiscard]] inline Eigen::Matrix<double, 12, 12> wrench_tangent(const PairTerms& t) {
  Eigen::Matrix<double, 12, 12> D;
  D << t.D_aa, t.D_ab, t.D_ba, t.D_bb;
  return D;
}

/// The step's motion as the wrenches' partner: Σ w·(u, θ) is the work at ρ∞ = 1.
[[nodiscard]] inline Displacement step_motion(const PairMotion& m) {
  const BodyStep a = m.a(), b = m.b();
  return (Displacement() << a.u, a.theta, b.u, b.theta).finished();
}

}  // namespace polhode::test
