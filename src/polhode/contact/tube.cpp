// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <polhode/contact/tube.hpp>

namespace polhode::contact {

namespace {

/// Number of fixed points on a rim, as a cylinder has them, for standing on it.
constexpr int kTubeRimPoints = 12;

}  // namespace

Shape tube(std::string_view where, double outer, double inner, double length,
           const TriangleSurface& polygon, const ShapePlace& place, double rounding) {
  Shape s = mesh(where, polygon, place, rounding);
  const double R = 0.5 * outer - s.rounding, r = 0.5 * inner + s.rounding;
  s.half = {R, r, 0.5 * length - s.rounding};
  s.centre = place.origin;
  s.axes = place.axes;
  s.detail = 0.5 * std::min(0.5 * (outer - inner), length);
  s.points.clear();
  for (int i = 0; i < static_cast<int>(s.corners.size()); ++i) {
    const Vec3 x = s.axes.transpose() * (s.corners[i] - s.centre);
    const double step = 2.0 * std::numbers::pi / kTubeRimPoints, angle = std::atan2(x.y(), x.x());
    if (std::hypot(x.x(), x.y()) > 0.5 * (R + r) && std::abs(std::remainder(angle, step)) < 1e-6)
      s.points.push_back(i);
  }
  return s;
}

}  // namespace polhode::contact
