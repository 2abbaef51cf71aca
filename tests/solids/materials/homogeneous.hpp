// SPDX-License-Identifier: Apache-2.0
// Homogeneous deformations without a change of volume, with closed forms of the stress.
#pragma once

#include <cmath>

#include <Eigen/Dense>

#include <polhode/solids/materials/registry.hpp>

namespace polhode::test {

inline Vec6 six_of(const Mat3& T) {
  Vec6 v;
  v << T(0, 0), T(1, 1), T(2, 2), T(0, 1), T(1, 2), T(2, 0);
  return v;
}
inline Mat3 tensor_of(const Vec6& v) {
  Mat3 T;
  T << v[0], v[3], v[5], v[3], v[1], v[4], v[5], v[4], v[2];
  return T;
}
inline Vec6 green_strain_of(const Mat3& F) {
  return six_of(0.5 * (F.transpose() * F - Mat3::Identity()));
}
/// Cauchy stress at a deformation gradient [Pa].
inline Mat3 cauchy(const solids::Material& material, const Mat3& F, const Vec3& A = Vec3::UnitX()) {
  const Vec6 E = green_strain_of(F);
  const Mat3 S = tensor_of(solids::discrete_stress(material, E, E, A).S);
  return F * S * F.transpose() / F.determinant();
}
inline Mat3 uniaxial(double stretch) {
  const double other = 1.0 / std::sqrt(stretch);
  return Vec3(stretch, other, other).asDiagonal();
}
inline Mat3 equibiaxial(double stretch) {
  return Vec3(stretch, stretch, 1.0 / (stretch * stretch)).asDiagonal();
}
inline Mat3 simple_shear(double amount) {
  Mat3 F = Mat3::Identity();
  F(0, 1) = amount;
  return F;
}

}  // namespace polhode::test
