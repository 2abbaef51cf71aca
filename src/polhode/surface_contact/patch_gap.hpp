// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/contact_laws/stop_force.hpp>
#include <polhode/surface_contact/mesh_surface.hpp>
#include <polhode/surface_contact/surface_patch.hpp>
#include <polhode/system/node_step.hpp>

namespace polhode::surface_contact {

/// Vector from a foot on a patch to a point, y = p − Σ M_a x_a, as a sum over nodes.
struct PatchVector {
  MeshPoint way;
  MeshPoint along[2];  ///< ∂y by the directions in which the foot is free.
  MeshPoint bend[3];   ///< ∂²y
  int free_count = 0;
  PatchVector(const MeshPoint& point, const SurfacePatch& patch, const PatchFoot& foot,
              const std::vector<MeshPoint>& vertices);
  [[nodiscard]] Vec3 between(const double* field) const;  ///< y
};

/// Distance of a point from smooth patches over a step. With y_e = p − Σ M_a x_a, the weights M of
/// the nearest point at the end e of the step, a force λ conjugate to the distance d acts along the
/// means of y_n and y_{n+1} over the step, so that its resultant and moment vanish and its work is
/// exactly λ Δd:
///
///   f_i = λ/(d_n + d_{n+1}) Σ_e (1 + κ Δ|y_e|²) ∂y_e/∂x_i ȳ_e,
///   κ = (Δ(d²) − ½ Σ_e Δ|y_e|²)/(½ Σ_e (Δ|y_e|²)²)
///
/// @eq{patch-force}
class PatchGap {
 public:
  static constexpr int kPoints = 4;
  /// y_n, y_{n+1} and the directions of the latter, one after another.
  using Force = Eigen::Matrix<double, 3 * kPoints, 1>;
  using Stiffness = Eigen::Matrix<double, 3 * kPoints, 3 * kPoints>;

  /// @param from, to  Of the feet at both ends. @param d_n, d_n1  Distances [m].
  PatchGap(const NodeStep& step, const PatchVector& from, const PatchVector& to, double d_n,
           double d_n1);

  [[nodiscard]] static int points() { return kPoints; }
  /// Sum over nodes to which block k of the results belongs.
  [[nodiscard]] const MeshPoint& at(int k) const {
    return k == 0 ? from_.way : k == 1 ? to_.way : to_.along[k - 2];
  }
  [[nodiscard]] Force force(double lambda) const;
  /// D force / D x_{n+1}.
  [[nodiscard]] Stiffness stiffness(const contact::ForceAndSlope& lambda) const;
  /// D d_{n+1} / D x_{n+1}.
  [[nodiscard]] Force slope() const;
  [[nodiscard]] static Vec3 on_point(const Force& f) { return f.segment<3>(0) + f.segment<3>(3); }

 private:
  const PatchVector &from_, &to_;
  double alpha_, d_n_, d_n1_, size_ = 0.0;
  bool exact_;
  Vec3 y_[2], change_[2];      ///< y_e at t_{n+1}, Δy_e.
  Vec3 shift_, moved_shift_;   ///< y_n − y_{n+1} at t_{n+1}, and its change.
  Vec3 along_[2], moved_[2];   ///< ∂y_{n+1} at t_{n+1}, and its change over the step.
  Eigen::Matrix2d curvature_;  ///< ∂²(½|y|²) by the free directions.
};

}  // namespace polhode::surface_contact
