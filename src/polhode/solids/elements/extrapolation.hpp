// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/solids/elements/registry.hpp>

namespace polhode::solids {

/// Extrapolation from integration points to nodes, n × points: by the least-squares polynomial
/// (with the weights of the rule), trilinear in hexahedra, linear in tetrahedra, linear in both
/// directions of wedges, constant if there are fewer points than that requires. (E. Hinton and J.
/// S. Campbell, Int. J. Numer. Methods Engrg. 8 (1974) 461-480.) @eq{nodal-stress}
using Extrapolation = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
[[nodiscard]] Extrapolation extrapolation(const ElementKind& kind);

}  // namespace polhode::solids
