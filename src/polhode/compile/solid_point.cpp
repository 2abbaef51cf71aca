// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/LU>

#include <polhode/compile/solid_point.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>

namespace polhode {

namespace {

/// Largest distance of a point outside an element, as a part of its extent.
constexpr double kOutside = 1e-6;
/// Iterations of the inverse map, which converges quadratically from the centre of valid elements.
constexpr int kPointIterations = 30;

/// Distance of reference coordinates outside a cell; negative inside.
double outside(const solids::CellShape& shape, const Vec3& xi) {
  const auto beyond = [&](int c) { return std::abs(xi[c]) - 1.0; };
  const double corner = std::max({-xi[0], -xi[1], xi[0] + xi[1] - 1.0});
  if (shape.corners == 8) return std::max({beyond(0), beyond(1), beyond(2)});
  if (shape.corners == 6) return std::max(corner, beyond(2));
  return std::max({-xi[0], -xi[1], -xi[2], xi.sum() - 1.0});
}

/// Reference coordinates of X in an element, if it lies there.
std::optional<Vec3> inverse_map(const solids::CellShape& shape, const std::vector<Vec3>& nodes,
                                const Vec3& X, double size) {
  Vec3 xi = Vec3::Zero();
  for (const Vec3& node : shape.nodes) xi += node / static_cast<double>(shape.nodes.size());
  for (int iteration = 0; iteration < kPointIterations; ++iteration) {
    const Vec N = solids::shape_functions(shape, xi);
    const Mat dN = solids::shape_gradients(shape, xi);
    Vec3 rest = X;
    Mat3 J = Mat3::Zero();
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const auto row = static_cast<Eigen::Index>(a);
      rest -= N[row] * nodes[a];
      for (int c = 0; c < 3; ++c) J.col(c) += dN(row, c) * nodes[a];
    }
    if (rest.norm() <= 1e-12 * size) break;
    const Vec3 move = J.partialPivLu().solve(rest);
    if (!move.allFinite()) return std::nullopt;
    xi += move / std::max(1.0, move.norm());
    if (outside(shape, xi) > 1.0) return std::nullopt;
  }
  if (outside(shape, xi) > kOutside) return std::nullopt;
  return xi;
}

}  // namespace

SolidPoint solid_point(std::string_view where, const solids::Mesh& mesh, const Vec3& X) {
  std::vector<Vec3> nodes;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const std::span<const int> of_element = mesh.element_nodes(e);
    nodes.clear();
    Vec3 least = Vec3::Constant(std::numeric_limits<double>::infinity()), most = -least;
    for (const int node : of_element) {
      nodes.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
      least = least.cwiseMin(nodes.back());
      most = most.cwiseMax(nodes.back());
    }
    // Curved faces bulge slightly out of the bounding box of the nodes.
    const double size = (most - least).norm();
    const Vec3 margin = Vec3::Constant(0.1 * size);
    if ((X - least + margin).minCoeff() < 0.0 || (most - X + margin).minCoeff() < 0.0) continue;
    const solids::CellShape& shape = mesh.element_shape(e);
    const std::optional<Vec3> xi = inverse_map(shape, nodes, X, size);
    if (!xi) continue;
    const Vec N = solids::shape_functions(shape, *xi);
    return {{of_element.begin(), of_element.end()}, {N.begin(), N.end()}};
  }
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < mesh.nodes.size(); ++i)
    if ((mesh.nodes[i] - X).norm() < (mesh.nodes[nearest] - X).norm()) nearest = i;
  const Vec3& N = mesh.nodes[nearest];
  throw InputError(where, "the point lies in no element of the solid",
                   format("Coordinates are the mesh's own; the nearest node is {} at ({:.6g}, "
                          "{:.6g}, {:.6g}), {:.3g} m away",
                          nearest, N[0], N[1], N[2], (N - X).norm()));
}

}  // namespace polhode
