// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/curve_pair.hpp>
#include <polhode/loads/load_description.hpp>

namespace polhode {

/// Cam on cam: two curves in planes that stay parallel, one on each body, in frictionless contact.
///
/// Its row is their distance, a function of two quadratic displacements and of the cosine and sine
/// of an angle, which are products of directions. Its discrete gradient (Gonzalez) is that at the
/// middle of the step plus a part along the step that makes its change exact. So the force does no
/// work, and acts on both bodies along one line. @eq{curves-distance} @eq{curves-gradient}
class CurveOnCurve : public InteractionItem {
 public:
  static constexpr const char* kKind = "curve_on_curve";
  /// @param load  Points; x, y of the planes are those of R_a, R_b; laws curve_x, curve_y, values
  /// period and open for a curve with ends, each also with the prefix other_; word side.
  explicit CurveOnCurve(const LoadDescription& load);

  [[nodiscard]] int rows() const { return 1; }
  [[nodiscard]] int history_size() const { return 2; }  ///< s of both contact points.
  void evaluate(const PairStep& step, PairTerms& terms) const;
  void acceleration_terms(const PairStep& step, Vec6& gamma) const;
  /// Report at an instant: force on b [N], s on a's and on b's curve, force along the normal [N],
  /// sliding speed of b along a's direction of s [m/s], contact point [m].
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;
  void initialize(const PairStep& step, double* history) const;
  void commit(const PairStep& step, double* history) const;
  void switch_on(const PairStep& step, double* history) const { initialize(step, history); }
  [[nodiscard]] bool acceptable(const PairStep& step) const;
  [[nodiscard]] bool always_queried() const { return true; }
  [[nodiscard]] const char* refusal() const {
    return "the contact point of two curves reached an end or is not unique, or the curves are not "
           "in parallel planes";
  }

 private:
  [[nodiscard]] FreeDisplacement along(int axis) const { return {Z_a_, Z_b_, R_a_.col(axis)}; }
  [[nodiscard]] CurvePair::Vec4 place(const PairStep& step) const;
  [[nodiscard]] CurvePair::Vec4 place_n(const PairStep& step) const;  ///< At the start.
  [[nodiscard]] CurvePair::Distance touch(const PairStep& step) const;

  Vec3 Z_a_, Z_b_;
  Mat3 R_a_, R_b_;
  CurvePair curves_;
};

/// Adds a CurveOnCurve to the system.
void add_curve_on_curve(System& system, const LoadDescription& load);

}  // namespace polhode
