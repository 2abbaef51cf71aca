// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/beams/bar_strain.hpp>
#include <polhode/system/interaction.hpp>

namespace polhode {

/// Description of a straight elastic bar or a segment of cable between a point of a and a point of
/// b.
struct CableSpec {
  std::string name;
  Participants bodies;
  Vec3 Z_a = Vec3::Zero(), Z_b = Vec3::Zero();  ///< From the centres of mass, body axes [m].
  double stiffness = 0.0;                       ///< EA [N].
  double free_length = 0.0;                     ///< L [m].
  double damping = 0.0;                         ///< Force per rate of elongation [N s/m].
  bool tension_only = true;                     ///< Slack when shorter than L.
  BarStrain strain = BarStrain::engineering;
  double coupled_mass = 0.0;  ///< m_ab; needs Z = 0. The row sums belong to the bodies. [kg]
};

/// A straight segment of cable, or a truss member.
///
/// With a measure s(l), s = l or l²/(2L), the energy is ½ (EA/L) (y − s_0)², s_0 = s(L), y = s or,
/// of a cable, max(s, s_0). As u·u is quadratic, Δs = u_α·Δu/ϱ with ϱ = l_α or L, and the force
///
///   F = −N u_α/ϱ,  N = r [EA/L (y_α − s_0) + c r ṡ_α],  r = Δy/Δs,  ṡ_α = u_α·u̇_α/ϱ
///   @eq{cable-gradient}
///
/// on b conserves the energy exactly, also in a step in which the cable becomes taut or slack. The
/// damper of a cable acts on its elongation while taut, and never makes it push: N ≥ 0.
class Cable : public InteractionItem {
 public:
  static constexpr const char* kKind = "cable";
  /// @throws InputError if a stiffness or length is not positive, a damping is negative, or a mass
  ///         is coupled away from the centres of mass.
  explicit Cable(const CableSpec& spec);

  [[nodiscard]] bool conservative() const { return spec_.damping == 0.0; }
  [[nodiscard]] bool dissipates() const { return spec_.damping != 0.0; }
  [[nodiscard]] double coupled_mass() const { return spec_.coupled_mass; }
  [[nodiscard]] double reach() const { return 0.5 * spec_.free_length; }
  [[nodiscard]] bool piecewise() const { return spec_.tension_only; }
  void pieces(const PairStep& step, ForcePieces& pieces) const;
  void evaluate(const PairStep& step, PairTerms& terms) const;
  [[nodiscard]] Work work(const PairStep& step) const;

  /// Tension at t_{n+1} with that of the damper, along the present length [N].
  [[nodiscard]] double tension(const PairStep& step) const;
  [[nodiscard]] double length(const PairStep& step) const;  ///< At t_{n+1} [m].

 private:
  struct Stretch;
  [[nodiscard]] Stretch stretch(const PairStep& step) const;
  /// Whether its damper would make it push.
  [[nodiscard]] bool is_limp(const Stretch& x) const;
  /// Force of the damper, no larger than lets a cable go slack [N].
  [[nodiscard]] double damper(const Stretch& x) const;
  [[nodiscard]] double measure(double length) const;
  /// y − s_0: elongation in the measure that stores energy.
  [[nodiscard]] double taut(double s) const;
  [[nodiscard]] bool is_taut(double s) const { return !spec_.tension_only || s > s_0_; }

  CableSpec spec_;
  double k_, s_0_;
};

}  // namespace polhode
