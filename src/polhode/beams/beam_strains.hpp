// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode {

using Vec15 = Eigen::Matrix<double, 15, 1>;
using Mat15 = Eigen::Matrix<double, 15, 15>;
using Mat6x15 = Eigen::Matrix<double, 6, 15>;

/// Section frames at both ends of a beam element and the offset between the ends, world. Averaged
/// over a step, the frames are not rotations.
struct BeamFrames {
  Vec3 offset;    ///< Δp = p_2 − p_1 [m].
  Mat3 D_1, D_2;  ///< Columns: along the beam, and the two section axes.
};

/// The scalar products ι = (a, b, R) of which strains are functions: a = D_1ᵀΔp, b = D_2ᵀΔp and R =
/// D_1ᵀD_2, column by column. They are quadratic in positions and frames, and invariant under
/// rotations of the whole. @eq{beam-invariants}
[[nodiscard]] Vec15 beam_invariants(const BeamFrames& frames);

/// Strains e = (Γ, K) of an element whose strains are constant along its length L:
///
///   φ = log R,  K = φ/L,  Γ = T⁻¹(φ) a/L = ½ [(a + b) − ½ φ × (a − b) + η φ × (φ × (a + b))] / L
///
/// with η = (1 − ½φ cot ½φ)/φ². Γ: extension and shears [-], K: torsion and bendings [1/m], both in
/// the section's axes; the undeformed straight beam has (1, 0, 0, 0, 0, 0).
///
/// With ends and signs exchanged the element is the same: the mean of the two forms, from a and
/// from b, is used; they differ only if R is an average. (Sonneville, Cardona, Brüls, Comput.
/// Methods Appl. Mech. Eng. 268 (2014) 451-474, for the interpolation on SE(3).)
struct BeamStrains {
  Vec6 e;
  Mat6x15 by_iota;  ///< ∂e/∂ι.
};

[[nodiscard]] Vec6 beam_strain_values(const Vec15& iota, double L);
[[nodiscard]] BeamStrains beam_strains(const Vec15& iota, double L);
/// Second derivative of σ·e by ι.
[[nodiscard]] Mat15 beam_strain_hessian(const Vec15& iota, double L, const Vec6& sigma);
/// Angle between the end frames [rad].
[[nodiscard]] double beam_angle(const Vec15& iota);

/// η(x) = (1 − ½φ cot ½φ)/φ² and its first two derivatives by x = φ²; |φ| < 2π.
struct Eta {
  double value, first, second;
};
[[nodiscard]] Eta beam_eta(double x);

}  // namespace polhode
