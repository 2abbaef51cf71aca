// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/core/types.hpp>

namespace polhode::solids {

/// A point of the reference cell and its weight.
struct QuadraturePoint {
  Vec3 xi;        ///< Reference coordinates [-].
  double weight;  ///< Sum over a rule: volume (area) of the reference cell.
};
using Quadrature = std::vector<QuadraturePoint>;

/// Gauss-Legendre on [−1, 1], 1 to 6 points.
[[nodiscard]] std::vector<std::pair<double, double>> gauss(int points);

/// Rules for solids. Hexahedra: that many points along each axis. Tetrahedra: degree 1 (1 point), 2
/// (4 points), 5 (15 points; P. Keast, Computer Methods in Applied Mechanics and Engineering 55
/// (1986) 339-348), 7 or 8 (125 or 150 points of a collapsed cube). Wedges: 3 × 2 points, 6 × 3
/// for quadratic ones, exact for their stiffness if they are straight, and 125 of a collapsed cube,
/// exact for their volume, mass and inertia even if they are curved.
[[nodiscard]] Quadrature hexahedron_rule(int points);
[[nodiscard]] Quadrature tetrahedron_rule(int degree);
[[nodiscard]] Quadrature wedge_rule();
[[nodiscard]] Quadrature wedge15_rule();
[[nodiscard]] Quadrature collapsed_wedge_rule();

/// Rule for loads on a face of that shape (tri3, tri6, tri7, quad4, quad8, quad9): exact for
/// pressure on flat faces.
[[nodiscard]] Quadrature face_rule(const std::string& shape);

}  // namespace polhode::solids
