// SPDX-License-Identifier: Apache-2.0
#include <polhode/solids/even_pressure.hpp>

namespace polhode::solids {

namespace {

/// Pressure at a deformation gradient [Pa].
double pressure_at(const Material& material, const Mat3& F) {
  const Mat3 C = F.transpose() * F;
  const auto six = [](const Mat3& T) {
    return (Vec6() << T(0, 0), T(1, 1), T(2, 2), T(0, 1), T(1, 2), T(2, 0)).finished();
  };
  const Vec6 E = 0.5 * six(Mat3(C - Mat3::Identity()));
  Vec6 S = discrete_stress(material, E, E).S;
  // The isochoric part, of fibres too, has no pressure.
  if (material.uncoupled()) S -= discrete_stress(material, E, E, Vec3::UnitX(), false).S;
  Vec6 c = six(C);
  c.tail<3>() *= 2.0;
  return -S.dot(c) / (3.0 * F.determinant());
}

/// An integration point in the deformed element.
struct Point {
  double weight = 0.0, J = 1.0, pressure = 0.0;  ///< Reference volume [m³], det F, and p [Pa].
  Mat g;                                         ///< By node: ∂N/∂x [1/m].
};

}  // namespace

void even_pressure(const SolidElements& elements, std::span<const Vec3> X, const double* x,
                   std::span<const int> slots, std::vector<double>& blocks) {
  const CellShape& cell = elements.element().cell();
  const int n = cell.size();
  const Quadrature& rule = elements.element().stiffness;
  std::vector<Mat> slopes;
  for (const QuadraturePoint& q : rule) slopes.push_back(shape_gradients(cell, q.xi));
  std::vector<Point> points(rule.size());
  Mat X_e(3, n), x_e(3, n);
  for (int e = 0; e < elements.size(); ++e) {
    const std::span<const int> nodes = elements.nodes(e);
    for (int a = 0; a < n; ++a) {
      const auto node = static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)]);
      X_e.col(a) = X[node];
      x_e.col(a) = Eigen::Map<const Vec3>(x + 3 * node);
    }
    double volume = 0.0, sum = 0.0;
    for (std::size_t q = 0; q < rule.size(); ++q) {
      const Mat3 to_X = X_e * slopes[q], to_x = x_e * slopes[q];
      Point& p = points[q];
      const Mat3 F = to_x * to_X.inverse();
      p.weight = rule[q].weight * to_X.determinant();
      p.J = F.determinant();
      p.pressure = pressure_at(elements.material(), F);
      p.g = slopes[q] * to_x.inverse();
      volume += p.weight * p.J;
      sum += p.weight * p.J * p.pressure;
    }
    // ∂²J/∂x_a∂x_b = J (g_a g_bᵀ − g_b g_aᵀ)
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b) {
        Mat3 K = Mat3::Zero();
        for (const Point& p : points) {
          const Mat3 product = p.g.row(a).transpose() * p.g.row(b);
          K += p.weight * p.J * (p.pressure - sum / volume) * (product - product.transpose());
        }
        double* block = blocks.data() + 9 * slots[(static_cast<std::size_t>(e) * n + a) * n + b];
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c) block[3 * r + c] += K(r, c);
      }
  }
}

}  // namespace polhode::solids
