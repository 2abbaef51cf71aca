// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include <polhode/geometry/wrapping.hpp>
#include <polhode/system/node_step.hpp>

namespace polhode {

/// An obstacle of a running cable between two of its points.
struct WindingSpec {
  std::string name;
  int span = 0;  ///< Of the cable, from 0.
  geometry::Roller roller;
  /// Nodes bonded to its body: its middle, and from there by `arm` along each of its axes.
  std::array<int, 4> frame{};
  double arm = 1.0;  ///< [m]
};

/// Six nodes of a span around an obstacle: its first point, the obstacle's frame, its second point.
inline constexpr int kWoundNodes = 6;
using WoundNodes = std::array<int, kWoundNodes>;
using Vec18 = Eigen::Matrix<double, 3 * kWoundNodes, 1>;
using Mat18 = Eigen::Matrix<double, 3 * kWoundNodes, 3 * kWoundNodes>;

/// A span around an obstacle over the step. Its length is a function of the coordinates π of its
/// points along the axes of the obstacle, which are products of differences of nodes: with a
/// discrete gradient by π, ΔL = G·Δπ, and Δπ = Dπ(x_m) Δx exactly, forces on the nodes conserve
/// both momenta, and their work is the tension times ΔL. @eq{wrap-gradient}
struct WoundSpan {
  enum class Outcome { straight, wound, inside, jumps };
  Outcome outcome = Outcome::straight;  ///< straight: at both ends of the step; no more is given.
  double l_n = 0.0, l_n1 = 0.0;         ///< Length at t_n, t_{n+1} [m].
  double change = 0.0;                  ///< [m]
  Vec18 n = Vec18::Zero();              ///< Discrete gradient of its length by the nodes.
  Vec18 e = Vec18::Zero();              ///< Gradient at t_{n+1}.
  double rate_alpha = 0.0;              ///< n·v_{n+αf} [m/s].
  Vec18 rate = Vec18::Zero();           ///< Derivative of that by the nodes [1/s].
  Mat18 turn = Mat18::Zero();           ///< Derivative of n by the nodes at t_{n+1} [1/m].
};

/// @param tangents  Whether `rate` and `turn` are needed.
[[nodiscard]] WoundSpan wound_span(const WindingSpec& winding, const WoundNodes& nodes,
                                   const NodeStep& step, bool tangents);

/// Coordinates of both points of the span at t_{n+1} along the axes of the obstacle [m].
[[nodiscard]] Vec6 wound_coordinates(const WindingSpec& winding, const WoundNodes& nodes,
                                     const double* x);

}  // namespace polhode
