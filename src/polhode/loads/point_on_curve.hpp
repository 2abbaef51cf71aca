// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/coordinate_motion.hpp>
#include <polhode/loads/load_description.hpp>
#include <polhode/loads/planar_curve.hpp>

namespace polhode {

/// A cam: a point of b, the centre of a roller, keeps its distance from a curve in a plane fixed to
/// a.
///
/// Its row f is the signed distance of the point from the curve minus the roller's radius, a
/// function of two quadratic displacements. Its discrete gradient (Gonzalez) is that at the middle
/// of the step plus a part along the step that makes its change exact. @eq{curve-distance}
/// @eq{curve-gradient}
class PointOnCurve : public InteractionItem {
 public:
  static constexpr const char* kKind = "point_on_curve";
  /// @param load  Points; x, y of the plane are those of R_a; laws curve_x, curve_y; values
  ///              period, roller_radius, and open for a curve with ends; word side, holds.
  explicit PointOnCurve(const LoadDescription& load);

  [[nodiscard]] int rows() const { return in_plane_ ? 2 : 1; }
  [[nodiscard]] int history_size() const { return 1; }  ///< s of the foot.
  void evaluate(const PairStep& step, PairTerms& terms) const;
  void acceleration_terms(const PairStep& step, Vec6& gamma) const;
  /// Report at an instant: force on b [N], s of the foot, pressure angle between the force and the
  /// point's velocity relative to a, position of the point along a's x, y, z axes [m].
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;
  void initialize(const PairStep& step, double* history) const;
  void commit(const PairStep& step, double* history) const;
  [[nodiscard]] bool acceptable(const PairStep& step) const;
  [[nodiscard]] bool always_queried() const { return true; }
  [[nodiscard]] const char* refusal() const {
    return "the point passed the end of the curve, or the roller is larger than the radius of "
           "curvature";
  }

 private:
  [[nodiscard]] FreeDisplacement along(int axis) const { return {Z_a_, Z_b_, R_a_.col(axis)}; }
  [[nodiscard]] PlanarCurve::Vec2 place(const PairStep& step) const;
  [[nodiscard]] PlanarCurve::Distance foot(const PairStep& step) const;

  Vec3 Z_a_, Z_b_;
  Mat3 R_a_;
  PlanarCurve curve_;
  double roller_ = 0.0;
  bool in_plane_ = false;
};

/// Adds a PointOnCurve to the system.
void add_point_on_curve(System& system, const LoadDescription& load);

}  // namespace polhode
