// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <utility>

#include <Eigen/Eigenvalues>

#include <polhode/core/assert.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/geometry/mass_properties.hpp>

namespace polhode::geometry {
namespace {

/// Relative excess of J₃ over J₁ + J₂ that is accepted as rounding of printed numbers.
constexpr double kTriangleSlack = 1e-6;
/// Share of the largest moment below which a moment is zero to round-off.
constexpr double kZeroMoment = 1e-14;
/// Relative difference of xy and yx that is accepted as round-off.
constexpr double kSymmetrySlack = 1e-9;

/// m (d² I − d⊗d), the inertia of a point mass at d.
Mat3 point_inertia(double mass, const Vec3& d) {
  return mass * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
}

constexpr const char* kSignNote =
    "The entries are those of the tensor: xy is −∫ x y dm, minus the product of inertia of some "
    "textbooks";

}  // namespace

PrincipalAxes principal_axes(const Mat3& inertia) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia);
  PrincipalAxes result{.moments = solver.eigenvalues(), .axes = solver.eigenvectors()};
  if (result.axes.determinant() < 0.0) result.axes.col(0) *= -1.0;
  POLHODE_ASSERT(!result.moments.allFinite() || result.axes.isUnitary(1e-12));
  return result;
}

void check_mass_properties(std::string_view where, double mass, const Mat3& inertia) {
  if (!std::isfinite(mass) || mass <= 0.0)
    throw InputError(where, format("mass must be positive and finite, but is {:g} kg", mass),
                     "Give the mass of the body, or a shape and a density");
  if (!inertia.allFinite())
    throw InputError(where, "inertia has an entry that is not a finite number",
                     "Give three principal moments or the six entries of the tensor");

  const double largest_entry = inertia.cwiseAbs().maxCoeff();
  const Mat3 skew = inertia - inertia.transpose();
  Eigen::Index i = 0;
  Eigen::Index j = 0;
  if (skew.cwiseAbs().maxCoeff(&i, &j) > kSymmetrySlack * largest_entry) {
    if (i > j) std::swap(i, j);
    const char* axis = "xyz";
    throw InputError(where,
                     format("inertia is not symmetric: entry {}{} is {:g}, but {}{} is {:g} kg m²",
                            axis[i], axis[j], inertia(i, j), axis[j], axis[i], inertia(j, i)),
                     "Make both the same");
  }

  const Vec3 moments = principal_axes(inertia).moments;
  const std::string named =
      format("the principal moments of inertia are {:.6g}, {:.6g} and {:.6g} kg m²", moments[0],
             moments[1], moments[2]);
  const bool diagonal = (inertia - Mat3(inertia.diagonal().asDiagonal())).isZero(0.0);
  const std::string sign_note = diagonal ? "" : format(". {}", kSignNote);
  if (moments[0] <= kZeroMoment * largest_entry)
    throw InputError(where, named + ", but each must be positive",
                     "Give a thin body its small thickness, or say point_mass: true if it has no "
                     "rotation" +
                         sign_note);
  if (moments[2] > (1.0 + kTriangleSlack) * (moments[0] + moments[1]))
    throw InputError(
        where,
        format("{}, but the largest may not exceed the sum of the other two, {:.6g}", named,
               moments[0] + moments[1]),
        "No distribution of mass has these; check the values and their units" + sign_note);
}

Mat3 inertia_at(const Mat3& Lambda, const Mat3& J_r) { return Lambda * J_r * Lambda.transpose(); }

Mat3 inertia_about(const MassProperties& properties, const Vec3& point) {
  return properties.inertia + point_inertia(properties.mass, point - properties.com);
}

MassProperties placed(const MassProperties& properties, const Vec3& p, const Mat3& R) {
  return {.mass = properties.mass,
          .com = p + R * properties.com,
          .inertia = inertia_at(R, properties.inertia)};
}

MassProperties composed(std::span<const MassProperties> parts) {
  MassProperties sum;
  Vec3 first_moment = Vec3::Zero();
  for (const MassProperties& part : parts) {
    sum.mass += part.mass;
    first_moment += part.mass * part.com;
  }
  if (sum.mass != 0.0) sum.com = first_moment / sum.mass;
  for (const MassProperties& part : parts) sum.inertia += inertia_about(part, sum.com);
  return sum;
}

}  // namespace polhode::geometry
