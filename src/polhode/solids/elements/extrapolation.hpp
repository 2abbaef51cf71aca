// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/solids/elements/registry.hpp>

namespace polhode {

/// Values at nodes by those at points of integration, n × points: that of the polynomial nearest to
/// the latter (least squares, by the weights of the rule), trilinear in hexahedra, linear in
/// tetrahedra, linear in both directions of wedges, constant where there are fewer points than that
/// takes. (E. Hinton and J. S. Campbell, Int. J. Numer. Methods Engrg. 8 (1974) 461-480.)
/// @eq{nodal-stress}
using Extrapolation = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
[[nodiscard]] Extrapolation extrapolation(const ElementKind& kind);

}  // namespace polhode
