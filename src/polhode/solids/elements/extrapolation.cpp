// SPDX-License-Identifier: Apache-2.0
#include <polhode/solids/elements/extrapolation.hpp>

namespace polhode::solids {

namespace {

/// Monomials 1, ξ, η, ζ, ... of a cell with this many corners.
Vec monomials(int corners, const Vec3& x) {
  switch (corners) {
    case 8: {
      Vec m(8);
      m << 1.0, x[0], x[1], x[2], x[0] * x[1], x[1] * x[2], x[2] * x[0], x[0] * x[1] * x[2];
      return m;
    }
    case 6: {
      Vec m(6);
      m << 1.0, x[0], x[1], x[2], x[0] * x[2], x[1] * x[2];
      return m;
    }
    case 4: {
      Vec m(4);
      m << 1.0, x[0], x[1], x[2];
      return m;
    }
    default:
      return Vec::Ones(1);
  }
}

}  // namespace

Extrapolation extrapolation(const ElementKind& kind) {
  const auto points = static_cast<Eigen::Index>(kind.stiffness.size());
  const auto nodes = static_cast<Eigen::Index>(kind.cell().size());
  int corners = kind.cell().corners;
  if (points < monomials(corners, Vec3::Zero()).size()) corners = 0;
  const Eigen::Index terms = monomials(corners, Vec3::Zero()).size();
  Mat at_points(points, terms), at_nodes(nodes, terms);
  for (Eigen::Index q = 0; q < points; ++q)
    at_points.row(q) = monomials(corners, kind.stiffness[static_cast<std::size_t>(q)].xi);
  for (Eigen::Index a = 0; a < nodes; ++a)
    at_nodes.row(a) = monomials(corners, kind.cell().nodes[static_cast<std::size_t>(a)]);
  Mat weighed = at_points.transpose();
  for (Eigen::Index q = 0; q < points; ++q)
    weighed.col(q) *= kind.stiffness[static_cast<std::size_t>(q)].weight;
  return at_nodes * (weighed * at_points).ldlt().solve(weighed);
}

}  // namespace polhode::solids
