// SPDX-License-Identifier: Apache-2.0
// A model whose motors prescribe all its freedoms reports the moments that they need: a robot's arm
// against Lagrange's equations.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>

namespace polhode::inverse_dynamics_tests {
namespace {

constexpr double kG = 9.81, m1 = 3.0, m2 = 2.0, l1 = 0.7, c1 = 0.3, c2 = 0.25, I1 = 0.12, I2 = 0.05;

const char* const kArm = R"(
format: 1
gravity: [0, -9.81, 0]
variables: {h: 5 ms, rho: 1}
bodies:
  upper: {mass: 3, inertia: [0.01, 0.12, 0.12], position: [0.3, 0, 0]}
  fore: {mass: 2, inertia: [0.01, 0.05, 0.05], position: [0.95, 0, 0]}
joints:
  shoulder: {type: revolute, bodies: [ground, upper], at: [0, 0, 0], axis: z}
  elbow: {type: revolute, bodies: [upper, fore], at: [0.7, 0, 0], axis: z}
loads:
  first: {type: rotary_motor, joint: shoulder, angle: 0.4*sin(3*t) + 0.2*t}
  second: {type: rotary_motor, joint: elbow, angle: 0.9*t^2 - 0.1*t^3}
analysis: {type: dynamics, duration: 1 s, step: h, rho_inf: rho}
output: {hdf5: false, every: 0.1 s}
)";

// The motion is known, so velocities and accelerations are those of the drives at any step.
TEST(InverseDynamics, GivesTheMomentsOfLagrangesEquations) {
  for (const char* h : {"h=0.1", "h=0.005", "h=0.0005"})
    for (const char* rho : {"rho=1", "rho=0.5"}) {
      Simulation s(io::read_model_text(kArm, "arm.yaml", {h, rho}));
      const RunSummary r = s.run([&](Simulation& now) {
        const double t = now.time();
        const double q1 = 0.4 * std::sin(3 * t) + 0.2 * t, q2 = 0.9 * t * t - 0.1 * t * t * t;
        const double w1 = 1.2 * std::cos(3 * t) + 0.2, w2 = 1.8 * t - 0.3 * t * t;
        const double a1 = -3.6 * std::sin(3 * t), a2 = 1.8 - 0.6 * t;
        const double M11 =
            I1 + I2 + m1 * c1 * c1 + m2 * (l1 * l1 + c2 * c2 + 2.0 * l1 * c2 * std::cos(q2));
        const double M22 = I2 + m2 * c2 * c2, M12 = M22 + m2 * l1 * c2 * std::cos(q2);
        const double k = -m2 * l1 * c2 * std::sin(q2);
        const double fore = m2 * c2 * kG * std::cos(q1 + q2);
        const double first = M11 * a1 + M12 * a2 + k * (2.0 * w1 * w2 + w2 * w2) +
                             (m1 * c1 + m2 * l1) * kG * std::cos(q1) + fore;
        const double second = M12 * a1 + M22 * a2 - k * w1 * w1 + fore;
        EXPECT_NEAR(now.load(0)[2], first, 1e-7) << h << rho << t;
        EXPECT_NEAR(now.load(1)[2], second, 1e-7) << h << rho << t;
      });
      EXPECT_EQ(r.end, RunEnd::finished) << r.message;
    }
}

}  // namespace
}  // namespace polhode::inverse_dynamics_tests
