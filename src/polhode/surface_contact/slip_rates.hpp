// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <polhode/core/types.hpp>

namespace polhode::surface_contact {

/// Two edges among four points, by the numbers of their ends.
using TwoEdges = std::array<int, 4>;

/// Relative velocity of the nearest points of two features in the plane normal to n, by the
/// velocities of their four points,
///
///   v_T = (I − n nᵀ)(Σ c_k v_k − ω × y),   y = Σ c_k x_k
///
/// with the rotation ω of the two given edges: a rotation of the whole causes no slip.
/// @param n  Unit, along y. @eq{edge-friction} @eq{mesh-friction}
[[nodiscard]] std::array<Mat3, 4> slip_rates(const Vec3 (&x)[4], const Eigen::Vector4d& c,
                                             const Vec3& n, const TwoEdges& edges);

}  // namespace polhode::surface_contact
