// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <Eigen/LU>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/elements/reference_data.hpp>

namespace polhode::solids {

Mat3 reference_jacobian(const Mat& shape_gradients, std::span<const int> nodes,
                        std::span<const Vec3> X) {
  Mat3 J = Mat3::Zero();
  for (std::size_t a = 0; a < nodes.size(); ++a)
    J += X[nodes[a]] * shape_gradients.row(static_cast<Eigen::Index>(a));
  return J;
}

namespace {

/// Enhanced gradients of Simo and Armero: G̃_k = (j_0/j) ξ_k J_0⁻ᵀ e_k. @eq{solid-enhanced-gradient}
Vec3 enhanced_gradient(const Mat3& J_0_inverse_transposed, double j_0, double j, const Vec3& xi,
                       int k) {
  return j_0 / j * xi[k] * J_0_inverse_transposed.col(k);
}

[[noreturn]] void refuse(const std::string& where, int element, double determinant) {
  throw InputError(
      where,
      format("element {} (the first is 0) is {}: det ∂X/∂ξ is {:.3g} m³ at one of its points",
             element, determinant < 0.0 ? "inverted" : "flat", determinant),
      "Order its nodes so that it has a volume, or mesh this place again");
}

}  // namespace

ReferenceData::ReferenceData(const std::string& where, const ElementKind& kind,
                             std::span<const int> connectivity, std::span<const Vec3> positions,
                             int families, std::span<const Vec3> directions, int width)
    : elements(static_cast<int>(connectivity.size()) / kind.sizes().nodes),
      blocks((elements + width - 1) / width),
      nodes(connectivity.begin(), connectivity.end()),
      X(static_cast<std::size_t>(blocks) * width * 3 * kind.sizes().nodes),
      points(static_cast<std::size_t>(blocks) * width * kind.sizes().points *
             kind.sizes().point_packs()),
      volumes(static_cast<std::size_t>(blocks) * width),
      fibres(directions.empty() ? 0 : static_cast<std::size_t>(blocks) * width * 3 * families) {
  const ElementSizes& sizes = kind.sizes();
  const CellShape& cell = kind.cell();
  const int n = sizes.nodes;
  for (int e = elements; e < blocks * width; ++e)
    for (int a = 0; a < n; ++a) nodes.push_back(connectivity[(elements - 1) * n + a]);
  std::vector<Mat> gradients;
  for (const QuadraturePoint& p : kind.stiffness) gradients.push_back(shape_gradients(cell, p.xi));
  const Mat at_centre = shape_gradients(cell, Vec3::Zero());
  // Inverted elements are also rejected at the points of the mass rule, which are near corners.
  std::vector<Mat> checks;
  for (const Vec3& xi : cell.nodes) checks.push_back(shape_gradients(cell, 0.999 * xi));
  for (int e = 0; e < blocks * width; ++e) {
    const std::span<const int> own = std::span(nodes).subspan(static_cast<std::size_t>(e) * n, n);
    const int b = e / width, l = e % width, real = std::min(e, elements - 1);
    double size = 0.0;
    for (int a = 1; a < n; ++a)
      size = std::max(size, (positions[own[a]] - positions[own[0]]).norm());
    const double smallest = 1e-12 * size * size * size;
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < 3; ++i)
        X.data()[(static_cast<std::size_t>(b) * 3 * n + 3 * a + i) * width + l] =
            positions[own[a]][i];
    const bool same = directions.size() == static_cast<std::size_t>(families);
    for (int f = 0; f < families; ++f) {
      const Vec3& d = directions[static_cast<std::size_t>((same ? 0 : real * families) + f)];
      for (int i = 0; i < 3; ++i)
        fibres.data()[((static_cast<std::size_t>(b) * families + f) * 3 + i) * width + l] =
            d.normalized()[i];
    }
    const Mat3 J_0 = reference_jacobian(at_centre, own, positions);
    const double j_0 = J_0.determinant();
    const Mat3 J_0_inverse_transposed = J_0.inverse().transpose();
    if (e < elements)
      for (const Mat& check : checks)
        if (const double j = reference_jacobian(check, own, positions).determinant();
            !(j > smallest))
          refuse(where, e, j);
    double element_volume = 0.0;
    for (int q = 0; q < sizes.points; ++q) {
      const Mat3 J = reference_jacobian(gradients[q], own, positions);
      const double j = J.determinant();
      if (!(j > smallest)) refuse(where, e, j);
      const double w = kind.stiffness[q].weight * j;
      element_volume += w;
      const Mat G = gradients[q] * J.inverse();
      double* to = points.data() +
                   (static_cast<std::size_t>(b) * sizes.points + q) * sizes.point_packs() * width +
                   l;
      *to = w;
      for (int r = 0; r < sizes.rows(); ++r) {
        const Vec3 g =
            r < n ? Vec3(G.row(r).transpose())
                  : enhanced_gradient(J_0_inverse_transposed, j_0, j, kind.stiffness[q].xi, r - n);
        for (int i = 0; i < 3; ++i) to[(1 + 3 * r + i) * width] = g[i];
      }
    }
    volumes.data()[b * width + l] = element_volume;
    if (e < elements) volume += element_volume;
  }
}

void element_mass(const ElementKind& kind, double density, std::span<const int> nodes,
                  std::span<const Vec3> X, double* M) {
  const CellShape& cell = kind.cell();
  const int n = cell.size();
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> mass(M, n, n);
  mass.setZero();
  for (const QuadraturePoint& p : kind.mass) {
    const double j = reference_jacobian(shape_gradients(cell, p.xi), nodes, X).determinant();
    const Vec N = shape_functions(cell, p.xi);
    mass += density * p.weight * j * N * N.transpose();
  }
}

}  // namespace polhode::solids
