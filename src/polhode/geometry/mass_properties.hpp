// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include <polhode/core/types.hpp>

namespace polhode::geometry {

/// Mass, centre of mass and inertia of a rigid body.
///
/// The inertia is the tensor about the centre of mass in the body's axes. Its entry xy is −∫ x y
/// dm, the negative of the product of inertia in some books.
struct MassProperties {
  double mass = 0.0;            ///< [kg]
  Vec3 com = Vec3::Zero();      ///< Centre of mass in the current coordinates [m].
  Mat3 inertia = Mat3::Zero();  ///< About the centre of mass [kg m²].
};

/// Principal moments and axes of an inertia tensor: inertia = axes · diag(moments) · axesᵀ.
struct PrincipalAxes {
  Vec3 moments;  ///< Ascending [kg m²].
  Mat3 axes;     ///< Unit columns, right-handed [-].
};

/// Principal moments (ascending) and right-handed axes of a symmetric tensor.
[[nodiscard]] PrincipalAxes principal_axes(const Mat3& inertia);

/// Rejects impossible mass properties: a mass that is not positive and finite, an inertia tensor
/// that is not symmetric, principal moments that are not positive or violate the triangle
/// inequality J₃ ≤ J₁ + J₂ by more than a relative 1e-6 (numbers in files have few digits).
///
/// @param where  Path of the body in the user's model, first part of the message.
/// @throws InputError that names the three principal moments and the violated bound.
void check_mass_properties(std::string_view where, double mass, const Mat3& inertia);

/// Inertia at the orientation Lambda: J = Λ·J_r·Λᵀ [kg m²]. @eq{eq:rbm-moi-rotation}
[[nodiscard]] Mat3 inertia_at(const Mat3& Lambda, const Mat3& J_r);

/// Inertia about another point, axes kept (parallel-axes theorem) [kg m²].
/// @param point  In the coordinates of properties.com [m].
[[nodiscard]] Mat3 inertia_about(const MassProperties& properties, const Vec3& point);

/// Mass properties in a parent's coordinates: the body is first rotated by R, then translated by p.
/// @param p  Origin of the body's coordinates, in the parent's [m].
/// @param R  Rotation from the body's axes to the parent's [-].
[[nodiscard]] MassProperties placed(const MassProperties& properties, const Vec3& p, const Mat3& R);

/// Mass properties of one rigid body composed of several, all described in the same coordinates. A
/// part of negative mass is a hole; the sum is not checked here.
[[nodiscard]] MassProperties composed(std::span<const MassProperties> parts);

}  // namespace polhode::geometry
