// SPDX-License-Identifier: Apache-2.0
// The Whipple bicycle of Meijaard, Papadopoulos, Ruina and Schwab, Proc. R. Soc. A 463 (2007):
// eigenvalues of its upright motion, from simulations.
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>
#include <support/paths.hpp>

namespace polhode::bicycle_tests {
namespace {

using Complex = std::complex<double>;

/// Eigenvalues from steer and lean of the bicycle: as a linear motion with 4 unknowns they satisfy
/// a recursion of the fourth order, whose roots are exp(λ Δ).
std::vector<Complex> eigenvalues(double v, double delta = 0.04, int samples = 60) {
  Simulation s(io::read_model(
      test::source_dir() + "/examples/bicycle/model.yaml",
      {"variables.v=" + std::to_string(v), "variables.push=1e-4", "variables.h=5 ms",
       "analysis.order=6", "analysis.duration=" + std::to_string(delta * samples) + " s"}));
  std::vector<Eigen::Vector2d> y;
  for (int k = 0; k < samples; ++k) {
    while (s.time() < k * delta - 1e-9) EXPECT_TRUE(s.step(k * delta).accepted);
    const Mat3 R = s.body(1).Lambda();
    y.emplace_back(s.joint(1).coordinates.at(0), std::asin(R(2, 1)));
  }
  // Recursion of the two signals, each scaled to size one.
  const int rows = samples - 4;
  Mat A(2 * rows, 4);
  Vec b(2 * rows);
  for (int c = 0; c < 2; ++c) {
    double size = 0.0;
    for (const auto& one : y) size = std::max(size, std::abs(one[c]));
    for (int k = 0; k < rows; ++k) {
      for (int i = 0; i < 4; ++i) A(c * rows + k, i) = y[static_cast<std::size_t>(k + i)][c] / size;
      b[c * rows + k] = y[static_cast<std::size_t>(k + 4)][c] / size;
    }
  }
  const Vec a = A.colPivHouseholderQr().solve(b);
  Mat companion = Mat::Zero(4, 4);
  companion.topRightCorner<3, 3>().setIdentity();
  companion.row(3) = a.transpose();
  const Eigen::EigenSolver<Mat> solver(companion);
  std::vector<Complex> list;
  for (int i = 0; i < 4; ++i) list.push_back(std::log(solver.eigenvalues()[i]) / delta);
  return list;
}

/// Eigenvalue nearest to a guess.
Complex nearest(const std::vector<Complex>& list, Complex guess) {
  Complex best = list.front();
  for (const Complex& one : list)
    if (std::abs(one - guess) < std::abs(best - guess)) best = one;
  return best;
}

/// Speed at which the real part changes its sign, by the secant method.
double critical_speed(double v_0, double v_1, Complex guess) {
  double f_0 = nearest(eigenvalues(v_0), guess).real();
  for (int i = 0; i < 4; ++i) {
    const double f_1 = nearest(eigenvalues(v_1), guess).real();
    const double next = v_1 - f_1 * (v_1 - v_0) / (f_1 - f_0);
    v_0 = v_1;
    f_0 = f_1;
    v_1 = next;
    if (std::abs(v_1 - v_0) < 1e-5) break;
  }
  return v_1;
}

}  // namespace

// M q̈ + v C₁ q̇ + (g K₀ + v² K₂) q = 0 with the matrices of the paper (its eqs. 3.5, benchmark
// values), q lean and steer. Weave and capsize at three speeds. @tests{rolling-slip}
TEST(Bicycle, HasThePublishedEigenvalues) {
  Eigen::Matrix2d M, K_0, K_2, C_1;
  M << 80.81722, 2.31941332208709, 2.31941332208709, 0.29784188199686;
  K_0 << -80.95, -2.59951685249872, -2.59951685249872, -0.80329488458618;
  K_2 << 0.0, 76.59734589573222, 0.0, 2.65431523794604;
  C_1 << 0.0, 33.86641391492494, -0.85035641456978, 1.68540397397560;
  for (const double v : {3.5, 4.6, 6.5}) {
    Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
    A.topRightCorner<2, 2>().setIdentity();
    A.bottomLeftCorner<2, 2>() = -M.inverse() * (9.81 * K_0 + v * v * K_2);
    A.bottomRightCorner<2, 2>() = -M.inverse() * (v * C_1);
    const auto list = eigenvalues(v);
    for (const Complex exact : Eigen::EigenSolver<Eigen::Matrix4d>(A).eigenvalues()) {
      if (exact.real() < -5.0) continue;  // castering mode: decays within a few samples
      EXPECT_LT(std::abs(nearest(list, exact) - exact), 1e-4) << v << ' ' << exact;
    }
  }
}

// Weave becomes stable at 4.292382536341 m/s, capsize unstable at 6.024262015388 m/s.
TEST(Bicycle, BalancesItselfBetweenThePublishedSpeeds) {
  EXPECT_NEAR(critical_speed(4.25, 4.32, {0.0, 3.4}), 4.292382536341, 5e-4);
  EXPECT_NEAR(critical_speed(6.0, 6.06, {0.0, 0.0}), 6.024262015388, 5e-4);
}

}  // namespace polhode::bicycle_tests
