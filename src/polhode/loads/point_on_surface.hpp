// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <polhode/loads/coordinate_motion.hpp>
#include <polhode/loads/load_description.hpp>

namespace polhode {

/// Constraint of a point of b to an ellipsoid fixed to a, with semi-axes a_i along x, y, z of a
/// frame; a semi-axis of 0 makes it a cylinder along that axis.
///
/// Its row ½ℓ (Σ s_i²/a_i² − 1) is a sum of squares of quadratic displacements s_i: by Δ(s²) = 2 s̄
/// Δs its discrete gradient is ℓ Σ s̄_i ∇s_i/a_i². @eq{surface-row}
class PointOnSurface : public InteractionItem {
 public:
  static constexpr const char* kKind = "point_on_surface";
  /// @param load  Points and the frame on a; values semi_axes.x, .y, .z [m].
  explicit PointOnSurface(const LoadDescription& load);

  [[nodiscard]] int rows() const { return 1; }
  void evaluate(const PairStep& step, PairTerms& terms) const;
  void acceleration_terms(const PairStep& step, Vec6& gamma) const;
  /// Report at an instant: force on b [N], position of the point along the frame's axes [m].
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;

 private:
  [[nodiscard]] FreeDisplacement along(int axis) const { return {Z_a_, Z_b_, R_a_.col(axis)}; }

  Vec3 Z_a_, Z_b_;
  Mat3 R_a_;
  Vec3 weight_;  ///< ℓ/a_i², 0 along a cylinder.
  double size_;  ///< ℓ, the smallest semi-axis [m].
};

/// Adds a PointOnSurface to the system.
void add_point_on_surface(System& system, const LoadDescription& load);

}  // namespace polhode
