// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <polhode/math/hat.hpp>

namespace polhode {

/// Cayley transform: the rotation by the Cayley vector chi.
/// @eq{eq:rbr-Cayley-transform}
///
///   cay[χ] = I + 2 / (1 + (χ/2)²) · (½ χ̂ + ¼ χ̂²)
///
/// @param chi  Cayley vector χ = 2 tan(angle/2) n [-]; any finite value.
/// @returns    Rotation matrix Λ [-]; orthogonal to rounding for every chi.
/// @note       Smooth at χ = 0: no small-angle branch. A rotation by π has no χ.
[[nodiscard]] inline Mat3 cay(const Vec3& chi) {
  const Mat3 chi_hat = hat(chi);
  const double half_squared = 0.25 * chi.squaredNorm();
  return Mat3::Identity() + 2.0 / (1.0 + half_squared) * (0.5 * chi_hat + 0.25 * chi_hat * chi_hat);
}

/// Cayley vector of a rotation, the inverse of cay(); nothing if the angle is π to rounding.
/// @eq{eq:exponential-Cayley-relation}
///
/// @param Lambda  Rotation matrix [-].
/// @returns       χ = 2 tan(angle/2) n [-].
[[nodiscard]] std::optional<Vec3> try_cayley_vector(const Mat3& Lambda);

/// Cayley vector of a rotation, see try_cayley_vector().
/// @throws InputError if the angle is π to rounding (χ would be infinite).
[[nodiscard]] Vec3 cayley_vector(const Mat3& Lambda);

/// T(Θ), the tangent of the Cayley vector for a right (material) increment:
/// cay[Θ + T(Θ)·ΔΘ] = cay[Θ]·cay[ΔΘ] to first order.
/// @eq{eq:td-T-Theta-relation} @eq{td-Theta-linearization} @eq{eq:td-linearization-rot}
///
/// @param Theta  Cayley vector of the step's rotation [-].
/// @returns      T(Θ) = I + ½ Θ̂ + ¼ Θ⊗Θ [-].
/// @note         For a left (spatial) increment of θ the tangent is T(θ)ᵀ.
[[nodiscard]] inline Mat3 cayley_tangent(const Vec3& Theta) {
  return Mat3::Identity() + 0.5 * hat(Theta) + 0.25 * Theta * Theta.transpose();
}

/// T(Θ)⁻¹ = (I − ½ Θ̂) / (1 + Θ²/4) [-].
[[nodiscard]] inline Mat3 cayley_tangent_inverse(const Vec3& Theta) {
  return (Mat3::Identity() - 0.5 * hat(Theta)) / (1.0 + 0.25 * Theta.squaredNorm());
}

/// Cayley vector of the product cay[b]·cay[a] [-]; infinite when that product is a rotation by π.
/// The Newton update of a rotation. @eq{eq:ga-Newton-iterations} Written as a plus a correction, so
/// that a small b causes no rounding of the length of a, which over many steps would show as a
/// drift of momentum.
[[nodiscard]] inline Vec3 compose_cayley(const Vec3& b, const Vec3& a) {
  const double q = 0.25 * a.dot(b);
  return a + (b + 0.5 * b.cross(a) + q * a) / (1.0 - q);
}

}  // namespace polhode
