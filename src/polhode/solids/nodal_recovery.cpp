// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <set>

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
  /// Blocks of one material.
  struct Part {
    Mesh own;                   ///< Of several materials: these blocks alone.
    const Mesh* mesh;           ///< That, or the whole.
    std::vector<int> elements;  ///< Numbers in the whole mesh; none: all.
    std::optional<StressPatches> patches;
  };
  const Mesh& mesh;
  std::vector<LinearModuli> moduli;  ///< By block.
  std::vector<Mat> products;         ///< By block.
  std::deque<Part> parts;

  Impl(const Mesh& m, const std::vector<int>& materials, std::vector<LinearModuli> of_blocks)
      : mesh(m), moduli(std::move(of_blocks)) {
    for (const ElementBlock& block : mesh.blocks) products.push_back(mean_products(block.shape()));
    const std::set<int> kinds(materials.begin(), materials.end());
    for (const int kind : kinds) {
      Part& part = parts.emplace_back();
      part.mesh = &mesh;
      if (kinds.size() > 1) take(part, materials, kind);
      if (StressPatches::suit(*part.mesh)) part.patches.emplace(*part.mesh);
    }
  }

  void take(Part& part, const std::vector<int>& materials, int kind) const {
    part.own.nodes = mesh.nodes;
    int first = 0;
    for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
      const ElementBlock& block = mesh.blocks[b];
      const int count = static_cast<int>(block.nodes.size()) / block.shape().size();
      if (materials[b] == kind) {
        part.own.blocks.push_back(block);
        for (int e = first; e < first + count; ++e) part.elements.push_back(e);
      }
      first += count;
    }
    part.mesh = &part.own;
  }

  /// Values at nodes from polynomials over patches.
  [[nodiscard]] static RecoveredValues by_patches(const Part& part,
                                                  std::span<const ElementSample> elements) {
    Eigen::Index rows = 0;
    for (const ElementBlock& block : part.mesh->blocks)
      rows += static_cast<Eigen::Index>(block.nodes.size()) / block.shape().size() *
              block.shape().corners;
    RecoveredValues corners(rows, kRecovered);
    Eigen::Index row = 0;
    for (std::size_t e = 0; e < elements.size(); ++e)
      for (int c = 0; c < part.mesh->element_shape(static_cast<int>(e)).corners; ++c) {
        const auto a = static_cast<std::size_t>(c);
        set_row(corners, row++, stress_at(elements[e], a), energy_at(elements[e], a));
      }
    return part.patches->at_nodes(corners);
  }

  /// Volume of the elements around each node [m³].
  [[nodiscard]] static Vec volumes(const Mesh& mesh, std::span<const ElementSample> elements) {
    Vec volume = Vec::Zero(static_cast<Eigen::Index>(mesh.nodes.size()));
    for (std::size_t e = 0; e < elements.size(); ++e)
      for (const int node : mesh.element_nodes(static_cast<int>(e)))
        volume[node] += elements[e].volume;
    return volume;
  }

  /// Nodal values as volume-weighted means over the adjacent elements.
  [[nodiscard]] static RecoveredValues by_means(const Mesh& mesh,
                                                std::span<const ElementSample> elements) {
    const auto count = static_cast<Eigen::Index>(mesh.nodes.size());
    RecoveredValues sum = RecoveredValues::Zero(count, kRecovered), own(1, kRecovered);
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const std::span<const int> nodes = mesh.element_nodes(static_cast<int>(e));
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        set_row(own, 0, stress_at(elements[e], a), energy_at(elements[e], a));
        sum.row(nodes[a]) += elements[e].volume * own;
      }
    }
    const Vec volume = volumes(mesh, elements);
    for (Eigen::Index i = 0; i < count; ++i)
      if (volume[i] > 0.0) sum.row(i) /= volume[i];
    return sum;
  }

  /// Complementary energy density of the material at rest: s:s/(4 G) + p²/(2 K), integrated over
  /// an element for stresses at its nodes.
  [[nodiscard]] double energy(std::size_t block, const RecoveredValues& stress) const {
    const Mat& M = products[block];
    const double shear = moduli[block].shear, bulk = moduli[block].lame + 2.0 / 3.0 * shear;
    double sum = 0.0;
    const auto product = [&](const Vec& v) { return v.dot(M * v); };
    const Vec p = (stress.col(0) + stress.col(1) + stress.col(2)) / 3.0;
    for (int c = 0; c < 3; ++c)
      sum +=
          product(stress.col(c) - p) / (4.0 * shear) + product(stress.col(3 + c)) / (2.0 * shear);
    return sum + product(p) / (2.0 * bulk);
  }

  /// Compares an element with the recovered values of its part, and adds their energies.
  void compare(std::size_t element, const ElementSample& sample, const RecoveredValues& values,
               NodalFields& result) const {
    const std::span<const int> nodes = mesh.element_nodes(static_cast<int>(element));
    const auto count = static_cast<Eigen::Index>(nodes.size());
    RecoveredValues here(count, kRecovered), off(count, kRecovered);
    double sum = 0.0;
    for (Eigen::Index a = 0; a < count; ++a) {
      const auto k = static_cast<std::size_t>(a);
      here.row(a) = values.row(nodes[k]);
      set_row(off, a, stress_at(sample, k), 0.0);
      off.row(a) -= here.row(a);
      const double mises = von_mises(tensor(off, a));
      sum += mises * mises;
    }
    result.stress_error[element] = std::sqrt(sum / static_cast<double>(count));
    const auto block = static_cast<std::size_t>(mesh.place(static_cast<int>(element)).block);
    result.energy += sample.volume * energy(block, here);
    result.error_energy += sample.volume * energy(block, off);
  }
};

