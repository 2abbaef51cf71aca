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

/// Gauss-Legendre on [−1, 1], 1 to 5 points.
[[nodiscard]] std::vector<std::pair<double, double>> gauss(int points);

/// Rules for solids. Hexahedra: that many points along each axis. Tetrahedra: degree 1 (1 point), 2
/// (4 points) or 7 (125 points of a collapsed cube). Wedges: 3 × 2 points.
[[nodiscard]] Quadrature hexahedron_rule(int points);
[[nodiscard]] Quadrature tetrahedron_rule(int degree);
[[nodiscard]] Quadrature wedge_rule();

/// Rule for loads on a face of that shape (tri3, tri6, quad4, quad8, quad9): exact for pressure on
/// flat faces.
[[nodiscard]] Quadrature face_rule(const std::string& shape);

}  // namespace polhode::solids
