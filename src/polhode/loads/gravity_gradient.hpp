// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/load_description.hpp>

namespace polhode {

struct LoadKind;

/// Attraction of body b by a point mass or sphere at the centre of mass of a or, if this is the
/// ground, at the world's origin, with the second-order potential of the extended body,
///
///   V = −μ m/l − μ/(2l³) (tr J − 3 e·J e),  e = d/l,  d = r_b − r_a.
///
/// It is a function of l² and of q = D·J_r D, D in body axes; both are quadratic, so that force and
/// moment with their discrete gradients do the work −ΔV exactly at ρ∞ = 1, and conserve both
/// momenta of a and b. @eq{gravity-gradient} @eq{gravity-gradient-step}
class GravityGradient : public InteractionItem {
 public:
  static constexpr const char* kKind = "gravity_gradient";
  /// @param load  With the value mu [m³/s²]; mass and inertia are those of b.
  explicit GravityGradient(const LoadDescription& load);

  [[nodiscard]] bool conservative() const { return true; }
  void evaluate(const PairStep& step, PairTerms& terms) const;
  [[nodiscard]] Work work(const PairStep& step) const;
  /// Report at an instant: force on b [N], moment on it about its centre of mass [N m], distance of
  /// the centres [m], potential energy [J].
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;

 private:
  [[nodiscard]] double potential(const Vec3& d, const Mat3& Lambda) const;

  Vec3
      Z_a_;  ///< The attracting point from the centre of mass of a; of the ground, from the origin.
  double mu_, mass_;
  Mat3 inertia_;
};

/// The entry of the gravity gradient in the registry of loads.
[[nodiscard]] LoadKind gravity_gradient_kind();

}  // namespace polhode
