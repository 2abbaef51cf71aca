// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode {

/// Cross-section of a beam: x along the beam through the centroid, y and z the principal axes.
struct SectionShape {
  double area = 0.0;                    ///< [m²]
  double I_y = 0.0, I_z = 0.0;          ///< ∫z² dA and ∫y² dA [m⁴].
  double J = 0.0;                       ///< Torsion constant of Saint-Venant [m⁴].
  double shear_y = 1.0, shear_z = 1.0;  ///< Shear factors: GA_y = shear_y·G·A.
};

/// Full solid rectangle, y by z. Torsion: series of Saint-Venant (Timoshenko and Goodier, Theory of
/// Elasticity, art. 109). Shear: Cowper, J. Appl. Mech. 33 (1966) 335-340, as all shear factors
/// here; they depend on Poisson's ratio.
/// @throws InputError if a size is not positive, or ν outside (−1, 0.5]. The same for all shapes.
[[nodiscard]] SectionShape rectangle_section(double y, double z, double nu);
[[nodiscard]] SectionShape circle_section(double diameter, double nu);
/// Round tube. @throws InputError if inner is not below outer.
[[nodiscard]] SectionShape tube_section(double outer, double inner, double nu);

/// Doubly symmetric I: web along y, flanges along z.
struct ISectionSizes {
  double height;  ///< Over all, along y [m].
  double width;   ///< Of the flanges, along z [m].
  double web;     ///< Thickness of the web [m].
  double flange;  ///< Thickness of a flange [m].
};
/// Areas and second moments are exact without fillets; torsion and shear along y are those of thin
/// walls (Σ b t³/3; Cowper), shear along z that of two rectangles, the flanges. Warping is
/// unconstrained.
[[nodiscard]] SectionShape i_section(const ISectionSizes& sizes, double nu);

/// Properties of a section for beam elements.
struct BeamSection {
  Mat6 stiffness = Mat6::Zero();           ///< (N, V_y, V_z, M_x, M_y, M_z) by (Γ, K).
  double mass_per_length = 0.0;            ///< [kg/m]
  Vec3 inertia_per_length = Vec3::Zero();  ///< About x, y, z, mass times radius² [kg m].
};

/// diag(EA, k_y GA, k_z GA, GJ, EI_y, EI_z) and ρ(I_y + I_z), ρI_y, ρI_z.
/// @throws InputError if E is not positive or ρ negative.
[[nodiscard]] BeamSection elastic_section(const SectionShape& shape, double E, double nu,
                                          double density);

}  // namespace polhode