NodalRecovery::NodalRecovery(const Mesh& mesh, LinearModuli moduli)
    : NodalRecovery(mesh, std::vector<int>(mesh.blocks.size(), 0),
                    std::vector<LinearModuli>(mesh.blocks.size(), moduli)) {}
NodalRecovery::NodalRecovery(const Mesh& mesh, const std::vector<int>& materials,
                             std::vector<LinearModuli> moduli)
    : impl_(std::make_unique<Impl>(mesh, materials, std::move(moduli))) {}
NodalRecovery::~NodalRecovery() = default;
NodalRecovery::NodalRecovery(NodalRecovery&&) noexcept = default;

NodalFields NodalRecovery::fields(std::span<const ElementSample> elements) const {
  const Impl& s = *impl_;
  NodalFields result;
  result.stress_error.assign(elements.size(), 0.0);
  const auto count = static_cast<Eigen::Index>(s.mesh.nodes.size());
  RecoveredValues values = RecoveredValues::Zero(count, kRecovered);
  Vec weight = Vec::Zero(count);
  for (const Impl::Part& part : s.parts) {
    std::vector<ElementSample> taken;
    for (const int e : part.elements) taken.push_back(elements[static_cast<std::size_t>(e)]);
    const std::span<const ElementSample> own = part.elements.empty() ? elements : taken;
    const RecoveredValues of_part =
        part.patches ? Impl::by_patches(part, own) : Impl::by_means(*part.mesh, own);
    for (std::size_t e = 0; e < own.size(); ++e)
      s.compare(part.elements.empty() ? e : static_cast<std::size_t>(part.elements[e]), own[e],
                of_part, result);
    if (s.parts.size() == 1) {
      values = of_part;
      continue;
    }
    const Vec volume = Impl::volumes(*part.mesh, own);
    values += volume.asDiagonal() * of_part;
    weight += volume;
  }
  for (Eigen::Index i = 0; i < count && s.parts.size() > 1; ++i)
    if (weight[i] > 0.0) values.row(i) /= weight[i];
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    result.cauchy.push_back(tensor(values, i));
    result.von_mises.push_back(von_mises(result.cauchy.back()));
    // A polynomial may be negative although the energy is not.
    result.strain_energy_density.push_back(std::max(0.0, values(i, 6)));
  }
  return result;
}

}  // namespace polhode::solids
