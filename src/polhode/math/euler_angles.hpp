// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include <polhode/core/types.hpp>

namespace polhode {

/// Euler angles of a rotation, each in (−π, π], the second in [0, π] for sequences like zxz and in
/// [−π/2, π/2] for others. Where the first and last axis coincide the last angle is zero.
/// @param sequence  Three letters, neighbours different: small ones are rotations about body-fixed
/// axes, capital ones about axes at rest.
/// @returns radians, in the order of the sequence. @eq{euler-angles}
[[nodiscard]] std::array<double, 3> euler_angles(const Mat3& R, std::string_view sequence);

}  // namespace polhode
