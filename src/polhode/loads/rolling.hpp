// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/load_description.hpp>

namespace polhode {

/// A wheel that rolls without slip on a plane: a body b with a round edge is in contact with a
/// plane fixed to a, without relative velocity of the material points in contact.
///
/// The edge is a circle of radius R about the axle n, of a round bar of radius ρ: a knife edge at ρ
/// = 0, a torus, a sphere at R = 0. One row keeps it on the plane and has an exact discrete
/// gradient; two rows forbid slip over the step, at the lever arms implied by this gradient. So the
/// force at the edge does no work, and acts on both bodies at one point. @eq{rolling-height}
/// @eq{rolling-slip}
class Rolling : public InteractionItem {
 public:
  static constexpr const char* kKind = "rolling";
  /// @param load  Points: one of the plane, the wheel's centre; z of R_a is the plane's normal on
  ///              the wheel's side, z of R_b the axle; values radius, edge_radius [m].
  explicit Rolling(const LoadDescription& load);

  [[nodiscard]] int rows() const { return 3; }
  void evaluate(const PairStep& step, PairTerms& terms) const;
  void acceleration_terms(const PairStep& step, Vec6& gamma) const;
  /// Report at an instant: force on b [N], contact point [m], force along the normal [N].
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;
  /// False if the wheel fell through the plane on which it would lie flat: no point of its edge is
  /// then the lowest.
  [[nodiscard]] bool acceptable(const PairStep& step) const;
  [[nodiscard]] bool always_queried() const { return circle_ > 0.0; }
  [[nodiscard]] const char* refusal() const {
    return "the wheel lies flat on its side, where its contact point is not defined";
  }

 private:
  struct Place;
  [[nodiscard]] Place place(const PairStep& step) const;

  Vec3 Z_a_, Z_b_;
  Mat3 R_a_;
  Vec3 axle_;             ///< Body b.
  double circle_, edge_;  ///< R, ρ [m].
};

/// Adds a Rolling to the system.
void add_rolling(System& system, const LoadDescription& load);

}  // namespace polhode
