// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <polhode/solids/elements/quadrature.hpp>
#include <polhode/solids/nodal_recovery.hpp>
#include <polhode/solids/stress_patches.hpp>

namespace polhode::solids {

namespace {

/// ∫N_a N_b over the reference cell, as a part of its volume: exact for products of two nodal
/// fields.
Mat mean_products(const CellShape& shape) {
  const Quadrature rule = shape.corners == 8   ? hexahedron_rule(shape.order + 1)
                          : shape.corners == 6 ? wedge_rule()
                                               : tetrahedron_rule(shape.order == 2 ? 7 : 2);
  Mat M = Mat::Zero(shape.size(), shape.size());
  double volume = 0.0;
  for (const QuadraturePoint& point : rule) {
    const Vec N = shape_functions(shape, point.xi);
    M += point.weight * N * N.transpose();
    volume += point.weight;
  }
  return M / volume;
}

Mat3 tensor(const RecoveredValues& values, Eigen::Index row) {
  const auto v = values.row(row);
  Mat3 m;
  m << v[0], v[3], v[5], v[3], v[1], v[4], v[5], v[4], v[2];
  return m;
}

void set_row(RecoveredValues& values, Eigen::Index row, const Mat3& stress, double energy) {
  values.row(row) << stress(0, 0), stress(1, 1), stress(2, 2), stress(0, 1), stress(1, 2),
      stress(0, 2), energy;
}

Mat3 stress_at(const ElementSample& sample, std::size_t node) {
  return node < sample.cauchy_at_nodes.size() ? sample.cauchy_at_nodes[node] : sample.cauchy;
}

double energy_at(const ElementSample& sample, std::size_t node) {
  return node < sample.energy_at_nodes.size() ? sample.energy_at_nodes[node]
                                              : sample.strain_energy_density;
}

}  // namespace

double von_mises(const Mat3& stress) {
  const Mat3 deviator = stress - stress.trace() / 3.0 * Mat3::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

struct NodalRecovery::Impl {
  const Mesh& mesh;
  double shear, bulk;
  std::vector<Mat> products;  ///< By block.
  std::optional<StressPatches> patches;

  Impl(const Mesh& m, LinearModuli moduli)
      : mesh(m), shear(moduli.shear), bulk(moduli.lame + 2.0 / 3.0 * moduli.shear) {
    for (const ElementBlock& block : mesh.blocks) products.push_back(mean_products(block.shape()));
    if (StressPatches::suit(mesh)) patches.emplace(mesh);
  }

  /// Values at nodes from polynomials over patches.
  [[nodiscard]] RecoveredValues by_patches(std::span<const ElementSample> elements) const {
    Eigen::Index rows = 0;
    for (const ElementBlock& block : mesh.blocks)
      rows += static_cast<Eigen::Index>(block.nodes.size()) / block.shape().size() *
              block.shape().corners;
    RecoveredValues corners(rows, kRecovered);
    Eigen::Index row = 0;
    for (std::size_t e = 0; e < elements.size(); ++e)
      for (int c = 0; c < mesh.element_shape(static_cast<int>(e)).corners; ++c) {
        const auto a = static_cast<std::size_t>(c);
        set_row(corners, row++, stress_at(elements[e], a), energy_at(elements[e], a));
      }
    return patches->at_nodes(corners);
  }

  /// Nodal values as volume-weighted means over the adjacent elements.
  [[nodiscard]] RecoveredValues by_means(std::span<const ElementSample> elements) const {
    const auto count = static_cast<Eigen::Index>(mesh.nodes.size());
    RecoveredValues sum = RecoveredValues::Zero(count, kRecovered), own(1, kRecovered);
    Vec volume = Vec::Zero(count);
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const std::span<const int> nodes = mesh.element_nodes(static_cast<int>(e));
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        set_row(own, 0, stress_at(elements[e], a), energy_at(elements[e], a));
        sum.row(nodes[a]) += elements[e].volume * own;
        volume[nodes[a]] += elements[e].volume;
      }
    }
    for (Eigen::Index i = 0; i < count; ++i)
      if (volume[i] > 0.0) sum.row(i) /= volume[i];
    return sum;
  }

  /// Complementary energy density of the material at rest: s:s/(4 G) + p²/(2 K), integrated over
  /// an element for stresses at its nodes.
  [[nodiscard]] double energy(const Mat& M, const RecoveredValues& stress) const {
    double sum = 0.0;
    const auto product = [&](const Vec& v) { return v.dot(M * v); };
    const Vec p = (stress.col(0) + stress.col(1) + stress.col(2)) / 3.0;
    for (int c = 0; c < 3; ++c)
      sum +=
          product(stress.col(c) - p) / (4.0 * shear) + product(stress.col(3 + c)) / (2.0 * shear);
    return sum + product(p) / (2.0 * bulk);
  }
};

NodalRecovery::NodalRecovery(const Mesh& mesh, LinearModuli moduli)
    : impl_(std::make_unique<Impl>(mesh, moduli)) {}
NodalRecovery::~NodalRecovery() = default;
NodalRecovery::NodalRecovery(NodalRecovery&&) noexcept = default;

NodalFields NodalRecovery::fields(std::span<const ElementSample> elements) const {
  const Impl& s = *impl_;
  const RecoveredValues values = s.patches ? s.by_patches(elements) : s.by_means(elements);
  NodalFields result;
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    result.cauchy.push_back(tensor(values, i));
    result.von_mises.push_back(von_mises(result.cauchy.back()));
    // A polynomial may be negative although the energy is not.
    result.strain_energy_density.push_back(std::max(0.0, values(i, 6)));
  }
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const std::span<const int> nodes = s.mesh.element_nodes(static_cast<int>(e));
    const auto count = static_cast<Eigen::Index>(nodes.size());
    RecoveredValues here(count, kRecovered), off(count, kRecovered);
    double sum = 0.0;
    for (Eigen::Index a = 0; a < count; ++a) {
      const auto k = static_cast<std::size_t>(a);
      here.row(a) = values.row(nodes[k]);
      set_row(off, a, stress_at(elements[e], k), 0.0);
      off.row(a) -= here.row(a);
      const double mises = von_mises(tensor(off, a));
      sum += mises * mises;
    }
    result.stress_error.push_back(std::sqrt(sum / static_cast<double>(count)));
    const Mat& M = s.products[static_cast<std::size_t>(s.mesh.place(static_cast<int>(e)).block)];
    result.energy += elements[e].volume * s.energy(M, here);
    result.error_energy += elements[e].volume * s.energy(M, off);
  }
  return result;
}

}  // namespace polhode::solids
