// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode {

/// Exponential map: the rotation by the angle |chi| about chi.
/// @eq{eq:rbr-rotation-tensor-alt-2}, equal to @eq{eq:rbr-rotation-tensor} and
/// @eq{eq:rbr-rotation-tensor-alt-1}, which divide by the angle.
///
///   exp[χ̂] = I + sin χ/χ χ̂ + 2/χ² sin²(χ/2) χ̂²
///
/// @param chi  Rotation vector χ n [rad]; any finite value, series below 1e-4 rad.
/// @returns    Rotation matrix Λ [-].
[[nodiscard]] Mat3 exp_map(const Vec3& chi);

/// Rotation vector of a rotation, the inverse of exp_map(): angle in [0, π] [rad].
[[nodiscard]] Vec3 log_map(const Mat3& Lambda);

/// Time derivative of a rotation vector, from the angular velocity ω in the axes of the reference
/// frame: χ̇ = ω − ½ χ × ω + (1 − ½χ cot ½χ)/χ² χ × (χ × ω). @param chi  Shorter than 2π [rad].
[[nodiscard]] Vec3 rotation_vector_rate(const Vec3& chi, const Vec3& omega);

}  // namespace polhode
