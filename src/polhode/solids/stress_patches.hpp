// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <polhode/core/types.hpp>
#include <polhode/solids/mesh/mesh.hpp>

namespace polhode::solids {

/// Number of values recovered together: six components of stress and the energy density.
inline constexpr int kRecovered = 7;
using RecoveredValues = Eigen::Matrix<double, Eigen::Dynamic, kRecovered, Eigen::RowMajor>;

/// Least-squares polynomials for values at scattered points: complete ones of up to second order,
/// or all products of up to second powers along three directions.
///
/// Coordinates are relative to the points' mean along their principal axes, or the directions, in
/// units of their spread; coefficients that the points do not determine are zero. The fit is
/// independent of axes and units, also for flat clouds of points. @eq{stress-patch}
class CloudFit {
 public:
  using Coefficients = Eigen::Matrix<double, Eigen::Dynamic, kRecovered>;

  /// @param order  Of complete polynomials: 1 or 2.
  /// @param directions  Columns, of any length, not coplanar; null: complete polynomials.
  CloudFit(std::span<const Vec3> points, int order, const Mat3* directions = nullptr);

  /// Monomials at a position: polynomials are sums of them times coefficients.
  [[nodiscard]] Vec monomials(const Vec3& X) const;
  /// @param moments  Sum over the points of monomials times values.
  [[nodiscard]] Coefficients coefficients(const Coefficients& moments) const {
    return basis_ * (basis_.transpose() * moments);
  }
  [[nodiscard]] Eigen::Index size() const { return basis_.rows(); }  ///< Of monomials.
  /// Number of determined ones.
  [[nodiscard]] Eigen::Index terms() const { return basis_.cols(); }

 private:
  Vec3 mean_ = Vec3::Zero();
  Mat3 to_own_ = Mat3::Zero();
  bool products_ = false;
  Mat basis_;  ///< Orthonormal polynomials over the points, by columns.
};

/// Patches of elements of a mesh by which values are transferred to its nodes.
class StressPatches {
 public:
  /// Whether the mesh has only cells with patch recovery: hex20, hex27, tet4, tet10.
  [[nodiscard]] static bool suit(const Mesh& mesh);
  /// @param mesh  Must outlive this and satisfy suit().
  explicit StressPatches(const Mesh& mesh);

  /// @param at_corners  By element and corner of it: values of the element's own polynomial.
  /// @returns By node of the mesh.
  [[nodiscard]] RecoveredValues at_nodes(const RecoveredValues& at_corners) const;

 private:
  struct Share {
    int patch;
    double weight;
  };
  struct Patch {
    std::vector<int> elements;
    CloudFit fit;
  };
  void place_points();
  void find_patches();
  [[nodiscard]] std::vector<int> boundary_ranks() const;
  [[nodiscard]] std::optional<Mat3> directions(int vertex) const;
  [[nodiscard]] std::vector<int> donors(int vertex, const std::vector<int>& rank) const;
  [[nodiscard]] std::span<const int> corners(int element) const;

  const Mesh& mesh_;
  std::vector<Mat> interpolation_;        ///< By block: values at points by those at corners.
  std::vector<Vec3> place_;               ///< Of all points.
  std::vector<int> first_point_;          ///< By element, and one more.
  std::vector<std::vector<int>> around_;  ///< By node: elements of which it is a corner.
  std::vector<Patch> patches_;
  std::vector<std::vector<Share>> shares_;  ///< By node; their sum is 1.
};

}  // namespace polhode::solids
