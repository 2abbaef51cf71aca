// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/contact/gap.hpp>
#include <polhode/surface_contact/combined_gap.hpp>
#include <polhode/surface_contact/rigid_surface.hpp>

namespace polhode::surface_contact {

namespace {

/// Smallest distance from the axis of a tube, as a part of its bore, for directions.
constexpr double kOffAxis = 1e-7;

/// Nearest point of a core, and its derivative.
struct Nearest {
  Vec3 point = Vec3::Zero();
  Mat3 D = Mat3::Zero();
};

void clamp_along(const Vec3& y, int axis, double half, Nearest& n) {
  n.point[axis] = std::clamp(y[axis], -half, half);
  if (std::abs(y[axis]) < half) n.D(axis, axis) = 1.0;
}

/// Nearest point of the disc or tube about z.
void clamp_radially(const Vec3& y, double radius, Nearest& n) {
  const double rho = std::hypot(y[0], y[1]);
  if (rho <= radius) {
    n.point[0] = y[0];
    n.point[1] = y[1];
    n.D(0, 0) = n.D(1, 1) = 1.0;
    return;
  }
  const Vec3 t(-y[1] / rho, y[0] / rho, 0.0);
  n.point[0] = radius * y[0] / rho;
  n.point[1] = radius * y[1] / rho;
  n.D += radius / rho * t * t.transpose();
}

/// The ring between two radii about z. A point on the axis is nearest to all of it.
void clamp_in_ring(const Vec3& y, double inner, double outer, Nearest& n) {
  const double rho = std::hypot(y[0], y[1]), nearest = std::clamp(rho, inner, outer);
  const Vec3 out = rho > 0.0 ? Vec3(y[0] / rho, y[1] / rho, 0.0) : Vec3(1.0, 0.0, 0.0);
  const Vec3 t(-out[1], out[0], 0.0);
  n.point += nearest * out;
  if (rho > 0.0) n.D += nearest / rho * t * t.transpose();
  if (rho == nearest) n.D += out * out.transpose();
}

/// Gap inside a core, which no contact should reach: exit through the nearest face.
RigidSurface::Gap inside(const Vec3& depth, const Vec3 (&normals)[3], double offset) {
  Eigen::Index face = 0;
  const double least = depth.minCoeff(&face);
  return {-least - offset, normals[face], Mat3::Zero()};
}

using contact::Dual;
using contact::Placement;
using contact::V3;

RigidSurface::Gap over(const geometry::Shape& solid, const Vec3& y) {
  V3<Dual> x = contact::constant<Dual>(y);
  x.x.d[0] = x.y.d[1] = x.z.d[2] = 1.0;
  const Mat3 still = Mat3::Identity();
  const contact::Gap<Dual> g =
      contact::point_over_solid(x, 0.0, solid, Placement<Dual>(Vec3::Zero(), still, 6));
  RigidSurface::Gap gap{g.distance.v, contact::value(g.normal), Mat3::Zero()};
  for (int j = 0; j < 3; ++j)
    gap.curvature.col(j) = Vec3(g.normal.x.d[j], g.normal.y.d[j], g.normal.z.d[j]);
  return gap;
}

}  // namespace

RigidSurface::Gap RigidSurface::gap(const Vec3& y, const GapQuery& question) const {
  if (kind == Kind::mesh) return triangles->gap(y, question);
  Gap g = plain_gap(y);
  g.value -= question.radius;
  const contact::NormalLaw& law = question.law;
  const bool deep = g.value < law.floor() + kDeepInRigid * 2.0 * law.tolerance;
  if (kind != Kind::tube || !(g.value < law.reach()) || deep) return g;
  // A thick cable in the bore or its mouth touches both sides. Their directions follow the point,
  // which therefore does not count as on the axis.
  const double off = kOffAxis * half[1];
  const Vec3 beside = std::hypot(y[0], y[1]) < off ? Vec3(off, 0.0, y[2]) : y;
  Gap far = far_side(beside);
  far.value -= question.radius;
  if (!(far.value < law.reach())) return g;
  g = plain_gap(beside);
  g.value -= question.radius;
  std::vector<std::pair<Gap, int>> sides{{g, 1}, {far, 1}};
  return combined_gap(law, sides, g);
}

/// Gap of a point off the axis, in the bore of a tube or in front of it, to the side beyond the
/// axis.
RigidSurface::Gap RigidSurface::far_side(const Vec3& y) const {
  const double bore = half[1] + rounding, end = half[2] - rounding;
  const double rho = std::hypot(y[0], y[1]);
  if (!(rho < bore)) return {std::numeric_limits<double>::infinity(), Vec3::UnitZ(), Mat3::Zero()};
  const Vec3 out(y[0] / rho, y[1] / rho, 0.0), t(-out[1], out[0], 0.0);
  Nearest core;
  core.point = -bore * out;
  core.D = -bore / rho * t * t.transpose();
  clamp_along(y, 2, end, core);
  const Vec3 from = y - core.point;
  const double d = from.norm();
  const Vec3 n = from / d;
  return {d - rounding, n, (Mat3::Identity() - core.D - n * n.transpose()) / d};
}

double RigidSurface::distance(const Vec3& y, double at_most, bool sided) const {
  if (kind == Kind::mesh) return triangles->distance(y, at_most, sided);
  if (kind != Kind::convex) return plain_gap(y).value;
  const Mat3 still = Mat3::Identity();
  return contact::point_over_solid(contact::v3(y), 0.0, *solid,
                                   Placement<double>(Vec3::Zero(), still, 6))
      .distance;
}

/// Gap to a core. With c the nearest point of the core, d = |y − c|, n = (y − c)/d: the gap d −
/// radius has the Hessian (I − Dc − n nᵀ)/d. @eq{surface-gap}
RigidSurface::Gap RigidSurface::plain_gap(const Vec3& y) const {
  Nearest core;
  double offset = radius;
  switch (kind) {
    case Kind::plane:
      return {y[2], Vec3::UnitZ(), Mat3::Zero()};
    case Kind::convex:
      return over(*solid, y);
    case Kind::sphere:
    case Kind::mesh:
      break;
    case Kind::hollow_sphere: {
      const double d = y.norm();
      if (!(d > 0.0)) return {radius, Vec3::UnitZ(), Mat3::Zero()};
      const Vec3 n = y / d;
      return {radius - d, -n, -(Mat3::Identity() - n * n.transpose()) / d};
    }
    case Kind::capsule:
      clamp_along(y, 2, half[2], core);
      break;
    case Kind::cylinder: {
      offset = rounding;
      const double rho = std::hypot(y[0], y[1]);
      const double side = radius - rounding, end = half[2] - rounding;
      if (rho < side && std::abs(y[2]) < end) {
        const Vec3 out = rho > 0.0 ? Vec3(y[0] / rho, y[1] / rho, 0.0) : Vec3(1.0, 0.0, 0.0);
        return inside({side - rho, side - rho, end - std::abs(y[2])},
                      {out, out, Vec3(0.0, 0.0, y[2] < 0.0 ? -1.0 : 1.0)}, offset);
      }
      clamp_radially(y, side, core);
      clamp_along(y, 2, end, core);
      break;
    }
    case Kind::tube: {
      offset = rounding;
      const double rho = std::hypot(y[0], y[1]), end = half[2] - rounding;
      const double side = radius - rounding, bore = half[1] + rounding;
      if (rho > bore && rho < side && std::abs(y[2]) < end) {
        const Vec3 out(y[0] / rho, y[1] / rho, 0.0);
        return inside({side - rho, rho - bore, end - std::abs(y[2])},
                      {out, Vec3(-out), Vec3(0.0, 0.0, y[2] < 0.0 ? -1.0 : 1.0)}, offset);
      }
      clamp_in_ring(y, bore, side, core);
      clamp_along(y, 2, end, core);
      break;
    }
    case Kind::box: {
      offset = rounding;
      const Vec3 core_half = half.array() - rounding;
      Vec3 normals[3];
      for (int i = 0; i < 3; ++i) normals[i] = (y[i] < 0.0 ? -1.0 : 1.0) * Vec3::Unit(i);
      if ((y.cwiseAbs().array() < core_half.array()).all())
        return inside(core_half - y.cwiseAbs(), normals, offset);
      for (int i = 0; i < 3; ++i) clamp_along(y, i, core_half[i], core);
      break;
    }
  }
  const Vec3 from = y - core.point;
  const double d = from.norm();
  if (!(d > 0.0)) return {-offset, Vec3::UnitZ(), Mat3::Zero()};
  const Vec3 n = from / d;
  return {d - offset, n, (Mat3::Identity() - core.D - n * n.transpose()) / d};
}

double RigidSurface::extent() const {
  switch (kind) {
    case Kind::sphere:
      return radius;
    case Kind::capsule:
      return radius + half[2];
    case Kind::cylinder:
    case Kind::tube:
      return std::hypot(radius, half[2]);
    case Kind::box:
      return half.norm();
    case Kind::plane:
    case Kind::hollow_sphere:
    case Kind::convex:
      break;
    case Kind::mesh:
      return triangles->extent();
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace polhode::surface_contact
