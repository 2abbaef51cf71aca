// SPDX-License-Identifier: Apache-2.0
// Friction with two coefficients, whose force is the one of the ellipse that dissipates most:
// sliding and impacts of a ball that does not turn, against the equations of its velocity.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <support/run_text.hpp>

namespace polhode::test::anisotropic_friction_tests {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kAlong = 0.2, kAcross = 0.5, kGravity = 9.81, kMass = 2.0;

/// Friction over the normal force, against a slip: (μ₁² x, μ₂² y)/|(μ₁ x, μ₂ y)|.
Vec2 friction(const Vec2& v) {
  const Vec2 weighted(kAlong * v.x(), kAcross * v.y());
  return -Vec2(kAlong * weighted.x(), kAcross * weighted.y()) / weighted.norm();
}

struct Slide {
  Vec2 x = Vec2::Zero(), v;
};

/// Sliding under a normal force that exerts `pressed` times the mass, in a time or, without any, at
/// once: the classical Runge-Kutta method.
Slide slid(const Vec2& v, double pressed, double time) {
  const int steps = 20000;
  Slide s{Vec2::Zero(), v};
  const double h = pressed / steps, dt = time / steps;
  for (int k = 0; k < steps; ++k) {
    const Vec2 a = friction(s.v), b = friction(s.v + 0.5 * h * a), c = friction(s.v + 0.5 * h * b),
               d = friction(s.v + h * c);
    s.x += dt * (s.v + h / 6.0 * (a + b + c));
    s.v += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
  return s;
}

std::string model(const std::string& law, double height, double fall, double gravity, double e,
                  double T, double h) {
  return format(R"yaml(
format: 1
gravity: [0, 0, {}]
bodies:
  floor: {{fixed: true, shape: {{plane: z}}}}
  ball: {{mass: {}, shape: {{sphere: 0.2}}, position: [0, 0, {}], velocity: [2, 1.5, {}]}}
joints: {{slide: {{type: generic, bodies: [ground, ball], at: [0, 0, 0.1], free: [x, y, z]}}}}
contacts:
  default: {{law: {}}}
  pairs: {{p: {{between: [floor, ball], friction: 0.2, friction_across: 0.5, direction: [1, 0, 0], restitution: {}}}}}
analysis: {{duration: {}, step: {}}}
output: {{hdf5: false}}
)yaml",
                -gravity, kMass, height, -fall, law, e, T, h);
}

}  // namespace

// @tests{row-problem} @tests{contact-bristle}
TEST(AnisotropicFriction, SlidesAgainstTheForceThatDissipatesMost) {
  const double T = 0.3;
  const Slide exact = slid({2.0, 1.5}, kGravity * T, T);
  for (const char* law : {"rigid", "barrier"})
    for (const double h : {0.01, 0.001, 0.0001}) {
      Simulation s = made(model(law, 0.1, 0.0, kGravity, 0.0, T, h));
      finished(s);
      const BodyMotion ball = s.body(1);
      const double allowed = law == std::string("rigid") ? 20.0 * h * h + 1e-9 : 2e-5 + 0.2 * h;
      EXPECT_LT((ball.r.head<2>() - exact.x).norm(), allowed) << law << " " << h;
      EXPECT_LT((ball.v.head<2>() - exact.v).norm(), 10.0 * allowed) << law << " " << h;
    }
}

// The impulse of an impact is a path of the same equation, with the normal impulse for time.
// @tests{routh} @tests{impact-friction}
TEST(AnisotropicFriction, ActsAlikeInImpacts) {
  for (const double e : {0.0, 0.5})
    for (const double fall : {0.5, 3.0}) {
      const Slide exact = slid({2.0, 1.5}, (1.0 + e) * fall, 0.0);
      for (const char* law : {"rigid", "barrier"})
        for (const double h : {0.01, 0.001, 0.0001}) {
          Simulation s = made(model(law, 0.1 + 0.0503 * fall, fall, 0.0, e, 0.1, h));
          finished(s);
          // In four parts, each with its own direction of friction.
          const double allowed = law == std::string("rigid") ? 0.02 * fall : 1e-3;
          EXPECT_LT((s.body(1).v.head<2>() - exact.v).norm(), allowed)
              << law << " " << h << " e " << e << " fall " << fall;
        }
    }
}

}  // namespace polhode::test::anisotropic_friction_tests
