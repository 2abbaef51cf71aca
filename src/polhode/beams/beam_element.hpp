// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/beams/beam_strains.hpp>
#include <polhode/system/interaction.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Largest angle between the ends of one element [rad]: near π its strains are not defined.
inline constexpr double kLargestBeamAngle = 2.5;

/// Position of one end of an element in its body.
struct BeamEnd {
  Vec3 Z = Vec3::Zero();      ///< From the centre of mass, body axes [m]; ground: world.
  Mat3 Q = Mat3::Identity();  ///< Section frame, body components (ground: world), x along the beam.
};

/// Description of a beam element. Its elastic energy is ½ L (e − e_ref)ᵀ C (e − e_ref).
struct BeamElementSpec {
  std::string name;
  Participants bodies;  ///< Ends 1 and 2.
  BeamEnd end_1, end_2;
  Mat6 stiffness = Mat6::Zero();  ///< C: (N, V_y, V_z, M_x, M_y, M_z) by strain, section axes.
  double length = 0.0;            ///< L, reference [m].
  Vec6 reference_strain = Vec6::Unit(0);
  /// Adds the bending due to linearly varying moments within the element to its shear flexibility:
  /// end loads then bend a straight element exactly. Otherwise C is used as given.
  bool residual_bending_flexibility = true;
  /// m_12 of the translational mass; the row sums belong to the bodies. Needs Z = 0. [kg]
  double coupled_mass = 0.0;
  double relaxation_time = 0.0;  ///< Kelvin-Voigt: viscous section forces are C ė times this [s].
};

/// Sets length and reference strains so that the element is free of stress with its ends at their
/// present positions. The length is that of the arc of constant curvature and twist between the
/// ends.
/// @throws InputError if the ends coincide, or include more than kLargestBeamAngle.
void set_reference(BeamElementSpec& spec, const BodyStep& body_1, const BodyStep& body_2);

/// C with the residual bending flexibility of an element of length L: L²/12 times the bending
/// flexibility is added to the shear terms of C⁻¹. (For the shear-deformable beam with one
/// integration point: MacNeal, Computers & Structures 8 (1978) 175-183.)
[[nodiscard]] Mat6 with_residual_flexibility(const Mat6& C, double L);

/// A two-node, geometrically exact beam element between bodies. In conserving form the force is a
/// discrete gradient of the energy, so at ρ∞ = 1 energy is conserved exactly for any step, and so
/// are both momenta. Derivation: docs/theory/beams.md.
class BeamElement : public InteractionItem {
 public:
  static constexpr const char* kKind = "beam";
  /// @throws InputError if a stiffness is not positive definite, a length not positive, or a mass
  ///         is coupled away from the centres of mass.
  explicit BeamElement(const BeamElementSpec& spec);

  [[nodiscard]] int history_size() const { return viscous() ? 18 : 6; }
  [[nodiscard]] bool conservative() const { return !viscous(); }
  [[nodiscard]] bool dissipates() const { return viscous(); }
  [[nodiscard]] double coupled_mass() const { return coupled_mass_; }
  [[nodiscard]] double reach() const { return 0.5 * L_; }
  [[nodiscard]] bool always_queried() const { return true; }
  [[nodiscard]] const char* refusal() const {
    return "bends by more than 2.5 rad between its ends; use more elements";
  }
  [[nodiscard]] bool acceptable(const PairStep& step) const;
  void initialize(const PairStep& step, double* history) const;
  void commit(const PairStep& step, double* history) const;
  void evaluate(const PairStep& step, PairTerms& terms) const;
  void extrapolate(const PairStep& step, const Vec6& of_1, const Vec6& of_2, double* history) const;
  [[nodiscard]] Work work(const PairStep& step) const;

  /// (N, V_y, V_z, M_x, M_y, M_z) of the elastic strains at t_{n+1}, section axes [N, N m].
  [[nodiscard]] Vec6 section_forces(const PairStep& step) const;
  /// Strains (Γ, K) minus those free of stress, at t_{n+1} [-, 1/m].
  [[nodiscard]] Vec6 strains(const PairStep& step) const;
  [[nodiscard]] double length() const { return L_; }

 private:
  struct Forces;
  [[nodiscard]] bool viscous() const { return tau_ > 0.0; }
  [[nodiscard]] double stiffening(const StepContext& context) const;
  void conserving_forces(const PairStep& step, const Vec15& iota_n, const Vec15& iota_n1,
                         Forces& forces) const;
  void plain_forces(const PairStep& step, const Vec15& iota_n, const Vec15& iota_n1,
                    const Vec15& iota_alpha, Forces& forces) const;
  /// Viscous strain rate at t_{n+αf}, from the strains at both ends of the step.
  [[nodiscard]] Vec6 strain_rate(const PairStep& step, const Vec6& De) const;
  [[nodiscard]] Vec6 strain_rate_now(const PairStep& step) const;
  [[nodiscard]] Vec15 invariants_n(const PairStep& step) const;
  [[nodiscard]] Vec15 invariants_n1(const PairStep& step) const;

  BeamEnd end_1_, end_2_;
  Mat6 C_;
  double L_;
  Vec6 e_ref_;
  double coupled_mass_, tau_;
};

}  // namespace polhode
