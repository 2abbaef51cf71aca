// SPDX-License-Identifier: Apache-2.0
// A constant-velocity joint that bends through 180 degrees and starts there, against equations on
// the sphere of its quaternions (w, x, y, 0).
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <polhode/core/format.hpp>
#include <support/run_text.hpp>

#include <Eigen/LU>

namespace polhode::test::folded_shafts_tests {
namespace {

constexpr double kMass = 1.0, kArm = 0.3, kGravity = 9.81, kEnd = 1.3;
const Vec3 kInertia(0.02, 0.03, 0.012);

/// A pendulum on a constant-velocity joint with the ground.
struct Shaft {
  Vec3 y;        ///< (w, x, y) at the start.
  Vec3 y_dot;    ///< [1/s]
  double drag;   ///< Moment of the drag [N m s/rad].
  double nears;  ///< Errors grow where the motion passes this near to the fold: [tolerances].
};

/// Angular velocity in body axes by the rate of the quaternion: Ω = B(y) ẏ.
Mat3 spin(const Vec3& y) {
  Mat3 B;
  B << -y[1], y[0], 0, -y[2], 0, y[0], 0, y[2], -y[1];
  return 2.0 * B;
}

/// ÿ from Bᵀ(J Ω̇ + Ω × J Ω − M) = λ y with y·ÿ = −ẏ², where Ω̇ = B ÿ.
Vec3 acceleration(const Shaft& shaft, const Vec3& y, const Vec3& y_dot) {
  const Vec3 J = kInertia + kMass * kArm * kArm * Vec3(1, 1, 0);
  const Mat3 B = spin(y);
  const Vec3 W = B * y_dot;
  const double w = y[0], a = y[1], b = y[2];
  const Vec3 up(-2.0 * w * b, 2.0 * w * a, 1.0 - 2.0 * (a * a + b * b));
  const Vec3 M = Vec3(0, 0, kArm).cross(-kMass * kGravity * up) - shaft.drag * W;
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  A.topLeftCorner<3, 3>() = B.transpose() * J.asDiagonal() * B;
  A.topRightCorner<3, 1>() = -y;
  A.bottomLeftCorner<1, 3>() = y.transpose();
  Eigen::Vector4d right;
  right << B.transpose() * (M - W.cross(J.asDiagonal() * W)), -y_dot.squaredNorm();
  return A.lu().solve(right).head<3>();
}

/// The quaternion's (w, x, y) at the end, by the classical Runge-Kutta method: error below 1e-12.
Vec3 exact(const Shaft& shaft) {
  const int steps = 40000;
  const double h = kEnd / steps;
  Vec3 y = shaft.y, v = shaft.y_dot;
  for (int k = 0; k < steps; ++k) {
    const Vec3 a_1 = acceleration(shaft, y, v), v_2 = v + 0.5 * h * a_1;
    const Vec3 a_2 = acceleration(shaft, y + 0.5 * h * v, v_2), v_3 = v + 0.5 * h * a_2;
    const Vec3 a_3 = acceleration(shaft, y + 0.5 * h * v_2, v_3), v_4 = v + h * a_3;
    const Vec3 a_4 = acceleration(shaft, y + h * v_3, v_4);
    y += h / 6.0 * (v + 2.0 * v_2 + 2.0 * v_3 + v_4);
    v += h / 6.0 * (a_1 + 2.0 * a_2 + 2.0 * a_3 + a_4);
  }
  return y.normalized();
}

std::string model(const Shaft& shaft, const std::string& analysis) {
  const double w = shaft.y[0], a = shaft.y[1], b = shaft.y[2];
  const Vec3 at = kArm * Vec3(2.0 * w * b, -2.0 * w * a, 1.0 - 2.0 * (a * a + b * b));
  const Quat q(w, a, b, 0.0);
  const Vec3 W = q * Vec3(spin(shaft.y) * shaft.y_dot);
  return format(
      "format: 1\ngravity: [0, 0, -9.81]\nbodies:\n  rod: {{mass: 1, inertia: [0.02, 0.03, 0.012], "
      "position: [{:.17g}, {:.17g}, {:.17g}], orientation: {{quaternion: [{:.17g}, {:.17g}, "
      "{:.17g}, 0]}}, "
      "angular_velocity: [{:.17g}, {:.17g}, {:.17g}], velocity: [{:.17g}, {:.17g}, {:.17g}]}}\n"
      "joints: {{bent: {{type: constant_velocity, bodies: [ground, rod], at: [0, 0, 0], "
      "axis_body: [z, z], x_axis_body: [x, x]}}}}\n{}"
      "analysis: {{duration: 1.3 s, {}}}\noutput: {{hdf5: false, every: 0.65 s}}\n",
      at[0], at[1], at[2], w, a, b, W[0], W[1], W[2], W.cross(at)[0], W.cross(at)[1],
      W.cross(at)[2],
      shaft.drag > 0.0
          ? format("loads: {{air: {{type: drag, body: rod, turning: {}}}}}\n", shaft.drag)
          : "",
      analysis);
}

struct Ended {
  double error;  ///< [rad]
  RunSummary summary;
};

Ended run(const Shaft& shaft, const std::string& analysis) {
  Simulation simulation = made(model(shaft, analysis));
  RunSummary summary = finished(simulation);
  const Vec3 y = exact(shaft);
  const Quat q(y[0], y[1], y[2], 0.0);
  return {q.angularDistance(simulation.body(0).q), std::move(summary)};
}

/// Upright with 12 rad/s, which pass the fold at 0.2 to 0.8 degrees three times; and folded from
/// the start, the pendulum's lowest position.
std::vector<Shaft> shafts() {
  return {{{1, 0, 0}, {0, 6, 0.15}, 0.0, 50.0}, {{1, 0, 0}, {0, 6, 0.15}, 0.01, 3.0},
          {{1, 0, 0}, {0, 6, 1.5}, 0.0, 10.0},  {{1, 0, 0}, {0, 6, 1.5}, 0.01, 3.0},
          {{0, 1, 0}, {1, 0, 2}, 0.0, 3.0},     {{0, 1, 0}, {1, 0, 2}, 0.01, 3.0}};
}

}  // namespace

// @tests{joint-equal-turns}
TEST(FoldedShafts, PassTheFoldWithinTheTolerance) {
  for (const Shaft& shaft : shafts())
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
      const Ended ended = run(shaft, format("tolerance: {}", tolerance));
      EXPECT_LT(ended.error, shaft.nears * tolerance)
          << shaft.y.transpose() << ", " << shaft.y_dot.transpose() << ", drag " << shaft.drag;
    }
}

TEST(FoldedShafts, KeepTheirOrderAndEnergyWithFixedSteps) {
  for (const Shaft& shaft : shafts()) {
    const Ended coarse = run(shaft, "step: 10 ms"), middle = run(shaft, "step: 1 ms"),
                fine = run(shaft, "step: 0.1 ms");
    EXPECT_NEAR(std::log10(coarse.error / middle.error), 2.0, 0.1);
    EXPECT_NEAR(std::log10(middle.error / fine.error), 2.0, 0.02);
    EXPECT_LT(coarse.summary.constraint_residual_max, 1e-12);
    EXPECT_LT(fine.summary.constraint_residual_max, 1e-12);
    if (shaft.drag > 0.0) continue;
    EXPECT_LT(coarse.summary.energy_drift, 1e-12);
    EXPECT_LT(fine.summary.energy_drift, 1e-11);
  }
}

}  // namespace polhode::test::folded_shafts_tests
