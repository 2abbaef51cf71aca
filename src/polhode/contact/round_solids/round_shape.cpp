// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <polhode/contact/round_solids/round_shape.hpp>

namespace polhode::contact {

namespace {

constexpr int kRimPoints = 12;           ///< Number of fixed points on a rim, for standing on it.
constexpr double kStandingRadius = 0.9;  ///< Radius of those against faces, as a part of the rim's.

}  // namespace

geometry::Shape round_shape(const RoundSolid& kind, const Vec3& half,
                            const geometry::ShapePlace& place) {
  geometry::Shape s;
  s.solid = geometry::Solid::round;
  s.round_solid = &kind;
  s.centre = place.origin;
  s.axes = place.axes;
  s.half = s.chords = half;
  return s;
}

void add_flat_end(geometry::Shape& s, double height, double radius) {
  s.flat_ends.push_back({height, radius});
  for (const double part : {1.0, kStandingRadius})
    for (int k = 0; k < kRimPoints; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kRimPoints, R = part * radius;
      (part == 1.0 ? s.points : s.face_points).push_back(static_cast<int>(s.corners.size()));
      s.corners.push_back(s.centre +
                          s.axes * Vec3(R * std::cos(angle), R * std::sin(angle), height));
    }
  s.rim_corners = static_cast<int>(s.corners.size());
}

CurvedSupport curved_ellipsoid(const Vec3& B, const Vec3& n) {
  const Vec3 squares = B.cwiseAbs2();
  const double length = B.cwiseProduct(n).norm();
  CurvedSupport c;
  c.x = squares.cwiseProduct(n) / length;
  c.D = (Mat3(squares.asDiagonal()) - c.x * c.x.transpose()) / length;
  return c;
}

}  // namespace polhode::contact
